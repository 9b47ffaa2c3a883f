/** Whether the engine takes the smallest function with a vector instruction. */
export function hasSimd(): boolean {
  // prettier-ignore
  return WebAssembly.validate(new Uint8Array([
    0, 97, 115, 109, 1, 0, 0, 0, // "\0asm", version 1
    1, 5, 1, 96, 0, 1, 123, // one type: () -> v128
    3, 2, 1, 0, // one function of it
    10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11, // i32.const 0; i8x16.splat; i8x16.popcnt; end
  ]));
}
