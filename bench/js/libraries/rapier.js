import { Candidates } from "./candidates.js";
import { isAtRest, meanWidth, rounding } from "./rows.js";

// Its world of sensors on bodies that the caller moves, stepped: what begins and ends to overlap
// comes as events. Boxes are a center and half sizes in single precision there, so they are made
// larger by what rounding takes, and the pairs tested once more.

/**
 * @param {any} RAPIER
 * @param {{ dimensions: number, rows: Float32Array }} setting
 */
export async function createWith(RAPIER, { dimensions, rows: first }) {
  await RAPIER.init();
  const width = 2 * dimensions;
  const zero = { x: 0, y: 0, z: 0 };
  const world = new RAPIER.World(zero);
  world.lengthUnit = meanWidth(first, dimensions);
  const events = new RAPIER.EventQueue(true);
  const candidates = new Candidates(dimensions, first.length / width);
  const more = 2 * rounding(first);

  const { KinematicPositionBased } = RAPIER.RigidBodyType;
  /** @type {any[]} */
  const bodies = [];
  /** @type {any[]} */
  const colliders = [];
  const indices = new Map();
  for (let i = 0; i < first.length / width; i++) {
    const body = world.createRigidBody(new RAPIER.RigidBodyDesc(KinematicPositionBased));
    const { cuboid } = RAPIER.ColliderDesc;
    const shape = dimensions === 2 ? cuboid(1, 1) : cuboid(1, 1, 1);
    shape.setSensor(true);
    shape.setActiveEvents(RAPIER.ActiveEvents.COLLISION_EVENTS);
    shape.setActiveCollisionTypes(RAPIER.ActiveCollisionTypes.ALL);
    const collider = world.createCollider(shape, body);
    indices.set(collider.handle, i);
    bodies.push(body);
    colliders.push(collider);
  }

  const sizes = new Float64Array((bodies.length || 1) * dimensions);
  const [center, half] = [{ ...zero }, { ...zero }];
  const axes = /** @type {const} */ (["x", "y", "z"]).slice(0, dimensions);

  function place(/** @type {Float32Array} */ rows, /** @type {number} */ i) {
    let isSame = true;
    axes.forEach((axis, k) => {
      const [least, greatest] = [rows[i * width + k], rows[i * width + dimensions + k]];
      center[axis] = (least + greatest) / 2;
      half[axis] = (greatest - least) / 2 + more;
      isSame &&= Math.abs(half[axis] - sizes[i * dimensions + k]) < more / 2;
    });
    bodies[i].setTranslation(center, true);
    if (isSame) return;
    colliders[i].setHalfExtents(half);
    axes.forEach((axis, k) => (sizes[i * dimensions + k] = half[axis]));
  }

  const before = new Float32Array(first.length).fill(NaN);
  return {
    find(rows) {
      for (let i = 0; i < bodies.length; i++) {
        if (!isAtRest(rows, before, i * width, width)) place(rows, i);
      }
      before.set(rows);
      world.step(events);
      events.drainCollisionEvents((a, b, started) => {
        if (started) candidates.add(indices.get(a), indices.get(b));
        else candidates.remove(indices.get(a), indices.get(b));
      });
      return candidates.exact(rows);
    },
  };
}
