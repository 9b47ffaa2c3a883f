// Stands before each of the other files: what they share.

// Threads of a workgroup. Where a processor plays the GPU, more would make shaders slow to compile and to run: it clears
// their shared memory number by number (SwiftShader took 13 times as long to sort 150 boxes with 256 threads).
const THREADS = 64u;

// Children of a node of the tree.
const CHILDREN = 8u;

// The bounds of a box or of a node of the tree. Lanes x, y and z are the axes (z is 0 in 2D); lane w is twice the number
// of the world, plus 1 in the second of two sets. Every lane is an integer that orders as the coordinate does, so no
// shader computes with floats and every device gives the same result. An invalid box has min > max in all lanes.
struct Bounds {
  min: vec4<u32>,
  max: vec4<u32>,
}

// The number of a workgroup: workgroups are dispatched in rows, since one dimension has at most 65,535 of them.
fn group_number(group: vec3<u32>, groups: vec3<u32>) -> u32 {
  return group.y * groups.x + group.x;
}

// A sum that would exceed a u32 stays at its maximum, so that an overflow is seen.
fn add(a: u32, b: u32) -> u32 {
  return select(a + b, 0xffffffffu, a + b < a);
}

// Closed intervals: bounds that touch overlap.
fn overlap(a: Bounds, b: Bounds) -> bool {
  return all(a.min <= b.max) && all(b.min <= a.max);
}

// min <= max on each axis and in the world.
fn is_valid(bounds: Bounds) -> bool {
  return all(bounds.min <= bounds.max);
}
