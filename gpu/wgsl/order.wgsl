// The key of each box in the order of the tree's leaves: its size class, its shape, its set, and its place in space.
//
// Sizes and places are ranks, not coordinates: the size of a box on an axis is the number of boxes whose min lies in its
// interval. So neither far outliers nor clusters nor units matter. Boxes of one class and shape are alike, so neighbors
// in the order bound each other tightly. An axis on which they are long is halved less often than the others, since it
// would not separate them.

struct Params {
  count: u32,
  dimensions: u32,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> rows: array<Bounds>;
// The min corners on each axis, sorted.
@group(0) @binding(2) var<storage, read> sorted_x: array<u32>;
@group(0) @binding(3) var<storage, read> sorted_y: array<u32>;
@group(0) @binding(4) var<storage, read> sorted_z: array<u32>;
// The key has two words.
@group(0) @binding(5) var<storage, read_write> high_keys: array<u32>;
@group(0) @binding(6) var<storage, read_write> low_keys: array<u32>;
@group(0) @binding(7) var<storage, read_write> order: array<u32>;

// The bits of the key: the size class, the shape on each of three axes, the set, and the place, which has the rest of the
// high word and the low word.
const CLASS_BITS = 5u;
const SHAPE_BITS = 4u;
const SET_BITS = 1u;
const HIGH_PLACE_BITS = 32u - CLASS_BITS - 3u * SHAPE_BITS - SET_BITS;
const PLACE_BITS = HIGH_PLACE_BITS + 32u;
// Within a class and a shape, sizes differ by a factor of about 2^STEP on each axis.
const STEP = 3;

fn sorted_at(axis: u32, i: u32) -> u32 {
  switch axis {
    case 0u: { return sorted_x[i]; }
    case 1u: { return sorted_y[i]; }
    default: { return sorted_z[i]; }
  }
}

// How many min corners are less than a coordinate, or at most equal to it if `or_equal`.
fn rank(axis: u32, coordinate: u32, or_equal: bool) -> u32 {
  var begin = 0u;
  var end = params.count;
  while (begin < end) {
    let middle = begin + (end - begin) / 2u;
    let min = sorted_at(axis, middle);
    if (min < coordinate || (or_equal && min == coordinate)) {
      begin = middle + 1u;
    } else {
      end = middle;
    }
  }
  return begin;
}

// The quotient, rounded to the nearest whole number; the dividend is greater than -64 times the divisor.
fn rounded(dividend: i32, divisor: i32) -> i32 {
  return (2 * dividend + divisor + 128 * divisor) / (2 * divisor) - 64;
}

@compute @workgroup_size(THREADS)
fn order_boxes(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let i = group_number(group, groups) * THREADS + thread;
  if (i >= params.count) {
    return;
  }
  order[i] = i;
  let bounds = rows[i];
  if (!is_valid(bounds)) {
    high_keys[i] = 0xffffffffu;
    low_keys[i] = 0xffffffffu;
    return;
  }
  // The middle of the box on each axis, in ranks, with the highest bit that a rank can have moved to the top.
  var middle: vec3<u32>;
  // Halved this often on each axis, space would be about as wide as the box.
  var bits: vec3<i32>;
  for (var axis = 0u; axis < params.dimensions; axis++) {
    let first = rank(axis, bounds.min[axis], false);
    let last = rank(axis, bounds.max[axis], true);
    middle[axis] = (first + (last - first) / 2u) << countLeadingZeros(params.count);
    bits[axis] = i32(firstLeadingBit(params.count / (last - first)));
  }
  // The class is the mean of the bits, and the shape how the bits differ from it: rounded, so that equal cubes in a crowd
  // and in an empty region are of one class or two, and of one shape.
  let dimensions = i32(params.dimensions);
  let sum = bits.x + bits.y + bits.z;
  let class_number = rounded(sum, dimensions * STEP);
  var key = (1u << CLASS_BITS) - 1u - u32(class_number);
  var halvings: vec3<u32>;
  for (var axis = 0u; axis < params.dimensions; axis++) {
    let shape = rounded(dimensions * bits[axis] - sum, dimensions * STEP);
    key = (key << SHAPE_BITS) | u32(shape + (1 << (SHAPE_BITS - 1u)));
    halvings[axis] = u32(max(STEP * (class_number + shape), 0));
  }
  // Large boxes come last. Each box looks for pairs among those that follow it, so a large box looks at few.
  key = (key << SET_BITS) | (bounds.min.w & 1u);
  // The place on a curve that halves space on one axis after the other (Morton order), while the axis has halvings left.
  var low = 0u;
  var used = 0u;
  for (var level = 0u; level < 32u; level++) {
    for (var axis = 0u; axis < params.dimensions; axis++) {
      if (level < halvings[axis] && used < PLACE_BITS) {
        let half = (middle[axis] >> (31u - level)) & 1u;
        if (used < HIGH_PLACE_BITS) {
          key = (key << 1u) | half;
        } else {
          low |= half << (PLACE_BITS - 1u - used);
        }
        used++;
      }
    }
  }
  high_keys[i] = key << (HIGH_PLACE_BITS - min(used, HIGH_PLACE_BITS));
  low_keys[i] = low;
}
