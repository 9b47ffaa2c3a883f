import type { EdgesBox } from "../boxes/boxes.js";
import type { BroadPhase } from "../world/broad-phase.js";
import type { Filter } from "../world/filter.js";
import { insert, type Kind, move } from "./objects.js";

/** A `Container` of Pixi: a sprite, graphics, a text, or what holds several. */
export interface PixiObject {
  /** Its bounds in the coordinates of the stage. */
  getBounds(skipUpdate?: boolean, bounds?: any): EdgesBox<2>;

  /** What it is in. */
  readonly parent?: PixiParent | null;

  /** Whether it was destroyed, after which it has no bounds. */
  readonly destroyed?: boolean;
}

/** A `Container` that holds others. */
export interface PixiParent {
  /** Whether what it holds is drawn. */
  readonly visible: boolean;

  /** What it is in. */
  readonly parent?: PixiParent | null;
}

/** One object for the bounds of all calls, which the first call makes. */
let bounds: ReturnType<PixiObject["getBounds"]> | undefined;

const kind: Kind<2, PixiObject> = {
  dimensions: 2,
  name: "a `Container` of Pixi",
  method: "getBounds",
  writeBox(object, boxes, at) {
    if (object.destroyed) return false;
    // Its bounds are the same if something that it is in is invisible.
    for (let { parent } = object; parent; { parent } = parent) if (!parent.visible) return false;
    bounds = object.getBounds(false, bounds);
    const { minX, minY, maxX, maxY } = bounds;
    // What is empty or invisible has these bounds in Pixi, wherever it is.
    if (minX === 0 && minY === 0 && maxX === 0 && maxY === 0) return false;
    boxes[at] = minX;
    boxes[at + 1] = minY;
    boxes[at + 2] = maxX;
    boxes[at + 3] = maxY;
    return true;
  },
};

/**
 * Inserts a body for each sprite or container, whose box is that of `getBounds()`, in the coordinates of the stage, and whose data is the
 * object. Returns their ids, in the order of the objects. What is empty or invisible, by itself or by what it is in, pairs with
 * nothing until it has bounds, and what was destroyed with nothing. What leaves the stage still has bounds: remove its body.
 *
 * @param filter One filter for all bodies, or an array with one for each.
 *
 * @throws `TypeError` if `world` is not a `BroadPhase`, or an object is not a `Container`; `RangeError` if `world` does not have 2 dimensions; otherwise as
 *   {@link BroadPhase.insertMany}.
 *
 * @example
 * ```js
 * const world = new BroadPhase({ dimensions: 2 });
 * insertObjects(world, coins, { category: 2, mask: 1 });
 * ```
 */
export function insertObjects<Data>(world: BroadPhase<2, Data>, objects: readonly (Data & PixiObject)[], filter?: Partial<Filter> | readonly Partial<Filter>[]): Float64Array {
  return insert(kind, world, objects, filter);
}

/**
 * Gives each body whose data is a sprite or a container the bounds that the object has now: call it once in each frame, before
 * `world.update()` and before queries. Other bodies stay where they are.
 *
 * A body is disabled while its object has no box, and in snapshots and clones of that time, too: after `restore` and in a clone,
 * enable it yourself. It is enabled when its object has a box again, also if you disabled it meanwhile.
 *
 * It takes the time of `getBounds()` for each object.
 *
 * @throws `TypeError` if `world` is not a `BroadPhase`, `RangeError` if it does not have 2 dimensions, {@link InvalidBoxError} if a box has a NaN.
 *
 * @example
 * ```js
 * app.ticker.add(() => {
 *   moveObjects(world);
 *   for (const [a, b] of world.dataPairs(world.update().begun)) collect(a, b);
 * });
 * ```
 */
export function moveObjects(world: BroadPhase<2>): void {
  move(kind, world);
}
