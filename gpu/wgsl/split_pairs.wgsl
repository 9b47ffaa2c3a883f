// Splits the pairs into keys and values, to sort them by their second index and then by their first.

struct Params {
  // How many pairs fit.
  capacity: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
// Begins with the number of pairs found and the number written.
@group(0) @binding(1) var<storage, read> summary: array<u32>;
@group(0) @binding(2) var<storage, read> pairs: array<vec2<u32>>;
@group(0) @binding(3) var<storage, read_write> firsts: array<u32>;
@group(0) @binding(4) var<storage, read_write> seconds: array<u32>;

@compute @workgroup_size(THREADS)
fn split_pairs(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.capacity) {
    return;
  }
  // What is not a pair stays behind all pairs.
  var pair = vec2(0xffffffffu);
  if (i < summary[1]) {
    pair = pairs[i];
  }
  firsts[i] = pair.x;
  seconds[i] = pair.y;
}
