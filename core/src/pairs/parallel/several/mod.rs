//! A search on several threads.

mod fill;
mod gather;
mod receiver;
mod schedule;
mod team;
mod threads;

#[cfg(all(test, feature = "std"))]
pub use gather::Gather;
pub use receiver::Receiver;
pub use team::{Helpers, Team};
#[cfg(all(test, feature = "std"))]
pub use {receiver::Chunk, schedule::Schedule};
