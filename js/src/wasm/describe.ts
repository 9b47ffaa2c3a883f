/** @internal What a value is, for an error message. */
export function describe(value: unknown): string {
  if (typeof value === "string") return "a string";
  if (typeof value === "bigint") return `${value}n`;
  if (value === null || (typeof value !== "object" && typeof value !== "function")) return String(value);
  try {
    const { name } = value.constructor;
    const type = typeof name === "string" && name ? name : "object";
    return `${/^[AEIOaeio]/.test(type) ? "an" : "a"} ${type}`;
  } catch {
    return "an object"; // a getter threw
  }
}
