// Turns the boxes of one set into rows of integers that order as their coordinates do, and reports invalid boxes.

struct Params {
  // The number of boxes of this set, and the row of its first box.
  count: u32,
  first_row: u32,
  dimensions: u32,
  // 1 for the second of two sets, else 0.
  second_set: u32,
  has_worlds: u32,
}

struct Invalid {
  count: atomic<u32>,
  first_row: atomic<u32>,
}

@group(0) @binding(0) var<uniform> params: Params;
// The bits of the coordinates: 2 * dimensions for each box, the min corner before the max corner.
@group(0) @binding(1) var<storage, read> boxes: array<u32>;
@group(0) @binding(2) var<storage, read> worlds: array<u32>;
@group(0) @binding(3) var<storage, read_write> rows: array<Bounds>;
@group(0) @binding(4) var<storage, read_write> invalid: Invalid;

const SIGN = 0x80000000u;
const INFINITY = 0x7f800000u;
// World numbers need one bit less than a u32 has: see Bounds.
const WORLDS = 0x80000000u;

// An integer that orders as the float of these bits does, with -0.0 equal to 0.0. Comparing floats would be wrong where a
// device takes subnormal numbers for zero.
fn ordered(bits: u32) -> u32 {
  if ((bits & ~SIGN) == 0u) {
    return SIGN;
  }
  return select(bits | SIGN, ~bits, (bits & SIGN) != 0u);
}

fn is_nan(bits: u32) -> bool {
  return (bits & ~SIGN) > INFINITY;
}

@compute @workgroup_size(THREADS)
fn load(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  var bounds: Bounds;
  var valid = true;
  for (var axis = 0u; axis < params.dimensions; axis++) {
    let at = 2u * params.dimensions * i + axis;
    let min = boxes[at];
    let max = boxes[at + params.dimensions];
    valid = valid && !is_nan(min) && !is_nan(max);
    bounds.min[axis] = ordered(min);
    bounds.max[axis] = ordered(max);
  }
  if (params.has_worlds != 0u) {
    let world = worlds[i];
    valid = valid && world < WORLDS;
    bounds.min.w = 2u * world;
  }
  bounds.min.w += params.second_set;
  bounds.max.w = bounds.min.w;
  let row = params.first_row + i;
  if (!valid || !is_valid(bounds)) {
    bounds = Bounds(vec4(0xffffffffu), vec4(0u));
    // Sums and minima do not depend on the order in which threads arrive.
    atomicAdd(&invalid.count, 1u);
    atomicMin(&invalid.first_row, row);
  }
  rows[row] = bounds;
}
