import type { Corner3D } from "../boxes/boxes.js";
import { PairFinder } from "../pairs/pair-finder.js";
import { hasMethods, Rows, wrongArgument } from "./common.js";

/** What {@link replaceBroadPhase} needs of a `World` of cannon-es. */
export interface CannonWorld {
  /** Its bodies. */
  readonly bodies: readonly object[];
  /** Its broad phase. */
  readonly broadphase: {
    /** Adds the bodies of each pair that may touch to two arrays: what is replaced. */
    collisionPairs(world: any, first: any[], second: any[]): void;
    /** Whether two bodies may collide: their filters allow it, and one of them moves. */
    needBroadphaseCollision(a: any, b: any): boolean;
  };
}

/** A body of cannon. */
interface Body {
  readonly aabb: { readonly lowerBound: Corner3D; readonly upperBound: Corner3D };
  updateAABB(): void;
}

/**
 * Gives a world of cannon-es another broad phase: it replaces `world.broadphase.collisionPairs`, which `world.step` calls. The
 * pairs are those of boxes, as with `SAPBroadphase`, where `NaiveBroadphase` compares spheres, so more pairs may reach the
 * narrow phase; the contacts are the same. Filters, rays and `aabbQuery` stay those of `world.broadphase`. Call it again if you
 * give the world another broad phase later.
 *
 * Each step takes O(n log n + pairs) time.
 *
 * @throws {@link NotInitializedError} before the `init()` of `sweep-and-prune` is done; `TypeError` if `world` is not a world of
 *   cannon-es. Each step throws an {@link InvalidBoxError}, with the index in `world.bodies`, if the box of a body has a NaN.
 *
 * @example
 * ```js
 * const world = new CANNON.World({ gravity: new CANNON.Vec3(0, -9.82, 0) });
 * replaceBroadPhase(world);
 * ```
 */
export function replaceBroadPhase(world: CannonWorld): void {
  const { bodies, broadphase } = Object(world) as CannonWorld;
  if (!Array.isArray(bodies) || !hasMethods(broadphase, "collisionPairs", "needBroadphaseCollision")) {
    throw wrongArgument("world", world, "a `World` of cannon-es, with `bodies` and `broadphase`");
  }
  const finder = new PairFinder({ dimensions: 3 });
  const rows = new Rows(6);

  broadphase.collisionPairs = ({ bodies }: { bodies: readonly Body[] }, first: Body[], second: Body[]): void => {
    const boxes = rows.for(bodies.length);
    for (let i = 0; i < bodies.length; i++) {
      const body = bodies[i]!;
      body.updateAABB(); // also of bodies at rest: cannon does not note that a position was set
      const { lowerBound: low, upperBound: high } = body.aabb;
      boxes[6 * i] = low.x;
      boxes[6 * i + 1] = low.y;
      boxes[6 * i + 2] = low.z;
      boxes[6 * i + 3] = high.x;
      boxes[6 * i + 4] = high.y;
      boxes[6 * i + 5] = high.z;
    }
    const pairs = finder.find(boxes);
    for (let i = 0; i < pairs.length; i += 2) {
      const [a, b] = [bodies[pairs[i]!]!, bodies[pairs[i + 1]!]!];
      if (!broadphase.needBroadphaseCollision(a, b)) continue; // cannon's filters, and bodies at rest
      first.push(a);
      second.push(b);
    }
  };
}
