//! broccoli: a kd-tree whose nodes are swept, in two dimensions.

use anyhow::Result;
use broccoli::aabb::BBox;
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// The tree with its elements stored in it.
pub const LIBRARY: Library = Library {
    name: "broccoli",
    origin: Origin::Crate("broccoli"),
    how: "`Tree::new` over `BBox<f32, u32>` (an index is smaller than the reference of the \
          recommended layout), `find_colliding_pairs`",
    alternative: true,
    two: Some(|| Box::new(Broccoli::default())),
    three: None,
};

#[derive(Default)]
struct Broccoli {
    boxes: Vec<BBox<f32, u32>>,
    pairs: Vec<[u32; 2]>,
}

impl Finder<2> for Broccoli {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<2>]) -> Result<&'a [[u32; 2]]> {
        self.boxes.clear();
        self.boxes.extend(boxes.iter().zip(0..).map(|(aabb, id)| {
            let rect = broccoli::rect(aabb.min[0], aabb.max[0], aabb.min[1], aabb.max[1]);
            broccoli::bbox(rect, id)
        }));
        let mut tree = broccoli::Tree::new(&mut self.boxes);
        self.pairs.clear();
        tree.find_colliding_pairs(|a, b| self.pairs.push([*a.unpack_inner(), *b.unpack_inner()]));
        Ok(&self.pairs)
    }
}
