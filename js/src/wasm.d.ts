/** A compiled core, whose bytes the build puts in the module as base64. */
declare module "*.wasm" {
  const base64: string;
  export default base64;
}
