//! geo-index: a packed R-tree in two dimensions.

use anyhow::Result;
use geo_index::rtree::{RTreeBuilder, RTreeIndex, sort::HilbertSort};
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// The tree joined with itself.
pub const LIBRARY: Library = Library {
    name: "geo-index",
    origin: Origin::Crate("geo-index"),
    how: "`RTreeBuilder` with `HilbertSort`, `intersection_candidates_with_other_tree` on itself, \
          each pair kept one way round",
    alternative: true,
    two: Some(|| Box::new(GeoIndex::default())),
    three: None,
};

#[derive(Default)]
struct GeoIndex {
    pairs: Vec<[u32; 2]>,
}

impl Finder<2> for GeoIndex {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<2>]) -> Result<&'a [[u32; 2]]> {
        self.pairs.clear();
        // It has no root to join without a box.
        if boxes.is_empty() {
            return Ok(&self.pairs);
        }
        let mut builder = RTreeBuilder::<f32>::new(boxes.len() as u32);
        for aabb in boxes {
            builder.add(aabb.min[0], aabb.min[1], aabb.max[0], aabb.max[1]);
        }
        let tree = builder.finish::<HilbertSort>();
        let both_ways = tree.intersection_candidates_with_other_tree(&tree);
        self.pairs.extend(both_ways.filter(|(a, b)| a < b).map(|(a, b)| [a, b]));
        Ok(&self.pairs)
    }
}
