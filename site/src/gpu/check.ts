// Finds the pairs of boxes on the processor, in a thread of its own, and compares them with those of the GPU.
import { findPairs, init } from "sweep-and-prune";
import { formatCount } from "../panel/counters.ts";
import type { Copied } from "./world.ts";

/** Says whether the GPU found as many pairs and highlighted the same boxes. */
async function check({ rows, highlighted, dimensions, pairs }: Copied): Promise<string> {
  await init();
  const boxes = new Float32Array(rows);
  const found = findPairs(boxes, { dimensions });
  const isInPair = new Uint8Array(boxes.length / (2 * dimensions));
  for (const box of found) isInPair[box] = 1;
  const onGpu = new Uint32Array(highlighted);
  const wrong = isInPair.reduce((sum, one, box) => sum + Number(one !== onGpu[box]), 0);
  if (wrong === 0 && found.length === 2 * pairs) return `Both agree: the processor finds ${formatCount(pairs)} pairs too, in the same boxes.`;
  return `They DISAGREE, a bug: please report it. GPU: ${formatCount(pairs)} pairs, processor: ${formatCount(found.length / 2)}; ${formatCount(wrong)} boxes are highlighted wrongly.`;
}

addEventListener("message", async ({ data }: MessageEvent<Copied>) => {
  postMessage(await check(data).catch(() => "The check needs a file that did not load. Is there a connection?"));
});
