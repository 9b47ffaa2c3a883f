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
// One thread sums up the counts that a part of the threads has of one word.
const PART = WORDS;
const PARTS = THREADS / PART;

@group(0) @binding(0) var<uniform> params: Params;
// Where each tile writes the first of its keys with each digit: digit by digit.
@group(0) @binding(1) var<storage, read> table: array<u32>;
@group(0) @binding(2) var<storage, read> keys: array<u32>;
@group(0) @binding(3) var<storage, read_write> sorted_keys: array<u32>;
@group(0) @binding(4) var<storage, read> values: array<u32>;
@group(0) @binding(5) var<storage, read_write> sorted_values: array<u32>;

// Word by word, and thread by thread for each word. A thread finds its counts by digit, so registers cannot hold them.
var<workgroup> counts: array<u32, WORDS * THREADS>;
// Word by word, and part by part for each word.
var<workgroup> part_sums: array<u32, WORDS * PARTS>;

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

// Where a thread counts a digit, and the bit at which the count begins.
fn word_of(digit: u32, thread: u32) -> u32 {
  return digit / 2u * THREADS + thread;
}

fn bit_of(digit: u32) -> u32 {
  return 16u * (digit % 2u);
}

// Lets `counts` say how many keys of the tile with each digit come before those of each thread.
fn count_before(range: Range, thread: u32) {
  for (var i = range.begin; i < range.end; i++) {
    let digit = digit_of(keys[i]);
    counts[word_of(digit, thread)] += 1u << bit_of(digit);
  }
  workgroupBarrier();
  // From here on a thread has a part of the counts of one word.
  let begin = thread * PART;
  var sum = 0u;
  for (var i = begin; i < begin + PART; i++) {
    sum += counts[i];
  }
  part_sums[thread] = sum;
  workgroupBarrier();
  var before = 0u;
  for (var part = thread - thread % PARTS; part < thread; part++) {
    before += part_sums[part];
  }
  for (var i = begin; i < begin + PART; i++) {
    let count = counts[i];
    counts[i] = before;
    before += count;
  }
  workgroupBarrier();
}

// The place of the next key of a thread; counts the key.
fn take_place(tile: u32, thread: u32, key: u32) -> u32 {
  let digit = digit_of(key);
  let word = word_of(digit, thread);
  let before = (counts[word] >> bit_of(digit)) & 0xffffu;
  counts[word] += 1u << bit_of(digit);
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
  count_before(range, thread);
  for (var i = range.begin; i < range.end; i++) {
    let key = keys[i];
    sorted_keys[take_place(tile, thread, key)] = key;
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
  count_before(range, thread);
  for (var i = range.begin; i < range.end; i++) {
    let key = keys[i];
    let place = take_place(tile, thread, key);
    sorted_keys[place] = key;
    sorted_values[place] = values[i];
  }
}
