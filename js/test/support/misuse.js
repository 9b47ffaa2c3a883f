// Calls with odd values in the place of each argument: what they throw is a named error, or a TypeError or RangeError of the package.
import assert from "node:assert/strict";

export const detached = new Float32Array(8);
structuredClone(detached.buffer, { transfer: [detached.buffer] });

/** Odd values for any argument. */
export const odd = [
  ...[undefined, null, true, "", "x", 5n, Symbol("s"), () => false, Object.create(null), new Date()],
  ...[NaN, -1, -0, 0, 1, 1.5, 2 ** 32, 2 ** 53, 1e308, Infinity, -Infinity],
  ...[[], [1], [NaN, 1, 2, 3], [3, 3, 1, 1], [1n, 2n], ["1"], new Array(3), [null], [{}], [[1, 2, 3, 4]], [{ min: {}, max: {} }]],
  ...[{}, { length: 4, 0: 1 }, { dimensions: 2 }, { category: "x" }, { group: 1.5 }, { minX: 0, minY: 0, maxX: 1, maxY: 1 }],
  ...[new Float32Array(0), new Float32Array(3), new Float32Array(4), new Float32Array([NaN, 0, 0, 0]), new Float64Array(5), detached],
  ...[new Int32Array(4), new Uint8Array(0), new Uint8Array(100), new Uint32Array(9), new ArrayBuffer(8), new DataView(new ArrayBuffer(8))],
  ...[new Float32Array(new SharedArrayBuffer(16)), new Float32Array(new ArrayBuffer(64), 16, 4), new Proxy([1, 2, 3, 4], {}), new Proxy(new Float32Array(4), {})],
];

const named = /^(InvalidBox|StaleProxy|NotInitialized|OutOfMemory|Snapshot)Error$/;

/**
 * @param {string} call
 * @param {any} error
 */
export function checkError(call, error) {
  const isNamed = named.test(error?.name);
  const isMisuse = error instanceof TypeError || error instanceof RangeError;
  assert.ok(isNamed || isMisuse, `${call} throws ${error?.name}: ${error?.message}`);
  // Messages of the engine, where our code did not check.
  assert.doesNotMatch(error.message, /Cannot read|not a function|unreachable|internal error|call stack/, call);
}

/**
 * Makes a call with odd values in the place of each argument, and with none.
 *
 * @param {string} name
 * @param {(...args: any[]) => unknown} call
 * @param {unknown[]} good
 */
export function misuse(name, call, good) {
  const all = good.flatMap((_, at) => odd.map((value) => good.with(at, value)));
  for (const args of [...all, []]) {
    try {
      call(...args);
    } catch (error) {
      checkError(name, error);
    }
  }
}
