// A place for a reader's code: a worker in a frame without document, storage and network. What does not answer in time is ended
// from outside.

import script from "virtual:sandbox-worker";
import type { ProgramEvent } from "sweep-and-prune-classroom/demo";
import type { Verdict } from "./checks.ts";
import type { Fault } from "./compile.ts";
import type { Answer, Question } from "./worker.ts";

/** The frame is of an origin of its own, and loads nothing: its worker inherits both. A message without text ends the worker. */
const FRAME = `<!doctype html><meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline' 'unsafe-eval' blob:; worker-src blob:">
<script>
let worker;
onmessage = ({ data, ports, source }) => {
  if (source !== parent) return;
  worker?.terminate();
  if (!data) return;
  worker = new Worker(URL.createObjectURL(new Blob([data], { type: "text/javascript" })));
  worker.postMessage(0, ports);
};
</script>`;

/** Code that takes longer is ended. Time counts while this page gets its turn: a busy machine is slow. */
const TICK_MS = 100;
const MOST_TICKS = 20;

/** The code is wrong, or has been ended. */
export class CodeError extends Error {
  constructor(readonly fault: Fault) {
    super(fault.message);
  }
}

const ended = (): CodeError =>
  new CodeError({ message: `Ended after ${(TICK_MS * MOST_TICKS) / 1000} seconds: does a loop never end?`, line: undefined, isSyntax: false });

export class Sandbox {
  readonly #frame: HTMLIFrameElement = document.createElement("iframe");
  readonly #loaded: Promise<void>;
  /** The way to the worker, once there is one. */
  #port: Promise<MessagePort> | undefined;
  /** Questions are answered one after the other. */
  #last: Promise<unknown> = Promise.resolve();

  constructor() {
    this.#frame.sandbox.add("allow-scripts");
    this.#frame.hidden = true;
    this.#frame.title = "Runs the code that you write";
    this.#frame.srcdoc = FRAME;
    this.#loaded = new Promise((resolve) => this.#frame.addEventListener("load", () => resolve(), { once: true }));
    document.body.append(this.#frame);
  }

  ask(question: Question & { kind: "run" }): Promise<readonly ProgramEvent[]>;
  ask(question: Question & { kind: "check" }): Promise<Verdict>;
  ask(question: Question): Promise<readonly ProgramEvent[] | Verdict> {
    const answer = this.#last.then(() => this.#ask(question));
    this.#last = answer.catch(() => undefined);
    return answer;
  }

  async #ask(question: Question): Promise<readonly ProgramEvent[] | Verdict> {
    const port = await (this.#port ??= this.#begin());
    return new Promise((resolve, reject) => {
      let ticks = 0;
      const timer = setInterval(() => {
        if (++ticks < MOST_TICKS) return;
        clearInterval(timer);
        this.#end();
        reject(ended());
      }, TICK_MS);
      port.onmessage = ({ data }: MessageEvent<Answer>) => {
        clearInterval(timer);
        if ("fault" in data) reject(new CodeError(data.fault));
        else resolve(data.value);
      };
      port.postMessage(question);
    });
  }

  async #begin(): Promise<MessagePort> {
    await this.#loaded;
    const { port1, port2 } = new MessageChannel();
    const ready = new Promise((resolve) => (port1.onmessage = resolve));
    // The frame has no origin that could be named.
    this.#frame.contentWindow?.postMessage(script, "*", [port2]);
    await ready;
    return port1;
  }

  #end(): void {
    this.#port = undefined;
    this.#frame.contentWindow?.postMessage("", "*");
  }
}
