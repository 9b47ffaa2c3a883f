// One library on one scene, in a thread of its own: it can be stopped, and what it leaves behind
// slows nothing else.

import { libraries } from "../../../bench/js/libraries/index.js";
import { load } from "../../../bench/js/libraries/load.js";
import { library as bruteForce } from "../../../bench/js/src/reference.js";
import { Scenes } from "../../../bench/js/src/scenes.js";
import { Trial } from "../../../bench/js/src/trial.js";
import scenesUrl from "../generated/bench-scenes.wasm?url";
import type { Answer, Ready, Start, Time } from "./messages.ts";
import { messageOf } from "../message-of.ts";

// What box-intersect's pool of arrays looks for, written when everybody used browserify.
Object.assign(globalThis, { global: globalThis });

const clock = { start: () => performance.now(), since: (start: number) => performance.now() - start };
let trial: Trial | undefined;

async function start({ library, scene, dimensions, boxes }: Start): Promise<Ready> {
  const entry = [...libraries, bruteForce].find(({ name }) => name === library);
  if (!entry) throw new Error(`there is no library '${library}'`);
  const [scenes, module] = await Promise.all([
    fetch(scenesUrl).then(async (response) => Scenes.start(await response.arrayBuffer())),
    load(entry),
  ]);
  trial = await Trial.start(scenes.open(scene, dimensions, boxes), dimensions, module, clock);
  const { fingerprint, pairs, longest } = trial.check();
  if (longest < 1000 && entry !== bruteForce) trial.warmUp();
  const estimate = longest < 200 && entry !== bruteForce ? (trial.time(1, longest < 20 ? 10 : 1)[0] ?? longest) : longest;
  return { fingerprint, pairs, estimate };
}

addEventListener("message", async ({ data }: MessageEvent<Start | Time>) => {
  let answer: Answer;
  try {
    // Clocks of browsers are coarse: calls are timed together.
    answer = { value: "library" in data ? await start(data) : (trial?.time(1, data.calls)[0] ?? NaN) };
  } catch (error) {
    answer = { failed: messageOf(error) };
  }
  postMessage(answer);
});
