declare module "virtual:benchmark-results" {
  const runs: readonly import("./results.ts").Run[];
  export default runs;
}
