// Balls that bounce: the class around the exports of this folder's crate. The types and what
// they promise stand in simulation.d.ts, the layout of the area in src/lib.rs.

const SCENES = { falling: 0, bouncing: 1, given: 2 };
const SETTINGS = { gravity: 0, restitution: 1, substeps: 2, collisions: 3, counting: 4 };
/** In the order of the exports' codes. */
const CODES = ["ok", "freed", "invalid-option", "no-room", "too-many", "internal"];
const MESSAGES = {
  "not-loaded": "call `await Simulation.load()` first",
  freed: "the simulation has been freed",
  "invalid-option": "an option is not a number, or does not exist",
  "no-room": "the balls do not fit into the box without overlap",
  "too-many": "at most 4,096 balls can be given",
  internal: "the simulation failed; this is a bug",
};
const AREA_LENGTH = 16;
const FLOATS_PER_BALL = 5;

/** The exports, once loaded. */
let exports;
let loading;

export class SimulationError extends Error {
  constructor(code, detail = MESSAGES[code]) {
    super(detail);
    this.name = "SimulationError";
    this.code = code;
  }
}

/** Calls an export; a trap, which only a bug or a lack of memory makes, becomes an error. */
function call(name, ...numbers) {
  if (!exports) throw new SimulationError("not-loaded");
  try {
    return exports[name](...numbers);
  } catch (cause) {
    throw Object.assign(new SimulationError("internal"), { cause });
  }
}

/** Calls an export that returns a code. */
function attempt(name, ...numbers) {
  const code = CODES[call(name, ...numbers)];
  if (code !== "ok") throw new SimulationError(code);
}

/** A view of the module's memory, new each time: memory moves when it grows. */
const view = (Type, pointer, length) => new Type(exports.memory.buffer, pointer, length);
const area = () => view(Float64Array, call("sim_area"), AREA_LENGTH);

function readNames(kind) {
  const pointer = call("sim_names", kind);
  const bytes = view(Uint8Array, pointer, area()[0]);
  return Object.freeze(new TextDecoder().decode(bytes).split("\n"));
}

async function compile(source = new URL(/* @vite-ignore */ "./simulation.wasm", import.meta.url)) {
  if (source instanceof WebAssembly.Module) return source;
  if (typeof source === "string" || source instanceof URL) source = await fetch(source);
  const bytes = source instanceof Response ? await source.arrayBuffer() : source;
  return WebAssembly.compile(bytes);
}

async function instantiate(source) {
  const env = { now: () => performance.now() };
  const instance = await WebAssembly.instantiate(await compile(source), { env });
  exports = instance.exports;
  [Simulation.algorithms, Simulation.sorts, Simulation.axes] = [0, 1, 2].map(readNames);
}

/** The place of a name in a list; the first if there is none. */
function indexOf(kind, names, name) {
  const index = name === undefined ? 0 : names.indexOf(name);
  if (index < 0) throw new SimulationError("invalid-option", `no ${kind} is called '${name}'`);
  return index;
}

const isAxis = (axis) => Number.isInteger(axis) && axis >= 0 && axis < 3;

export class Simulation {
  static algorithms = Object.freeze([]);
  static sorts = Object.freeze([]);
  static axes = Object.freeze([]);

  static load(source) {
    loading ??= instantiate(source).catch((error) => {
      loading = undefined;
      throw error;
    });
    return loading;
  }

  #handle;
  #bodies;
  #dimensions;
  #bounds;

  constructor(options = {}) {
    const { scene = "falling", balls } = options;
    const isFalling = scene === "falling";
    if (!isFalling && scene !== "bouncing") {
      throw new SimulationError("invalid-option", `no scene is called '${scene}'`);
    }
    const given = !isFalling && balls !== undefined;
    const { dimensions = isFalling ? 3 : 2 } = options;
    const { bodies = isFalling ? 10_000 : 5, spread = 1, seed = 1 } = options;
    const { size = isFalling ? (dimensions === 3 ? 0.2 : 0.04) : 35 } = options;
    const { width = 600, height = 400 } = options;
    const number = given ? SCENES.given : SCENES[scene];

    writeBalls(given ? balls : []);
    area().set([number, dimensions, bodies, size, spread, seed, width, height].map(Number));
    attempt("sim_new");
    this.#handle = area()[0];
    const [d, n, , ...corners] = this.#describe();
    this.#dimensions = d;
    this.#bodies = n;
    this.#bounds = { min: corners.slice(0, d), max: corners.slice(3, 3 + d) };

    try {
      for (const name of Object.keys(SETTINGS)) {
        if (options[name] !== undefined) this[name] = options[name];
      }
      if (options.broadPhase !== undefined) this.setBroadPhase(options.broadPhase);
    } catch (error) {
      this.free();
      throw error;
    }
  }

  get dimensions() {
    return this.#dimensions;
  }

  get bodies() {
    return this.#bodies;
  }

  get bounds() {
    return { min: [...this.#bounds.min], max: [...this.#bounds.max] };
  }

  get steps() {
    return this.#describe()[2];
  }

  get positions() {
    return view(Float32Array, this.#call("sim_positions"), this.#bodies * this.#dimensions);
  }

  get velocities() {
    return view(Float32Array, this.#call("sim_velocities"), this.#bodies * this.#dimensions);
  }

  get radii() {
    return view(Float32Array, this.#call("sim_radii"), this.#bodies);
  }

  get pairs() {
    const pointer = this.#call("sim_pairs");
    return view(Uint32Array, pointer, area()[0] * 2);
  }

  get gravity() {
    return this.#describe()[9];
  }

  set gravity(value) {
    this.#set("gravity", value);
  }

  get restitution() {
    return this.#describe()[10];
  }

  set restitution(value) {
    this.#set("restitution", value);
  }

  get substeps() {
    return this.#describe()[11];
  }

  set substeps(value) {
    this.#set("substeps", value);
  }

  get collisions() {
    return this.#describe()[12] !== 0;
  }

  set collisions(value) {
    this.#set("collisions", value);
  }

  get counting() {
    return this.#describe()[13] !== 0;
  }

  set counting(value) {
    this.#set("counting", value);
  }

  setBroadPhase({ algorithm, sort, axis, persistent = true } = {}) {
    const rules = Simulation.axes;
    attempt(
      "sim_set_broad_phase",
      this.#live(),
      indexOf("algorithm", Simulation.algorithms, algorithm),
      indexOf("sort", Simulation.sorts, sort),
      isAxis(axis) ? rules.length + axis : indexOf("axis", rules, axis),
      persistent ? 1 : 0,
    );
  }

  step() {
    attempt("sim_step", this.#live());
    const [broadPhases, tests, axisOverlaps, comparisons, swaps, pairs, contacts, ...times] = area();
    const counted = (count) => (count < 0 ? null : count);
    return {
      broadPhases,
      tests: counted(tests),
      axisOverlaps: counted(axisOverlaps),
      comparisons: counted(comparisons),
      swaps: counted(swaps),
      pairs,
      contacts,
      broadPhaseMs: times[0],
      narrowPhaseMs: times[1],
      totalMs: times[2],
    };
  }

  save() {
    attempt("sim_save", this.#live());
    return area()[0];
  }

  restore(moment) {
    attempt("sim_restore", this.#live(), moment);
  }

  forget(moment) {
    attempt("sim_forget", this.#live(), moment);
  }

  place(ball, { x, y, vx = 0, vy = 0 }) {
    attempt("sim_place", this.#live(), ball, x, y, vx, vy);
  }

  energy() {
    return this.#call("sim_energy");
  }

  hash() {
    const half = (upper) => (this.#call("sim_hash", upper) >>> 0).toString(16).padStart(8, "0");
    return half(1) + half(0);
  }

  free() {
    if (this.#handle === undefined) return;
    attempt("sim_free", this.#handle);
    this.#handle = undefined;
  }

  [Symbol.dispose ?? Symbol.for("Symbol.dispose")]() {
    this.free();
  }

  /** The handle, which a freed simulation has no more. */
  #live() {
    if (this.#handle === undefined) throw new SimulationError("freed");
    return this.#handle;
  }

  #call(name, ...numbers) {
    return call(name, this.#live(), ...numbers);
  }

  #describe() {
    attempt("sim_describe", this.#live());
    return area();
  }

  #set(name, value) {
    attempt("sim_set", this.#live(), SETTINGS[name], Number(value));
  }
}

/** Rows of x, y, radius, vx, vy. */
function writeBalls(balls) {
  const pointer = call("sim_balls", balls.length);
  if (pointer === 0 && balls.length > 0) throw new SimulationError("too-many");
  const rows = view(Float32Array, pointer, balls.length * FLOATS_PER_BALL);
  balls.forEach(({ x, y, radius, vx = 0, vy = 0 }, index) => {
    rows.set([x, y, radius, vx, vy], index * FLOATS_PER_BALL);
  });
}
