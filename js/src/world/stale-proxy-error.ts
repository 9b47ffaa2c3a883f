import { SweepAndPruneError } from "../wasm/errors.js";

/** The id of a body that was removed, or an id that never had a body. An id of another `BroadPhase` may go unnoticed. */
export class StaleProxyError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "StaleProxyError";

  constructor(
    /** The position of the id among those that were passed; 0 for a single one. */
    readonly index: number,
    /** The id. */
    readonly id: number,
  ) {
    super(`the id at index ${index} (${id}) is stale: its body was removed, or it never had one here`);
  }
}
