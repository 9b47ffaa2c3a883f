// Adds to each number of a block the sum of all blocks before it.

struct Params {
  count: u32,
}

// The numbers of a block of scan.wgsl.
const BLOCK = 16u * THREADS;

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> numbers: array<u32>;
// The sums of all blocks before each block.
@group(0) @binding(2) var<storage, read> before: array<u32>;

@compute @workgroup_size(THREADS)
fn scan_add(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  numbers[i] = add(numbers[i], before[i / BLOCK]);
}
