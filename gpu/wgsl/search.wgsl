// Each box looks for the boxes that follow it in the order of the leaves and overlap it: once to count them, and once,
// when it is known where its pairs belong, to write them.

struct Params {
  // The number of all boxes.
  count: u32,
  // Whether there are two sets, and the number of boxes of the first; 0 if there is one.
  two_sets: u32,
  first_set: u32,
  has_filters: u32,
  // How many pairs fit.
  capacity: u32,
  // The number of the level with one node.
  top: u32,
  // Where each level begins among the nodes; the entry after the last level is the number of nodes.
  levels: array<vec4<u32>, 4>,
}

@group(0) @binding(0) var<uniform> params: Params;
@group(0) @binding(1) var<storage, read> nodes: array<Bounds>;
@group(0) @binding(2) var<storage, read> order: array<u32>;
// The category and the mask of each box, by row.
@group(0) @binding(3) var<storage, read> filters: array<vec2<u32>>;
// The number of pairs of each box, and later the sum of the numbers before it.
@group(0) @binding(4) var<storage, read_write> tally: array<u32>;
@group(0) @binding(5) var<storage, read_write> pairs: array<vec2<u32>>;

// A walk over the tree, depth first. No stack is needed: eight nodes have one parent, and all levels end together.
struct Walk {
  bounds: Bounds,
  filter_bits: vec2<u32>,
  // The node to look at next.
  level: u32,
  at: u32,
  // How many nodes and boxes were tested.
  tests: u32,
}

fn level_begin(level: u32) -> u32 {
  return params.levels[level / 4u][level % 4u];
}

// From a node to the next that was not tested: the parent's neighbor after the last child.
fn advance(walk: ptr<function, Walk>) {
  (*walk).at++;
  while ((*walk).level < params.top && (*walk).at % CHILDREN == 0u) {
    (*walk).at /= CHILDREN;
    (*walk).level++;
  }
}

fn start(leaf: u32) -> Walk {
  var walk: Walk;
  walk.bounds = nodes[leaf];
  if (params.two_sets != 0u) {
    // Lane w says which set a box is in: it looks for the other set.
    walk.bounds.min.w ^= 1u;
    walk.bounds.max.w ^= 1u;
  }
  if (params.has_filters != 0u) {
    walk.filter_bits = filters[order[leaf]];
  }
  walk.at = leaf;
  advance(&walk);
  return walk;
}

fn may_pair(walk: ptr<function, Walk>, leaf: u32) -> bool {
  if (params.has_filters == 0u) {
    return true;
  }
  let other = filters[order[leaf]];
  let own = (*walk).filter_bits;
  return (own.x & other.y) != 0u && (other.x & own.y) != 0u;
}

// The next leaf that pairs with the box of the walk, or the number of leaves if there is none.
fn next(walk: ptr<function, Walk>) -> u32 {
  loop {
    let node = level_begin((*walk).level) + (*walk).at;
    if (node >= level_begin((*walk).level + 1u)) {
      return params.count;
    }
    (*walk).tests++;
    if (!overlap((*walk).bounds, nodes[node])) {
      advance(walk);
    } else if ((*walk).level > 0u) {
      (*walk).level--;
      (*walk).at *= CHILDREN;
    } else {
      advance(walk);
      if (may_pair(walk, node)) {
        return node;
      }
    }
  }
  return params.count;
}

// The leaf of a thread. Invalid boxes come last and are not searched for.
fn is_searched(leaf: u32) -> bool {
  return leaf < params.count && is_valid(nodes[leaf]);
}

@compute @workgroup_size(THREADS)
fn count_pairs(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let leaf = group_number(group, groups) * THREADS + thread;
  if (leaf > params.count) {
    return;
  }
  // One number more than there are boxes: summed up, it is the number of all pairs.
  var found = 0u;
  if (is_searched(leaf)) {
    var walk = start(leaf);
    while (next(&walk) < params.count) {
      found++;
    }
  }
  tally[leaf] = found;
}

// For tests of the work: the number of tests instead of the number of pairs.
@compute @workgroup_size(THREADS)
fn count_tests(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let leaf = group_number(group, groups) * THREADS + thread;
  if (leaf > params.count) {
    return;
  }
  var tests = 0u;
  if (is_searched(leaf)) {
    var walk = start(leaf);
    while (next(&walk) < params.count) {
    }
    tests = walk.tests;
  }
  tally[leaf] = tests;
}

@compute @workgroup_size(THREADS)
fn write_pairs(
  @builtin(workgroup_id) group: vec3<u32>,
  @builtin(num_workgroups) groups: vec3<u32>,
  @builtin(local_invocation_index) thread: u32,
) {
  let leaf = group_number(group, groups) * THREADS + thread;
  if (!is_searched(leaf)) {
    return;
  }
  var to = tally[leaf];
  let end = min(tally[leaf + 1u], params.capacity);
  if (to >= end) {
    return;
  }
  let row = order[leaf];
  var walk = start(leaf);
  while (to < end) {
    let other = order[next(&walk)];
    // A row of the second set is an index of that set plus the size of the first.
    pairs[to] = vec2(min(row, other), max(row, other) - params.first_set);
    to++;
  }
}
