import type { TraceEvent } from "../trace.js";
import type { DemoEvent, DemoEventMap, DemoSort } from "./types.js";

/** Which kind of event a listener is told a trace event as. */
const kinds: Partial<Record<TraceEvent["kind"], DemoEvent["kind"]>> = {
  compare: "compare",
  swap: "swap",
  test: "test",
  enter: "enter",
  leave: "leave",
  overlap: "overlap",
  prune: "skip",
};

/** What listeners are told of an event, the so-manyeth of its detection, if anything. */
export function toldAs(event: TraceEvent, index: number): DemoEvent | undefined {
  const kind = kinds[event.kind];
  if (!kind) return undefined;
  const a = Number(event["a"] ?? event["left"] ?? event["id"]);
  const b = Number(event["b"] ?? event["right"] ?? event["id"]);
  const isOfEdges = kind === "compare" || kind === "swap";
  return { kind, a: isOfEdges ? a >> 1 : a, b: isOfEdges ? b >> 1 : b, index };
}

/** What it is as an event of the sort, if it is one. */
function toldOfSort({ kind, i, j, a, b }: TraceEvent): DemoSort | undefined {
  if (kind === "swap") return { kind, i: Number(i), j: Number(j) };
  if (kind === "compare") return { kind, i: Number(a), j: Number(b) };
  return undefined;
}

/** Tells those who listen to a demo. */
export function emit<K extends keyof DemoEventMap>(demo: Element, type: K, detail: DemoEventMap[K]["detail"]): void {
  demo.dispatchEvent(new CustomEvent(type, { detail, bubbles: true, composed: true }));
}

/** Tells of an event, the so-manyeth of its detection, if it is one to be told. */
export function tell(demo: Element, event: TraceEvent, index: number): void {
  const detail = toldAs(event, index);
  if (!detail) return;
  const ofSort = toldOfSort(event);
  if (ofSort) emit(demo, "sap-sort", ofSort);
  emit(demo, "sap-event", detail);
}
