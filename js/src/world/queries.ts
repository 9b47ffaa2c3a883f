import { lengthOf } from "../wasm/typed.js";
import type { Dimensions } from "../boxes/boxes.js";
import { checkRule, readCorners, readPoint } from "./arguments.js";
import { Bodies, oneBox } from "./bodies.js";
import type { Passed } from "../wasm/engine.js";
import { Query } from "./core.js";
import type { FilterWords } from "./filter.js";
import { checkCount, checkLength, noIds, type QueryChoices, readChoices, wordsOf } from "./query-arguments.js";
import type { Box, CastOptions, ExcludeOptions, Hit, Neighbor, Point, ProxyId, QueryFilter, QueryOptions } from "./types.js";

/** Bodies that can be asked: what overlaps a box, a point or a sphere, what a ray or a moving box hits, what is nearest. */
export abstract class Queries<D extends Dimensions = Dimensions> extends Bodies<D> {
  /** All of memory, as numbers and as bytes, which are read without making a view of each answer. */
  #floats = new Float64Array(0);
  #bytes = new Uint8Array(0);

  /**
   * The bodies whose boxes, as last set, overlap a box, sorted by slot.
   *
   * In all queries, `filter` is the filter of an imagined body: the query finds the bodies that may
   * pair with it. Or it is a function that gets an id and returns whether the query finds that body. It
   * is called after the search, so it may call anything. Without a filter a query finds every body. With
   * `{ sorted: false }` the bodies are in no particular order: sorting takes a quarter of the time for 100 bodies, and
   * half for 10,000.
   *
   * @throws {@link InvalidBoxError}; and what `filter` throws.
   */
  overlapping(box: Box<D>, filter?: QueryFilter, options?: QueryOptions): ProxyId[] {
    return this.#ask(Query.Overlapping, readCorners(box, this.dimensions, "box"), 0, filter, options);
  }

  /**
   * The bodies whose boxes contain a point, sorted by slot.
   *
   * @throws `RangeError` for a NaN.
   */
  containing(point: Point<D>, filter?: QueryFilter, options?: QueryOptions): ProxyId[] {
    return this.#ask(Query.Containing, this.#readPoint(point, "point", "a number"), 0, filter, options);
  }

  /**
   * The bodies whose boxes are at most `radius` away from `center`, sorted by slot.
   *
   * @throws `RangeError` if the center is not finite, or the radius negative or NaN.
   */
  within(center: Point<D>, radius: number, filter?: QueryFilter, options?: QueryOptions): ProxyId[] {
    checkLength(radius, "radius");
    return this.#ask(Query.Within, this.#readPoint(center, "center"), radius, filter, options);
  }

  /**
   * The first body that a ray hits, with `t` of the hit, which is at `origin + t * direction`. The
   * ray ends at `t = limit`. `direction` may have any length: if its length is 1, `t` is a distance.
   * Of several bodies hit at once it is the one with the smallest slot.
   *
   * The ray is tested against boxes. To find the first hit of what is inside the boxes, pass a function
   * as `filter`, which is called nearest first until it returns true, or test the results of
   * {@link Queries.rayCastAll}. With a function all hits are searched first; to leave out single bodies, pass
   * `{ exclude }`, which takes no longer than without. `{ ignoreTouching: true }` passes what the ray only touches.
   *
   * @throws `RangeError` if the origin or the direction is not finite, or the limit negative or NaN.
   */
  rayCast(origin: Point<D>, direction: Point<D>, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit | undefined {
    return this.#firstHit(this.#readRay(origin, direction, limit), filter, options);
  }

  /**
   * All bodies that a ray hits, nearest first.
   *
   * @throws As {@link Queries.rayCast}.
   */
  rayCastAll(origin: Point<D>, direction: Point<D>, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit[] {
    return this.#allHits(this.#readRay(origin, direction, limit), filter, options);
  }

  /**
   * The first body that a moving box hits.
   *
   * @throws As {@link Queries.rayCast}, also if the box is inverted.
   */
  boxCast(box: Box<D>, direction: Point<D>, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit | undefined {
    return this.#firstHit(this.#readCast(box, direction, limit), filter, options);
  }

  /**
   * All bodies that a moving box hits, nearest first.
   *
   * @throws As {@link Queries.boxCast}.
   */
  boxCastAll(box: Box<D>, direction: Point<D>, limit: number = Infinity, filter?: QueryFilter, options?: CastOptions): Hit[] {
    return this.#allHits(this.#readCast(box, direction, limit), filter, options);
  }

  /**
   * The `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then by slot.
   * None is farther away than `maxDistance`: no farther parts of the world are searched, so a small one saves time. A
   * function as `filter` is called nearest first, until it
   * has returned true `k` times. Distances are compared as squares, which overflow beyond 1e154: only double precision has
   * such coordinates.
   *
   * @throws `RangeError` if the point is not finite, `k` not a whole number, or the distance negative or NaN.
   */
  nearest(point: Point<D>, k: number = 1, maxDistance: number = Infinity, filter?: QueryFilter, options?: ExcludeOptions): Neighbor[] {
    checkCount(k, "k");
    checkLength(maxDistance, "maxDistance");
    const from = this.#readPoint(point, "point");
    const words = wordsOf(filter);
    const choices = readChoices(options, "nearest");
    const search = (wanted: number): Neighbor[] => {
      const excluded = this.writeExcluded(choices.excluded);
      this.#writeSphere(from, maxDistance);
      this.query(Query.Nearest, words, 1, excluded, oneBox, Math.min(wanted, 2 ** 32 - 1));
      const { engine } = this.memory;
      const [at, count, values, floats] = [engine.detail(0) / 8, engine.detail(1), this.memory.numbers()[0]! / 8, this.#readFloats()];
      const found: Neighbor[] = [];
      for (let index = 0; index < count; index++) {
        const distance = Math.sqrt(floats[values + index]!);
        // The search compares squares, and finds a little more.
        if (distance <= maxDistance) found.push({ id: floats[at + index]!, distance });
      }
      return found;
    };
    if (typeof filter !== "function") return search(k);
    // Twice as many each time, since only the search knows which is next. The function may change the world, too.
    const accepted: Neighbor[] = [];
    const asked = new Set<ProxyId>();
    const most = this.size;
    for (let wanted = 2 * k; accepted.length < k; wanted *= 2) {
      for (const neighbor of search(wanted)) {
        if (accepted.length === k) break;
        if (asked.has(neighbor.id)) continue;
        asked.add(neighbor.id);
        if (filter(neighbor.id)) accepted.push(neighbor);
      }
      if (wanted >= most) break;
    }
    return accepted;
  }

  #ask(query: Query, corners: Float64Array, radius: number, filter: QueryFilter | undefined, options: QueryOptions | undefined): ProxyId[] {
    const words = wordsOf(filter);
    const choices = readChoices(options, "region");
    const excluded = this.writeExcluded(choices.excluded);
    if (query === Query.Within) this.#writeSphere(corners, radius);
    else this.memory.write(0, corners);
    this.query(query, words, choices.isSorted, excluded, oneBox);
    const found = this.found();
    return typeof filter === "function" ? found.filter((id) => filter(id)) : found;
  }

  /** @internal Makes a query whose numbers are written: `many` behind the excluded ids, or if that is 0, those of one query. */
  protected query(query: Query, [category, mask, group, isStatic]: FilterWords, isSorted: 0 | 1, excluded: number, passed: Passed, k = 0, many = 0): void {
    this.memory.call((exports, world) => exports.world_query(world, query, k, category, mask, group, isStatic, isSorted, excluded, many), passed);
  }

  /**
   * @internal The ids that a call reports, as an array of JavaScript: V8 takes 30 ns to make one of 22 numbers, and 400 to make a
   * `Float64Array` (Node 20).
   */
  protected found(): ProxyId[] {
    const { engine } = this.memory;
    const [from, count, floats] = [engine.detail(0) / 8, engine.detail(1), this.#readFloats()];
    const ids = new Array<ProxyId>(count);
    for (let at = 0; at < count; at++) ids[at] = floats[from + at]!;
    return ids;
  }

  #readFloats(): Float64Array {
    // Growing the memory detaches the view, which leaves it with length 0.
    if (this.#floats.length === 0) this.#floats = new Float64Array(this.memory.engine.buffer);
    return this.#floats;
  }

  #readBytes(): Uint8Array {
    if (this.#bytes.length === 0) this.#bytes = new Uint8Array(this.memory.engine.buffer);
    return this.#bytes;
  }

  #hits(query: Query, path: Path, words: FilterWords, choices: QueryChoices): Hit[] {
    const excluded = this.writeExcluded(choices.excluded);
    this.#writePath(path);
    this.query(query, words, 1, excluded, oneBox);
    const { engine } = this.memory;
    const [values = 0, faces = 0] = this.memory.numbers();
    const [from, count, floats, bytes] = [engine.detail(0) / 8, engine.detail(1), this.#readFloats(), this.#readBytes()];
    const hits: Hit[] = [];
    for (let at = 0; at < count; at++) {
      const axis = this.axisOf(bytes[faces + at]!);
      const normal: number[] = [];
      for (let each = 0; each < this.dimensions; each++) normal.push(each === axis ? signOf(bytes[faces + at]!) : 0);
      hits.push({ id: floats[from + at]!, t: floats[values / 8 + at]!, normal, startsInside: axis < 0 });
    }
    return hits;
  }

  /** @internal The axis of a face as the core numbers it, or -1 if there is none: on an axis that is only stored the cast starts inside. */
  protected axisOf(face: number): number {
    const axis = Math.ceil(face / 2) - 1;
    return axis < this.dimensions ? axis : -1;
  }

  #allHits(path: Path, filter: QueryFilter | undefined, options: CastOptions | undefined): Hit[] {
    const words = wordsOf(filter);
    const choices = readChoices(options, "cast");
    const hits = this.#hits(choices.ignoresTouching ? Query.CastAllEntering : Query.CastAll, path, words, choices);
    return typeof filter === "function" ? hits.filter(({ id }) => filter(id)) : hits;
  }

  #firstHit(path: Path, filter: QueryFilter | undefined, options: CastOptions | undefined): Hit | undefined {
    if (typeof filter === "function") return this.#allHits(path, undefined, options).find(({ id }) => filter(id));
    const words = wordsOf(filter);
    const choices = readChoices(options, "cast");
    return this.#hits(choices.ignoresTouching ? Query.CastEntering : Query.Cast, path, words, choices)[0];
  }

  /** @internal Writes the ids that a query does not find, and returns how many there are. */
  protected writeExcluded(excluded: Float32Array | Float64Array): number {
    const count = excluded === noIds ? 0 : lengthOf(excluded);
    if (count > 0) this.memory.writeIds(this.memory.keepIds(excluded));
    return count;
  }

  #readRay(origin: Point<D>, direction: Point<D>, limit: number): Path {
    const start = this.#readPoint(origin, "origin");
    const box = new Float64Array(2 * start.length);
    box.set(start);
    box.set(start, start.length);
    return this.#readPath(box, direction, limit);
  }

  #readCast(box: Box<D>, direction: Point<D>, limit: number): Path {
    return this.#readPath(checkRule(readCorners(box, this.dimensions, "box"), "box", "finite"), direction, limit);
  }

  #readPath(box: Float64Array, direction: Point<D>, limit: number): Path {
    checkLength(limit, "limit");
    return { box, direction: this.#readPoint(direction, "direction"), limit };
  }

  #writePath({ box, direction, limit }: Path): void {
    const { stored } = this.memory;
    this.memory.write(0, box);
    this.memory.write(2 * stored, direction);
    this.memory.numbers()[3 * stored] = limit;
  }

  #readPoint(point: Point<D>, name: string, rule: "finite" | "a number" = "finite"): Float64Array {
    return checkRule(readPoint(point, this.dimensions, name), name, rule);
  }

  #writeSphere(center: Float64Array, radius: number): void {
    this.memory.write(0, center);
    this.memory.numbers()[this.memory.stored] = radius;
  }
}

/** A moving box. */
interface Path {
  readonly box: Float64Array;
  readonly direction: Float64Array;
  readonly limit: number;
}

/** @internal Which way a face looks along its axis. */
export function signOf(face: number): 1 | -1 {
  return face % 2 ? -1 : 1;
}
