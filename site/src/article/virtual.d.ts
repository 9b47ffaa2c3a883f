declare module "virtual:quicksort" {
  export const compile: import("./edit/harness.ts").Compile;
}
