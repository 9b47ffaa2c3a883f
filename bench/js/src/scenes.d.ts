import type { Task } from "../libraries/index.js";

export interface Listed {
  readonly name: string;
  readonly task: Task;
  readonly dimensions: readonly number[];
  readonly description: string;
}

export interface Scene {
  readonly isMoving: boolean;
  readonly frames: number;
  readonly varied: number;
  readonly first: Float32Array;
  next(): Float32Array;
}

export class Scenes {
  static start(wasm: WebAssembly.Module | BufferSource): Promise<Scenes>;
  table(): Listed[];
  open(name: string, dimensions: number, boxes: number): Scene;
}
