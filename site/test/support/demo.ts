import { expect, type Locator, type Page } from "@playwright/test";

/** What a demo says of itself. */
export interface State {
  tick: number;
  events: number;
  tests: number;
  flagChecks: number;
  axisOverlaps: number;
  pairs: number;
  comparisons: number;
  swaps: number;
  hash: string;
}

type Element = HTMLElement & { state: State; settled: Promise<void>; balls: number[][]; isPlaying: boolean; pause(): void; play(): void; step(): void; back(): void; reset(): void };

/** One demo of the article, by the id of its figure. */
export class Demo {
  readonly root: Locator;

  constructor(readonly page: Page, readonly id: string, at = 0) {
    this.root = page.locator(`#${id} sap-demo`).nth(at);
  }

  /** Comes near enough for it to start, and waits until it has. */
  async open(): Promise<this> {
    await this.root.scrollIntoViewIfNeeded();
    await expect.poll(async () => (await this.balls()).length, { message: `${this.id} has balls` }).toBeGreaterThan(0);
    return this;
  }

  state(): Promise<State> {
    return this.root.evaluate((demo) => (demo as unknown as Element).state);
  }

  balls(): Promise<number[][]> {
    return this.root.evaluate((demo) => (demo as unknown as Element).balls ?? []);
  }

  pause(): Promise<void> {
    return this.root.evaluate((demo) => (demo as unknown as Element).pause());
  }

  reset(): Promise<void> {
    return this.root.evaluate((demo) => {
      (demo as unknown as Element).reset();
      (demo as unknown as Element).pause();
    });
  }

  play(): Promise<void> {
    return this.root.evaluate((demo) => (demo as unknown as Element).play());
  }

  /** The kinds of events that it reports within `count` steps. */
  async step(count: number): Promise<string[]> {
    return this.root.evaluate((demo, count) => {
      const kinds: string[] = [];
      const hear = (event: Event): void => void kinds.push((event as CustomEvent<{ kind: string }>).detail.kind);
      demo.addEventListener("sap-event", hear);
      for (let done = 0; done < count; done++) (demo as unknown as Element).step();
      demo.removeEventListener("sap-event", hear);
      return kinds;
    }, count);
  }

  /** Steps until a detection is done: what it counted, and where the balls were. */
  async finish(): Promise<State & { balls: number[][] }> {
    return this.root.evaluate(async (element) => {
      const demo = element as unknown as Element;
      // The next step after the last of a detection begins another: its counters start at zero.
      let last = { ...demo.state, balls: demo.balls };
      for (let steps = 0; steps < 2000; steps++) {
        demo.step();
        await demo.settled;
        if (demo.state.tick !== last.tick || demo.state.events < last.events) return last;
        last = { ...demo.state, balls: demo.balls };
      }
      return last;
    });
  }

  /** Presses a ball and moves it by `dx` and `dy` units of the world. */
  async drag(ball: number, dx: number, dy = 0): Promise<void> {
    const [x = 0, y = 0] = (await this.balls())[ball] ?? [];
    const box = await this.root.locator("canvas").first().boundingBox();
    if (!box) throw new Error(`${this.id} has no picture`);
    const scale = box.width / 600;
    const [fromX, fromY] = [box.x + x * scale, box.y + y * scale];
    await this.page.mouse.move(fromX, fromY);
    await this.page.mouse.down();
    await this.page.mouse.move(fromX + dx * scale * 0.5, fromY + dy * scale * 0.5, { steps: 4 });
    await this.page.mouse.move(fromX + dx * scale, fromY + dy * scale, { steps: 4 });
    await this.page.mouse.up();
  }
}
