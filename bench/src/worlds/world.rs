//! What a world is to the harness: how it takes the boxes of a frame, and how it reports their pairs.

use anyhow::Result;
use sweep_and_prune::Aabb;

use crate::libraries::Library;

/// Tracks the pairs of boxes that move.
pub trait World<const D: usize> {
    /// Takes in the boxes of the first frame. The first `movers` may move. The others are static: they never move, and no
    /// two of them form a pair.
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>>;

    /// Continues with the next frame, in which the boxes at the indices `moved` (ascending) have changed. This is what is
    /// timed: until it is known which pairs there are, or which began and ended.
    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>>;

    /// The current pairs of a world that stores them in its own form. Not timed.
    fn kept(&mut self) -> &[[u32; 2]] {
        &[]
    }
}

/// What a world reports of a frame: pairs of indices, in any order and orientation, of the boxes or
/// of boxes that it made larger.
pub enum Found<'a> {
    /// The pairs that began and those that ended.
    Events {
        /// Pairs that did not overlap in the last frame.
        begun: &'a [[u32; 2]],
        /// Pairs that no longer overlap.
        ended: &'a [[u32; 2]],
    },
    /// All pairs.
    Pairs(&'a [[u32; 2]]),
    /// All pairs, where [`World::kept`] finds them.
    #[allow(dead_code, reason = "only some features have such a world")]
    Kept,
    /// The library does not say which pairs there are.
    #[allow(dead_code, reason = "only some features have such a world")]
    Unknown,
}

/// Makes a world.
pub type Maker<const D: usize> = fn() -> Box<dyn World<D>>;

/// A world as the harness knows it.
pub type WorldLibrary = Library<Maker<2>, Maker<3>>;
