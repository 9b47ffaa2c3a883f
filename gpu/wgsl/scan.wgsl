// Replaces each number of a block by the sum of those before it in the block, and writes the sum of the block. Sums that
// exceed a u32 stay at its maximum, so that an overflow is seen.

struct Params {
  count: u32,
  blocks: u32,
}

const ITEMS = 4u;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> numbers: array<u32>;
@group(0) @binding(2) var<storage, read_write> block_sums: array<u32>;

var<workgroup> shared_sums: array<u32, THREADS>;

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
  // The sums over this thread and all before it (Hillis and Steele).
  shared_sums[thread] = sum;
  workgroupBarrier();
  for (var distance = 1u; distance < THREADS; distance *= 2u) {
    if (thread >= distance) {
      sum = add(sum, shared_sums[thread - distance]);
    }
    workgroupBarrier();
    shared_sums[thread] = sum;
    workgroupBarrier();
  }
  if (thread == THREADS - 1u) {
    block_sums[block] = sum;
  }
  var before = 0u;
  if (thread > 0u) {
    before = shared_sums[thread - 1u];
  }
  for (var i = begin; i < end; i++) {
    let number = numbers[i];
    numbers[i] = before;
    before = add(before, number);
  }
}
