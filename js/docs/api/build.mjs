// Writes the API reference, static HTML, to js/dist-docs/, or what the options given to this say. Installs TypeDoc first if it is not here.
// Fails if something exported has no documentation, or a link leads nowhere.
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const here = fileURLToPath(new URL(".", import.meta.url));
const typedoc = join(here, "node_modules/typedoc/bin/typedoc");
if (!existsSync(typedoc)) run("npm", "ci", "--no-audit", "--no-fund", "--loglevel=error");
run(process.execPath, typedoc, "--logLevel", "Warn", ...process.argv.slice(2));

/** @param {string} command @param {string[]} options */
function run(command, ...options) {
  const { status, error } = spawnSync(command, options, { cwd: here, stdio: "inherit" });
  if (error) console.error(`cannot start ${command}: ${error.message}`);
  if (status !== 0) process.exit(status ?? 1);
}
