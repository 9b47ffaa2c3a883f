import { radiusOf } from "../balls/setup.ts";
import { LARGEST_SEED } from "../panel/parts.ts";
import type { Laws, Method, Setup } from "./messages.ts";

/** Everything that a visitor can choose for falling balls; the address keeps it. */
export interface Settings extends Method, Laws {
  readonly bodies: number;
  /** Per cent of the radius at which the bodies fill a fixed share of the box. */
  readonly size: number;
  /** The greatest radius over the least. */
  readonly spread: number;
  readonly seed: number;
}

/** The numbers that the sliders offer. */
export const RANGES = {
  bodies: [1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500, 700, 1000, 1500, 2000, 3000, 5000, 7000, 10000],
  size: [40, 50, 60, 70, 80, 90, 100, 110, 120, 130, 140],
  spread: [1, 1.5, 2, 3, 4, 5, 6, 8, 10, 15, 20],
  gravity: [-9.81, 0, 1.62, 3.7, 9.81, 20, 50],
  substeps: [1, 2, 3, 4, 6, 8, 12, 16],
} as const;

/** The world of these settings. */
export function setupOf({ bodies, size, spread, seed }: Settings): Setup {
  return { bodies, radius: (radiusOf(bodies, 2) * size) / 100, spread, seed };
}

/** Reads `prefix.bodies=500&prefix.seed=3..` from the page's address; `defaults` where it says nothing sensible. */
export function readSettings(prefix: string, defaults: Settings, mostBodies: number): Settings {
  const query = new URLSearchParams(location.search);
  const text = (key: keyof Method): string => query.get(`${prefix}.${key}`) ?? defaults[key];
  const number = (key: "bodies" | "size" | "spread" | "seed" | keyof Laws, least: number, most: number): number => {
    const given = Number.parseFloat(query.get(`${prefix}.${key}`) ?? "");
    return given >= least && given <= most ? given : defaults[key];
  };
  return {
    algorithm: text("algorithm"),
    sort: text("sort"),
    axis: text("axis"),
    bodies: Math.round(number("bodies", 1, mostBodies)),
    size: number("size", 10, 200),
    spread: number("spread", 1, 20),
    seed: Math.round(number("seed", 0, LARGEST_SEED)),
    gravity: number("gravity", -100, 100),
    substeps: Math.round(number("substeps", 1, 32)),
  };
}

/** Writes into the page's address what differs from the defaults. */
export function writeSettings(prefix: string, settings: Settings, defaults: Settings): void {
  const url = new URL(location.href);
  for (const key of Object.keys(defaults) as (keyof Settings)[]) {
    if (settings[key] === defaults[key]) url.searchParams.delete(`${prefix}.${key}`);
    else url.searchParams.set(`${prefix}.${key}`, String(settings[key]));
  }
  history.replaceState(history.state, "", url);
}
