//! The bodies: their ids, filters and boxes, and what was done to them since the last update.

mod boxes;
mod displacements;
mod edits;
mod exclusions;
mod filter;
mod id;
mod rows;
mod rules;
mod slots;
mod sweeps;
mod table;

pub(super) use boxes::REPLACES_ALL;
pub(super) use exclusions::{BEFORE, NOW};
pub use filter::Filter;
pub use id::{ProxyId, sort_ids};
pub(super) use rules::{Rules, When};
pub(super) use slots::{Slots, flag};
pub(super) use table::{Bodies, RANDOM_READ, differ};
