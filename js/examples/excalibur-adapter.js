// A collision processor for Excalibur.
import * as ex from "excalibur";
import { BroadPhase, init } from "sweep-and-prune/broad-phase";

await init();

/** Gives a scene another broad phase, before actors are added. */
export function replaceBroadPhase(scene) {
  const processor = new SweepAndPruneProcessor(scene.physics.config.sparseHashGrid);
  Object.defineProperty(scene.physics, "collisionProcessor", { value: processor });
}

/** A collision processor: Excalibur's colliders are its bodies. The narrow phase stays Excalibur's. */
class SweepAndPruneProcessor extends ex.SparseHashGridCollisionProcessor {
  #world = new BroadPhase({ dimensions: 2, precision: "double" });
  /** Of each collider its id, and the filter that it had last. */
  #tracked = new Map();

  getColliders() {
    return [...this.#tracked.keys()];
  }

  track(target) {
    for (const collider of partsOf(target)) {
      collider.owner = target.owner;
      const { left, top, right, bottom } = collider.bounds;
      if (!this.#tracked.has(collider)) {
        this.#tracked.set(collider, { id: this.#world.insert([left, top, right, bottom], { data: collider }) });
      }
    }
  }

  untrack(target) {
    for (const collider of partsOf(target)) {
      if (this.#tracked.has(collider)) this.#world.remove(this.#tracked.get(collider).id);
      this.#tracked.delete(collider);
    }
  }

  update(colliders) {
    const { ids, boxes } = this.#world.buffers(colliders.length);
    for (let i = 0; i < colliders.length; i++) {
      const collider = colliders[i];
      const tracked = this.#tracked.get(collider);
      const { left, top, right, bottom } = collider.bounds;
      ids[i] = tracked.id;
      boxes[4 * i] = left;
      boxes[4 * i + 1] = top;
      boxes[4 * i + 2] = right;
      boxes[4 * i + 3] = bottom;
      const { group, collisionType } = collider.owner.get(ex.BodyComponent);
      if (tracked.group === group && tracked.type === collisionType) continue;
      Object.assign(tracked, { group, type: collisionType });
      this.#world.setFilter(tracked.id, { category: group.category, mask: group.mask, isStatic: collisionType === ex.CollisionType.Fixed });
    }
    this.#world.setMany(ids, boxes);
    return colliders.length;
  }

  broadphase() {
    this.#world.update();
    const pairs = [];
    for (const [a, b] of this.#world.dataPairs(this.#world.pairs())) {
      // What is left for Excalibur to decide: colliders of one actor, actors that are not active; boxes that only touch.
      if (ex.Pair.canCollide(a, b) && a.bounds.overlaps(b.bounds)) pairs.push(new ex.Pair(a, b));
    }
    return pairs;
  }

  query(where) {
    const found = where instanceof ex.Vector ? this.#world.containing([where.x, where.y]) : this.#world.overlapping([where.left, where.top, where.right, where.bottom]);
    return this.#world.dataOf(found);
  }

  rayCast(ray, { maxDistance = Infinity, collisionGroup, collisionMask, searchAllColliders = false, ignoreCollisionGroupAll = false, filter = () => true } = {}) {
    const mask = collisionGroup?.category ?? collisionMask ?? ex.CollisionGroup.All.category;
    const along = ray.dir.normalize();
    const hits = this.#world.rayCastAll([ray.pos.x, ray.pos.y], [along.x, along.y], maxDistance).flatMap(({ id }) => {
      const collider = this.#world.data(id);
      const { group } = collider.owner.get(ex.BodyComponent);
      if ((mask & group.category) === 0 || (ignoreCollisionGroupAll && group === ex.CollisionGroup.All)) return [];
      return collider.rayCast(ray, maxDistance) ?? [];
    });
    const chosen = hits.sort((a, b) => a.distance - b.distance).filter(filter);
    return searchAllColliders ? chosen : chosen.slice(0, 1);
  }
}

/** The colliders of a compound one, or the collider. */
function partsOf(collider) {
  return collider instanceof ex.CompositeCollider ? collider.getColliders() : [collider];
}
