// A library in a process of its own: asked, and stopped when it takes too long.
import { spawn } from "node:child_process";
import { createInterface } from "node:readline";

/** Marks the lines of the protocol. */
export const MARK = "@reply ";

/** What happened instead of an answer. */
export class NoAnswer extends Error {}

export class Remote {
  #child;
  /** @type {string[]} */
  #lines = [];
  /** @type {((line: string | undefined) => void) | undefined} */
  #waiting;
  #isOver = false;
  #errors = "";

  /**
   * @param {string} command
   * @param {readonly string[]} args
   * @param {Record<string, string>} env
   */
  constructor(command, args, env = {}) {
    this.#child = spawn(command, args, { stdio: ["pipe", "pipe", "pipe"], env: { ...process.env, ...env } });
    this.#child.stdin.on("error", () => {}); // it ended: the next question says so
    this.#child.stderr.on("data", (text) => (this.#errors = (this.#errors + text).slice(-2000)));
    const lines = createInterface({ input: this.#child.stdout });
    lines.on("line", (line) => {
      if (line.startsWith(MARK)) this.#push(line.slice(MARK.length));
      else if (line.startsWith("{")) this.#push(line);
    });
    this.#child.on("close", () => {
      this.#isOver = true;
      this.#waiting?.(undefined);
    });
  }

  #push(/** @type {string} */ line) {
    if (this.#waiting) this.#waiting(line);
    else this.#lines.push(line);
  }

  /**
   * The next answer. A process that does not answer in time is stopped.
   *
   * @param {string} request empty to wait for what comes by itself
   * @param {number} limit milliseconds
   * @returns {Promise<any>}
   */
  async ask(request, limit) {
    if (request !== "") this.#child.stdin.write(`${request}\n`);
    const line = this.#lines.shift() ?? (await this.#next(limit));
    const reply = JSON.parse(line);
    if (reply.failed) throw new NoAnswer(reply.failed);
    return reply;
  }

  /** @returns {Promise<string>} */
  #next(/** @type {number} */ limit) {
    return new Promise((resolve, reject) => {
      const end = (/** @type {string | undefined} */ line) => {
        clearTimeout(timer);
        this.#waiting = undefined;
        if (line !== undefined) resolve(line);
        else reject(new NoAnswer(this.#errors.trim().split("\n").at(-1) || "it ended without an answer"));
      };
      const timer = setTimeout(() => {
        this.#waiting = undefined;
        this.stop();
        reject(new NoAnswer(`over ${limit / 1000} s`));
      }, limit);
      this.#waiting = end;
      if (this.#isOver) end(undefined);
    });
  }

  /** Ends the process. */
  stop() {
    this.#child.kill("SIGKILL");
  }
}
