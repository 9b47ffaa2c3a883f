import type { TraceEvent } from "../algorithms/trace.js";
import type { DemoEvent, DemoEventMap, DemoSort } from "./types.js";

/** The kind of demo event that each kind of trace event becomes. */
const kinds: Partial<Record<TraceEvent["kind"], DemoEvent["kind"]>> = {
  compare: "compare",
  swap: "swap",
  test: "test",
  enter: "enter",
  leave: "leave",
  overlap: "overlap",
  prune: "skip",
  "axis overlap": "flag",
};

/** The demo event of a trace event, if it has one. `index` counts within its detection. */
export function demoEventOf(event: TraceEvent, index: number): DemoEvent | undefined {
  const kind = kinds[event.kind];
  if (!kind) return undefined;
  const a = Number(event["a"] ?? event["left"] ?? event["id"]);
  const b = Number(event["b"] ?? event["right"] ?? event["id"]);
  const isOfEdges = kind === "compare" || kind === "swap";
  const line = event["line"] === undefined ? {} : { line: Number(event["line"]) };
  return { kind, a: isOfEdges ? a >> 1 : a, b: isOfEdges ? b >> 1 : b, index, ...line };
}

/** The event of the sort, if it is one. */
function demoSortOf({ kind, i, j, a, b }: TraceEvent): DemoSort | undefined {
  if (kind === "swap") return { kind, i: Number(i), j: Number(j) };
  if (kind === "compare") return { kind, i: Number(a), j: Number(b) };
  return undefined;
}

/** Dispatches an event to the listeners of a demo. */
export function emit<K extends keyof DemoEventMap>(demo: Element, type: K, detail: DemoEventMap[K]["detail"]): void {
  demo.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
}

/** Reports a trace event to listeners, if it is of a kind that they can see. `index` counts within its detection. */
export function report(demo: Element, event: TraceEvent, index: number): void {
  const detail = demoEventOf(event, index);
  if (!detail) return;
  const ofSort = demoSortOf(event);
  if (ofSort) emit(demo, "sap-sort", ofSort);
  emit(demo, "sap-event", detail);
}
