import { expect, type Locator, type Page } from "@playwright/test";

/** The falling discs of the article, as their visitor handles them. */
export class FallingBalls {
  readonly root: Locator;
  readonly algorithm: Locator;
  readonly play: Locator;
  readonly status: Locator;

  constructor(page: Page, id: "few" = "few") {
    this.root = page.locator(`#${id}`);
    this.algorithm = this.root.getByLabel("Algorithm");
    this.play = this.root.locator('[data-part="play"]');
    this.status = this.root.getByRole("status");
  }

  /** Comes near enough for it to start, and waits until it has. */
  async open(): Promise<this> {
    await this.root.scrollIntoViewIfNeeded();
    await expect(this.root).toHaveAttribute("data-step", /^\d+$/);
    return this;
  }

  async algorithms(): Promise<string[]> {
    return this.algorithm.locator("option").allTextContents();
  }

  async pause(): Promise<void> {
    if ((await this.play.textContent()) === "Pause") await this.play.click();
    await expect(this.status).toContainText("Paused");
  }

  /** Makes `count` single steps and waits for each. Only while paused. */
  async step(count: number): Promise<void> {
    for (let done = 0; done < count; done++) {
      const before = await this.stepNumber();
      await this.root.getByRole("button", { name: "Step" }).click();
      await expect(this.root).toHaveAttribute("data-step", String(before + 1));
    }
  }

  async reset(): Promise<void> {
    await this.root.getByRole("button", { name: "Reset" }).click();
    await expect(this.root).toHaveAttribute("data-step", "0");
  }

  async stepNumber(): Promise<number> {
    return Number(await this.root.getAttribute("data-step"));
  }

  /** The hash of all positions and velocities. */
  async hash(): Promise<string> {
    return (await this.root.getAttribute("data-hash")) ?? "";
  }

  /** The text of a counter. */
  async counter(key: string): Promise<string> {
    return (await this.root.locator(`[data-counter="${key}"] dd`).textContent()) ?? "";
  }

  /** A counter as a number, NaN if it is not counted. */
  async value(key: string): Promise<number> {
    return Number.parseFloat((await this.counter(key)).replaceAll(",", ""));
  }
}
