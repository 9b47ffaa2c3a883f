/** @internal What a value is, for an error message. */
export function describe(value: unknown): string {
  if (value === null || typeof value !== "object") return typeof value === "string" ? "a string" : String(value);
  return `a ${value.constructor?.name ?? "object"}`;
}
