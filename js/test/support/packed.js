// The package as users install it: packed, and unpacked into a project's node_modules.
import { execFileSync } from "node:child_process";
import { mkdirSync, rmSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

/**
 * Installs the packed package into a project, and returns where.
 *
 * @param {string} project
 */
export function installInto(project) {
  const packed = execFileSync("npm", ["pack", "--ignore-scripts", "--silent", "--pack-destination", project], {
    cwd: fileURLToPath(new URL("../..", import.meta.url)),
    encoding: "utf8",
  });
  const installed = join(project, "node_modules/sweep-and-prune");
  mkdirSync(installed, { recursive: true });
  execFileSync("tar", ["-xzf", join(project, packed.trim()), "-C", installed, "--strip-components=1"]);
  rmSync(join(project, packed.trim()));
  return installed;
}
