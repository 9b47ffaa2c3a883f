/**
 * The code with the number of its line told before each call of what reports to a demo, on the same lines. So the demo can say
 * which line did what it shows.
 */
export const withLines = (code: string): string =>
  code
    .split("\n")
    .map((line, at) => (/\bfunction (precedes|overlaps)\b/.test(line) ? line : line.replace(/\b(precedes|overlaps|onOverlapX|onPair)\(/g, `($line(${at + 1}), $1)(`)))
    .join("\n");
