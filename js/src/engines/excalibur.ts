import { BroadPhase } from "../world/broad-phase.js";
import type { ProxyId } from "../world/types.js";
import { hasMethods, wrongArgument } from "./common.js";

/** What {@link replaceBroadPhase} needs of a `Scene` of Excalibur. */
export interface ExcaliburScene {
  /** Its physics. */
  readonly physics: {
    /** Its broad phase: what is replaced. */
    readonly collisionProcessor: object;
  };
}

/** What {@link replaceBroadPhase} needs of Excalibur: the module, or an object with these three of its classes. */
export interface ExcaliburModule {
  /** `ex.BodyComponent`. */
  readonly BodyComponent: Function;
  /** `ex.CollisionGroup`. */
  readonly CollisionGroup: {
    /** The group of bodies that have none. */
    readonly All: object;
  };
  /** `ex.Pair`. */
  readonly Pair: {
    /** A pair of colliders. */
    new (a: any, b: any): object;
    /** Whether two colliders may collide. */
    canCollide(a: any, b: any): boolean;
  };
}

/** A collider of Excalibur. */
interface Collider {
  readonly bounds: BoundingBox;
  owner: { get(component: unknown): Body | undefined };
  rayCast(ray: Ray, maxDistance: number): RayCastHit | null;
  /** Of a composite collider. */
  getColliders?(): Collider[];
}

interface BoundingBox {
  readonly left: number;
  readonly top: number;
  readonly right: number;
  readonly bottom: number;
  overlaps(other: BoundingBox): boolean;
}

interface Body {
  readonly group: { readonly category: number; readonly mask: number };
  readonly collisionType: string;
}

interface Vector {
  readonly x: number;
  readonly y: number;
}

interface Ray {
  readonly pos: Vector;
  readonly dir: Vector & { normalize(): Vector };
}

interface RayCastHit {
  readonly distance: number;
}

interface RayCastOptions {
  readonly maxDistance?: number;
  readonly collisionGroup?: { readonly category: number };
  readonly collisionMask?: number;
  readonly searchAllColliders?: boolean;
  readonly ignoreCollisionGroupAll?: boolean;
  readonly filter?: (hit: RayCastHit) => boolean;
}

/** Excalibur's interface `CollisionProcessor`. */
interface CollisionProcessor {
  getColliders(): readonly Collider[];
  track(target: Collider): void;
  untrack(target: Collider | undefined): void;
  update(colliders: readonly Collider[], elapsed: number): number;
  broadphase(colliders: readonly Collider[], elapsed: number): object[];
  narrowphase(pairs: object[], stats?: object): object[];
  query(where: Vector | BoundingBox): Collider[];
  rayCast(ray: Ray, options?: RayCastOptions): RayCastHit[];
  debug(context: object, elapsed: number): void;
}

/**
 * Gives a scene of Excalibur another broad phase: a `BroadPhase` whose bodies are the scene's colliders. It finds the pairs, and
 * answers `scene.physics.query` and `scene.physics.rayCast`. The narrow phase and the solver stay Excalibur's. The contacts are
 * the same; their order is not. Excalibur's dynamic tree also stops fast bodies at what is in their way
 * (`continuous.checkForFastBodies`); this one does not.
 *
 * A step takes the time of {@link BroadPhase.update}, and O(1) for each collider that is passed to it.
 *
 * @param scene The scene. It may have actors already.
 * @param excalibur The module: `import * as ex from "excalibur"`. Or, for smaller bundles, `{ BodyComponent, CollisionGroup, Pair }`.
 *
 * @throws {@link NotInitializedError} before the `init()` of `sweep-and-prune/broad-phase` is done; `TypeError` if `scene` or
 *   `excalibur` is something else. A step throws an {@link InvalidBoxError} if the bounds of a collider have a NaN.
 *
 * @example
 * ```js
 * import * as ex from "excalibur";
 *
 * replaceBroadPhase(engine.currentScene, ex);
 * ```
 */
export function replaceBroadPhase(scene: ExcaliburScene, excalibur: ExcaliburModule): void {
  const { physics } = Object(scene) as ExcaliburScene;
  const own = Object(physics).collisionProcessor as CollisionProcessor | undefined;
  if (!hasMethods(own, "getColliders", "track", "untrack", "narrowphase")) {
    throw wrongArgument("scene", scene, "a `Scene` of Excalibur, with `physics.collisionProcessor`");
  }
  const { BodyComponent, CollisionGroup, Pair } = Object(excalibur) as ExcaliburModule;
  if (typeof BodyComponent !== "function" || !CollisionGroup?.All || !hasMethods(Pair, "canCollide")) {
    throw wrongArgument("excalibur", excalibur, "the module excalibur, with `BodyComponent`, `CollisionGroup` and `Pair`");
  }
  const processor = new Processor(own!, excalibur);
  for (const collider of [...own!.getColliders()]) {
    own!.untrack(collider);
    processor.track(collider);
  }
  // `collisionProcessor` is a getter that makes another one when the configuration changes, and `query` reads what is behind it.
  Object.defineProperties(physics, { collisionProcessor: { value: processor, configurable: true }, _collisionProcessor: { value: processor, configurable: true } });
}

/** A collision processor whose broad phase is a {@link BroadPhase}. Excalibur's colliders are its bodies. */
class Processor implements CollisionProcessor {
  readonly #own: CollisionProcessor;
  readonly #excalibur: ExcaliburModule;
  readonly #world = new BroadPhase<2, Collider>({ dimensions: 2, precision: "double" });
  /** Of each collider its id, and the group and the type that its body had last. */
  readonly #tracked = new Map<Collider, { readonly id: ProxyId; group?: Body["group"]; type?: string }>();

  constructor(own: CollisionProcessor, excalibur: ExcaliburModule) {
    this.#own = own;
    this.#excalibur = excalibur;
  }

  getColliders(): Collider[] {
    return [...this.#tracked.keys()];
  }

  track(target: Collider | undefined): void {
    for (const collider of partsOf(target)) {
      collider.owner = target!.owner;
      if (this.#tracked.has(collider)) continue;
      const { left, top, right, bottom } = collider.bounds;
      this.#tracked.set(collider, { id: this.#world.insert([left, top, right, bottom], { data: collider }) });
    }
  }

  untrack(target: Collider | undefined): void {
    for (const collider of partsOf(target)) {
      const tracked = this.#tracked.get(collider);
      if (tracked) this.#world.remove(tracked.id);
      this.#tracked.delete(collider);
    }
  }

  update(colliders: readonly Collider[]): number {
    const known = colliders.filter((collider) => this.#tracked.has(collider));
    const { ids, boxes } = this.#world.buffers(known.length);
    known.forEach((collider, i) => {
      const tracked = this.#tracked.get(collider)!;
      const { left, top, right, bottom } = collider.bounds;
      ids[i] = tracked.id;
      boxes[4 * i] = left;
      boxes[4 * i + 1] = top;
      boxes[4 * i + 2] = right;
      boxes[4 * i + 3] = bottom;
      const body = this.#bodyOf(collider);
      // Excalibur lets no two collide of which one has no body, such as one for the pointer alone.
      if (!body || (tracked.group === body.group && tracked.type === body.collisionType)) return;
      const { group, collisionType: type } = body;
      Object.assign(tracked, { group, type });
      this.#world.setFilter(tracked.id, { category: group.category, mask: group.mask, isStatic: type === "Fixed" });
    });
    this.#world.setMany(ids, boxes);
    return known.length;
  }

  broadphase(): object[] {
    const { Pair } = this.#excalibur;
    this.#world.update();
    const pairs = [];
    for (const [a, b] of this.#world.dataPairs(this.#world.pairs())) {
      // What is left for Excalibur to decide: colliders of one actor, actors that are not active; boxes that only touch.
      if (Pair.canCollide(a, b) && a.bounds.overlaps(b.bounds)) pairs.push(new Pair(a, b));
    }
    return pairs;
  }

  narrowphase(pairs: object[], stats?: object): object[] {
    return this.#own.narrowphase(pairs, stats);
  }

  query(where: Vector | BoundingBox): Collider[] {
    const found = "left" in where
      ? this.#world.overlapping([where.left, where.top, where.right, where.bottom])
      : this.#world.containing([where.x, where.y]);
    return this.#world.dataOf(found);
  }

  rayCast(ray: Ray, options: RayCastOptions = {}): RayCastHit[] {
    const { maxDistance = Infinity, collisionGroup, collisionMask, searchAllColliders = false, ignoreCollisionGroupAll = false, filter = () => true } = options;
    const { All } = this.#excalibur.CollisionGroup;
    const mask = collisionGroup?.category ?? collisionMask ?? (All as Body["group"]).category;
    const along = ray.dir.normalize();
    const hits = this.#world.rayCastAll([ray.pos.x, ray.pos.y], [along.x, along.y], maxDistance).flatMap(({ id }) => {
      const collider = this.#world.data(id)!;
      const group = this.#bodyOf(collider)?.group;
      if (group && ((mask & group.category) === 0 || (ignoreCollisionGroupAll && group === All))) return [];
      return collider.rayCast(ray, maxDistance) ?? [];
    });
    const chosen = hits.sort((a, b) => a.distance - b.distance).filter(filter);
    return searchAllColliders ? chosen : chosen.slice(0, 1);
  }

  /** Draws the structure of Excalibur's own processor, which is empty. */
  debug(context: object, elapsed: number): void {
    this.#own.debug(context, elapsed);
  }

  #bodyOf(collider: Collider): Body | undefined {
    return collider.owner.get(this.#excalibur.BodyComponent);
  }
}

/** The colliders of a composite one, or the collider. An actor without a shape has none. */
function partsOf(collider: Collider | undefined): readonly Collider[] {
  return collider ? (collider.getColliders?.() ?? [collider]) : [];
}
