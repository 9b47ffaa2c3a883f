import type { Core, Exports } from "./engine.js";

/** How to start. */
export interface InitOptions {
  /**
   * Whether to use the build with vector instructions (simd128). By default it is used where the
   * engine has them. Both give the same results in the same order.
   */
  simd?: boolean;
  /**
   * Where the compiled core is, if it is not beside this module: its address, its bytes, or the
   * module compiled already. It must be the build that `simd` names.
   */
  wasm?: string | URL | BufferSource | WebAssembly.Module;
  /**
   * Whether views that are used after their time throw a `TypeError`, at a price in speed: they
   * are then proxies of typed arrays. For development; off by default.
   */
  development?: boolean;
}

/** What `init()` started. */
export interface Started {
  /** Whether it is the build with vector instructions. */
  readonly simd: boolean;
}

/** Where the two builds are to be had, unless the caller says otherwise. */
export interface Sources {
  simd(): NonNullable<InitOptions["wasm"]>;
  scalar(): NonNullable<InitOptions["wasm"]>;
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
  await core.start(await compile(options.wasm ?? (simd ? sources.simd() : sources.scalar())), options.development === true);
  return { simd };
}

async function compile(wasm: NonNullable<InitOptions["wasm"]>): Promise<WebAssembly.Module> {
  if (wasm instanceof WebAssembly.Module) return wasm;
  if (typeof wasm !== "string" && !("href" in wasm)) return WebAssembly.compile(wasm);
  const address = String(wasm);
  if (address.startsWith("file:")) {
    const fs = nodeFiles();
    if (fs) return WebAssembly.compile(await fs.readFile(new URL(address)));
  }
  const response = await fetch(address);
  if (!response.ok) throw new Error(`cannot load ${address}: ${response.status} ${response.statusText}`);
  // Compiling while it streams needs the right content type, which not every server sends.
  return response.headers.get("content-type")?.startsWith("application/wasm")
    ? WebAssembly.compileStreaming(response)
    : WebAssembly.compile(await response.arrayBuffer());
}

interface FileSystem {
  readFile(path: URL): Promise<Uint8Array<ArrayBuffer>>;
}

/** Node's files, whose `fetch` knows no `file:`; asked for so that no bundler sees an import. */
function nodeFiles(): FileSystem | undefined {
  const { process } = globalThis as { process?: { getBuiltinModule?(name: string): FileSystem } };
  return process?.getBuiltinModule?.("node:fs/promises");
}

/** Whether the engine takes the smallest function with a vector instruction. */
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
