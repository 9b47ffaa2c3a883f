import { Engine, type Exports, type Module } from "./engine.js";
import { NotInitializedError } from "./errors.js";
import { checkOptionNames } from "./options.js";

/**
 * A compiled core: its address (a string or a `URL`), its bytes (an `ArrayBuffer` or a view of one), a
 * `Response`, or a `WebAssembly.Module`. Not these types themselves, which not every project has.
 */
export type Wasm = string | object;

/** Options of `init`. */
export interface InitOptions {
  /**
   * Whether to use the build with vector instructions (simd128). By default it is used where the
   * engine has them. Both give the same results in the same order.
   */
  simd?: boolean;
  /**
   * The compiled core of this entry point, if it is not beside its module: its address, its bytes, the
   * response of `fetch`, or the compiled module; or a promise of one of these. It must be the build that
   * `simd` names. With it, the other entry points are not started.
   */
  wasm?: Wasm | PromiseLike<Wasm>;
  /**
   * Whether stale views throw a `TypeError` when they are used. This is slower: views are then proxies
   * of typed arrays. For development; off by default.
   */
  development?: boolean;
}

/** What `init()` started. */
export interface Started {
  /** Whether it is the build with vector instructions. */
  readonly simd: boolean;
}

/** What starting a core needs to know of it. */
interface AnyCore {
  start(module: Module, isDevelopment: boolean): Promise<void>;
}

/** One of the compiled cores, which is started once. */
export class Core<E extends Exports> implements AnyCore {
  #engine: Engine<E> | undefined;

  /** `known` is the name of an export that only this core has, `entry` that of the package's entry. */
  constructor(
    readonly known: string & keyof E,
    readonly entry: string,
  ) {}

  /** The engine, once {@link start} is done. */
  engine(): Engine<E> {
    if (this.#engine === undefined) throw new NotInitializedError(this.entry);
    return this.#engine;
  }

  async start(module: Module, isDevelopment: boolean): Promise<void> {
    this.#engine = await Engine.start<E>(module, this.known, isDevelopment);
  }
}

/** Where the builds of a core are, unless the caller passes one. */
interface Sources {
  /** The one with vector instructions, if there is one. */
  simd?: () => Wasm;
  scalar: () => Wasm;
}

/** The cores of the entry points that the program has imported: one `init()` starts them all. */
const known = new Map<AnyCore, Sources>();

/** The promises of cores: each is started once, whichever entry asks first. */
const starting = new Map<AnyCore, Promise<Started>>();

const initOptions = ["simd", "wasm", "development"];

/** Makes a core known, and returns the `init` of its entry point. */
export function entry(core: AnyCore, sources: Sources): (options?: InitOptions) => Promise<Started> {
  known.set(core, sources);
  return (options = {}) => {
    checkOptionNames(options, initOptions);
    const own = start(core, sources, options);
    const others = options.wasm === undefined ? [...known].filter(([other]) => other !== core) : [];
    return others.length === 0 ? own : Promise.all([own, ...others.map((other) => start(...other, options))]).then(() => own);
  };
}

/** Starts a core once: later and concurrent calls get the first one's promise. */
function start(core: AnyCore, sources: Sources, options: InitOptions): Promise<Started> {
  let promise = starting.get(core);
  if (promise === undefined) {
    promise = load(core, sources, options).catch((error: unknown) => {
      starting.delete(core); // the network may be back: the next call tries again
      throw error;
    });
    starting.set(core, promise);
  }
  return promise;
}

async function load(core: AnyCore, sources: Sources, options: InitOptions): Promise<Started> {
  const vector = (options.simd ?? hasSimd()) ? sources.simd : undefined;
  const module = options.wasm === undefined ? await beside(vector ?? sources.scalar) : await compile(await options.wasm);
  await core.start(module, options.development === true);
  return { simd: vector !== undefined };
}

/** The core of the package. If it cannot be loaded, the error says what to do. */
async function beside(source: () => Wasm): Promise<WebAssembly.Module> {
  let wasm: Wasm = "the .wasm file";
  try {
    wasm = source(); // throws where a bundler leaves no address of the module: in a plain script
    return await compile(wasm);
  } catch (error) {
    if (!isAddress(wasm)) throw error;
    throw new Error(
      `sweep-and-prune cannot start: ${error instanceof Error ? error.message : String(error)}. If your bundler ` +
        `does not copy ${String(wasm)}, import the entry that ends in /inline, or pass \`init({ wasm })\``,
      { cause: error },
    );
  }
}

async function compile(wasm: Wasm): Promise<WebAssembly.Module> {
  // By its tag, not by `instanceof`: Next's edge runtime passes one of another realm.
  if (Object.prototype.toString.call(wasm) === "[object WebAssembly.Module]") return wasm as WebAssembly.Module;
  if (typeof Response !== "undefined" && wasm instanceof Response) return compileResponse(wasm);
  if (!isAddress(wasm)) return WebAssembly.compile(wasm as BufferSource); // which throws for anything else
  const address = String(wasm);
  if (address.startsWith("file:")) {
    const fs = nodeFiles();
    if (fs) return WebAssembly.compile(await fs.readFile(new URL(address)));
  }
  return compileResponse(await fetch(address));
}

function isAddress(wasm: unknown): wasm is string | URL {
  return typeof wasm === "string" || (typeof wasm === "object" && wasm !== null && "href" in wasm);
}

async function compileResponse(response: Response): Promise<WebAssembly.Module> {
  if (!response.ok) throw new Error(`${response.url || "the server"} answers ${response.status} ${response.statusText}`);
  // Compiling while it streams needs the right content type, which not every server sends.
  return response.headers.get("content-type")?.startsWith("application/wasm")
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

interface FileSystem {
  readFile(path: URL): Promise<Uint8Array<ArrayBuffer>>;
}

/** Node's file system, since its `fetch` cannot read `file:`. Not imported, so that bundlers do not see it. */
function nodeFiles(): FileSystem | undefined {
  const { process } = globalThis as { process?: { getBuiltinModule?(name: string): FileSystem } };
  return process?.getBuiltinModule?.("node:fs/promises");
}

/** Whether the engine accepts the smallest function with a vector instruction. */
function hasSimd(): boolean {
  return WebAssembly.validate(
    // prettier-ignore
    new Uint8Array([
      0, 97, 115, 109, 1, 0, 0, 0, // "\0asm", version 1
      1, 5, 1, 96, 0, 1, 123, // one type: () -> v128
      3, 2, 1, 0, // one function of it
      10, 10, 1, 8, 0, // its body:
      65, 0, 253, 15, // i32.const 0; i8x16.splat
      253, 98, // i8x16.popcnt, which only the finished proposal has
      11, // end
    ]),
  );
}
