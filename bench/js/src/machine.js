// What the times depend on.
import { execFileSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { availableParallelism, cpus, loadavg, release, totalmem } from "node:os";

/** The machine, in the fields that bench/README.md names. */
export function describe() {
  return {
    cpu: processor(),
    cores: availableParallelism(),
    vectors: [],
    memory_bytes: totalmem(),
    system: `${process.platform} ${release()}`,
    tsc_mhz: null,
    copy_bytes_per_second: 0,
    load: load(),
  };
}

/** The load average: above 0.5 others were at work. */
export function load() {
  return loadavg()[0] ?? null;
}

function processor() {
  const name = cpus()[0]?.model.trim() || process.arch;
  try {
    const field = (/** @type {string} */ field) =>
      readFileSync("/proc/cpuinfo", "utf8").match(new RegExp(`^${field}\\s*: (.*)$`, "m"))?.[1];
    return `${name} (family ${field("cpu family")} model ${field("model")})`;
  } catch {
    return name;
  }
}

/** The commit that is checked out, marked if files differ from it; null outside of Git. */
export function revision() {
  try {
    const cwd = new URL(".", import.meta.url);
    return execFileSync("git", ["describe", "--always", "--dirty"], { cwd, encoding: "utf8", stdio: "pipe" }).trim();
  } catch {
    return null;
  }
}
