//! The worlds: what keeps its boxes from frame to frame and tells what began and ended, ours and
//! its peers, each in its own short file and used as its own documentation recommends.

use anyhow::Result;
use sweep_and_prune::Aabb;

use crate::peers::Peer;

mod following;
mod ours;
mod scratch;

#[cfg(feature = "cpp")]
mod box2d;
#[cfg(feature = "cpp")]
mod bullet;
#[cfg(feature = "physx")]
mod physx;
#[cfg(feature = "light")]
mod rapier;

pub use following::{FRAMES_CHECKED, Following, oracle};
pub use scratch::FROM_SCRATCH;

/// Follows boxes that move.
pub trait World<const D: usize> {
    /// Takes in the boxes of the first frame.
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<Found<'a>>;

    /// Goes on to the next frame, in which the boxes of the indices `moved`, in ascending order,
    /// are others than in the last. This is what is timed: until it is known which pairs there
    /// are, or which began and ended.
    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>>;

    /// The pairs that there are, of a world that keeps them in a form of its own. Not timed.
    fn kept(&mut self) -> &[[u32; 2]] {
        &[]
    }
}

/// What a world tells of a frame: pairs of indices, in any order and orientation, of the boxes or
/// of boxes that it made larger.
pub enum Found<'a> {
    /// The pairs that began and those that ended.
    Events {
        /// Which were none before.
        begun: &'a [[u32; 2]],
        /// Which are none any more.
        ended: &'a [[u32; 2]],
    },
    /// All pairs.
    Pairs(&'a [[u32; 2]]),
    /// All pairs, where [`World::kept`] finds them.
    #[allow(dead_code, reason = "only some features have such a world")]
    Kept,
}

/// Makes a world.
pub type Maker<const D: usize> = fn() -> Box<dyn World<D>>;

/// A world as the harness knows it.
pub type WorldPeer = Peer<Maker<2>, Maker<3>>;

/// All worlds that were compiled in, ours first.
pub fn all() -> Vec<WorldPeer> {
    let mut worlds = vec![ours::PEER, scratch::FINDER];
    #[cfg(feature = "light")]
    worlds.extend([scratch::PARRY, rapier::PEER]);
    #[cfg(feature = "cpp")]
    {
        worlds.push(box2d::PEER);
        worlds.extend(bullet::PEERS);
    }
    #[cfg(feature = "physx")]
    worlds.extend(physx::PEERS);
    worlds
}
