import type { Dimensions } from "../boxes/boxes.js";
import { InvalidBoxError } from "../wasm/errors.js";
import { lengthOf, tagOf } from "../wasm/typed.js";
import { allocate } from "../wasm/views.js";
import { dropMissing } from "./missing.js";

type Rows = Float32Array | Float64Array;

/** How many boxes, of both sets, a chunk has on average. */
const CHUNK = 8192;

/** An axis cut into cells, by which boxes are sorted: as whole numbers, which takes a fraction of the time. */
interface Cells {
  readonly axis: number;
  readonly low: number;
  readonly high: number;
}

/** How many cells there are: with an index of 32 bits, a number that a double holds. */
const CELLS = 2 ** 20;

/** The cell of a coordinate: never less for a greater one. By halves, whose difference is finite. */
function cellOf({ low, high }: Cells, at: number): number {
  return at <= low ? 0 : at >= high ? CELLS : Math.floor(((at / 2 - low / 2) / (high / 2 - low / 2)) * CELLS);
}

/** Boxes of a set, copied in the order of the cells where they begin. */
interface Ordered {
  readonly rows: Rows;
  /** By place, the index that the user knows. */
  readonly indices: Uint32Array;
  /** By place, the cell where the box begins. */
  readonly begins: Uint32Array;
  /** By place, the cell where the box ends. */
  readonly ends: Uint32Array;
}

/** Finds the pairs of two sets of rows, or of one. */
type Find = (a: Rows, b?: Rows) => Uint32Array;

/**
 * The pairs of two sets of rows, or of one, chunk by chunk: each is found when it is asked for, so that a program can wait in
 * between. The boxes are checked and copied at once.
 *
 * A chunk has the pairs of the next boxes along an axis. It searches them with what has begun and is not past. Of one set
 * these are boxes to come: those before had their pairs with them in earlier chunks.
 */
export function chunksOf(a: Rows, b: Rows | undefined, dimensions: Dimensions, skipsMissing: boolean, find: Find): Generator<Uint32Array<ArrayBuffer>, void, undefined> {
  const cells = longestAxis(a, dimensions);
  const first = inOrder(a, dimensions, cells, skipsMissing, b ? "a" : "boxes");
  const second = b && inOrder(b, dimensions, cells, skipsMissing, "b");
  return search(first, second, 2 * dimensions, find);
}

function* search(first: Ordered, second: Ordered | undefined, width: number, find: Find): Generator<Uint32Array<ArrayBuffer>, void, undefined> {
  const others = second ?? first;
  const [count, otherCount] = [first.indices.length, others.indices.length];
  const step = Math.ceil(count / Math.ceil((count + (second ? otherCount : 0)) / CHUNK));
  let open: number[] = [];
  let next = 0;
  for (let from = 0; from < count; from += step) {
    const to = Math.min(from + step, count);
    const begin = first.begins[from]!;
    let end = 0;
    for (let at = from; at < to; at++) end = Math.max(end, first.ends[at]!);
    if (!second) next = to;
    open = second ? open.filter((at) => others.ends[at]! >= begin) : [];
    for (; next < otherCount && others.begins[next]! <= end; next++) if (others.ends[next]! >= begin) open.push(next);
    const rows = first.rows.subarray(from * width, to * width);
    const beside = allocate(() => new (floatsOf(others.rows))(open.length * width));
    open.forEach((at, place) => {
      for (let number = 0; number < width; number++) beside[place * width + number] = others.rows[at * width + number]!;
    });
    const within = second ? new Uint32Array(0) : new Uint32Array(find(rows)); // copied: with the option `views` the next search would overwrite it
    const between = find(rows, beside);
    const pairs = new Uint32Array(within.length + between.length);
    within.forEach((place, at) => (pairs[at] = first.indices[from + place]!));
    for (let at = 0, to = within.length; at < between.length; at += 2, to += 2) {
      pairs[to] = first.indices[from + between[at]!]!;
      pairs[to + 1] = others.indices[open[between[at + 1]!]!]!;
    }
    if (!second) sortWithin(pairs);
    yield pairs;
  }
}

function floatsOf(rows: Rows): Float32ArrayConstructor | Float64ArrayConstructor {
  return tagOf(rows) === "Float64Array" ? Float64Array : Float32Array;
}

/** Puts the smaller index of each pair first. */
function sortWithin(pairs: Uint32Array): void {
  for (let at = 0; at < pairs.length; at += 2) {
    const [a, b] = [pairs[at]!, pairs[at + 1]!];
    if (a > b) [pairs[at], pairs[at + 1]] = [b, a];
  }
}

/**
 * Copies boxes in the order of the cells where they begin.
 *
 * @throws {@link InvalidBoxError} for the first one that is invalid.
 */
function inOrder(given: Rows, dimensions: Dimensions, cells: Cells, skipsMissing: boolean, name: string): Ordered {
  const [rows, kept] = skipsMissing ? dropMissing(given, dimensions) : [given, undefined];
  const width = 2 * dimensions;
  const count = lengthOf(rows) / width;
  const keys = allocate(() => new Float64Array(count));
  for (let index = 0; index < count; index++) {
    for (let axis = 0; axis < dimensions; axis++) {
      const [min, max] = [rows[index * width + axis]!, rows[index * width + dimensions + axis]!];
      if (!(min <= max)) throw new InvalidBoxError(kept?.[index] ?? index, axis, name, min, max);
    }
    keys[index] = cellOf(cells, rows[index * width + cells.axis]!) * 2 ** 32 + index;
  }
  keys.sort();
  const copied = allocate(() => new (floatsOf(rows))(count * width));
  const [indices, begins, ends] = allocate(() => [new Uint32Array(count), new Uint32Array(count), new Uint32Array(count)]);
  for (let to = 0; to < count; to++) {
    const from = keys[to]! % 2 ** 32;
    for (let number = 0; number < width; number++) copied[to * width + number] = rows[from * width + number]!;
    indices[to] = kept?.[from] ?? from;
    begins[to] = Math.floor(keys[to]! / 2 ** 32);
    ends[to] = cellOf(cells, rows[from * width + dimensions + cells.axis]!);
  }
  return { rows: copied, indices, begins, ends };
}

/** The axis along which boxes are spread most for their size. */
function longestAxis(rows: Rows, dimensions: Dimensions): Cells {
  const [width, length] = [2 * dimensions, lengthOf(rows)];
  let best: Cells = { axis: 0, low: 0, high: 0 };
  let most = -1;
  for (let axis = 0; axis < dimensions; axis++) {
    let [low, high, sides, count] = [Infinity, -Infinity, 0, 0];
    for (let at = axis; at < length; at += width) {
      const [min, side] = [rows[at]!, rows[at + dimensions]! - rows[at]!];
      if (!Number.isFinite(side)) continue;
      low = Math.min(low, min);
      high = Math.max(high, min);
      sides += side;
      count++;
    }
    const spread = high > low ? (high - low) / (sides / count) : 0;
    if (spread > most) [best, most] = [{ axis, low, high }, spread];
  }
  return best;
}
