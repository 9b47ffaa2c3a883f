// Cycles in a graph of files: a Map of file -> Map of imported file -> Set of imported names.

/** The groups of files that import each other, directly or indirectly: Tarjan's components of two or more. */
export function cyclicGroups(graph) {
  const state = new Map();
  const stack = [];
  const groups = [];
  let next = 0;
  const visit = (file) => {
    const own = { index: next, low: next++, open: true };
    state.set(file, own);
    stack.push(file);
    for (const imported of graph.get(file)?.keys() ?? []) {
      if (!state.has(imported)) own.low = Math.min(own.low, visit(imported).low);
      else if (state.get(imported).open) own.low = Math.min(own.low, state.get(imported).index);
    }
    if (own.low === own.index) {
      const group = stack.splice(stack.indexOf(file));
      for (const member of group) state.get(member).open = false;
      if (group.length > 1) groups.push(group.sort());
    }
    return own;
  };
  for (const file of graph.keys()) if (!state.has(file)) visit(file);
  return groups;
}

/** The shortest way from a file back to itself, as the files on it, the first one repeated at the end. */
export function shortestCycle(graph, group) {
  let best;
  for (const start of group) {
    const from = new Map();
    const queue = [start];
    search: while (queue.length > 0) {
      const file = queue.shift();
      for (const imported of graph.get(file).keys()) {
        if (imported === start) {
          const way = [start];
          for (let at = file; at !== start; at = from.get(at)) way.unshift(at);
          if (file !== start) way.unshift(start);
          if (!best || way.length < best.length) best = way;
          break search;
        }
        if (group.includes(imported) && !from.has(imported)) {
          from.set(imported, file);
          queue.push(imported);
        }
      }
    }
  }
  return best;
}
