// Puts the functions of a WebAssembly module into an order in which those with much in common are near each other: gzip finds
// what it has seen in the last 32 KB. The same code for several types of boxes becomes 3 to 4 % smaller.
import { gzipSync } from "node:zlib";

/** What gzip remembers, less what the function itself takes, in bytes. Which is best depends on the file: all are tried. */
const MEMORIES = [16_000, 22_000, 28_000];
/** The length of the byte strings that are compared. */
const LENGTH = 6;

/** How many functions are tried as the first one, and how many orders as whole modules: in another order functions have other numbers. */
const [STARTS, MODULES] = [16, 6];

/** The bytes of a module, as `binaryen` writes it without names, with its functions in another order. */
export function orderBySimilarity(binaryen, bytes, features) {
  return smallest(ordersOf(bodiesOf(bytes)).map((order) => inOrder(order, binaryen, bytes, features)))[0];
}

/** A module with its functions in this order. */
function inOrder(order, binaryen, bytes, features) {
  const imported = WebAssembly.Module.imports(new WebAssembly.Module(bytes)).filter(({ kind }) => kind === "function").length;
  const names = new Array(imported + order.length);
  for (let at = 0; at < imported; at++) names[at] = `a${String(at).padStart(6, "0")}`;
  order.forEach((at, rank) => (names[imported + at] = `b${String(rank).padStart(6, "0")}`));
  const module = binaryen.readBinary(Buffer.concat([bytes, nameSection(names)]));
  module.setFeatures(features);
  module.runPasses(["reorder-functions-by-name", "strip-debug"]);
  const ordered = module.emitBinary();
  module.dispose();
  return Buffer.from(ordered);
}

/** The orders, as positions of bodies, in which bodies are smallest after gzip, of those that are tried. */
function ordersOf(bodies) {
  const strings = stringsOf(bodies);
  const starts = Array.from({ length: STARTS }, (_, start) => Math.floor((start * bodies.length) / STARTS));
  const orders = MEMORIES.flatMap((memory) => starts.map((start) => similarNext(bodies, strings, memory, start)));
  return smallest(orders, (order) => Buffer.concat(order.map((at) => bodies[at]))).slice(0, MODULES);
}

/** Sorts what has such bytes by their size after gzip. */
function smallest(all, bytesOf = (bytes) => bytes) {
  const sizes = new Map(all.map((each) => [each, gzipSync(bytesOf(each), { level: 9 }).length]));
  return all.toSorted((a, b) => sizes.get(a) - sizes.get(b));
}

/** The positions of bodies from `start` on: each is followed by the one of which the largest part occurs in those within `memory` bytes before. */
function similarNext(bodies, { ofBody, bodiesWith }, memory, start) {
  const left = new Set(bodies.keys());
  const order = [];
  // How many of the last functions have a string, and how many of its strings a function has in common with them.
  const remembered = new Uint32Array(bodiesWith.length);
  const known = new Uint32Array(bodies.length);
  let [first, size] = [0, 0];
  let next = start;
  while (next !== undefined) {
    left.delete(next);
    order.push(next);
    size += bodies[next].length;
    for (const string of ofBody[next]) {
      if (remembered[string]++ === 0) for (const at of bodiesWith[string]) known[at]++;
    }
    for (; size > memory && first < order.length - 1; first++) {
      size -= bodies[order[first]].length;
      for (const string of ofBody[order[first]]) {
        if (--remembered[string] === 0) for (const at of bodiesWith[string]) known[at]--;
      }
    }
    let most = -1;
    next = undefined;
    for (const at of left) {
      const share = known[at] / (ofBody[at].length + 3);
      if (share > most) [most, next] = [share, at];
    }
  }
  return order;
}

/** The different strings of `LENGTH` bytes, numbered: those in each body, and the bodies in which each is. */
function stringsOf(bodies) {
  const numbers = new Map();
  const bodiesWith = [];
  const ofBody = bodies.map((body, position) => {
    const strings = new Set();
    for (let at = 0; at + LENGTH <= body.length; at++) {
      const text = body.readUIntLE(at, LENGTH);
      const string = numbers.get(text) ?? numbers.size;
      numbers.set(text, string);
      strings.add(string);
    }
    for (const string of strings) (bodiesWith[string] ??= []).push(position);
    return [...strings];
  });
  return { ofBody, bodiesWith };
}

/** The bodies of the functions of a module. */
function bodiesOf(bytes) {
  let at = 8;
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 7) {
      const byte = bytes[at++];
      value |= (byte & 127) << shift;
      if (byte < 128) return value >>> 0;
    }
  };
  const CODE = 10;
  for (let section = bytes[at++], length = number(); section !== CODE; section = bytes[at++], length = number()) at += length;
  const bodies = [];
  for (let left = number(); left > 0; left--) {
    const length = number();
    bodies.push(bytes.subarray(at, at + length));
    at += length;
  }
  return bodies;
}

/** The section that names the functions of a module. */
function nameSection(names) {
  const section = (id, content) => [id, ...leb(content.length), ...content];
  const text = (name) => [...leb(name.length), ...Buffer.from(name)];
  const all = names.flatMap((name, at) => [...leb(at), ...text(name)]);
  return Buffer.from(section(0, [...text("name"), ...section(1, [...leb(names.length), ...all])]));
}

/** A number as WebAssembly writes it. */
function leb(number) {
  const bytes = [];
  for (; number > 127; number >>>= 7) bytes.push((number & 127) | 128);
  return [...bytes, number];
}
