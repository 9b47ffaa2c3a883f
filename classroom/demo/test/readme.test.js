// The README's examples print what they say.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";

const readme = readFileSync(new URL("../README.md", import.meta.url), "utf8");
const examples = [...readme.matchAll(/^```js\n(.*?)^```/gms)].map(([, code]) => code ?? "");

test("there is an example", () => assert.ok(examples.length >= 1));

for (const [index, example] of examples.entries()) {
  test(`example ${index + 1} prints what it says`, () => {
    const expected = [...example.matchAll(/console\.log\(.*\);\s*\/\/ (.*)/g)].flatMap(([, said]) => said?.split(" | "));
    assert.ok(expected.length > 0);
    const options = { cwd: new URL("..", import.meta.url), encoding: /** @type {const} */ ("utf8") };
    assert.deepEqual(execFileSync(process.execPath, ["--input-type=module", "--eval", example], options).trim().split("\n"), expected);
  });
}
