// First step of a pass of the radix sort: counts the digits of each tile.

struct Params {
  count: u32,
  tiles: u32,
  // The lowest bit of the digit.
  shift: u32,
}

const ITEMS = 16u;
const TILE = THREADS * ITEMS;
const DIGITS = 16u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> keys: array<u32>;
// Digit by digit, and tile by tile for each digit: summed up, it says where each tile writes its keys.
@group(0) @binding(2) var<storage, read_write> table: array<u32>;

var<workgroup> counts: array<atomic<u32>, DIGITS>;

@compute @workgroup_size(THREADS)
fn count_digits(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let tile = group_number(group, groups);
  if (tile >= params.tiles) {
    return;
  }
  let end = min((tile + 1u) * TILE, params.count);
  for (var i = tile * TILE + thread; i < end; i += THREADS) {
    atomicAdd(&counts[(keys[i] >> params.shift) & (DIGITS - 1u)], 1u);
  }
  workgroupBarrier();
  if (thread < DIGITS) {
    table[thread * params.tiles + tile] = atomicLoad(&counts[thread]);
  }
}
