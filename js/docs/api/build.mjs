// Writes the API reference, static HTML, to js/dist-docs/, or what the options given to this say. Installs TypeDoc first
// if it is not here as package-lock.json names it.
// Fails if something exported has no documentation, or a link leads nowhere.
import { spawnSync } from "node:child_process";
import { statSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const typedoc = join(here, "node_modules/typedoc/bin/typedoc");
// As scripts/setup.sh knows what is installed.
const time = (/** @type {string} */ path) => statSync(join(here, path), { throwIfNoEntry: false })?.mtimeMs ?? 0;
if (time("node_modules/.package-lock.json") < time("package-lock.json")) run("npm", "ci", "--no-audit", "--no-fund", "--loglevel=error");
run(process.execPath, typedoc, "--logLevel", "Warn", ...process.argv.slice(2));

/** @param {string} command @param {string[]} options */
function run(command, ...options) {
  const { status, error } = spawnSync(command, options, { cwd: here, stdio: "inherit" });
  if (error) console.error(`cannot start ${command}: ${error.message}`);
  if (status !== 0) process.exit(status ?? 1);
}
