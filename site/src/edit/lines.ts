/** A call of what reports to a demo. Not a method, and not where a function or a method of such a name is defined. */
const CALL = /(?<![.\w$#]|\bfunction\s+)(?:precedes|overlaps|onOverlapX|onPair)(?=\()(?!\([^()]*\)\s*\{)/g;

/**
 * The code with the number of its line told before each call of what reports to a demo, on the same lines. So the demo can say
 * which line did what it shows.
 */
export const withLines = (code: string): string => code.replace(CALL, (name, at: number) => `$line(${code.slice(0, at).split("\n").length}, ${name})`);
