// Writes one level of the tree: each node bounds eight neighbors of the level below.

struct Params {
  // The number of nodes to write.
  count: u32,
  // Where this level and the one below begin.
  first: u32,
  first_child: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read_write> nodes: array<Bounds>;

@compute @workgroup_size(THREADS)
fn parents(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  let begin = params.first_child + CHILDREN * i;
  // The levels follow each other, so the one below ends where this one begins.
  let end = min(begin + CHILDREN, params.first);
  // The bounds of an invalid box change nothing in a union.
  var bounds = nodes[begin];
  for (var child = begin + 1u; child < end; child++) {
    bounds.min = min(bounds.min, nodes[child].min);
    bounds.max = max(bounds.max, nodes[child].max);
  }
  nodes[params.first + i] = bounds;
}
