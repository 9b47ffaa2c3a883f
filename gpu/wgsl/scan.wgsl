// Replaces each number of a block by the sum of those before it in the block, and writes the sum of the block. Sums that
// exceed a u32 stay at its maximum, so that an overflow is seen.

struct Params {
  count: u32,
  blocks: u32,
}

const ITEMS = 16u;
// One thread sums up the sums of a part of the threads.
const PART = 8u;
const PARTS = THREADS / PART;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> numbers: array<u32>;
@group(0) @binding(2) var<storage, read_write> block_sums: array<u32>;

var<workgroup> sums: array<u32, THREADS>;
var<workgroup> part_sums: array<u32, PARTS>;

@compute @workgroup_size(THREADS)
fn scan(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let block = group_number(group, groups);
  if (block >= params.blocks) {
    return;
  }
  let begin = (block * THREADS + thread) * ITEMS;
  let end = min(begin + ITEMS, params.count);
  var sum = 0u;
  for (var i = begin; i < end; i++) {
    sum = add(sum, numbers[i]);
  }
  sums[thread] = sum;
  workgroupBarrier();
  if (thread < PARTS) {
    var part_sum = 0u;
    for (var i = thread * PART; i < (thread + 1u) * PART; i++) {
      part_sum = add(part_sum, sums[i]);
    }
    part_sums[thread] = part_sum;
  }
  workgroupBarrier();
  // The sum of the parts before this thread's, and of the threads before it in its part.
  let own_part = thread / PART;
  var before = 0u;
  for (var part = 0u; part < own_part; part++) {
    before = add(before, part_sums[part]);
  }
  for (var i = own_part * PART; i < thread; i++) {
    before = add(before, sums[i]);
  }
  if (thread == THREADS - 1u) {
    block_sums[block] = add(before, sum);
  }
  for (var i = begin; i < end; i++) {
    let number = numbers[i];
    numbers[i] = before;
    before = add(before, number);
  }
}
