// The broken variants, which the site has in compiled algorithms of its own.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { before, test } from "node:test";
import { init, Player, Runner } from "sweep-and-prune-classroom";
import { oracle, sorted } from "../../js/test/support/boxes.js";

before(() => init({ wasm: readFileSync(new URL("../src/generated/algorithms.wasm", import.meta.url)) }));

test("the wrong methods are wrong, as their names say, and play like the others", () => {
  const worlds = {
    "strict ties (wrong)": [0, 0, 1, 1, 1, 0, 2, 1],
    "sorted start (wrong)": [0, 0, 2, 1, 1, 0, 3, 1],
    "sort by center (wrong)": [-1, 0, 1, 1, 2, 0, 4, 1, 0, 0, 8, 1],
  };
  for (const [method, boxes] of Object.entries(worlds)) {
    const runner = new Runner({ dimensions: 2, method, axis: 0, persistent: true, traceWords: 1 << 16 });
    const found = [0, 1].map(() => runner.step(boxes));
    const expected = oracle(boxes, 2);
    assert.ok(found.some(({ pairs }) => pairs.length / 2 !== expected.length), method);
    const player = new Player(runner);
    player.seek(2 ** 32);
    assert.deepEqual(player.state().overlaps, sorted(found[1]?.pairs ?? new Uint32Array()).flat());
    assert.deepEqual(player.state().held, player.state().overlaps);
  }
});
