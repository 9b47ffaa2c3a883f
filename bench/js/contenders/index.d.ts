export type Task = "find" | "follow";

export interface Contender {
  readonly name: string;
  readonly package: string;
  readonly dimensions: readonly number[];
  readonly tasks: readonly Task[];
  readonly rival: boolean;
  readonly how: string;
  readonly module: string;
}

export interface ContenderModule {
  create(setting: { dimensions: number; isMoving: boolean; rows: Float32Array }): Promise<unknown>;
}

export const OURS: string;
export const WORLD: string;
export const PLAIN: string;
export const contenders: readonly Contender[];
