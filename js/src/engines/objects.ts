import type { Boxes } from "../boxes/boxes.js";
import { BroadPhase } from "../world/broad-phase.js";
import type { Filter } from "../world/filter.js";
import type { ProxyId } from "../world/types.js";
import { hasMethods, Rows, wrongArgument } from "./common.js";

/** How the objects of a renderer become bodies of a `BroadPhase`, whose data they are. */
export interface Kind<D extends 2 | 3, T> {
  readonly dimensions: D;
  /** What an object is, for errors. */
  readonly name: string;
  /** The method that tells an object from other data. */
  readonly method: string;
  /** Writes the box of an object from an index on, or returns false if it has none: if it is empty, say. */
  writeBox(object: T, boxes: Float64Array, at: number): boolean;
}

/** The bodies of each broad phase that were enabled until their objects had no box. */
const withoutBox = new WeakMap<object, Set<ProxyId>>();

/** For the boxes of all objects that move in a frame. */
const rows = { 2: new Rows(4), 3: new Rows(6) } as const;

/** Inserts a body for each object, with the object as its data, and returns their ids. */
export function insert<D extends 2 | 3, T, Data>(kind: Kind<D, T>, world: BroadPhase<D, Data>, objects: readonly (Data & T)[], filter?: Partial<Filter> | readonly Partial<Filter>[]): Float64Array {
  checkWorld(kind, world);
  if (!Array.isArray(objects)) throw wrongArgument("objects", objects, `an array, each of which is ${kind.name}`);
  const width = 2 * kind.dimensions;
  const boxes = new Float64Array(width * objects.length); // points, where an object has no box
  const hasBox = objects.map((object, at) => {
    if (!hasMethods(object, kind.method)) throw wrongArgument(`objects[${at}]`, object, kind.name);
    return kind.writeBox(object, boxes, width * at);
  });
  const ids = world.insertMany(boxes as Boxes<D>, filter, objects);
  if (!hasBox.includes(false)) return ids;
  const kept = ids.slice(); // with the option `views`, the next call may overwrite them
  hide(world, kept.filter((_, at) => !hasBox[at]), withoutBox.get(world));
  return kept;
}

/** Gives each body whose data is such an object the box that the object has now. */
export function move<D extends 2 | 3, T>(kind: Kind<D, T>, world: BroadPhase<D>): void {
  checkWorld(kind, world);
  const width = 2 * kind.dimensions;
  const boxes = rows[kind.dimensions].for(world.size);
  const before = withoutBox.get(world);
  const ids: ProxyId[] = [];
  const hidden: ProxyId[] = [];
  for (const id of Array.from(world.ids())) {
    const object = world.data(id);
    if (!hasMethods(object, kind.method)) continue;
    if (kind.writeBox(object as T, boxes, width * ids.length)) ids.push(id);
    else if (before?.has(id) || world.isEnabled(id)) hidden.push(id);
  }
  world.setMany(ids, boxes.subarray(0, width * ids.length) as Boxes<D>);
  if (before) for (const id of ids) if (before.has(id)) world.setEnabled(id, true);
  hide(world, hidden);
}

/** Disables bodies, and notes them beside others: when their objects have boxes again, these are enabled, and none that the user disabled. */
function hide(world: BroadPhase, hidden: Iterable<ProxyId>, others: Iterable<ProxyId> = []): void {
  for (const id of hidden) world.setEnabled(id, false);
  withoutBox.set(world, new Set([...others, ...hidden]));
}

/** Refuses what is not a broad phase of such objects. */
export function checkWorld<D extends 2 | 3, T>({ dimensions }: Kind<D, T>, world: unknown): void {
  if (!(world instanceof BroadPhase)) throw wrongArgument("world", world, 'a `BroadPhase` of "sweep-and-prune/broad-phase"');
  if (world.dimensions !== dimensions) throw new RangeError(`\`world\` has boxes of ${world.dimensions} dimensions; it must have ${dimensions}`);
}
