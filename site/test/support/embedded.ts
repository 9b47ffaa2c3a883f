// `<sap-demo>`, one at a time on embed.html, as a visitor handles it.
import { expect, type Locator, type Page, test } from "@playwright/test";
import type { DemoEvent, DemoState, SapDemo } from "sweep-and-prune-classroom/demo";
import { complaints } from "./pages.ts";

export type Attributes = Record<string, string>;

/** Fails every test of a file in which the browser complains. */
export function complainOfNothing(): void {
  let heard: string[];
  test.beforeEach(({ page }) => {
    heard = complaints(page);
  });
  test.afterEach(() => expect(heard).toEqual([]));
}

/** Opens a demo of these attributes, and waits until it is there. */
export async function open(page: Page, attributes: Attributes): Promise<Locator> {
  await page.goto(`/embed.html#${new URLSearchParams(attributes)}`);
  const demo = page.locator("sap-demo");
  await demo.evaluate((element: SapDemo) => element.ready);
  return demo;
}

export const stateOf = (demo: Locator): Promise<DemoState> => demo.evaluate((element: SapDemo) => element.state);
export const step = (demo: Locator): Promise<void> => demo.evaluate((element: SapDemo) => element.step());
export const counter = (demo: Locator, name: string): Promise<string | null> => demo.locator(`[data-counter="${name}"]`).textContent();

/** Steps through one detection to its end; the events that were reported. */
export function walk(demo: Locator): Promise<DemoEvent[]> {
  return demo.evaluate((element: SapDemo) => {
    const reported: DemoEvent[] = [];
    const hear = (event: CustomEvent<DemoEvent>): unknown => reported.push(event.detail);
    element.addEventListener("sap-event", hear);
    const { tick } = element.state;
    let last = -1;
    while (element.state.tick === tick && element.state.events !== last) {
      last = element.state.events;
      element.step();
    }
    if (element.state.tick !== tick) element.back();
    element.removeEventListener("sap-event", hear as EventListener);
    return reported;
  });
}

/** Every pair of the balls, highlighted one after another. */
export const pairwise = { strategy: "pairwise", "skip-interval": "4", decorations: "checks:#4c8", paused: "" };
