// `<sap-demo>` as scripts use it: calls from its listeners, programs that fail, attributes that change.
import assert from "node:assert/strict";
import { test } from "node:test";
import { comparisonOf, demoOf, memory, pass, settle } from "./support/element.js";

test("a listener can pause: at an event, at a tick, in a comparison", async () => {
  const checks = await demoOf({ balls: "10", decorations: "checks" });
  let tests = 0;
  checks.addEventListener("sap-event", (/** @type {any} */ { detail }) => {
    if (detail.kind !== "test") return;
    tests++;
    checks.pause();
  });
  pass(100);
  assert.deepEqual([checks.isPlaying, tests, checks.state.tick], [false, 1, 0]);

  const fast = await demoOf({ balls: "10", speed: "4" });
  fast.addEventListener("simulate", (/** @type {any} */ { detail }) => detail.tick === 9 && fast.pause());
  pass(20);
  assert.deepEqual([fast.isPlaying, fast.state.tick], [false, 9]);

  const comparison = await comparisonOf([{ strategy: "pairwise" }, { strategy: "sweep" }]);
  const [first] = comparison.children;
  first.addEventListener("simulate", (/** @type {any} */ { detail }) => detail.tick === 9 && first.pause());
  pass(20);
  assert.deepEqual([comparison.isPlaying, ...comparison.children.map((/** @type {any} */ demo) => demo.state.tick)], [false, 9, 9]);
});

test("a listener can start over, while it plays and in a step", async () => {
  const demo = await demoOf({ balls: "10", speed: "4", "skip-interval": "4" });
  const begin = demo.state.hash;
  demo.addEventListener("simulate", (/** @type {any} */ { detail }) => detail.tick === 9 && demo.reset());
  pass(20);
  assert.ok(demo.isPlaying && demo.state.hash !== "" && demo.state.tick < 9);
  demo.reset();
  for (let i = 0; i < 3; i++) demo.step();
  assert.deepEqual([demo.state.tick, demo.state.hash], [0, begin]);
});

test("the oldest moment is reached, also where the oldest kept tick has no detection", async () => {
  const demo = await demoOf({ balls: "5", "skip-interval": "4" });
  pass(1003);
  demo.pause();
  demo.seek(1);
  const { tick } = demo.state;
  demo.seek(0);
  assert.equal(demo.state.tick, tick);
  assert.ok(tick < 200);
});

test("what a program throws is shown in its place, and the demo can start over", async () => {
  const calls = /** @type {((demo: any) => void)[]} */ ([(demo) => demo.step(), (demo) => demo.seek(0), (demo) => (demo.play(), pass(3))]);
  for (const call of calls) {
    const demo = await demoOf({ balls: "5", paused: "" });
    for (let i = 0; i < 3; i++) demo.step();
    let answer = () => /** @type {unknown[]} */ ([]);
    demo.program = () => answer();
    demo.step();
    answer = () => {
      throw new Error("it broke");
    };
    call(demo);
    await settle();
    if (call !== calls[1]) assert.equal(demo.state.hash, "", String(call));
    else assert.notEqual(demo.state.hash, "", "what was answered once is kept");
    answer = () => [];
    demo.reset();
    await settle();
    assert.notEqual(demo.state.hash, "");
  }
});

test("programs that throw at once leave no world behind", async () => {
  const demo = await demoOf({ balls: "400", paused: "" });
  const fail = async () => {
    demo.program = () => {
      throw new Error("it broke");
    };
    await settle();
    assert.equal(demo.state.hash, "");
  };
  for (let i = 0; i < 5; i++) await fail();
  const before = memory();
  assert.ok(before > 0);
  for (let i = 0; i < 500; i++) await fail();
  assert.equal(memory(), before);
});

test("an answer that is no list is shown as what went wrong; any promise will do", async () => {
  const demo = await demoOf({ balls: "5", paused: "" });
  for (const program of [async () => {}, () => {}, async () => [null]]) {
    demo.program = program;
    await demo.settled;
    await settle();
    assert.equal(demo.state.hash, "", String(program));
  }
  demo.program = () => ({ then: (/** @type {(events: unknown[]) => void} */ answer) => answer([{ kind: "test", a: 0, b: 1 }]) });
  await settle();
  assert.equal(demo.state.tests, 1);
});

test("a program is asked once for each detection, also if the demo leaves before the answer and comes back", async () => {
  const demo = await demoOf({ balls: "5", paused: "" });
  let asked = 0;
  let answer = (/** @type {unknown} */ _events) => {};
  demo.program = () => (++asked === 1 ? [] : new Promise((resolve) => (answer = resolve)));
  demo.step();
  demo.seek(0);
  demo.seek(99);
  answer([{ kind: "test", a: 0, b: 1 }]);
  await demo.settled;
  assert.deepEqual([asked, demo.state.tick, demo.state.tests], [2, 1, 1]);
});

test('"false" is the same as without, for every attribute that is there or not', async () => {
  const demo = await demoOf({ paused: "false", static: "false", "no-bounce": "" });
  assert.deepEqual([demo.isPlaying, demo.paused, demo.static, demo.noBounce], [true, false, false, true]);
  demo.setAttribute("paused", "");
  assert.equal(demo.isPlaying, false);
  demo.setAttribute("paused", "false");
  assert.equal(demo.isPlaying, true);
  const comparison = await comparisonOf([{ paused: "false" }, {}]);
  assert.equal(comparison.isPlaying, true);
});

test("attributes that change only looks leave the history and the stop as they are", async () => {
  const demo = await demoOf({ balls: "5", strategy: "swap", decorations: "checks", paused: "" });
  for (let i = 0; i < 12; i++) demo.step();
  const { state } = demo;
  for (const [name, value] of [["heading", "Look"], ["decorations", "checks:red:50, edges"], ["rainbow", ""], ["labels", "A,B,C,D,E"], ["speed", "2"], ["aria-label", "Balls"]]) {
    demo.setAttribute(name, value);
    await settle();
    assert.deepEqual(demo.state, state, name);
  }
  demo.back();
  demo.step();
  assert.deepEqual(demo.state, state);
  demo.setAttribute("strategy", "sweep");
  await settle();
  assert.deepEqual([demo.state.tick, demo.state.hash], [state.tick, state.hash], "in the same world");
});

test("the demos of a comparison stay at the same tick when an attribute of one changes", async () => {
  for (const which of [0, 1]) {
    for (const [name, value] of [["strategy", "sweep"], ["heading", "Mine"], ["seed", "2"]]) {
      const comparison = await comparisonOf([{ strategy: "pairwise" }, { strategy: "sorted-pairwise" }]);
      const ticks = () => comparison.children.map((/** @type {any} */ demo) => demo.state.tick);
      pass(60);
      comparison.pause();
      comparison.children[which].setAttribute(name, value);
      await settle();
      for (let i = 0; i < 3; i++) comparison.step();
      const [tick] = ticks();
      comparison.back();
      assert.deepEqual(ticks(), [tick - 1, tick - 1], `${name} of ${which}`);
    }
  }
});
