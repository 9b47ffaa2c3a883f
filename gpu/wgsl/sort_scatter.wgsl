// Last step of a pass of the radix sort: moves each key, and the value beside it, to its place. Keys with equal digits
// keep their order.

struct Params {
  count: u32,
  tiles: u32,
  // The lowest bit of the digit.
  shift: u32,
}

// As in sort_count.wgsl.
const ITEMS = 16u;
const TILE = THREADS * ITEMS;
// Counts of two digits share a word: a tile has fewer than 2^16 keys.
const WORDS = 8u;

@group(0) @binding(0) var<uniform> params: Params;
// Where each tile writes the first of its keys with each digit: digit by digit.
@group(0) @binding(1) var<storage, read> table: array<u32>;
@group(0) @binding(2) var<storage, read> keys: array<u32>;
@group(0) @binding(3) var<storage, read_write> sorted_keys: array<u32>;
@group(0) @binding(4) var<storage, read> values: array<u32>;
@group(0) @binding(5) var<storage, read_write> sorted_values: array<u32>;

var<workgroup> counts: array<array<u32, WORDS>, THREADS>;

// The keys of a thread. Each thread has neighboring keys, so that the order of the threads is the order of the keys.
struct Range {
  begin: u32,
  end: u32,
}

fn range_of(tile: u32, thread: u32) -> Range {
  let begin = tile * TILE + thread * ITEMS;
  return Range(begin, min(begin + ITEMS, params.count));
}

fn digit_of(key: u32) -> u32 {
  return (key >> params.shift) & 15u;
}

// How many keys of the tile with each digit come before those of a thread.
fn counts_before(range: Range, thread: u32) -> array<u32, WORDS> {
  var own: array<u32, WORDS>;
  for (var i = range.begin; i < range.end; i++) {
    let digit = digit_of(keys[i]);
    own[digit / 2u] += 1u << (16u * (digit % 2u));
  }
  // The sums over this thread and all before it (Hillis and Steele).
  var sums = own;
  for (var distance = 1u; distance < THREADS; distance *= 2u) {
    counts[thread] = sums;
    workgroupBarrier();
    if (thread >= distance) {
      for (var word = 0u; word < WORDS; word++) {
        sums[word] += counts[thread - distance][word];
      }
    }
    workgroupBarrier();
  }
  for (var word = 0u; word < WORDS; word++) {
    sums[word] -= own[word];
  }
  return sums;
}

// The place of the next key of a thread; counts the key.
fn take_place(sums: ptr<function, array<u32, WORDS>>, tile: u32, key: u32) -> u32 {
  let digit = digit_of(key);
  let half = 16u * (digit % 2u);
  let before = ((*sums)[digit / 2u] >> half) & 0xffffu;
  (*sums)[digit / 2u] += 1u << half;
  return table[digit * params.tiles + tile] + before;
}

@compute @workgroup_size(THREADS)
fn scatter_keys(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let tile = group_number(group, groups);
  if (tile >= params.tiles) {
    return;
  }
  let range = range_of(tile, thread);
  var sums = counts_before(range, thread);
  for (var i = range.begin; i < range.end; i++) {
    let key = keys[i];
    sorted_keys[take_place(&sums, tile, key)] = key;
  }
}

@compute @workgroup_size(THREADS)
fn scatter_values(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let tile = group_number(group, groups);
  if (tile >= params.tiles) {
    return;
  }
  let range = range_of(tile, thread);
  var sums = counts_before(range, thread);
  for (var i = range.begin; i < range.end; i++) {
    let key = keys[i];
    let place = take_place(&sums, tile, key);
    sorted_keys[place] = key;
    sorted_values[place] = values[i];
  }
}
