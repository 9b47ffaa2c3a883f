// Writes what the caller reads: the number of pairs, and arguments for an indirect dispatch and an indirect draw.

struct Params {
  // The number of boxes.
  count: u32,
  // How many pairs fit.
  capacity: u32,
  // The size of a workgroup of the indirect dispatch: one thread for each pair.
  group_size: u32,
  // The vertices of the indirect draw: one instance for each pair.
  vertices: u32,
}

struct Invalid {
  count: u32,
  first_row: u32,
}

struct Summary {
  found: u32,
  written: u32,
  invalid: u32,
  first_invalid: u32,
  dispatch: vec4<u32>,
  draw: vec4<u32>,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> tally: array<u32>;
@group(0) @binding(2) var<storage, read> invalid: Invalid;
@group(0) @binding(3) var<storage, read_write> summary: Summary;

// The most workgroups in one dimension that every device grants.
const MOST_GROUPS = 65535u;

@compute @workgroup_size(1)
fn summarize() {
  let found = tally[params.count];
  let written = min(found, params.capacity);
  // Rounded up without an overflow.
  let groups = written / params.group_size + select(0u, 1u, written % params.group_size != 0u);
  let columns = min(groups, MOST_GROUPS);
  var rows = 0u;
  if (columns > 0u) {
    rows = (groups + columns - 1u) / columns;
  }
  summary = Summary(
    found,
    written,
    invalid.count,
    select(0u, invalid.first_row, invalid.count > 0u),
    vec4(columns, rows, 1u, 0u),
    vec4(params.vertices, written, 0u, 0u),
  );
}
