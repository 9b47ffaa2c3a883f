// Writes the sorted pairs back.

struct Params {
  // How many pairs fit.
  capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Begins with the number of pairs found and the number written.
@group(0) @binding(1) var<storage, read> summary: array<u32>;
@group(0) @binding(2) var<storage, read> firsts: array<u32>;
@group(0) @binding(3) var<storage, read> seconds: array<u32>;
@group(0) @binding(4) var<storage, read_write> pairs: array<vec2<u32>>;

@compute @workgroup_size(THREADS)
fn merge_pairs(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i < min(params.capacity, summary[1])) {
    pairs[i] = vec2(firsts[i], seconds[i]);
  }
}
