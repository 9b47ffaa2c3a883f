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
pub use team::Helpers;
#[cfg(all(test, feature = "std"))]
pub use {receiver::Chunk, schedule::Schedule};
