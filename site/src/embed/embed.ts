// One demo, as the address says after its `#`: what `share()` and `embedCode()` lead to.

import { readShared } from "sweep-and-prune/demo";

const main = document.querySelector("main")!;

function show(): void {
  const demo = document.createElement("sap-demo");
  for (const [name, value] of readShared(location.hash)) demo.setAttribute(name, value);
  // From here too it can be shared, at this very address.
  demo.setAttribute("embed-url", location.href.replace(/#.*/, ""));
  main.querySelector("sap-demo")?.remove();
  main.append(demo);
}

addEventListener("hashchange", show);
show();
