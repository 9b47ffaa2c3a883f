// The examples of docs/, with the libraries that they name: each prints what it says, and each page
// shows the file that ran.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { fileURLToPath } from "node:url";
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
  assert.ok(steps === 150 && hits > 20_000, `${hits} hits in ${steps} steps`);
  assert.ok(Math.min(...gone) > 5, "a callback removed too few");
  assert.deepEqual(late, [0, 0], "hits of what a callback removed");
});

test("the picture is what its script draws", () => {
  const drawn = execFileSync(process.execPath, [join(pages, "picture.mjs")], { cwd: pages, encoding: "utf8" });
  assert.equal(drawn, readFileSync(join(pages, "picture.svg"), "utf8"));
});
