import type { Exports } from "../wasm/engine.js";
import { Core } from "../wasm/init.js";
import type { FilterWords } from "./filter.js";

/** What js/wasm/src/broad_phase/ exports. The small files, for events only, have no queries, lists of pairs and snapshots. */
export interface WorldExports extends Exports {
  world_new(dimensions: number, double: number, margin: number, prediction: number, fat: number): number;
  world_free(world: number): void;
  world_numbers(world: number): number;
  world_rows(world: number, count: number): number;
  world_ids_in(world: number, count: number): number;
  world_bytes(world: number, count: number): number;
  world_insert(world: number): number;
  world_insert_many(world: number, count: number, ...filter: FilterWords): number;
  world_set(world: number, id: number, teleports: number): number;
  world_shift(world: number): number;
  world_set_many(world: number, count: number): number;
  world_set_swept(world: number, id: number): number;
  world_set_filter(world: number, id: number, ...filter: FilterWords): number;
  world_set_enabled(world: number, id: number, enabled: number): number;
  world_filter(world: number, id: number): number;
  world_box(world: number, id: number, reported: number): number;
  world_contains(world: number, id: number): number;
  world_remove_many(world: number, count: number): number;
  world_update(world: number, failures: number): number;
  world_exclude(world: number, a: number, b: number, excluded: number): number;
  world_pairs(world: number, sorted: number): number;
  world_pairs_of(world: number, id: number): number;
  world_ids(world: number): number;
  world_len(world: number): number;
  world_query(world: number, query: Query, k: number, ...others: [...FilterWords, sorted: number, excluded: number, many: number]): number;
  world_snapshot(world: number): number;
  world_restore(world: number): number;
  world_state_hash(world: number): number;
}

/** Which query; bindings/src/queries.rs has the same list. */
export const enum Query {
  Overlapping = 0,
  Containing = 1,
  Within = 2,
  Cast = 3,
  CastAll = 4,
  Nearest = 5,
  CastEntering = 6,
  CastAllEntering = 7,
}

/** The core of the persistent broad phase. */
export const worldCore: Core<WorldExports> = new Core("world_query", "sweep-and-prune/broad-phase");
