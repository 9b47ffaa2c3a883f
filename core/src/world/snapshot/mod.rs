//! Snapshots: the whole state as bytes, for rollback, replay and saved games, and a hash of them.

mod format;
mod hash;
mod read;
mod write;

pub use format::SnapshotInfo;
pub(super) use hash::hash;
pub(super) use read::read;
pub(super) use write::write;
