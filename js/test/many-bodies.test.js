// With this number of bodies, the product of two counts does not fit 32 bits.
import assert from "node:assert/strict";
import { test } from "node:test";
import { BroadPhase, init, slotOf } from "sweep-and-prune/broad-phase";

test("half a million moving bodies are tracked", async () => {
  await init();
  const count = 600_000;
  const width = 1000;
  const boxes = new Float32Array(4 * count);
  const place = (/** @type {number} */ body, /** @type {number} */ x) => {
    const [column, row] = [body % width, Math.floor(body / width)];
    boxes.set([2 * column + x, 2 * row, 2 * column + x + 1, 2 * row + 1], 4 * body);
  };
  for (let body = 0; body < count; body++) place(body, 0);
  const world = new BroadPhase({ dimensions: 2 });
  const ids = world.insertMany(boxes);
  assert.equal(world.update().begun.length, 0);
  // One in two hundred touches its right neighbor, and leaves it again.
  for (const [x, frame] of [[1, "begun"], [0, "ended"], [1, "begun"], [0, "ended"]]) {
    for (let body = 0; body < count; body += 200) place(body, Number(x));
    world.setMany(ids, boxes);
    const changes = world.update();
    const [some, none] = frame === "begun" ? [changes.begun, changes.ended] : [changes.ended, changes.begun];
    assert.equal(none.length, 0);
    assert.equal(some.length / 2, count / 200);
    for (let i = 0; i < some.length; i += 2) {
      assert.equal(slotOf(/** @type {number} */ (some[i])), 100 * i);
      assert.equal(slotOf(/** @type {number} */ (some[i + 1])), 100 * i + 1);
    }
  }
  world.free();
});
