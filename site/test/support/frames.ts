import { expect, type Page } from "@playwright/test";

/**
 * Waits until the page has been drawn this many times. What a page does by itself it does in frames, so this is how tests
 * let it go on: a fixed time is many frames on one machine and none on another.
 */
export const frames = (page: Page, count: number): Promise<void> =>
  page.evaluate(async (count) => {
    for (let frame = 0; frame < count; frame++) await new Promise(requestAnimationFrame);
  }, count);

/** Waits until what is read stays the same for 30 frames, and returns it: what was on its way has arrived. */
export async function settled<Value>(page: Page, read: () => Promise<Value>, message: string): Promise<Value> {
  let now = await read();
  const isSettled = async (): Promise<boolean> => {
    const before = now;
    await frames(page, 30);
    now = await read();
    return now === before;
  };
  await expect.poll(isSettled, { message }).toBe(true);
  return now;
}
