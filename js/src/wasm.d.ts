/** A compiled core, whose bytes the build puts in the module. */
declare module "*.wasm" {
  const bytes: Uint8Array<ArrayBuffer>;
  export default bytes;
}
