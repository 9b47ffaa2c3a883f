//! The broad phases that keep their boxes from frame to frame and report which pairs began and ended: this
//! repository's and the alternatives to it, each in its own short file, called as its own documentation
//! recommends.

mod level;
mod scratch;
mod this_crate;
mod tracking;
mod world;

#[cfg(feature = "cpp")]
mod bullet;
#[cfg(feature = "cpp")]
mod dynamic_tree;
#[cfg(feature = "cpp")]
mod jolt;
#[cfg(feature = "physx")]
mod physx;
#[cfg(feature = "light")]
mod rapier;

use world::WorldLibrary;

pub use level::NAME as LEVEL;
pub use scratch::{FROM_SCRATCH, TREE_FROM_SCRATCH};
pub use tracking::{FRAMES_CHECKED, Tracking, oracle};

/// All worlds that were compiled in, this repository's first.
#[allow(unused_mut, reason = "without the features there are no alternatives to add")]
pub fn all() -> Vec<WorldLibrary> {
    let mut worlds = vec![this_crate::LIBRARY, scratch::FINDER];
    #[cfg(feature = "light")]
    worlds.extend([scratch::TREE, rapier::LIBRARY]);
    #[cfg(feature = "cpp")]
    {
        worlds.extend([dynamic_tree::BOX2D, dynamic_tree::BOX3D]);
        worlds.extend(bullet::LIBRARIES);
    }
    #[cfg(feature = "physx")]
    worlds.extend(physx::LIBRARIES);
    worlds
}

/// The worlds that tell static boxes from others, this repository's first.
#[allow(unused_mut, reason = "without the features there are no alternatives to add")]
pub fn with_statics() -> Vec<WorldLibrary> {
    let mut worlds = vec![this_crate::STATIC, this_crate::RESTING];
    #[cfg(feature = "light")]
    worlds.push(rapier::LIBRARY);
    #[cfg(feature = "cpp")]
    {
        worlds.extend([dynamic_tree::BOX2D, dynamic_tree::BOX3D, jolt::LIBRARY]);
        worlds.extend(bullet::LIBRARIES);
    }
    #[cfg(feature = "physx")]
    worlds.extend(physx::LIBRARIES);
    worlds
}
