//! Worlds that keep nothing: all pairs are found from scratch in every frame.

use anyhow::{Result, ensure};
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::{self, Finder, Library};

/// The name of this library's finder, called in every frame.
pub const FROM_SCRATCH: &str = "sweep-and-prune, from scratch";

/// Makes a world of a library that finds pairs.
macro_rules! from_scratch {
    ($finder:expr, $name:expr, $how:expr, $alternative:expr) => {
        Library {
            name: $name,
            origin: $finder.origin,
            how: $how,
            alternative: $alternative,
            two: Some(|| Box::new(Scratch(($finder.two.expect("in 2D"))()))),
            three: Some(|| Box::new(Scratch(($finder.three.expect("in 3D"))()))),
        }
    };
}

/// The worlds that any other world has to beat.
pub const FINDER: WorldLibrary = from_scratch!(
    libraries::this_crate::LIBRARY,
    FROM_SCRATCH,
    "`PairFinder::find` in every frame, one finder for all frames",
    false
);

/// The name of the fastest tree, built from scratch in every frame.
pub const TREE_FROM_SCRATCH: &str = "packed_spatial_index, from scratch";

/// The fastest tree that can be built from scratch in every frame.
#[cfg(feature = "light")]
pub const TREE: WorldLibrary = from_scratch!(
    libraries::packed_spatial_index::LIBRARY,
    TREE_FROM_SCRATCH,
    "packed_spatial_index's tree made and joined with itself in every frame",
    true
);

struct Scratch<const D: usize>(Box<dyn Finder<D>>);

impl<const D: usize> World<D> for Scratch<D> {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>> {
        ensure!(movers == boxes.len(), "it would also find the pairs of static boxes");
        Ok(Found::Pairs(self.0.find(boxes)?))
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], _moved: &[u32]) -> Result<Found<'a>> {
        Ok(Found::Pairs(self.0.find(boxes)?))
    }
}
