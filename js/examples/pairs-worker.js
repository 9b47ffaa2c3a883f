// The worker of pairs-in-worker.js.
import { init, PairFinder } from "sweep-and-prune";

const ready = init(); // not `await` at the top: some bundlers build workers as plain scripts
let finder, boxes, pairs;

onmessage = async ({ data }) => {
  try {
    await ready;
    if (typeof data === "object") {
      ({ boxes, pairs } = data);
      finder = new PairFinder({ dimensions: 2 });
      return;
    }
    postMessage(finder.findInto(boxes.subarray(0, 4 * data), pairs));
  } catch (error) {
    reportError(error); // else the page would not hear of it: this function is async
  }
};
