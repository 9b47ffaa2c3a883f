//! packed_spatial_index: a packed Hilbert R-tree in two and three dimensions.

use std::ops::ControlFlow;

use anyhow::Result;
use packed_spatial_index::{Box2D, Box3D, Index2DBuilder, Index3DBuilder};
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin};

/// The tree's own join with itself.
pub const LIBRARY: Library = Library {
    name: "packed_spatial_index",
    origin: Origin::Crate("packed_spatial_index"),
    how: "`Index2DBuilder` or `Index3DBuilder`, `finish`, `pairs_each`, all in f64",
    alternative: true,
    two: Some(|| Box::new(Packed::default())),
    three: Some(|| Box::new(Packed::default())),
};

#[derive(Default)]
struct Packed {
    pairs: Vec<[u32; 2]>,
}

impl Packed {
    fn keep(&mut self) -> impl FnMut(usize, usize) -> ControlFlow<()> {
        self.pairs.clear();
        |a, b| {
            self.pairs.push([a as u32, b as u32]);
            ControlFlow::Continue(())
        }
    }
}

impl Finder<2> for Packed {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<2>]) -> Result<&'a [[u32; 2]]> {
        let mut builder = Index2DBuilder::new(boxes.len());
        for aabb in boxes {
            let ([x0, y0], [x1, y1]) = (aabb.min.map(f64::from), aabb.max.map(f64::from));
            builder.add(Box2D::new(x0, y0, x1, y1));
        }
        let _ = builder.finish()?.pairs_each(self.keep());
        Ok(&self.pairs)
    }
}

impl Finder<3> for Packed {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<3>]) -> Result<&'a [[u32; 2]]> {
        let mut builder = Index3DBuilder::new(boxes.len());
        for aabb in boxes {
            let ([x0, y0, z0], [x1, y1, z1]) = (aabb.min.map(f64::from), aabb.max.map(f64::from));
            builder.add(Box3D::new(x0, y0, z0, x1, y1, z1));
        }
        let _ = builder.finish()?.pairs_each(self.keep());
        Ok(&self.pairs)
    }
}
