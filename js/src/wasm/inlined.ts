import { inflateSync } from "fflate";

/** The digits of base64, by their code. */
const digits = new Uint8Array(128);
for (const [value, digit] of [..."ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/"].entries()) digits[digit.charCodeAt(0)] = value;

/** The bytes of a compiled core that is inside a module: deflated, in base64. */
export function bytesOf(inlined: string): Uint8Array<ArrayBuffer> {
  return inflateSync(fromBase64(inlined));
}

/** Not by `atob` (and not by a `DecompressionStream` above), which worklets do not have. */
function fromBase64(base64: string): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(Math.floor((base64.replace(/=+$/, "").length * 3) / 4));
  const digit = (at: number): number => digits[base64.charCodeAt(at)]!;
  for (let from = 0, to = 0; to < bytes.length; from += 4, to += 3) {
    const three = (digit(from) << 18) | (digit(from + 1) << 12) | (digit(from + 2) << 6) | digit(from + 3);
    // What does not fit is not written.
    bytes[to] = three >> 16;
    bytes[to + 1] = three >> 8;
    bytes[to + 2] = three;
  }
  return bytes;
}
