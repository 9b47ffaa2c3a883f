import type { Corner3D } from "../boxes/boxes.js";
import type { BroadPhase } from "../world/broad-phase.js";
import type { Filter } from "../world/filter.js";
import type { QueryFilter } from "../world/types.js";
import { hasMethods, wrongArgument } from "./common.js";
import { checkWorld, insert, type Kind, move } from "./objects.js";

/** An `Object3D` of three.js: a mesh, or a group. */
export interface ThreeObject {
  /** Calls a function with the object and all that is in it. */
  traverse(callback: (part: any) => void): void;
}

/** An `Intersection` of three.js. */
export interface ThreeHit {
  /** How far along the ray it is. */
  readonly distance: number;
}

/** What {@link pick} needs of a `Raycaster` of three.js. */
export interface ThreeRaycaster<Hit extends ThreeHit> {
  /** Its ray. */
  readonly ray: {
    /** Where it begins. */
    readonly origin: Corner3D;
    /** Its direction, of length 1. */
    readonly direction: Corner3D;
  };
  /** How far it reaches. */
  readonly far: number;
  /** Tests one object and all that is in it. */
  intersectObject(object: any): Hit[];
}

/** A `Box3` of three.js. */
interface Box3 {
  readonly min: Corner3D;
  readonly max: Corner3D;
  clone(): Box3;
  isEmpty(): boolean;
  setFromObject(object: ThreeObject): Box3;
}

/** One box for all calls: three's own arithmetic, without importing it. */
let box: Box3 | undefined;

const kind: Kind<3, ThreeObject> = {
  dimensions: 3,
  name: "an `Object3D` of three.js",
  method: "traverse",
  writeBox(object, boxes, at) {
    box ??= anyBoxIn(object);
    if (!box || box.setFromObject(object).isEmpty()) return false;
    const { min, max } = box;
    boxes[at] = min.x;
    boxes[at + 1] = min.y;
    boxes[at + 2] = min.z;
    boxes[at + 3] = max.x;
    boxes[at + 4] = max.y;
    boxes[at + 5] = max.z;
    return true;
  },
};

/** A copy of the box of a geometry in an object, if there is one. */
function anyBoxIn(object: ThreeObject): Box3 | undefined {
  let found: Box3 | undefined;
  object.traverse(({ geometry }: { geometry?: { boundingBox: Box3 | null; computeBoundingBox(): void } }) => {
    if (found || !geometry) return;
    if (!geometry.boundingBox) geometry.computeBoundingBox();
    found = geometry.boundingBox?.clone();
  });
  return found;
}

/**
 * Inserts a body for each mesh or group, whose box is that of `Box3.setFromObject`, in world coordinates, and whose data is the
 * object. Returns their ids, in the order of the objects. What is empty pairs with nothing until it has a box.
 *
 * @param filter One filter for all bodies, or an array with one for each.
 *
 * @throws `TypeError` if `world` is not a `BroadPhase`, or an object is not an `Object3D`; `RangeError` if `world` does not have 3 dimensions; otherwise as
 *   {@link BroadPhase.insertMany}.
 *
 * @example
 * ```js
 * const world = new BroadPhase({ dimensions: 3 });
 * insertObjects(world, scene.children);
 * ```
 */
export function insertObjects<Data>(world: BroadPhase<3, Data>, objects: readonly (Data & ThreeObject)[], filter?: Partial<Filter> | readonly Partial<Filter>[]): Float64Array {
  return insert(kind, world, objects, filter);
}

/**
 * Gives each body whose data is a mesh or a group the box that the object has now: call it once in each frame, before
 * `world.update()` and before queries. Other bodies stay where they are. It does not update the matrices of parents, which
 * rendering does, or `scene.updateMatrixWorld()`.
 *
 * A body is disabled while its object has no box, and in snapshots and clones of that time, too: after `restore` and in a clone,
 * enable it yourself. It is enabled when its object has a box again, also if you disabled it meanwhile.
 *
 * It takes O(1) time for each object and what is in it: for the 8 corners of each geometry's box. Vertices are read once for
 * each geometry, by three.js.
 *
 * @throws `TypeError` if `world` is not a `BroadPhase`, `RangeError` if it does not have 3 dimensions, {@link InvalidBoxError} if a box has a NaN.
 *
 * @example
 * ```js
 * moveObjects(world);
 * for (const [a, b] of world.dataPairs(world.update().begun)) console.log(`${a.name} meets ${b.name}`);
 * ```
 */
export function moveObjects(world: BroadPhase<3>): void {
  move(kind, world);
}

/**
 * The first hit of a `Raycaster` among the bodies whose data are meshes or groups: what
 * `raycaster.intersectObjects(objects)[0]` gives. Boxes come nearest first, and three.js tests what is in them until no nearer hit is left.
 * Of hits at the same distance it is any.
 * Lines, points and sprites, which a ray may hit beside their boxes, are not always found.
 *
 * It takes the time of {@link BroadPhase.rayCastAll} and of `intersectObject` for some of the boxes that the ray hits. Boxes in
 * single precision are rounded: use a world with `precision: "double"` if a ray that only touches a mesh has to hit it.
 *
 * @param filter Which bodies it tests, as in the queries of a `BroadPhase`.
 *
 * @throws `TypeError` if `world` is not a `BroadPhase`, or `raycaster` is not a `Raycaster`; `RangeError` if `world` does not have 3 dimensions.
 *
 * @example
 * ```js
 * raycaster.setFromCamera(pointer, camera);
 * const hit = pick(world, raycaster);
 * if (hit) hit.object.material = highlighted;
 * ```
 */
export function pick<Hit extends ThreeHit>(world: BroadPhase<3>, raycaster: ThreeRaycaster<Hit>, filter?: QueryFilter): Hit | undefined {
  checkWorld(kind, world);
  if (!hasMethods(raycaster, "intersectObject")) throw wrongArgument("raycaster", raycaster, "a `Raycaster` of three.js");
  const { ray, far } = raycaster;
  let first: Hit | undefined;
  for (const { id, t } of world.rayCastAll(ray.origin, ray.direction, far, filter)) {
    if (first && first.distance < t) break; // all other objects are behind it
    const object = world.data(id);
    if (!hasMethods(object, kind.method)) continue;
    const [hit] = raycaster.intersectObject(object);
    if (hit && !(hit.distance >= first?.distance!)) first = hit;
  }
  return first;
}
