// The demos that the address names after its `#`: what `share()` and `embedCode()` lead to. Several stand side by side.

import "../classroom/start.ts";
import { showLoadFailure } from "../load-failed.ts";
import { readShared } from "sweep-and-prune-classroom/demo";

const place = document.querySelector<HTMLElement>("#demos")!;

function show(): void {
  if (location.hash === "#three-structures") return void import("../structures/alone.ts").then(({ ThreeStructures }) => place.replaceChildren(new ThreeStructures()), (error: unknown) => showLoadFailure(place, error));
  const demos = location.hash.slice(1).split("|").map(demoOf);
  const [first] = demos;
  if (demos.length === 1) return place.replaceChildren(first!);
  const comparison = document.createElement("sap-comparison");
  const grid = document.createElement("div");
  grid.className = "together";
  grid.append(...demos);
  comparison.append(grid);
  place.replaceChildren(comparison);
}

function demoOf(shared: string): HTMLElement {
  const demo = document.createElement("sap-demo");
  for (const [name, value] of readShared(shared)) demo.setAttribute(name, value);
  // From here too it can be shared, at this very address.
  demo.setAttribute("embed-url", location.href.replace(/#.*/, ""));
  return demo;
}

addEventListener("hashchange", show);
show();

// The page around the frame gives it this height, if it listens.
if (parent !== self) {
  const main = document.querySelector("main")!;
  new ResizeObserver(() => parent.postMessage({ sapDemoHeight: Math.ceil(main.getBoundingClientRect().height) }, "*")).observe(main);
}
