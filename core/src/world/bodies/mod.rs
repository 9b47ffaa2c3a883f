//! The bodies: their ids, filters and boxes, and what was done to them since the last update.

mod filter;
mod id;
mod slots;
mod table;

pub use filter::Filter;
pub use id::{ProxyId, sort_ids};
pub(super) use slots::{Slots, flag};
pub(super) use table::{Bodies, RANDOM_READ, differ};
