//! obvhs: a bounding volume hierarchy in three dimensions.

use anyhow::Result;
use obvhs::aabb::Aabb as Bounds;
use obvhs::bvh2::Bvh2;
use obvhs::ploc::{PlocBuilder, PlocSearchDistance, SortPrecision};
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin, lift};

/// The tree asked once for each box.
pub const LIBRARY: Library = Library {
    name: "obvhs",
    origin: Origin::Crate("obvhs"),
    how: "as its physics example: `PlocBuilder::build_with_bvh` with the fastest settings, \
          `aabb_traverse` for each box, here in the order of the tree's leaves",
    alternative: true,
    two: Some(|| Box::new(Obvhs::default())),
    three: Some(|| Box::new(Obvhs::default())),
};

#[derive(Default)]
struct Obvhs {
    builder: PlocBuilder,
    tree: Bvh2,
    bounds: Vec<Bounds>,
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize> Finder<D> for Obvhs {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let bounds = |aabb: &Aabb<D>| Bounds::new(lift(aabb.min).into(), lift(aabb.max).into());
        self.bounds.clear();
        self.bounds.extend(boxes.iter().map(bounds));
        self.builder.build_with_bvh(
            &mut self.tree,
            PlocSearchDistance::Minimum,
            &self.bounds,
            (0..boxes.len() as u32).collect(),
            SortPrecision::U64,
            0,
        );

        self.pairs.clear();
        for &a in &self.tree.primitive_indices {
            let wanted = self.bounds[a as usize];
            self.tree.aabb_traverse(wanted, |tree, node| {
                let node = &tree.nodes[node as usize];
                let first = node.first_index as usize;
                for &b in &tree.primitive_indices[first..first + node.prim_count as usize] {
                    if a < b && self.bounds[b as usize].intersect_aabb(&wanted) {
                        self.pairs.push([a, b]);
                    }
                }
                true
            });
        }
        Ok(&self.pairs)
    }
}
