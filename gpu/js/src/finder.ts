import { checkBoxes, checkBuffer, type GpuBoxes } from "./boxes.js";
import { Buffers, mostBytes } from "./buffers.js";
import { checked, read, TIMES, watch } from "./device.js";
import { GpuError } from "./errors.js";
import { type Kernels, kernelsOf } from "./kernels.js";
import { scan, scanLevels, sort, tableLength } from "./sort.js";
import { type StageTime, StageTimer } from "./stages.js";
import { type Bound, Steps } from "./steps.js";
import { type Summary, SUMMARY_BYTES, summaryOf } from "./summary.js";
import { levels, mostLeaves } from "./tree.js";
import { Usage } from "./usage.js";

/** Bounds of a box or node, in numbers. */
const BOUNDS = 8;

/** The world is the last lane of the bounds. */
const WORLD_LANE = 3;

/** The greatest number that a kernel counts to. */
const MOST = 0xffff_ffff;

/** How many boxes there are in all sets. */
const countOf = (sets: readonly GpuBoxes[]): number => sets.reduce((sum, { count }) => sum + count, 0);

/** Options of {@link PairFinder.create}. */
export interface GpuPairFinderOptions {
  /** 2 or 3. */
  readonly dimensions: 2 | 3;

  /** Whether pairs are sorted by their first index, then by their second; takes up to 16 more passes over the pairs, or over all for which a buffer of yours has space. Default false. */
  readonly sorted?: boolean;

  /** The size of a workgroup of the indirect dispatch in the summary: one thread for each pair. Default 64. */
  readonly dispatchGroupSize?: number;

  /** The vertices of the indirect draw in the summary, which draws one instance for each pair. Default 2, for a line. */
  readonly drawVertices?: number;

  /**
   * Whether each search measures its stages, for {@link PairFinder.stageTimes}. Each stage is then a pass of its own, between
   * which the device may pause. Default false.
   */
  readonly timed?: boolean;
}

/** The pairs of a search, in buffers of the finder, which its next search overwrites. */
export interface GpuPairs extends Summary {
  /** Begins with the pairs, two 32-bit whole numbers each. Its usages are `STORAGE`, `VERTEX` and `COPY_SRC`. */
  readonly pairs: GPUBuffer;

  /** The summary, see {@link SUMMARY_BYTES}. Its usages are `STORAGE`, `INDIRECT` and `COPY_SRC`. */
  readonly summary: GPUBuffer;
}

/** One search: what its kernels share. */
interface Search {
  readonly count: number;
  readonly params: (capacity: number) => number[];
  readonly nodes: Bound;
  readonly order: Bound;
  readonly filters: Bound;
  readonly tally: Bound;
  readonly sums: readonly Bound[];
}

/**
 * Finds overlapping pairs of boxes on a GPU, in two or three dimensions, and keeps its buffers between calls.
 *
 * Boxes are closed: touching boxes overlap. A pair is reported once, smaller index first. Every pair is found, however
 * crowded the boxes are. The pairs and their order are the same in every run and on every device. Invalid boxes (NaN, or
 * inverted) are counted and have no pairs.
 *
 * A call hands its commands to the device at once if all earlier calls of the finder are done, else after them. Await it
 * before you submit commands that change its boxes or use its results.
 *
 * Make it with {@link PairFinder.create}.
 */
export class PairFinder {
  readonly #device: GPUDevice;
  readonly #kernels: Kernels;
  readonly #buffers: Buffers;
  readonly #options: Required<GpuPairFinderOptions>;
  /** Missing if nothing is measured, or the device cannot. */
  readonly #timer: StageTimer | undefined;
  /** Searches use the same buffers, so they are done one after the other: the last one, until it is done. */
  #last: Promise<unknown> | undefined;

  private constructor(device: GPUDevice, kernels: Kernels, timer: StageTimer | undefined, options: Required<GpuPairFinderOptions>) {
    this.#device = device;
    this.#kernels = kernels;
    this.#buffers = new Buffers(device);
    this.#timer = timer;
    this.#options = options;
  }

  /**
   * Makes a finder. The first of a device compiles the shaders, which takes a fraction of a second; later ones share them.
   *
   * @throws {@link GpuError} if the device is lost or cannot compile the shaders; `RangeError` for an option.
   */
  static async create(device: GPUDevice, options: GpuPairFinderOptions): Promise<PairFinder> {
    const { dimensions, sorted = false, dispatchGroupSize = 64, drawVertices = 2, timed = false } = options;
    if (dimensions !== 2 && dimensions !== 3) throw new RangeError(`dimensions is ${dimensions}; it must be 2 or 3`);
    if (!(Number.isInteger(dispatchGroupSize) && dispatchGroupSize > 0)) {
      throw new RangeError(`dispatchGroupSize is ${dispatchGroupSize}; it must be a whole number, 1 or more`);
    }
    if (!(Number.isInteger(drawVertices) && drawVertices >= 0)) {
      throw new RangeError(`drawVertices is ${drawVertices}; it must be a whole number, 0 or more`);
    }
    watch(device);
    const timer = timed && device.features.has(TIMES) ? new StageTimer(device) : undefined;
    const kernels = await checked(device, () => ({ compiled: kernelsOf(device) }))
      .then(({ compiled }) => compiled)
      .catch((error) => {
        throw error instanceof GpuError ? error : new GpuError("DEVICE", `the GPU cannot compile the shaders: ${error}`);
      });
    return new PairFinder(device, kernels, timer, { dimensions, sorted, dispatchGroupSize, drawVertices, timed });
  }

  /** The most boxes that this device can search, of both sets together: about 3.6 million with WebGPU's default limits. */
  get mostBoxes(): number {
    return Math.min(mostLeaves(Math.floor(mostBytes(this.#device) / (4 * BOUNDS))), MOST - 1);
  }

  /** The most pairs that a buffer of this device holds: about 16.7 million with WebGPU's default limits. */
  get mostPairs(): number {
    return Math.min(Math.floor(mostBytes(this.#device) / 8), MOST - 1);
  }

  /**
   * Finds all pairs of one set and keeps them on the device, in a buffer of the finder that is as large as needed. Waits
   * once for the device, to learn the number of pairs. Pairs are `[a, b]` with `a < b`.
   *
   * @throws {@link GpuError}; `TOO_MANY_PAIRS` has the exact number in `count`.
   */
  find(boxes: GpuBoxes): Promise<GpuPairs> {
    return this.#find([boxes]);
  }

  /**
   * Finds all pairs of a box of one set and a box of another, as {@link find} does. Pairs are
   * `[index in first, index in second]`.
   *
   * @throws {@link GpuError}
   */
  findBetween(first: GpuBoxes, second: GpuBoxes): Promise<GpuPairs> {
    return this.#find([first, second]);
  }

  /**
   * Finds all pairs of one set and writes them to a buffer of the caller, without waiting for the device.
   *
   * `pairs` needs the usage `STORAGE` and receives two 32-bit whole numbers for each pair, `a < b`. If it is too small,
   * nothing is written past its end, and the summary still has the exact number of pairs. `summary` needs the usage
   * `STORAGE` and {@link SUMMARY_BYTES} bytes. The promise is fulfilled when the device has taken the commands.
   *
   * @throws {@link GpuError}
   */
  findInto(boxes: GpuBoxes, pairs: GPUBuffer, summary: GPUBuffer): Promise<void> {
    return this.#findInto([boxes], pairs, summary);
  }

  /**
   * Finds all pairs between two sets and writes them to a buffer of the caller, as {@link findInto} does.
   *
   * @throws {@link GpuError}
   */
  findBetweenInto(first: GpuBoxes, second: GpuBoxes, pairs: GPUBuffer, summary: GPUBuffer): Promise<void> {
    return this.#findInto([first, second], pairs, summary);
  }

  /**
   * Reads a summary, which needs the usage `COPY_SRC`.
   *
   * @throws {@link GpuError}
   */
  async readSummary(summary: GPUBuffer): Promise<Summary> {
    checkBuffer("summary", summary, SUMMARY_BYTES, Usage.COPY_SRC);
    return summaryOf(await read(this.#device, summary, SUMMARY_BYTES));
  }

  /**
   * Reads the pairs that a search wrote, `a` and `b` in turn. The buffer needs the usage `COPY_SRC`.
   *
   * @throws {@link GpuError}
   */
  async readPairs(pairs: GPUBuffer, { written }: Pick<Summary, "written">): Promise<Uint32Array> {
    checkBuffer("pairs", pairs, 8 * written, Usage.COPY_SRC);
    return read(this.#device, pairs, 8 * written);
  }

  /**
   * Reads how long each stage of the last search took on the device, in the order of the stages: to show it or to compare
   * inputs, for the times of one search vary. Searches that are called meanwhile do not wait for it.
   *
   * The list is empty where the device does not have the feature `timestamp-query`, which {@link openDevice} asks for, and
   * before the first search.
   *
   * @throws `Error` if the finder was made without the option `timed`; {@link GpuError}.
   */
  async stageTimes(): Promise<readonly StageTime[]> {
    if (!this.#options.timed) throw new Error("stageTimes: the finder does not measure; make it with the option `timed: true`");
    // In the turn of the call the times are copied. What is not awaited there holds no search up.
    const { times } = await this.#inTurn(async () => ({ times: this.#timer?.read() }));
    return times ?? [];
  }

  /** Gives the memory of the finder on the device back. The device stays. The finder must not be used any more. */
  destroy(): void {
    this.#buffers.destroy();
    this.#timer?.destroy();
  }

  /**
   * Finds all pairs of one set and copies them, before the next search overwrites them.
   *
   * @internal
   */
  findAndRead(boxes: GpuBoxes): Promise<Summary & { numbers: Uint32Array }> {
    return this.#inTurn(async () => {
      const found = await this.#findNow([boxes]);
      return { ...found, numbers: await this.readPairs(found.pairs, found) };
    });
  }

  #find(sets: readonly GpuBoxes[]): Promise<GpuPairs> {
    return this.#inTurn(() => this.#findNow(sets));
  }

  async #findNow(sets: readonly GpuBoxes[]): Promise<GpuPairs> {
    this.#check(sets);
    const { search, summary } = await this.#submit((steps) => {
      const search = this.#prepare(sets, steps);
      this.#count(search, steps);
      this.#sum(search, steps);
      const summary = this.#buffers.get("summary", SUMMARY_BYTES / 4);
      this.#summarize(search, 0, summary, steps);
      return { search, summary };
    });
    const counted = await this.readSummary(summary.buffer);
    if (counted.found > this.mostPairs) {
      const count = await this.#countExactly(sets);
      const most = this.mostPairs;
      const message = `there are ${count} pairs, but a buffer of this device holds ${most}: find them in smaller groups of boxes`;
      throw new GpuError("TOO_MANY_PAIRS", message, count);
    }
    const pairs = await this.#submit((steps) => {
      const pairs = this.#buffers.get("pairs", 2 * counted.found);
      this.#write(search, counted.found, pairs, summary, steps);
      return pairs;
    });
    return { ...counted, written: counted.found, pairs: pairs.buffer, summary: summary.buffer };
  }

  #findInto(sets: readonly GpuBoxes[], pairs: GPUBuffer, summary: GPUBuffer): Promise<void> {
    return this.#inTurn(async () => {
      checkBuffer("pairs", pairs, 0, Usage.STORAGE);
      checkBuffer("summary", summary, SUMMARY_BYTES, Usage.STORAGE);
      this.#check(sets);
      const capacity = Math.min(Math.floor(pairs.size / 8), this.mostPairs);
      await this.#submit((steps) => {
        const search = this.#prepare(sets, steps);
        this.#count(search, steps);
        this.#sum(search, steps);
        const to = capacity === 0 ? this.#buffers.get("unused", 0) : { buffer: pairs, size: 8 * capacity };
        this.#write(search, capacity, to, { buffer: summary, size: SUMMARY_BYTES }, steps);
      });
    });
  }

  /** The number of pairs, without the limits of 32 bits. */
  async #countExactly(sets: readonly GpuBoxes[]): Promise<number> {
    const { tally, count } = await this.#submit((steps) => {
      const search = this.#prepare(sets, steps);
      this.#count(search, steps);
      return search;
    });
    const counts = await read(this.#device, tally.buffer, 4 * count);
    return counts.reduce((sum, found) => sum + found, 0);
  }

  /** Checks the boxes of a search, before anything of the finder changes. */
  #check(sets: readonly GpuBoxes[]): void {
    for (const set of sets) checkBoxes(set, this.#options.dimensions);
    const count = countOf(sets);
    const most = this.mostBoxes;
    if (count > most) {
      const message = `${count} boxes are too many: this device can search ${most}; request a larger maxStorageBufferBindingSize and maxBufferSize`;
      throw new GpuError("TOO_MANY_BOXES", message, count);
    }
  }

  /** Adds the steps from boxes to the tree. */
  #prepare(sets: readonly GpuBoxes[], steps: Steps): Search {
    this.#timer?.restart();
    const count = countOf(sets);
    const begins = levels(count);
    const hasFilters = sets.some(({ filters }) => filters);
    const hasWorlds = sets.some(({ worlds }) => worlds);
    const isBetween = sets.length === 2;
    const firstSet = isBetween ? sets[0]!.count : 0;
    const top = begins.length - 2;
    const params = (capacity: number) => [count, Number(isBetween), firstSet, Number(hasFilters), capacity, top, 0, 0, ...begins];
    const rows = this.#buffers.get("rows", BOUNDS * count);
    const filters = this.#buffers.get("filters", hasFilters ? 2 * count : 0);
    const sums = this.#sums(count);
    this.#load(sets, rows, filters, hasFilters, steps);
    steps.stage = "order boxes";
    const order = this.#order(rows, count, hasWorlds, sums, steps);
    const nodes = this.#buffers.get("nodes", BOUNDS * begins.at(-1)!);
    steps.stage = "build the tree";
    steps.forEach("leaves", count, [count], [rows, order, nodes]);
    for (let level = 1; level + 1 < begins.length; level++) {
      const [firstChild, first, end] = begins.slice(level - 1) as [number, number, number];
      steps.forEach("parents", end - first, [end - first, first, firstChild], [nodes]);
    }
    return { count, params, nodes, order, filters, tally: this.#buffers.get("tally", count + 1), sums };
  }

  /** Adds the steps that read the boxes, the worlds and the filters. */
  #load(sets: readonly GpuBoxes[], rows: Bound, filters: Bound, hasFilters: boolean, steps: Steps): void {
    const { dimensions } = this.#options;
    const invalid = this.#buffers.get("invalid", 2);
    this.#device.queue.writeBuffer(invalid.buffer, 0, new Uint32Array([0, MOST]));
    const unused = this.#buffers.get("unused", 0);
    let firstRow = 0;
    for (const [number, set] of sets.entries()) {
      const { count } = set;
      if (count === 0) continue;
      const boxes = { buffer: set.boxes, size: 8 * dimensions * count };
      const worlds = set.worlds && { buffer: set.worlds, size: 4 * count };
      const params = [count, firstRow, dimensions, number, Number(worlds !== undefined)];
      steps.forEach("load", count, params, [boxes, worlds ?? unused, rows, invalid]);
      if (hasFilters) {
        const given = set.filters && { buffer: set.filters, size: 8 * count };
        steps.forEach("copy_filters", count, [count, firstRow, Number(given !== undefined)], [given ?? unused, filters]);
      }
      firstRow += count;
    }
  }

  /** Adds the steps that put the boxes in the order of the leaves. */
  #order(rows: Bound, count: number, hasWorlds: boolean, sums: readonly Bound[], steps: Steps): Bound {
    const { dimensions } = this.#options;
    const buffers = this.#buffers;
    const space = { table: buffers.get("table", tableLength(count)), sums };
    const otherKeys = buffers.get("otherKeys", count);
    const unused = buffers.get("unused", 0);
    const axes = (["sortedX", "sortedY", "sortedZ"] as const).map((slot, axis) => {
      if (axis >= dimensions) return unused;
      const keys = { now: buffers.get(slot, count), other: otherKeys };
      steps.forEach("extract", count, [count, axis, 0], [rows, unused, keys.now]);
      sort(steps, space, keys, undefined, count, 32);
      return keys.now;
    });
    const keys = { now: buffers.get("keys", count), other: otherKeys };
    const order = { now: buffers.get("order", count), other: buffers.get("otherOrder", count) };
    const highKeys = buffers.get("highKeys", count);
    steps.forEach("order_boxes", count, [count, dimensions], [rows, ...axes, highKeys, keys.now, order.now]);
    sort(steps, space, keys, order, count, 32);
    steps.forEach("gather", count, [count], [highKeys, order.now, keys.now]);
    sort(steps, space, keys, order, count, 32);
    if (hasWorlds) {
      steps.forEach("extract", count, [count, WORLD_LANE, 1], [rows, order.now, keys.now]);
      sort(steps, space, keys, order, count, 32);
    }
    return order.now;
  }

  /** Adds the step that counts the pairs of each box. */
  #count({ count, params, nodes, order, filters, tally }: Search, steps: Steps): void {
    steps.stage = "count the pairs";
    steps.forEach("count_pairs", count + 1, params(0), [nodes, order, filters, tally]);
  }

  /** Adds the steps that turn the numbers of pairs into the places where they belong. */
  #sum({ count, tally, sums }: Search, steps: Steps): void {
    steps.stage = "sum the numbers up";
    scan(steps, tally, count + 1, sums);
  }

  /** Adds the steps that write pairs and summary, once it is counted where they belong. */
  #write(search: Search, capacity: number, pairs: Bound, summary: Bound, steps: Steps): void {
    const { count, params, nodes, order, filters, tally } = search;
    steps.stage = "write the pairs";
    steps.forEach("write_pairs", count, params(capacity), [nodes, order, filters, tally, pairs]);
    this.#summarize(search, capacity, summary, steps);
    if (this.#options.sorted) this.#sortPairs(count, capacity, pairs, summary, steps);
  }

  #summarize({ count, tally }: Search, capacity: number, summary: Bound, steps: Steps): void {
    const { dispatchGroupSize, drawVertices } = this.#options;
    steps.add("summarize", [count, capacity, dispatchGroupSize, drawVertices], [tally, this.#buffers.get("invalid", 2), summary], 1);
  }

  /** Adds the steps that sort the pairs: by the second index, then by the first. */
  #sortPairs(count: number, capacity: number, pairs: Bound, summary: Bound, steps: Steps): void {
    const buffers = this.#buffers;
    const firsts = { now: buffers.get("firsts", capacity), other: buffers.get("otherFirsts", capacity) };
    const seconds = { now: buffers.get("seconds", capacity), other: buffers.get("otherSeconds", capacity) };
    const space = { table: buffers.get("table", tableLength(capacity)), sums: this.#sums(capacity) };
    steps.stage = "sort the pairs";
    steps.forEach("split_pairs", capacity, [capacity], [summary, pairs, firsts.now, seconds.now]);
    // Enough bits for each index and for one number above all, which stands where there is no pair.
    const bits = 32 - Math.clz32(count);
    sort(steps, space, seconds, firsts, capacity, bits);
    sort(steps, space, firsts, seconds, capacity, bits);
    steps.forEach("merge_pairs", capacity, [capacity], [summary, firsts.now, seconds.now, pairs]);
  }

  /** Builds steps and hands them to the device. After an error of the device the buffers are made again by the next call. */
  async #submit<R>(build: (steps: Steps) => R): Promise<R> {
    const buffers = this.#buffers;
    try {
      return await checked(this.#device, () => {
        const steps = new Steps();
        const result = build(steps);
        buffers.params = steps.submit(this.#device, this.#kernels, buffers.params, this.#timer);
        return result;
      });
    } catch (error) {
      // Some may be invalid.
      buffers.destroy();
      throw error;
    }
  }

  /** Runs a search: at once, or after those before it. */
  #inTurn<R>(run: () => Promise<R>): Promise<R> {
    const result = this.#last ? this.#last.then(run) : run();
    const done = () => {
      if (this.#last === last) this.#last = undefined;
    };
    const last = result.then(done, done);
    this.#last = last;
    return result;
  }

  /** The sums of a scan of up to `count + 1` numbers. */
  #sums(count: number): Bound[] {
    return scanLevels(count + 1).map((length, level) => this.#buffers.get(`sums${level}`, length));
  }
}
