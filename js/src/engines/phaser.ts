import { PairFinder } from "../pairs/pair-finder.js";
import { hasMethods, Rows, sortedPairs, wrongArgument } from "./common.js";

/** What {@link replaceBroadPhase} needs of a `Scene` of Phaser with arcade physics. */
export interface ArcadeScene {
  /** Its arcade physics. */
  readonly physics: {
    /** Its world, whose overlaps of groups are replaced. */
    readonly world: {
      /** Tests two bodies, and moves them apart unless `overlapOnly`. */
      separate(a: any, b: any, process?: any, context?: any, overlapOnly?: boolean): boolean;
    };
  };
}

type Callback = ((this: unknown, a: object, b: object) => unknown) | null;

/** A group of Phaser. Those of arcade physics have a `physicsType`. */
interface Group {
  readonly isParent?: boolean;
  readonly physicsType?: number;
  getChildren(): readonly { readonly body: Body | null }[];
  contains(child: object): boolean;
}

/** A body of arcade physics. */
interface Body {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  readonly enable: boolean;
  readonly checkCollision: { readonly none: boolean };
  readonly gameObject: object;
}

/** The world of arcade physics, with what its types leave out. */
interface World {
  _total: number;
  canCollide(a: object, b: object): boolean;
  collideObjects(a: Group, b: Group | undefined, onHit: Callback, process: Callback, context: unknown, overlapOnly: boolean): boolean;
  separate(a: Body, b: Body, process: Callback, context: unknown, overlapOnly: boolean): boolean;
}

/**
 * Gives the arcade physics of a scene another broad phase for overlaps of its groups, `this.physics.add.overlap(bullets, rocks, onHit)`
 * and `this.physics.overlap(bullets, rocks)`, also of a group with itself: one search finds the pairs of all bodies. Arcade physics tests
 * each pair itself, and calls the same callbacks: for each object of the first group, in its order, with those of the second group in
 * their order. Colliders, single sprites, groups without physics and tilemaps stay as they are. Call it in `create`, since each start
 * of a scene makes a world.
 *
 * A callback that moves or enables a body changes what is found in the next step, and not in this one.
 *
 * Each overlap of groups takes O(n log n + pairs) time, and does not use arcade's own tree. If your game has no other
 * colliders of dynamic groups, `useTree: false` in its configuration saves the time to build that tree in each step.
 *
 * @throws {@link NotInitializedError} before the `init()` of `sweep-and-prune` is done; `TypeError` if `scene` is not a scene with
 *   arcade physics. A step throws an {@link InvalidBoxError} if the box of a body has a NaN.
 *
 * @example
 * ```js
 * create() {
 *   replaceBroadPhase(this);
 *   this.physics.add.overlap(this.bullets, this.rocks, (bullet, rock) => rock.destroy());
 * }
 * ```
 */
export function replaceBroadPhase(scene: ArcadeScene): void {
  const world = Object(Object(scene).physics).world as World;
  if (!hasMethods(world, "canCollide", "collideObjects", "separate")) {
    throw wrongArgument("scene", scene, "a `Scene` of Phaser with arcade physics, with `physics.world`");
  }
  const finder = new PairFinder({ dimensions: 2 });
  const [rowsA, rowsB] = [new Rows(4), new Rows(4)];
  const own = world.collideObjects;

  world.collideObjects = (a, b, onHit, process, context, overlapOnly) => {
    // A collider moves bodies apart between two tests, so later pairs are not those that a search finds now.
    if (!overlapOnly || !isGroup(a) || !(b === undefined || isGroup(b))) return own.call(world, a, b, onHit, process, context, overlapOnly);
    world._total = 0;
    if (b && b !== a && !world.canCollide(a, b)) return false;
    const first = bodiesOf(a).filter((body) => !b || world.canCollide(body, b));
    const second = b ? bodiesOf(b) : first;
    const boxes = boxesOf(first, rowsA);
    // Without a second group, each pair once.
    const pairs = b ? finder.findBetween(boxes, boxesOf(second, rowsB)) : finder.find(boxes);
    for (const [i, j] of sortedPairs(pairs, second.length)) {
      const [bodyA, bodyB] = [first[i]!, second[j]!];
      // A callback may have taken it out of its group; `separate` sees that it was destroyed.
      if (bodyA === bodyB || !(b ?? a).contains(bodyB.gameObject)) continue;
      if (!world.separate(bodyA, bodyB, process, context, true)) continue;
      onHit?.call(context, bodyA.gameObject, bodyB.gameObject);
      world._total++;
    }
    return world._total > 0;
  };
}

/** Whether it is a group of arcade physics: neither a sprite nor an array, say. */
function isGroup(group: Group | null): boolean {
  return group?.isParent === true && group.physicsType !== undefined;
}

/** The bodies of a group that may touch others. */
function bodiesOf(group: Group): Body[] {
  return group.getChildren().flatMap(({ body }) => (body?.enable && !body.checkCollision.none ? body : []));
}

function boxesOf(bodies: readonly Body[], rows: Rows): Float64Array {
  const boxes = rows.for(bodies.length);
  bodies.forEach(({ left, top, right, bottom }, i) => {
    boxes[4 * i] = left;
    boxes[4 * i + 1] = top;
    boxes[4 * i + 2] = right;
    boxes[4 * i + 3] = bottom;
  });
  return boxes;
}
