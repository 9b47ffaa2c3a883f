// Copies the category and the mask of the boxes of one set to where those of both sets are. A set without filters pairs
// with everything.

struct Params {
  count: u32,
  first_row: u32,
  has_filters: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> given: array<vec2<u32>>;
@group(0) @binding(2) var<storage, read_write> filters: array<vec2<u32>>;

@compute @workgroup_size(THREADS)
fn copy_filters(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  var filter_bits = vec2(0xffffffffu);
  if (params.has_filters != 0u) {
    filter_bits = given[i];
  }
  filters[params.first_row + i] = filter_bits;
}
