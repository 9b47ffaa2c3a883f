/** Children of a node, as in `wgsl/common.wgsl`. */
const CHILDREN = 8;

/** The entries of `Params.levels` in `wgsl/search.wgsl`. */
const ENTRIES = 16;

/** Where each level of the tree over `count` boxes begins, leaves first; the last entry is the number of nodes. */
export function levels(count: number): number[] {
  const begins = [0];
  for (let nodes = count, end = 0; ; nodes = Math.ceil(nodes / CHILDREN)) {
    end += nodes;
    begins.push(end);
    if (nodes <= 1) return begins;
  }
}

/** The most boxes whose tree has at most this many nodes: each level has at most an eighth of the one below, rounded up. */
export const mostLeaves = (nodes: number): number => Math.floor(Math.max(0, nodes - ENTRIES) / CHILDREN) * (CHILDREN - 1);
