import type { Core, Exports } from "./engine.js";

/** A compiled core: its address, its bytes, its answer from a server, or the module. */
export type Wasm = string | URL | BufferSource | Response | WebAssembly.Module;

/** Options of `init`. */
export interface InitOptions {
  /**
   * Whether to use the build with vector instructions (simd128). By default it is used where the
   * engine has them. Both give the same results in the same order.
   */
  simd?: boolean;
  /**
   * The compiled core, if it is not beside this module: its address, its bytes, the response of
   * `fetch`, or the compiled module; or a promise of one of these. It must be the build that `simd`
   * names.
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

/** Where the two builds are, unless the caller passes one. */
export interface Sources {
  simd(): Wasm;
  scalar(): Wasm;
}

/** Starts cores: each once, whichever entry asks first. */
const starting = new Map<unknown, Promise<Started>>();

/** Starts a core once: later and concurrent calls get the first one's promise. */
export function start<E extends Exports>(core: Core<E>, sources: Sources, options: InitOptions): Promise<Started> {
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

async function load<E extends Exports>(core: Core<E>, sources: Sources, options: InitOptions): Promise<Started> {
  const simd = options.simd ?? hasSimd();
  const module = options.wasm === undefined ? await beside(simd ? sources.simd() : sources.scalar()) : await compile(await options.wasm);
  await core.start(module, options.development === true);
  return { simd };
}

/** The core of the package. If it cannot be loaded, the error says what to do. */
async function beside(wasm: Wasm): Promise<WebAssembly.Module> {
  try {
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
  if (wasm instanceof WebAssembly.Module) return wasm;
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
