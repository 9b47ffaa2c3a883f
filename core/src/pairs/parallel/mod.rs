//! Several threads for one search: `several/`.
//!
//! Without the feature `parallel`, `alone.rs` plays its part: a search never gets a team, since a `Team` has no values,
//! and what it would do with one is compiled to nothing. So the rest of the search reads the same in both cases.

#[cfg(not(feature = "parallel"))]
mod alone;
mod kept;
#[cfg(feature = "parallel")]
mod several;

#[cfg(not(feature = "parallel"))]
pub(super) use alone::{Helpers, Receiver, Team};
pub(super) use kept::{Kept, MAY_SPLIT};
#[cfg(feature = "parallel")]
pub(super) use several::*;
