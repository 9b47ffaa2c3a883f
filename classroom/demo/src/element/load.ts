import { init } from "../index.js";
import { algorithmsOfVariants } from "./variants.js";
import { loadWorlds } from "./world.js";

let loading: Promise<void> | undefined;

/** Loads the compiled algorithms and the compiled simulation, once; after a failure the next call tries again. */
export function loadDemos(): Promise<void> {
  const wasm = algorithmsOfVariants();
  loading ??= Promise.all([init(wasm === undefined ? {} : { wasm }), loadWorlds()]).then(
    () => undefined,
    (error: unknown) => {
      loading = undefined;
      throw error;
    },
  );
  return loading;
}
