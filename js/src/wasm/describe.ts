/** @internal What a value is, for an error message. */
export function describe(value: unknown): string {
  if (typeof value === "string") return "a string";
  if (value === null || (typeof value !== "object" && typeof value !== "function")) return String(value);
  try {
    const { name } = value.constructor;
    return `a ${typeof name === "string" && name ? name : "object"}`;
  } catch {
    return "an object"; // a getter threw
  }
}
