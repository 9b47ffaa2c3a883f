import { SweepAndPruneError } from "../wasm/errors.js";

/** The bytes are not a snapshot, or not one that can be restored with these options. */
export class SnapshotError extends SweepAndPruneError {
  /** The name of this class. */
  override name = "SnapshotError";

  /** @internal */
  constructor(fault: number, found: number) {
    const faults = [
      "it does not begin as a snapshot does",
      `it is of version ${found}, which this version of the package cannot read`,
      `it holds boxes of other dimensions: pass \`dimensions: ${found}\` (JavaScript cannot read the 1D and the double-precision 2D snapshots of Rust and Python)`,
      "it ends too early",
      "it is damaged: its parts contradict each other or their checksum",
    ];
    super(`the snapshot cannot be restored: ${faults[fault] ?? faults[4]}`);
  }
}
