//! The persistent broad phase: bodies that are inserted, moved and removed, and which overlaps begin
//! and end.
//!
//! ```text
//! bodies -> tree -> candidates -> policy -> search_tree, sets -> finder, permutation -> tracking -> layout
//!     -> update -> queries, snapshot, invariants -> broad_phase -> edit
//! ```
//! Each of these uses only those before it. `update/mod.rs` is the update on one page; `invariants.rs` is the page of what
//! holds between calls.

mod bodies;
mod broad_phase;
mod candidates;
mod changes;
mod edit;
mod finder;
mod invariants;
mod layout;
mod options;
mod permutation;
mod policy;
mod queries;
mod search_tree;
#[cfg(feature = "serde")]
mod serde;
mod sets;
mod snapshot;
mod tracking;
mod tree;
mod update;
#[cfg(all(test, feature = "std"))]
mod work;

pub use bodies::{Filter, ProxyId};
pub use broad_phase::BroadPhase;
pub use changes::{Changes, Pairs};
pub use options::{Options, Report};
pub use queries::{Cast, Hit, Lists, Neighbor, Queries};
pub use snapshot::SnapshotInfo;
