import { describe } from "../wasm/describe.js";
import { checkOptions } from "./bodies.js";
import { checkDimensions, type Dimensions } from "../boxes/boxes.js";
import { checkFits, Code } from "../wasm/engine.js";
import { OutOfMemoryError } from "../wasm/errors.js";
import { checkSorted } from "./query-arguments.js";
import { SnapshotError } from "./snapshot-error.js";
import { checkId } from "./arguments.js";
import { worldCore } from "./core.js";
import { checkOptionNames } from "../wasm/options.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { checkViews } from "../wasm/views.js";
import { Batches } from "./batches.js";
import { newWorld, WorldMemory } from "./memory.js";
import type { BroadPhaseOptions, ProxyId, SortOptions } from "./types.js";

/**
 * A persistent broad phase: it keeps bodies with boxes, and reports which overlaps began and which
 * ended.
 *
 * ```js
 * using world = new BroadPhase({ dimensions: 2 });
 * const hero = world.insert(0, 0, 1, 2);
 * world.set(hero, 3.5, 0, 4.5, 2);
 * const { begun } = world.update();
 * for (let i = 0; i < begun.length; i += 2) console.log(begun[i], "touches", begun[i + 1]);
 * ```
 *
 * The same calls give the same results on every machine. A call that throws changes nothing, with one
 * exception: a `BroadPhase` that runs out of memory is freed.
 */
export class BroadPhase extends Batches {
  /**
   * An empty broad phase.
   *
   * @throws {@link NotInitializedError} before `init()` is done.
   * @throws `RangeError` for dimensions other than 1, 2 and 3, or a margin or prediction that is
   *   negative, infinite or NaN; `TypeError` if `views` is not a boolean.
   */
  constructor(options: BroadPhaseOptions) {
    const given: unknown = options;
    super(given instanceof WorldMemory ? given : WorldMemory.create(worldCore, checkOptions(options)));
  }

  /**
   * Restores a {@link BroadPhase.snapshot}: for the same calls it gives the same ids, events and
   * results. The other options are in the bytes.
   *
   * @throws {@link SnapshotError} if the bytes are not a snapshot of boxes with these dimensions.
   */
  static fromSnapshot(bytes: Uint8Array, options: { dimensions: Dimensions; views?: boolean }): BroadPhase {
    if (tagOf(bytes) !== "Uint8Array") throw new TypeError(`\`bytes\` must be a Uint8Array, not ${describe(bytes)}`);
    checkOptionNames(options, ["dimensions", "views"]);
    const memory: unknown = restore(bytes, checkDimensions(options.dimensions), checkViews(options.views));
    return new BroadPhase(memory as BroadPhaseOptions);
  }

  /**
   * The pairs that overlapped at the last update: `a0, b0, a1, b1, ...`, sorted by slot. With
   * `{ sorted: false }` they are in no particular order, which takes less time.
   */
  pairs(options?: SortOptions): Float64Array {
    const isSorted = checkSorted(options);
    return this.memory.answer((exports, world) => exports.world_pairs(world, isSorted));
  }

  /**
   * The bodies that overlapped this one at the last update, sorted by slot.
   *
   * @throws {@link StaleProxyError}.
   */
  pairsOf(id: ProxyId): Float64Array {
    checkId(id);
    return this.memory.answer((exports, world) => exports.world_pairs_of(world, id), { ids: [id] });
  }

  /**
   * A copy of the whole state as bytes, for rollback, replay and saved games. Equal states give equal
   * bytes.
   */
  snapshot(): Uint8Array<ArrayBuffer> {
    this.memory.call((exports, world) => exports.world_snapshot(world));
    const { engine } = this.memory;
    return new Uint8Array(engine.exports.memory.buffer, engine.detail(0), engine.detail(1)).slice();
  }

  /** A 64-bit hash of the whole state, equal for equal states on every machine. */
  stateHash(): bigint {
    this.memory.call((exports, world) => exports.world_state_hash(world));
    const { engine } = this.memory;
    return (BigInt(engine.detail(1)) << 32n) | BigInt(engine.detail(0));
  }
}

/** The broad phase of a snapshot. */
function restore(bytes: Uint8Array, dimensions: Dimensions, isView: boolean): WorldMemory {
  const engine = worldCore.engine();
  const length = lengthOf(bytes);
  checkFits(length);
  const handle = newWorld(engine, dimensions, false);
  try {
    engine.calls++;
    const at = handle.call((exports, world) => exports.world_bytes(world, length)) >>> 0;
    if (at === 0) throw new OutOfMemoryError();
    new Uint8Array(engine.exports.memory.buffer, at, length).set(bytes);
    const code = handle.call((exports, world) => exports.world_restore(world));
    if (code === Code.InvalidSnapshot) throw new SnapshotError(engine.detail(0), engine.detail(1));
    engine.check(code);
    return new WorldMemory(dimensions, engine.detail(0) !== 0, isView, handle);
  } catch (error) {
    handle.free();
    throw error;
  }
}
