import type { LibraryModule } from "../libraries/index.js";
import type { Scene } from "./scenes.js";

export interface Clock {
  start(): unknown;
  since(start: never): number;
}

export class Trial {
  static start(scene: Scene, dimensions: number, module: LibraryModule, clock: Clock): Promise<Trial>;
  check(): { fingerprint: string; pairs: number; longest: number; varied: number };
  warmUp(): void;
  time(repeats: number, batch?: number): number[];
}
