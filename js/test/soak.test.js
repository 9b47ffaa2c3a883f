// A world whose bodies are inserted, moved and removed stays right, and its memory flat. So does one that is only edited
// and queried, never updated. SOAK_MINUTES says for how long, counted in updates: no machine is too slow or too fast.
import assert from "node:assert/strict";
import { test } from "node:test";
import { setFlagsFromString } from "node:v8";
import vm from "node:vm";
import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";
import { boxesSpread, oracle, random } from "./support/boxes.js";

const count = 2000;
/** The world moves in one way for this many updates: every body, one in 50, one in 7, or none. */
const phase = 100;
const moving = [1, 50, 7, Infinity];
/** Updates in which the world moves in each way once. */
const cycle = phase * moving.length;
/** How many updates a minute has, on an average machine. */
const updatesPerMinute = 60 * cycle;
const minutes = Number(process.env["SOAK_MINUTES"] ?? (process.env["TEST_LONG"] ? 1 : 1 / 30));
/** Memory is compared after half of the updates, which is whole cycles, and after all. */
const half = cycle * Math.max(1, Math.round((minutes * updatesPerMinute) / (2 * cycle)));
/** Updates between two comparisons with brute force. */
const check = 100;

/** @typedef {[number, number, number, number]} Row */

class Soak {
  next = random(1);
  rows = boxesSpread(this.next, count, 2);
  velocities = Float64Array.from({ length: 2 * count }, () => 0.004 * (this.next() - 0.5));
  world = new BroadPhase({ dimensions: 2, precision: "double" });
  ids = [...this.world.insertMany(this.rows)];
  /** The pairs by the events so far. */
  live = new Set();
  /** Is never updated. */
  edited = new BroadPhase({ dimensions: 2, precision: "double" });
  /** @type {Map<number, Row>} */
  editedRows = new Map(Array.from({ length: count / 10 }, () => this.row()).map((row) => [this.edited.insert(...row), row]));

  below(/** @type {number} */ bound) {
    return Math.floor(this.next() * bound);
  }

  /** A box in the unit square, seldom a large one. */
  row() {
    const side = this.below(100) === 0 ? 0.3 : 0.03 * this.next();
    const [x, y] = [this.next(), this.next()];
    return /** @type {Row} */ ([x, y, x + side, y + side]);
  }

  rowOf(/** @type {number} */ body) {
    return /** @type {Row} */ ([...this.rows.subarray(4 * body, 4 * body + 4)]);
  }

  update() {
    const { begun, ended } = this.world.update();
    for (let i = 0; i < ended.length; i += 2) assert.ok(this.live.delete(`${ended[i]}-${ended[i + 1]}`));
    for (let i = 0; i < begun.length; i += 2) this.live.add(`${begun[i]}-${begun[i + 1]}`);
  }

  /** One update, with all that a game does between two of them. */
  step(/** @type {number} */ number) {
    const every = moving[Math.floor(number / phase) % moving.length] ?? 1;
    const movers = this.ids.map((_, body) => body).filter((body) => body % every === every - 1);
    for (const body of movers) {
      for (const axis of [0, 1]) {
        const [least, most] = [4 * body + axis, 4 * body + axis + 2];
        // It turns around where it leaves the unit square.
        const way = this.velocities[2 * body + axis] ?? 0;
        const turned = (this.rows[least] ?? 0) + way >= 0 && (this.rows[least] ?? 0) + way <= 1 ? way : -way;
        this.velocities[2 * body + axis] = turned;
        this.rows[least] = (this.rows[least] ?? 0) + turned;
        this.rows[most] = (this.rows[most] ?? 0) + turned;
      }
    }
    this.world.setMany(movers.map((body) => this.ids[body] ?? NaN), Float64Array.from(movers.flatMap((body) => this.rowOf(body))));
    for (let i = 0; i < count / 200; i++) {
      const [body, row] = [this.below(count), this.row()];
      const id = this.ids[body] ?? NaN;
      const kind = this.below(3);
      if (kind === 0) this.world.set(id, ...row);
      if (kind === 1) this.world.setSwept(id, this.rowOf(body), row);
      if (kind === 2) {
        this.world.remove(id);
        this.ids[body] = this.world.insert(...row);
      }
      this.rows.set(row, 4 * body);
    }
    const row = this.row();
    this.world.overlapping(row);
    this.world.nearest([row[0], row[1]], 5);
    this.world.rayCast([row[0], row[1]], [0.3, 0.2], 1);
    this.update();
    this.edit();
  }

  /** What happens to the world that is never updated. */
  edit() {
    const ids = [...this.editedRows.keys()];
    for (let i = 0; i < 20; i++) {
      const [id, row] = [ids[this.below(ids.length)] ?? NaN, this.row()];
      if (!this.editedRows.has(id)) continue;
      const kind = this.below(3);
      if (kind === 0) this.edited.set(id, ...row);
      if (kind === 1) this.edited.setSwept(id, row, row);
      if (kind === 2) {
        this.edited.remove(id);
        this.editedRows.delete(id);
      }
      this.editedRows.set(kind === 2 ? this.edited.insert(...row) : id, row);
    }
    const area = this.row();
    const found = [...this.editedRows].filter(([, row]) => overlap(row, area)).map(([id]) => id);
    assert.deepEqual([...this.edited.overlapping(area)].sort(), found.sort());
  }

  /** Compares pairs, events and queries with brute force, and goes on with a restored world. */
  compare() {
    // A swept body is at its end after one update, so that the boxes are those of the second.
    this.update();
    this.update();
    const bodies = this.ids.map((id, body) => ({ id, row: this.rowOf(body) })).sort((a, b) => slotOf(a.id) - slotOf(b.id));
    const expected = oracle(bodies.flatMap(({ row }) => row), 2).map(([a, b]) => `${bodies[a]?.id}-${bodies[b]?.id}`);
    const pairs = this.world.pairs();
    assert.deepEqual(Array.from({ length: pairs.length / 2 }, (_, i) => `${pairs[2 * i]}-${pairs[2 * i + 1]}`), expected);
    assert.deepEqual(this.live, new Set(expected));
    const area = this.row();
    const found = bodies.filter(({ row }) => overlap(row, area)).map(({ id }) => id);
    assert.deepEqual([...this.world.overlapping(area)], found);
    const restored = BroadPhase.fromSnapshot(this.world.snapshot(), { dimensions: 2 });
    assert.equal(restored.stateHash(), this.world.stateHash());
    this.world.free();
    this.world = restored;
  }
}

/**
 * @param {Row} a
 * @param {Row} b
 */
function overlap(a, b) {
  return a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3];
}

setFlagsFromString("--expose-gc");
const collect = vm.runInNewContext("gc");

/** The memory of JavaScript's objects and arrays, and that of WebAssembly, which all worlds share, in MiB. */
function memory() {
  collect();
  const world = new BroadPhase({ dimensions: 2, views: true });
  world.insert(0, 0, 1, 1);
  const { byteLength } = world.ids().buffer;
  world.free();
  const { heapUsed, arrayBuffers } = process.memoryUsage();
  return { script: (heapUsed + arrayBuffers) / 2 ** 20, wasm: byteLength / 2 ** 20 };
}

test(`a world stays right and its memory flat for ${2 * half} updates`, async (t) => {
  await init();
  const soak = new Soak();
  /** The memory after `half` more updates. */
  const used = (/** @type {number} */ from) => {
    for (let number = from; number < from + half; number++) {
      soak.step(number);
      if (number % check === check - 1) soak.compare();
    }
    const used = memory();
    t.diagnostic(`after ${from + half} updates: JavaScript has ${used.script.toFixed(1)} MiB, WebAssembly ${used.wasm.toFixed(1)}`);
    return used;
  };
  const [early, late] = [used(0), used(half)];
  // By now buffers have grown to their sizes.
  assert.ok(late.wasm <= 1.2 * early.wasm + 1, `WebAssembly's memory grew from ${early.wasm} to ${late.wasm} MiB`);
  assert.ok(late.script <= 1.2 * early.script + 1, `JavaScript's memory grew from ${early.script} to ${late.script} MiB`);
});
