//! Worlds that keep nothing: all pairs are found anew in every frame.

use anyhow::Result;
use sweep_and_prune::Aabb;

use super::{Found, World, WorldPeer};
use crate::peers::{self, Contender, Peer};

/// The name of our own finder as a world.
pub const FROM_SCRATCH: &str = "ours, from scratch";

/// Makes a world of a contender that finds pairs.
macro_rules! from_scratch {
    ($finder:expr, $name:expr, $how:expr, $rival:expr) => {
        Peer {
            name: $name,
            origin: $finder.origin,
            how: $how,
            rival: $rival,
            two: Some(|| Box::new(Scratch(($finder.two.expect("in 2D"))()))),
            three: Some(|| Box::new(Scratch(($finder.three.expect("in 3D"))()))),
        }
    };
}

/// What a world has to be faster than.
pub const FINDER: WorldPeer = from_scratch!(
    peers::ours::PEER,
    FROM_SCRATCH,
    "`PairFinder::find` in every frame, one finder for all frames",
    false
);

/// A tree made anew in every frame.
#[cfg(feature = "light")]
pub const PARRY: WorldPeer = from_scratch!(
    peers::parry::PEER,
    "parry, from scratch",
    "parry's tree made and traversed in every frame",
    true
);

struct Scratch<const D: usize>(Box<dyn Contender<D>>);

impl<const D: usize> World<D> for Scratch<D> {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<Found<'a>> {
        Ok(Found::Pairs(self.0.find(boxes)?))
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], _moved: &[u32]) -> Result<Found<'a>> {
        Ok(Found::Pairs(self.0.find(boxes)?))
    }
}
