//! The levels of the tree over the boxes.

/// Children of a node, as in `wgsl/common.wgsl`.
const CHILDREN: u64 = 8;

/// The entries of `Params::levels` in `wgsl/search.wgsl`.
const ENTRIES: usize = 16;

/// Where each level of the tree over `count` boxes begins, leaves first; the last entry is the number of nodes.
pub fn levels(count: u64) -> Vec<u64> {
    let mut begins = vec![0];
    let mut nodes = count;
    let mut end = 0;
    loop {
        end += nodes;
        begins.push(end);
        if nodes <= 1 {
            return begins;
        }
        nodes = nodes.div_ceil(CHILDREN);
    }
}

/// The levels as the kernels read them.
pub fn level_params(levels: &[u64]) -> [u32; ENTRIES] {
    core::array::from_fn(|level| levels.get(level).map_or(0, |&begin| begin as u32))
}

/// The most boxes whose tree has at most this many nodes.
pub fn most_leaves(nodes: u64) -> u64 {
    // Each level has at most an eighth of the nodes of the one below, rounded up.
    nodes.saturating_sub(ENTRIES as u64) / CHILDREN * (CHILDREN - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_with_one_node() {
        assert_eq!(levels(0), [0, 0]);
        assert_eq!(levels(1), [0, 1]);
        assert_eq!(levels(8), [0, 8, 9]);
        assert_eq!(levels(9), [0, 9, 11, 12]);
        assert!(levels(1 << 32).len() <= ENTRIES);
    }

    #[test]
    fn most_leaves_fit() {
        for nodes in [16, 17, 100, 4096, 1 << 22, 1 << 31] {
            let leaves = most_leaves(nodes);
            assert!(levels(leaves)[levels(leaves).len() - 1] <= nodes);
        }
    }
}
