declare module "virtual:listing/*" {
  export const compile: import("./harness.ts").Compile;
}
declare module "virtual:sandbox-worker" {
  /** The script of worker.ts with all that it imports, as text. */
  const script: string;
  export default script;
}
