//! coitrees: cache oblivious interval trees, by Daniel C. Jones.

use anyhow::Result;
use coitrees::{
    COITree, COITreeSortedQuerent, GenericInterval, Interval, IntervalTree, SortedQuerent,
};

use super::draw::{Set, Sets};
use super::library::{IntervalLibrary, Intervals};
use crate::libraries::Origin;

/// A tree of the smaller set, asked once for each interval of the larger.
pub const LIBRARY: IntervalLibrary = IntervalLibrary {
    name: "coitrees",
    origin: Origin::Crate("coitrees"),
    how: "`COITree::new` of the smaller set, `query` or `query_count` for each interval of the larger one, in sorted order by \
          `COITreeSortedQuerent`; compiled for the processor, as its README asks",
    alternative: true,
    make: || Box::new(Tree::default()),
};

#[derive(Default)]
struct Tree {
    nodes: Vec<Interval<u32>>,
    /// `None` if pairs within the only set are wanted.
    asked: Option<Set>,
    is_sorted: bool,
    tree: Option<COITree<u32, u32>>,
    pairs: Vec<[u32; 2]>,
}

impl Tree {
    fn build(&mut self) {
        self.tree = Some(COITree::new(&self.nodes));
    }

    /// The intervals to ask for, with their indices.
    fn asked(
        nodes: &[Interval<u32>],
        asked: Option<&Set>,
    ) -> impl Iterator<Item = (u32, [i32; 2])> {
        let own = nodes.iter().filter(move |_| asked.is_none()).map(|it| [it.first, it.last]);
        (0..).zip(asked.into_iter().flatten().copied().chain(own))
    }
}

impl Intervals for Tree {
    fn prepare(&mut self, sets: &Sets) {
        let indexed = sets.second.as_ref().unwrap_or(&sets.first);
        let node = |(&[from, to], index): (&[i32; 2], u32)| Interval::new(from, to, index);
        self.nodes = indexed.iter().zip(0..).map(node).collect();
        self.asked = sets.second.is_some().then(|| sets.first.clone());
        self.is_sorted = sets.is_sorted;
        self.tree = None;
    }

    fn pairs(&mut self) -> Result<&[[u32; 2]]> {
        self.build();
        let Self { nodes, asked, is_sorted, tree, pairs, .. } = self;
        pairs.clear();
        let Some(tree) = tree else { return Ok(pairs) };
        let within = asked.is_none();
        let mut keep = |a: u32, b: u32| {
            if !within || a < b {
                pairs.push([a, b]);
            }
        };
        let all = Self::asked(nodes, asked.as_ref());
        if *is_sorted {
            let mut querent = COITreeSortedQuerent::new(tree);
            all.for_each(|(a, [from, to])| {
                querent.query(from, to, |node| keep(a, *node.metadata()))
            });
        } else {
            all.for_each(|(a, [from, to])| tree.query(from, to, |node| keep(a, *node.metadata())));
        }
        Ok(pairs)
    }

    fn count(&mut self) -> Result<u64> {
        self.build();
        let Self { nodes, asked, tree, .. } = self;
        let Some(tree) = tree else { return Ok(0) };
        let all = Self::asked(nodes, asked.as_ref());
        let found = all.map(|(_, [from, to])| tree.query_count(from, to) as u64).sum();
        // Within a set, each interval finds itself, and each pair is found twice.
        Ok(if asked.is_none() { (found - nodes.len() as u64) / 2 } else { found })
    }
}
