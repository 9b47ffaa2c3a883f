/** An attribute has a value that is not possible. The message is for the author of the page. */
export class OptionError extends Error {
  override readonly name = "OptionError";
}

/** Why a demo cannot start. */
export function messageOf(error: unknown): string {
  return error instanceof OptionError ? error.message : `This demo cannot start: ${String(error)}`;
}
