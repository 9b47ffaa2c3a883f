// Endpoints through time: what the figure draws is what an independent count says.
import { expect, test } from "@playwright/test";
import { history, WORLDS } from "../src/article/space-time.ts";

test("each crossing is one swap of its kind: overlaps begun less those ended are those that there are, in every frame of every world", () => {
  for (const [name, world] of Object.entries(WORLDS)) {
    const { orders, crossings, boxes } = history(world);
    const overlapping = (frame: number): number => {
      const all = boxes[frame]!;
      return all.reduce((sum, a, at) => sum + all.slice(at + 1).filter((b) => a.left <= b.right && b.left <= a.right).length, 0);
    };
    let [begun, ended] = [0, 0];
    const atFirst = overlapping(0);
    for (let frame = 1; frame < boxes.length; frame++) {
      const now = crossings.filter((crossing) => crossing.frame === frame);
      begun += now.filter(({ kind }) => kind === "begins").length;
      ended += now.filter(({ kind }) => kind === "ends").length;
      expect(atFirst + begun - ended, `${name}, frame ${frame}`).toBe(overlapping(frame));
      // As many swaps as there are pairs of endpoints whose order has changed.
      const [before, after] = [orders[frame - 1]!.split(" "), orders[frame]!.split(" ")];
      const inversions = before.reduce((sum, p, at) => sum + before.slice(at + 1).filter((q) => after.indexOf(p) > after.indexOf(q)).length, 0);
      expect(now.length, `${name}, frame ${frame}`).toBe(inversions);
    }
  }
  const jump = history(WORLDS["A jumps"]!).crossings;
  const most = Math.max(...jump.map(({ frame }) => jump.filter((crossing) => crossing.frame === frame).length));
  expect(most, "a jump past three boxes: their six endpoints, each passed by two").toBe(12);
});

test("a moment is chosen by hand and by keys, and a world by name", async ({ page }) => {
  await page.goto("/#space-time");
  const figure = page.locator("space-time");
  const [time, said] = [figure.getByRole("slider", { name: "Time" }), figure.locator("[data-part=said]")];
  await time.fill("0");
  await expect(said).toContainText("(A A) (B B) (C C) (D D): 0 swaps so far");
  await time.press("End");
  const { orders, crossings } = history(WORLDS["A moves through the others"]!);
  await expect(said).toContainText(`${orders.at(-1)}: ${crossings.length} swaps so far`);
  await expect(figure.locator("circle")).toHaveCount(crossings.length);
  await figure.getByLabel("World").selectOption("A jumps");
  await expect(figure.locator("circle")).toHaveCount(history(WORLDS["A jumps"]!).crossings.length);
});
