// Documentation of the library in each language, made by that language's own tool, into public/api,
// from where the site's build takes it. Not part of the quick build:
//
//   npm run api -w site && npm run build -w site

import { spawnSync } from "node:child_process";
import { cpSync, rmSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const root = resolve(dirname(fileURLToPath(import.meta.url)), "../..");
const output = join(root, "site/public/api");
// A folder of its own: the usual one may hold the documentation of every crate there is.
const target = join(resolve(root, process.env.CARGO_TARGET_DIR ?? "target"), "api");

function run(command, args, options = {}) {
  const { status } = spawnSync(command, args, { cwd: root, stdio: "inherit", ...options });
  if (status !== 0) process.exit(status ?? 1); // it has said why
}

function take(from, name) {
  rmSync(join(output, name), { recursive: true, force: true });
  cpSync(from, join(output, name), { recursive: true });
  console.log(`public/api/${name}`);
}

run("cargo", ["doc", "--quiet", "--no-deps", "--package", "sweep-and-prune", "--target-dir", target]);
take(join(target, "doc"), "rust");

run("npm", ["run", "--silent", "docs", "--workspace", "js"]);
take(join(root, "js/dist-docs"), "js");
