import type { BoxObject, Corner, Dimensions, TypedNumbers } from "../boxes/boxes.js";
import type { Filter } from "./filter.js";

/**
 * The id of a body: a whole number below 2^53. The lower 26 bits are its slot (see {@link slotOf}),
 * the others count the bodies that have had the slot. An id does not come to mean another body
 * before its slot has had 134 million others.
 */
export type ProxyId = number;

/**
 * The slot of a body: an index into your own tables. It is less than the greatest number of bodies
 * that there ever were at once, where those that were removed since the last update count, too.
 */
export function slotOf(id: ProxyId): number {
  return id % 2 ** 26;
}

/** How a `BroadPhase` for events only treats its boxes. */
export interface EventsOptions<D extends Dimensions = Dimensions> {
  /** How many dimensions the boxes have. */
  dimensions: D;
  /** The precision in which coordinates are kept and compared: they are rounded to it. */
  precision?: "single";
  /**
   * Whether pairs of the boxes as given are reported, or pairs of fat AABBs, which begin and end less often. A body keeps
   * its fat AABB while its box is within, unless that is on any axis more than twice as wide as a new one. `"exact"` by
   * default.
   */
  report?: "exact" | "fat";
  /** Only with `report: "fat"`: how far a fat AABB reaches beyond the body on every side, in units of length. 0 by default. */
  margin?: number;
  /**
   * Only with `report: "fat"`: how many displacements a fat AABB reaches ahead of the body, by at most 4 times its longest side and
   * the margin together. 0 by default.
   */
  prediction?: number;
  /**
   * Whether each `Float64Array` of ids is a view of WebAssembly's memory, which saves the time of a copy. A view is
   * valid until the next call of anything in this package: that call may overwrite it, or let the memory
   * grow, which leaves the view with length 0. False by default.
   */
  views?: boolean;
}

/** How a `BroadPhase` treats its boxes. */
export interface BroadPhaseOptions<D extends Dimensions = Dimensions> extends Omit<EventsOptions<D>, "precision"> {
  /**
   * The precision in which coordinates are kept and compared: `"single"` (they are rounded to it)
   * or `"double"`. `"single"` by default.
   */
  precision?: "single" | "double";
}

/** What a body has beside its box. What is left out of its filter is as in the default one. */
export interface InsertOptions<Data = unknown> extends Partial<Filter> {
  /** Anything of yours: see `BroadPhase.data`. */
  data?: Data;
}

/** What an update found; see `BroadPhase.update`. */
export interface Changes {
  /**
   * The pairs that overlap now and did not at the last update. Two ids a pair, one pair after
   * another: `a0, b0, a1, b1, ...`. So the length is twice the number of pairs.
   */
  begun: Float64Array;
  /** The pairs that overlapped at the last update and do not now, in the same form. Some ids may be stale. */
  ended: Float64Array;
}

/** Arrays to write to; see `BroadPhase.buffers`. */
export interface Buffers {
  /** Where to write ids. */
  ids: Float64Array;
  /** Where to write as many boxes. */
  boxes: Float32Array | Float64Array;
}

/** A body that a ray or a moving box hits. */
export interface Hit {
  /** The body. */
  id: ProxyId;
  /** Where the hit is: at `origin + t * direction`. 0 if they overlap at the start. */
  t: number;
  /**
   * Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts inside
   * the body. At an edge or a corner, the face of the first axis.
   */
  normal: number[];
  /** Whether the cast starts inside the body. A box that only touches it at the start does not. */
  startsInside: boolean;
}

/** What many queries found: the ids of each, one list after another. */
export interface Lists {
  /** The ids of all. */
  ids: Float64Array;
  /** Where the ids of each query end; they begin where those of the query before end. */
  ends: Uint32Array;
}

/** The bodies near each of many points, nearest first. */
export interface NeighborLists extends Lists {
  /** The distance of each body; see {@link Neighbor}. */
  distances: Float64Array;
}

/** The first hit of each of many rays or moving boxes. */
export interface Hits {
  /** The bodies; -1 for a cast that hits nothing. */
  ids: Float64Array;
  /** Where the hits are; infinite for a cast that hits nothing. */
  t: Float64Array;
  /** The normals of {@link Hit}, one after another; 0 for a cast that hits nothing. */
  normals: Float64Array;
  /** Whether each cast starts inside the body: 0 or 1. */
  startsInside: Uint8Array;
}

/** A body near a point. */
export interface Neighbor {
  /** The body. */
  id: ProxyId;
  /** The distance from the point to its box; 0 if the point is in it. */
  distance: number;
}

/** Ids, or the coordinates of a point, a direction or a box. */
export type Numbers = readonly number[] | TypedNumbers;

/** A point or a direction: its coordinates, or an object `{ x, y, z }`. */
export type Point<D extends Dimensions = Dimensions> = Numbers | Corner<D>;

/** Points: an array of them, or their coordinates one after another. */
export type Points<D extends Dimensions = Dimensions> = Numbers | readonly Point<D>[];

/** Which bodies a query finds: those that may pair with a body of this filter, or those for which a function returns true. */
export type QueryFilter = Partial<Filter> | ((id: ProxyId) => boolean);

/** The pairs of all bodies, by body: what `pairsByBody` returns. */
export interface PairsByBody {
  /** By slot, where the other bodies of its body start in `others`; and at the end, how many there are in all. */
  readonly starts: Uint32Array<ArrayBuffer>;
  /** The ids of the other bodies, slot by slot. */
  readonly others: Float64Array<ArrayBuffer>;
}

/** How ids are returned. */
export interface SortOptions {
  /** Whether they are sorted by slot; true by default. */
  sorted?: boolean;
}

/** What a query leaves out, without a call for each body as of a function. */
export interface ExcludeOptions {
  /** The bodies that it does not find: what asks, and what it carries. Each body that is found is compared with all of them. */
  exclude?: ProxyId | Numbers;
}

/** Options of a search for bodies in a region. */
export interface QueryOptions extends SortOptions, ExcludeOptions {}

/** Options of a ray or a moving box. */
export interface CastOptions extends ExcludeOptions {
  /**
   * Whether it passes what it only touches: the floor that a character stands on, the wall along which it slides. It hits
   * what it enters. False by default.
   */
  ignoreTouching?: boolean;
}

/** One box: its min corner and then its max corner, or an object. */
export type Box<D extends Dimensions = Dimensions> = BoxObject<D>;

/** A box as separate numbers: its min corner and then its max corner. */
export type Corners<D extends Dimensions = Dimensions> = D extends 1
  ? [minX: number, maxX: number]
  : D extends 2
    ? [minX: number, minY: number, maxX: number, maxY: number]
    : [minX: number, minY: number, minZ: number, maxX: number, maxY: number, maxZ: number];
