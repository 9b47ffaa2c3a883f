import { describe } from "./describe.js";

/**
 * Checks an object of options, apart from their values.
 *
 * @throws `TypeError` if it is no object, or has an option that does not exist.
 */
export function checkOptionNames(options: unknown, known: readonly string[], name = "options"): void {
  if (typeof options !== "object" || options === null || Array.isArray(options) || ArrayBuffer.isView(options)) {
    throw new TypeError(`\`${name}\` must be an object with ${listed(known)}, not ${describe(options)}`);
  }
  for (const key in options) if (!known.includes(key)) throw new TypeError(`\`${name}\` has no \`${key}\`: there is ${listed(known)}`);
}

function listed(names: readonly string[]): string {
  return names.map((name) => `\`${name}\``).join(", ");
}
