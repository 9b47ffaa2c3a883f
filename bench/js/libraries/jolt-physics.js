import initJolt from "jolt-physics";
import { PairList } from "./pair-list.js";
import { isAtRest, overlaps, rounding } from "./rows.js";

// Its quadtree, asked for each box. Boxes are a center and half sizes in single precision there, so
// they are made larger by what rounding takes, and the pairs tested once more.
export async function create({ isMoving, rows: first }) {
  const Jolt = await initJolt();
  const count = first.length / 6;
  const pairs = new PairList();

  const settings = new Jolt.JoltSettings();
  settings.mMaxBodies = Math.max(count, 1);
  settings.mMaxBodyPairs = settings.mMaxContactConstraints = 1;
  const layers = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
  layers.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
  settings.mObjectLayerPairFilter = new Jolt.ObjectLayerPairFilterTable(1);
  settings.mBroadPhaseLayerInterface = layers;
  settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(
    layers,
    1,
    settings.mObjectLayerPairFilter,
    1,
  );
  const jolt = new Jolt.JoltInterface(settings);
  const system = jolt.GetPhysicsSystem();
  const bodies = system.GetBodyInterface();
  const query = system.GetBroadPhaseQuery();
  const [layerFilter, objectFilter] = [new Jolt.BroadPhaseLayerFilter(), new Jolt.ObjectLayerFilter()];
  const box = new Jolt.AABox();
  const [min, max] = [new Jolt.Vec3(), new Jolt.Vec3()];
  const position = new Jolt.RVec3();
  const rotation = Jolt.Quat.prototype.sIdentity();

  /** @type {any[]} */
  const ids = [];
  /** The box of each of its numbers for bodies. */
  const boxOf = new Uint32Array(settings.mMaxBodies);
  let [rows, current] = [first, 0];
  const collector = new Jolt.CollideShapeBodyCollectorJS();
  collector.Reset = () => {};
  collector.AddHit = (hit) => {
    const other = boxOf[Jolt.HEAPU32[hit >> 2] & 0x7fffff];
    if (other > current && overlaps(rows, 3, current, other)) pairs.push(current, other);
  };

  const more = 2 * rounding(first);
  const sizes = new Float64Array(first.length / 2);

  /** Whether the shape of a body has to change; writes its new half sizes to `min`. */
  function isResized(i) {
    let isSame = true;
    for (let axis = 0; axis < 3; axis++) {
      const half = (rows[6 * i + 3 + axis] - rows[6 * i + axis]) / 2 + more;
      min.SetComponent(axis, half);
      isSame &&= Math.abs(half - sizes[3 * i + axis]) < more / 2;
      if (!isSame) sizes[3 * i + axis] = half;
    }
    return !isSame;
  }

  function center(i) {
    const at = 6 * i;
    position.Set((rows[at] + rows[at + 3]) / 2, (rows[at + 1] + rows[at + 4]) / 2, (rows[at + 2] + rows[at + 5]) / 2);
    return position;
  }

  const list = new Jolt.ArrayBodyID();
  for (let i = 0; i < count; i++) {
    isResized(i);
    const body = new Jolt.BodyCreationSettings(new Jolt.BoxShape(min, 0), center(i), rotation, Jolt.EMotionType_Kinematic, 0);
    const id = bodies.CreateBody(body).GetID();
    Jolt.destroy(body);
    boxOf[id.GetIndex()] = i;
    ids.push(id);
    list.push_back(id);
  }
  const state = bodies.AddBodiesPrepare(list.data(), list.size());
  bodies.AddBodiesFinalize(list.data(), list.size(), state, Jolt.EActivation_DontActivate);
  system.OptimizeBroadPhase();

  function search() {
    pairs.clear();
    for (current = 0; current < ids.length; current++) {
      const at = 6 * current;
      min.Set(rows[at], rows[at + 1], rows[at + 2]);
      max.Set(rows[at + 3], rows[at + 4], rows[at + 5]);
      box.set_mMin(min);
      box.set_mMax(max);
      query.CollideAABox(box, collector, layerFilter, objectFilter);
    }
    return pairs.pairs;
  }

  const before = first.slice();
  return {
    find(boxes) {
      rows = boxes;
      for (let i = 0; i < count; i++) {
        if (isAtRest(rows, before, 6 * i, 6)) continue;
        bodies.SetPosition(ids[i], center(i), Jolt.EActivation_DontActivate);
        if (isResized(i)) bodies.SetShape(ids[i], new Jolt.BoxShape(min, 0), false, Jolt.EActivation_DontActivate);
      }
      before.set(rows);
      // Where it tidies its tree: a little each step, or all at once.
      if (isMoving) jolt.Step(1 / 60, 1);
      else system.OptimizeBroadPhase();
      return search();
    },
  };
}
