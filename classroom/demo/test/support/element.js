// `<sap-demo>` in Node: its class as it is built, in a document that draws nothing and whose frames the test lets pass.
import { readFileSync } from "node:fs";

/** @type {((now: number) => void)[]} */
const frames = [];
let now = 0;

class FakeElement extends EventTarget {
  /** @type {Map<string, string>} */
  #attributes = new Map();
  isConnected = false;
  /** @type {any} */
  parent = null;
  /** @type {any[]} */
  children = [];

  /** @param {string} name */
  getAttribute(name) {
    return this.#attributes.get(name) ?? null;
  }
  /** @param {string} name */
  hasAttribute(name) {
    return this.#attributes.has(name);
  }
  /** @param {string} name @param {unknown} value */
  setAttribute(name, value) {
    const old = this.getAttribute(name);
    this.#attributes.set(name, String(value));
    /** @type {any} */ (this).attributeChangedCallback(name, old, String(value));
  }
  /** @param {string} name */
  removeAttribute(name) {
    const old = this.getAttribute(name);
    this.#attributes.delete(name);
    if (old !== null) /** @type {any} */ (this).attributeChangedCallback(name, old, null);
  }
  closest() {
    return this.parent;
  }
  querySelectorAll() {
    return this.children;
  }
  /** @param {FakeElement} other */
  compareDocumentPosition(other) {
    const all = this.parent.children;
    return all.indexOf(other) > all.indexOf(this) ? 4 : 0;
  }
}

/** @type {Map<string, any>} */
const classes = new Map();
Object.assign(globalThis, {
  window: globalThis,
  document: Object.assign(new EventTarget(), {
    hidden: false,
    baseURI: "http://localhost/",
    createElement: () => ({ style: {}, setAttribute() {}, append() {}, addEventListener() {} }),
    createTreeWalker: () => ({}),
    createComment: () => ({}),
  }),
  matchMedia: () => ({ matches: false, addEventListener() {}, removeEventListener() {} }),
  requestAnimationFrame: (/** @type {(now: number) => void} */ frame) => frames.push(frame),
  cancelAnimationFrame: () => void (frames.length = 0),
  /** Sees everything. */
  IntersectionObserver: class {
    /** @param {(entries: unknown[]) => void} see */
    constructor(see) {
      this.see = see;
    }
    /** @param {unknown} target */
    observe(target) {
      queueMicrotask(() => this.see([{ target, isIntersecting: true }]));
    }
    unobserve() {}
  },
  ResizeObserver: class {
    observe() {}
    disconnect() {}
  },
  Node: { DOCUMENT_POSITION_FOLLOWING: 4 },
  ShadowRoot: class {},
  Document: class {},
  CSSStyleSheet: class {},
  HTMLElement: FakeElement,
  customElements: { get: (/** @type {string} */ name) => classes.get(name), define: (/** @type {string} */ name, /** @type {any} */ element) => classes.set(name, element) },
  fetch: async (/** @type {URL} */ url) => new Response(readFileSync(url)),
});

/** @type {WebAssembly.Memory[]} */
const memories = [];
const { instantiate } = WebAssembly;
WebAssembly.instantiate = async (/** @type {any[]} */ ...given) => {
  const made = await /** @type {any} */ (instantiate)(...given);
  memories.push((made.instance ?? made).exports.memory);
  return made;
};

/** The bytes of memory that the compiled modules have. */
export const memory = () => memories.reduce((sum, { buffer }) => sum + buffer.byteLength, 0);

await import("sweep-and-prune-classroom/demo");
for (const element of classes.values()) {
  // What a browser reads when the element is defined.
  element.observedAttributes;
  element.prototype.requestUpdate = () => {};
  element.prototype.createRenderRoot = () => ({ querySelector: () => null });
  Object.defineProperty(element.prototype, "updateComplete", { get: () => Promise.resolve() });
}

/** Lets microtasks and timers without a delay run. */
export const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

/** @param {any} element */
function connect(element) {
  element.isConnected = true;
  element.connectedCallback();
}

/**
 * Makes a demo that is ready.
 *
 * @param {Record<string, string>} attributes
 */
export async function demoOf(attributes) {
  return (await all([attributes], null))[0];
}

/**
 * Makes a comparison, its demos ready.
 *
 * @param {Record<string, string>[]} demos
 */
export async function comparisonOf(demos) {
  const comparison = new (classes.get("sap-comparison"))();
  connect(comparison);
  await all(demos, comparison);
  return comparison;
}

/** @param {Record<string, string>[]} demos @param {any} parent */
async function all(demos, parent) {
  const made = demos.map((attributes) => {
    const demo = new (classes.get("sap-demo"))();
    demo.parent = parent;
    for (const [name, value] of Object.entries(attributes)) demo.setAttribute(name, value);
    return demo;
  });
  if (parent) parent.children = made;
  for (const demo of made) connect(demo);
  await Promise.all(made.map(({ ready }) => ready));
  await settle();
  return made;
}

/** Lets frames pass, each a little longer than a tick. */
export function pass(count = 1) {
  for (let i = 0; i < count; i++) {
    now += 16.7;
    for (const frame of frames.splice(0)) frame(now);
  }
}
