export type Task = "find" | "track";

export interface Library {
  readonly name: string;
  readonly package: string;
  readonly dimensions: readonly number[];
  readonly tasks: readonly Task[];
  readonly alternative: boolean;
  readonly how: string;
  readonly module: string;
}

export interface LibraryModule {
  create(setting: { dimensions: number; isMoving: boolean; rows: Float32Array }): Promise<unknown>;
}

export const FINDER: string;
export const WORLD: string;
export const PLAIN: string;
export const libraries: readonly Library[];
