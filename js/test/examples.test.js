// The examples of docs/, with the libraries that they name: each prints what it says, and each page
// shows the file that ran.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { init } from "sweep-and-prune";
import { BroadPhase } from "sweep-and-prune/broad-phase";
import { replaceBroadPhase } from "sweep-and-prune/cannon-es";
import { insertObjects, moveObjects, pick } from "sweep-and-prune/three";
import { random } from "./support/boxes.js";
import { resultOf, startBrowser } from "./support/browser.js";
import { serve } from "./support/serve.js";

const folder = fileURLToPath(new URL("../examples", import.meta.url));
const pages = fileURLToPath(new URL("../docs", import.meta.url));
const examples = readdirSync(folder).filter((name) => name.endsWith(".js"));
/** Those that need a browser. */
const inBrowser = ["excalibur-engine.js", "pairs-in-worker.js", "phaser-game.js", "phaser-overlap.js", "pixi-game.js"];
/** The workers that they start. */
const workers = ["pairs-worker.js"];

before(() => {
  const lock = readFileSync(join(folder, "package-lock.json"), "utf8");
  const marker = join(folder, "node_modules/.installed");
  if (existsSync(marker) && readFileSync(marker, "utf8") === lock) return;
  execFileSync("npm", ["ci", "--no-audit", "--no-fund", "--loglevel=error"], { cwd: folder, stdio: "inherit" });
  writeFileSync(marker, lock);
});

/** What an example says that it prints.
 *
 * @param {string} code
 */
function promised(code) {
  return [...code.matchAll(/console\.log\(.*\);\s*\/\/ (.*)/g)].map(([, said]) => said);
}

for (const name of examples.filter((name) => ![...inBrowser, ...workers].includes(name))) {
  test(`${name} prints what it says`, () => {
    const expected = promised(readFileSync(join(folder, name), "utf8"));
    assert.ok(expected.length > 0);
    const printed = execFileSync(process.execPath, [name], { cwd: folder, encoding: "utf8" });
    assert.deepEqual(printed.trim().split("\n"), expected);
  });
}

for (const name of inBrowser) {
  test(`${name} prints what it says, in Chromium`, async () => {
    const expected = promised(readFileSync(join(folder, name), "utf8"));
    assert.ok(expected.length > 0);
    const { server, address } = await serve([name, ...workers].map((name) => join(folder, name)));
    const browser = await startBrowser();
    try {
      const page = await browser.newPage();
      /** @type {string[]} */
      const printed = [];
      // A browser short of memory or of time warns by itself, of a WebGL context that was lost, say.
      page.on("console", (message) => message.type() === "warning" || printed.push(message.text()));
      page.on("pageerror", (error) => printed.push(String(error)));
      const done = page.waitForEvent("console", { predicate: () => printed.length >= expected.length, timeout: 600_000 });
      await page.goto(address);
      await done;
      assert.deepEqual(printed.filter((line) => !line.includes("favicon") && !line.includes("404")), expected);
    } finally {
      await browser.close();
      server.close();
    }
  });
}

test("each page shows examples as they are, and each example has a page", () => {
  const shown = readdirSync(pages).filter((name) => name.endsWith(".md")).flatMap((name) =>
    [...readFileSync(join(pages, name), "utf8").matchAll(/^```js\n(.*?)^```/gms)].map(([, code]) => code),
  );
  const files = examples.map((name) => readFileSync(join(folder, name), "utf8"));
  assert.deepEqual(shown.sort(), files.sort());
});

/**
 * What a page of support/ leaves in `result`.
 *
 * @param {string} name
 */
async function resultOfPage(name) {
  const { server, address } = await serve([fileURLToPath(new URL(`support/${name}`, import.meta.url))]);
  const browser = await startBrowser();
  try {
    return await resultOf(browser, address);
  } finally {
    await browser.close();
    server.close();
  }
}

test("in Excalibur pairs, queries and rays are those of brute force in 400 steps in which anything changes", async () => {
  const { differences, takenOver, pairs, found, hits, colliders, ofExcalibur } = await resultOfPage("excalibur-page.js");
  assert.deepEqual(differences, []);
  assert.ok(pairs > 1_000 && found > 500 && hits > 200, `${pairs} pairs, ${found} found, ${hits} hits`);
  assert.equal(takenOver, 5, "colliders that were there before");
  assert.equal(colliders, ofExcalibur, "colliders that are tracked");
});

test("in Phaser overlaps of groups are those of arcade physics in 150 steps in which anything changes", async () => {
  const { differences, steps, hits, gone, late } = await resultOfPage("phaser-page.js");
  assert.deepEqual(differences, []);
  assert.ok(steps === 150 && hits > 30_000, `${hits} hits in ${steps} steps`);
  assert.ok(Math.min(...gone) > 5, "a callback removed too few");
  assert.deepEqual(late, [0, 0], "hits of what a callback removed");
});

test("in cannon pairs are those of its own brute force, with filters, sleeping and static bodies, and bodies that are set elsewhere", async () => {
  /** @type {any} */
  const CANNON = await import(pathToFileURL(join(folder, "node_modules/cannon-es/dist/cannon-es.js")).href);
  await init();
  const next = random(9);
  const somewhere = () => new CANNON.Vec3(8 * next(), 8 * next(), 8 * next());
  const world = new CANNON.World();
  replaceBroadPhase(world);
  const own = new CANNON.NaiveBroadphase();
  own.useBoundingBoxes = true;
  const keysOf = (/** @type {any} */ broadphase) => {
    /** @type {{ index: number }[][]} */
    const [first, second] = [[], []];
    broadphase.collisionPairs(world, first, second);
    return first?.map((a, at) => [a.index, second?.[at]?.index].sort((x, y) => Number(x) - Number(y)).join("-")).sort();
  };
  let found = 0;
  for (let step = 0; step < 100; step++) {
    if (step < 60) {
      const body = new CANNON.Body({ mass: step % 3, shape: new CANNON.Sphere(0.5 + next()), collisionFilterGroup: 1 << step % 2, collisionFilterMask: step % 5 ? 3 : 1 });
      world.addBody(body);
    }
    for (const body of world.bodies) if (next() < 0.5) body.position.copy(somewhere()); // of which cannon takes no note
    if (step % 4 === 0) world.bodies[Math.floor(next() * world.bodies.length)].sleep();
    const pairs = keysOf(world.broadphase);
    for (const body of world.bodies) body.updateAABB();
    assert.deepEqual(pairs, keysOf(own));
    found += pairs?.length ?? 0;
  }
  assert.ok(found > 1_000, `${found} pairs`);
});

test("the boxes of three.js are those of Box3.setFromObject, and picks are those of a Raycaster, for meshes, groups and instances that move", async () => {
  /** @type {any} */
  const THREE = await import(pathToFileURL(join(folder, "node_modules/three/build/three.module.js")).href);
  await init();
  const next = random(3);
  const somewhere = () => [10 * next() - 5, 10 * next() - 5, 10 * next() - 5];
  const geometries = [new THREE.BoxGeometry(1, 2, 0.5), new THREE.SphereGeometry(0.7, 8, 6), new THREE.PlaneGeometry(1, 1)];
  const material = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
  const mesh = () => new THREE.Mesh(geometries[Math.floor(3 * next())], material);
  const scene = new THREE.Scene();
  const empty = new THREE.Group();
  const instances = new THREE.InstancedMesh(geometries[0], material, 3);
  for (let i = 0; i < 3; i++) instances.setMatrixAt(i, new THREE.Matrix4().setPosition(2 * i, i, 0));
  const groups = [0, 1, 2].map(() => new THREE.Group().add(mesh(), new THREE.Group().add(mesh())));
  const objects = [empty, ...Array.from({ length: 60 }, mesh), instances, ...groups];
  scene.add(...objects);

  const world = new BroadPhase({ dimensions: 3, precision: "double" });
  const ids = insertObjects(world, objects);
  world.insert(-9, -9, -9, 9, 9, 9); // no object: it is not picked
  const picks = { hits: 0, misses: 0 };
  for (let step = 0; step < 60; step++) {
    if (step === 30) empty.add(mesh());
    for (const object of objects) {
      object.position.set(...somewhere());
      object.rotation.set(...somewhere());
    }
    scene.updateMatrixWorld();
    moveObjects(world);
    for (const [at, object] of objects.entries()) {
      const { min, max } = new THREE.Box3().setFromObject(object);
      const id = Number(ids[at]);
      assert.equal(world.isEnabled(id), object !== empty || step >= 30);
      if (world.isEnabled(id)) assert.deepEqual(world.box(id), [...min, ...max]);
    }
    for (let i = 0; i < 10; i++) {
      const raycaster = new THREE.Raycaster(new THREE.Vector3(...somewhere()), new THREE.Vector3(...somewhere()).normalize(), 2 * next(), 3 + 9 * next());
      /** @type {any} */
      const hit = pick(world, raycaster);
      assert.equal(hit?.distance, raycaster.intersectObjects(objects)[0]?.distance);
      picks[hit ? "hits" : "misses"]++;
      if (!hit) continue;
      const own = objects.findIndex((object) => object.getObjectById(hit.object.id));
      const others = raycaster.intersectObjects(objects.filter((_, at) => at !== own))[0];
      assert.equal(pick(world, raycaster, (id) => id !== ids[own])?.distance, others?.distance);
    }
  }
  assert.ok(picks.hits > 100 && picks.misses > 100, JSON.stringify(picks));
});

test("TypeScript takes the objects of the engines, as bundlers and as Node resolve", () => {
  const typescript = join(createRequire(import.meta.url).resolve("typescript/package.json"), "..", "bin/tsc");
  const options = ["--ignoreConfig", "--noEmit", "--strict", "--exactOptionalPropertyTypes", "--target", "es2022", "--lib", "es2022,dom,dom.iterable,esnext.disposable", "--types", ""];
  for (const [module, resolution] of [["esnext", "bundler"], ["node16", "node16"]]) {
    // Without the declarations of the engines, which have faults of their own.
    const how = ["--skipLibCheck", "--module", module ?? "", "--moduleResolution", resolution ?? ""];
    execFileSync(process.execPath, [typescript, ...options, ...how, "typed.ts"], { cwd: folder, stdio: "pipe", encoding: "utf8" });
  }
});

test("the picture is what its script draws", () => {
  const drawn = execFileSync(process.execPath, [join(pages, "picture.mjs")], { cwd: pages, encoding: "utf8" });
  assert.equal(drawn, readFileSync(join(pages, "picture.svg"), "utf8"));
});
