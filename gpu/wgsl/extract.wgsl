// Writes one lane of the min corners as keys to sort by: in the order of the rows, or in that of an earlier sort.

struct Params {
  count: u32,
  lane: u32,
  // Whether `order` says which row comes where.
  is_ordered: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Bounds>;
@group(0) @binding(2) var<storage, read> order: array<u32>;
@group(0) @binding(3) var<storage, read_write> keys: array<u32>;

@compute @workgroup_size(THREADS)
fn extract(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  var row = i;
  if (params.is_ordered != 0u) {
    row = order[i];
  }
  // Without the bit that says which set: it is part of the other key.
  keys[i] = select(rows[row].min[params.lane], rows[row].min.w >> 1u, params.lane == 3u);
}
