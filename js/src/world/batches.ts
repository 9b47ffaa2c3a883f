import { type Boxes, checkBoxes, checkNumbers, type Dimensions } from "../boxes/boxes.js";
import type { Passed } from "../wasm/engine.js";
import { Query } from "./core.js";
import type { Filter } from "./filter.js";
import { Queries, signOf } from "./queries.js";
import { checkRule } from "./arguments.js";
import { checkCount, checkLength, type QueryChoices, own, readChoices, readPoints, wordsOf } from "./query-arguments.js";
import type { CastOptions, ExcludeOptions, Hits, Lists, NeighborLists, Numbers, Points, QueryOptions } from "./types.js";

/** Many queries in one call, which takes less time than a call for each. */
export abstract class Batches<D extends Dimensions = Dimensions> extends Queries<D> {
  /**
   * {@link Queries.overlapping} for each of many boxes: `ids` are those that they find, one list after another, and
   * `ends[i]` is where the list of box `i` ends. A filter is an object, not a function, here and in the other calls for
   * many queries.
   *
   * @throws {@link InvalidBoxError} with the index of the first bad box; {@link OutOfMemoryError}, here and in the other calls
   *   for many queries, if the answers do not fit: ask fewer at a time.
   *
   * @example
   * ```js
   * const { ids, ends } = world.overlappingMany([0, 0, 2, 2,  5, 5, 9, 9]);
   * for (let i = 0, at = 0; i < ends.length; i++) for (; at < ends[i]; at++) console.log(`box ${i} finds ${ids[at]}`);
   * ```
   */
  overlappingMany(boxes: Boxes<D>, filter?: Partial<Filter>, options?: QueryOptions): Lists {
    return this.#lists(Query.Overlapping, this.#boxParts(own(checkBoxes(boxes, this.dimensions), boxes)), filter, options);
  }

  /**
   * {@link Queries.containing} for each of many points.
   *
   * @throws `RangeError` for a NaN.
   */
  containingMany(points: Points<D>, filter?: Partial<Filter>, options?: QueryOptions): Lists {
    return this.#lists(Query.Containing, [this.#pointPart(points, "points", "a number")], filter, options);
  }

  /**
   * {@link Queries.within} for each of many centers, with a radius for each or one for all.
   *
   * @throws `RangeError` if a center is not finite, a radius negative or NaN, or there are not as many.
   */
  withinMany(centers: Points<D>, radii: number | Numbers, filter?: Partial<Filter>, options?: QueryOptions): Lists {
    const part = this.#pointPart(centers, "centers");
    return this.#lists(Query.Within, [part, lengthPart(radii, "radii", countOf(part))], filter, options);
  }

  /**
   * {@link Queries.nearest} for each of many points: `distances` has one for each id.
   *
   * @throws As {@link Queries.nearest}.
   */
  nearestMany(points: Points<D>, k: number = 1, maxDistance: number = Infinity, filter?: Partial<Filter>, options?: ExcludeOptions): NeighborLists {
    checkCount(k, "k");
    checkLength(maxDistance, "maxDistance");
    const part = this.#pointPart(points, "points");
    const count = this.#ask(Query.Nearest, [part], filter, readChoices(options, "nearest"), k, maxDistance);
    const { ids, values, ends } = this.#found(count);
    const [near, distances, nearEnds]: [number[], number[], Uint32Array] = [[], [], new Uint32Array(count)];
    for (let query = 0, at = 0; query < count; query++) {
      for (; at < ends[query]!; at++) {
        const distance = Math.sqrt(values[at]!);
        // The search compares squares, and finds a little more.
        if (distance > maxDistance) continue;
        near.push(ids[at]!);
        distances.push(distance);
      }
      nearEnds[query] = near.length;
    }
    return { ids: Float64Array.from(near), distances: Float64Array.from(distances), ends: nearEnds };
  }

  /**
   * {@link Queries.rayCast} for each of many rays, with a limit for each or one for all: the first hit of each.
   *
   * @throws `RangeError` if an origin or a direction is not finite, a limit negative or NaN, or there are not as many.
   */
  rayCastMany(origins: Points<D>, directions: Points<D>, limits: number | Numbers = Infinity, filter?: Partial<Filter>, options?: CastOptions): Hits {
    const from = this.#pointPart(origins, "origins");
    return this.#firstHits([from, from], directions, limits, filter, options);
  }

  /**
   * {@link Queries.boxCast} for each of many boxes, with a limit for each or one for all: the first hit of each.
   *
   * @throws As {@link Batches.rayCastMany}, also if a box is inverted.
   */
  boxCastMany(boxes: Boxes<D>, directions: Points<D>, limits: number | Numbers = Infinity, filter?: Partial<Filter>, options?: CastOptions): Hits {
    const rows = checkRule(own(checkBoxes(boxes, this.dimensions), boxes), "boxes", "finite");
    return this.#firstHits(this.#boxParts(rows), directions, limits, filter, options);
  }

  #firstHits(starts: readonly Part[], directions: Points<D>, limits: number | Numbers, filter: Partial<Filter> | undefined, options: CastOptions | undefined): Hits {
    const { dimensions } = this;
    const total = countOf(starts[0]!);
    const parts = [...starts, this.#pointPart(directions, "directions", "finite", total), lengthPart(limits, "limits", total)];
    const choices = readChoices(options, "cast");
    const count = this.#ask(choices.ignoresTouching ? Query.CastEntering : Query.Cast, parts, filter, choices);
    const { ids, values, faces, ends } = this.#found(count);
    const hits: Hits = {
      ids: new Float64Array(count).fill(-1),
      t: new Float64Array(count).fill(Infinity),
      normals: new Float64Array(count * dimensions),
      startsInside: new Uint8Array(count),
    };
    for (let query = 0, at = 0; query < count; query++) {
      if (at === ends[query]) continue;
      hits.ids[query] = ids[at]!;
      hits.t[query] = values[at]!;
      const axis = this.axisOf(faces[at]!);
      if (axis < 0) hits.startsInside[query] = 1;
      else hits.normals[query * dimensions + axis] = signOf(faces[at]!);
      at++;
    }
    return hits;
  }

  #lists(query: Query, parts: readonly Part[], filter: Partial<Filter> | undefined, options: QueryOptions | undefined): Lists {
    const count = this.#ask(query, parts, filter, readChoices(options, "region"));
    if (count === 0) return { ids: new Float64Array(0), ends: new Uint32Array(0) };
    const { engine } = this.memory;
    const ends = new Uint32Array(engine.buffer, this.memory.numbers()[2]!, count).slice();
    return { ids: this.memory.give(engine.detail(0), engine.detail(1)), ends };
  }

  /** Makes queries whose numbers are those of the parts, side by side, and returns how many there are: if none, without a call. */
  #ask(query: Query, parts: readonly Part[], filter: Partial<Filter> | undefined, choices: QueryChoices, k = 0, maxDistance = 0): number {
    if (typeof filter === "function") throw new TypeError("`filter` must be an object here: many queries call no function");
    const words = wordsOf(filter);
    const { dimensions, memory } = this;
    const excluded = new Float64Array(choices.excluded);
    memory.checkUsable();
    const count = countOf(parts[0]!);
    if (count === 0) return 0;
    const width = parts.reduce((sum, { isLength }) => sum + (isLength ? 1 : memory.stored), 0);
    const into = memory.idsFor(excluded.length + count * width);
    into.set(excluded);
    let start = excluded.length;
    for (const { numbers, stride, offset, isLength } of parts) {
      const [given, written] = isLength ? [1, 1] : [dimensions, memory.stored];
      for (let at = 0, from = offset, to = start; at < count; at++, from += stride, to += width) {
        for (let axis = 0; axis < written; axis++) into[to + axis] = axis < given ? numbers[from + axis]! : 0;
      }
      start += written;
    }
    // How far a search for the nearest goes stands where it stands for one.
    memory.numbers()[memory.stored] = maxDistance;
    const passed: Passed = { boxes: [["boxes", count]], read: (_, index, axis) => this.#corners(parts, index, axis) };
    this.query(query, words, choices.isSorted, excluded.length, passed, Math.min(k, 2 ** 32 - 1), count * width);
    return count;
  }

  /** The corners of a box on an axis, for an error. */
  #corners([min, max]: readonly Part[], index: number, axis: number): readonly [number, number] {
    const at = index * min!.stride + axis;
    return [min!.numbers[at]!, max!.numbers[at + max!.offset]!];
  }

  /** What queries found, where it lies in memory. */
  #found(count: number): { ids: Float64Array; values: Float64Array; faces: Uint8Array; ends: Uint32Array } {
    const { engine } = this.memory;
    const { buffer } = engine;
    const [values = 0, faces = 0, ends = 0] = this.memory.numbers();
    const found = count && engine.detail(1);
    return {
      ids: new Float64Array(buffer, found && engine.detail(0), found),
      values: new Float64Array(buffer, found && values, found),
      faces: new Uint8Array(buffer, found && faces, found),
      ends: new Uint32Array(buffer, count && ends, count),
    };
  }

  #boxParts(rows: Float64Array): Part[] {
    const stride = 2 * this.dimensions;
    return [0, this.dimensions].map((offset) => ({ numbers: rows, stride, offset, isLength: false }));
  }

  #pointPart(points: Points<D>, name: string, rule: "finite" | "a number" = "finite", count?: number): Part {
    const numbers = checkRule(readPoints(points, this.dimensions, name), name, rule);
    const part = { numbers, stride: this.dimensions, offset: 0, isLength: false };
    if (count !== undefined) checkCounts(name, countOf(part), count);
    return part;
  }
}

/** The numbers that each of many queries takes from an array: a point, or a length. */
interface Part {
  readonly numbers: Float64Array;
  /** From the numbers of a query to those of the next: 0 if all have the same. */
  readonly stride: number;
  readonly offset: number;
  readonly isLength: boolean;
}

function countOf({ numbers, stride }: Part): number {
  return numbers.length / stride;
}

function lengthPart(values: number | Numbers, name: string, count: number): Part {
  if (typeof values === "number") return { numbers: Float64Array.of(checkLength(values, name)), stride: 0, offset: 0, isLength: true };
  const numbers = own(checkNumbers(values, name), values);
  numbers.forEach((value, at) => checkLength(value, `${name}[${at}]`));
  checkCounts(name, numbers.length, count);
  return { numbers, stride: 1, offset: 0, isLength: true };
}

/** Throws unless there are as many of something as queries. */
function checkCounts(name: string, count: number, expected: number): void {
  if (count !== expected) throw new RangeError(`\`${name}\` has ${count}, and there are ${expected} queries; there must be as many`);
}
