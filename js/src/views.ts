/** The arrays that views of memory are. */
export type Typed = Float32Array | Float64Array | Uint32Array | Uint8Array;

/** The last view if it still is the one asked for, which saves the garbage, or a new one. */
export function view<T extends Typed>(
  Type: new (buffer: ArrayBuffer, at: number, length: number) => T,
  last: Typed | undefined,
  buffer: ArrayBuffer,
  at: number,
  length: number,
): T {
  const isSame =
    last instanceof Type && last.buffer === buffer && last.byteOffset === at && last.length === length;
  return isSame ? last : new Type(buffer, at, length);
}
