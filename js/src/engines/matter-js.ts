import { PairFinder } from "../pairs/pair-finder.js";
import { hasMethods, Rows, sortedPairs, wrongArgument } from "./common.js";

/** What {@link replaceBroadPhase} needs of matter: the module, or an object with these three parts of it. */
export interface MatterModule {
  /** `Matter.Bounds`. */
  readonly Bounds: {
    /** Whether two bounds overlap. */
    overlaps(a: any, b: any): boolean;
  };
  /** `Matter.Collision`. */
  readonly Collision: {
    /** The collision of two bodies, if their shapes overlap. */
    collides(a: any, b: any, pairs?: any): object | null;
  };
  /** `Matter.Detector`. */
  readonly Detector: {
    /** Whether the filters of two bodies allow them to collide. */
    canCollide(a: any, b: any): boolean;
    /** All collisions of a detector's bodies: what is replaced. */
    collisions(detector: any): any[];
  };
}

/** A body of matter. */
interface Body {
  readonly bounds: { readonly min: Vector; readonly max: Vector };
  readonly collisionFilter: object;
  readonly isSleeping: boolean;
  readonly isStatic: boolean;
  readonly parts: readonly Body[];
}

interface Vector {
  readonly x: number;
  readonly y: number;
}

interface Detector {
  readonly bodies: Body[];
  readonly pairs: object;
  collisions: object[];
}

/**
 * Gives matter another broad phase: it replaces `Matter.Detector.collisions`, which each step calls. All engines
 * of this module use it from then on. The collisions are those of matter, in matter's order, so bodies move bit for bit as before.
 *
 * Each step takes O(n log n + pairs) time, and creates garbage as matter does: an array of the collisions.
 *
 * @throws {@link NotInitializedError} before the `init()` of `sweep-and-prune` is done; `TypeError` if `matter` is not the module.
 *   Each step throws an {@link InvalidBoxError} if the bounds of a body have a NaN.
 *
 * @example
 * ```js
 * import Matter from "matter-js";
 *
 * replaceBroadPhase(Matter);
 * ```
 */
export function replaceBroadPhase(matter: MatterModule): void {
  const { Bounds, Collision, Detector } = Object(matter) as MatterModule;
  if (!hasMethods(Detector, "canCollide", "collisions") || !hasMethods(Collision, "collides") || !hasMethods(Bounds, "overlaps")) {
    throw wrongArgument("matter", matter, "the module matter-js, with `Detector`, `Collision` and `Bounds`");
  }
  const finder = new PairFinder({ dimensions: 2 });
  const rows = new Rows(4);

  Detector.collisions = (detector: Detector): object[] => {
    const { bodies, pairs } = detector;
    bodies.sort((a, b) => a.bounds.min.x - b.bounds.min.x); // as matter does: its solver works in this order
    const boxes = rows.for(bodies.length);
    for (let i = 0; i < bodies.length; i++) {
      const { min, max } = bodies[i]!.bounds;
      boxes[4 * i] = min.x;
      boxes[4 * i + 1] = min.y;
      boxes[4 * i + 2] = max.x;
      boxes[4 * i + 3] = max.y;
    }
    const collisions: object[] = [];
    for (const [i, j] of sortedPairs(finder.find(boxes), bodies.length)) {
      const [a, b] = [bodies[i]!, bodies[j]!];
      if ((a.isStatic || a.isSleeping) && (b.isStatic || b.isSleeping)) continue;
      if (!Detector.canCollide(a.collisionFilter, b.collisionFilter)) continue;
      const isSimple = a.parts.length === 1 && b.parts.length === 1;
      for (const partA of partsOf(a)) {
        for (const partB of partsOf(b)) {
          const collision = (isSimple || Bounds.overlaps(partA.bounds, partB.bounds)) && Collision.collides(partA, partB, pairs);
          if (collision) collisions.push(collision);
        }
      }
    }
    return (detector.collisions = collisions);
  };
}

/** The parts of a compound body, or the body. */
function partsOf(body: Body): readonly Body[] {
  return body.parts.length > 1 ? body.parts.slice(1) : body.parts;
}
