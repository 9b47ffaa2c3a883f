//! Several threads for one search.
//!
//! Without the feature `parallel`, `alone.rs` stands for all of this: a search never gets a [`Team`], since there is
//! none, and what it would do with one is compiled to nothing. So the rest of the search reads the same in both cases.

#[cfg(not(feature = "parallel"))]
mod alone;
#[cfg(feature = "parallel")]
mod fill;
#[cfg(feature = "parallel")]
mod gather;
mod kept;
#[cfg(feature = "parallel")]
mod receiver;
#[cfg(feature = "parallel")]
mod schedule;
#[cfg(feature = "parallel")]
mod team;
#[cfg(feature = "parallel")]
mod threads;

#[cfg(not(feature = "parallel"))]
pub(super) use alone::{Helpers, Receiver};
#[cfg(all(test, feature = "std", feature = "parallel"))]
pub(super) use gather::Gather;
pub(super) use kept::{Kept, MAY_SPLIT};
#[cfg(feature = "parallel")]
pub(super) use receiver::Receiver;
#[cfg(feature = "parallel")]
pub(super) use team::Helpers;
#[cfg(all(test, feature = "std", feature = "parallel"))]
pub(super) use {receiver::Chunk, schedule::Schedule};
