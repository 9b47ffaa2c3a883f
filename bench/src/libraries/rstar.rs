//! rstar: an R*-tree.

use anyhow::Result;
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// The tree joined with itself.
pub const LIBRARY: Library = Library {
    name: "rstar",
    origin: Origin::Crate("rstar"),
    how: "`RTree::bulk_load`, `intersection_candidates_with_other_tree` on itself, each pair kept \
          one way round",
    alternative: true,
    two: Some(|| Box::new(Rstar::default())),
    three: Some(|| Box::new(Rstar::default())),
};

#[derive(Default)]
struct Rstar {
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize> Finder<D> for Rstar {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let leaf = |(aabb, id): (&Aabb<D>, u32)| {
            let envelope = AABB::from_corners(aabb.min, aabb.max);
            GeomWithData::new(Rectangle::from_aabb(envelope), id)
        };
        let tree = RTree::bulk_load(boxes.iter().zip(0..).map(leaf).collect());
        let both_ways = tree.intersection_candidates_with_other_tree(&tree);
        let one_way = both_ways.filter(|(a, b)| a.data < b.data);
        self.pairs.clear();
        self.pairs.extend(one_way.map(|(a, b)| [a.data, b.data]));
        Ok(&self.pairs)
    }
}
