import type { Begun, Choices, Frame, FromSimulation, Laws, Method, Setup, ToSimulation } from "./messages.ts";

/** What a simulation tells the page. */
export interface Listener {
  ready(choices: Choices): void;
  begun(world: Begun): void;
  /** The positions may be read until the next call of this or `begun`. */
  frame(frame: Frame): void;
  failed(message: string): void;
}

/** A simulation in its own thread. It handles requests in their order. */
export class SimulationClient {
  readonly #worker = new Worker(new URL("./worker.ts", import.meta.url), { type: "module" });
  readonly #listener: Listener;
  #run = 0;
  #methods = 0;
  /** The frame last given to the listener, whose buffer is not yet given back. */
  #shown: Frame | undefined;

  constructor(listener: Listener) {
    this.#listener = listener;
    this.#worker.addEventListener("message", ({ data }: MessageEvent<FromSimulation>) => this.#receive(data));
    this.#worker.addEventListener("error", ({ message }) => listener.failed(message ?? "its script"));
  }

  /** Drops the world there is, if any, and begins another. */
  begin(setup: Setup, laws: Laws, method: Method): void {
    this.#shown = undefined;
    this.#send({ type: "begin", run: ++this.#run, setup, laws, method });
  }

  /** Goes on with the same world under other laws. */
  setLaws(laws: Laws): void {
    this.#send({ type: "laws", laws });
  }

  /** Goes on with the same world by another algorithm. */
  setMethod(method: Method): void {
    this.#methods++;
    this.#send({ type: "method", method });
  }

  /** Whether what a frame has measured belongs to the world that began last and the method that was set last. */
  isCurrent(frame: Frame): boolean {
    return frame.run === this.#run && frame.methods === this.#methods;
  }

  setRunning(running: boolean): void {
    this.#send({ type: "pace", running });
  }

  step(): void {
    this.#send({ type: "step" });
  }

  /** Whether frames carry the pairs. */
  listPairs(on: boolean): void {
    this.#send({ type: "list-pairs", on });
  }

  close(): void {
    this.#worker.terminate();
  }

  #receive(message: FromSimulation): void {
    switch (message.type) {
      case "ready":
        this.#listener.ready(message.choices);
        break;
      case "begun":
        if (message.run === this.#run) this.#listener.begun(message);
        break;
      case "frame":
        if (message.run !== this.#run) break;
        this.#recycle();
        this.#shown = message;
        this.#listener.frame(message);
        break;
      case "failed":
        this.#listener.failed(message.message);
        break;
    }
  }

  #recycle(): void {
    if (!this.#shown) return;
    const { run, positions } = this.#shown;
    this.#shown = undefined;
    this.#send({ type: "recycle", run, positions }, [positions.buffer]);
  }

  #send(message: ToSimulation, transfer: Transferable[] = []): void {
    this.#worker.postMessage(message, transfer);
  }
}
