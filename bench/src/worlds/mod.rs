//! The broad phases that keep their boxes from frame to frame and report which pairs began and ended: this
//! repository's and the alternatives to it, each in its own short file, called as its own documentation
//! recommends.

mod scratch;
mod this_crate;
mod tracking;
mod world;

#[cfg(feature = "cpp")]
mod box2d;
#[cfg(feature = "cpp")]
mod bullet;
#[cfg(feature = "physx")]
mod physx;
#[cfg(feature = "light")]
mod rapier;

use world::WorldLibrary;

pub use scratch::FROM_SCRATCH;
pub use tracking::{FRAMES_CHECKED, Tracking, oracle};

/// All worlds that were compiled in, this repository's first.
#[allow(unused_mut, reason = "without the features there are no alternatives to add")]
pub fn all() -> Vec<WorldLibrary> {
    let mut worlds = vec![this_crate::LIBRARY, scratch::FINDER];
    #[cfg(feature = "light")]
    worlds.extend([scratch::PARRY, rapier::LIBRARY]);
    #[cfg(feature = "cpp")]
    {
        worlds.push(box2d::LIBRARY);
        worlds.extend(bullet::LIBRARIES);
    }
    #[cfg(feature = "physx")]
    worlds.extend(physx::LIBRARIES);
    worlds
}
