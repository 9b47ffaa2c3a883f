//! The broad phase for `avian2d`: it takes the place of Avian's `BvhBroadPhasePlugin`.
//!
//! Both crates of Avian have the same items, so `src/avian` is compiled once for each.

#[cfg(feature = "avian2d-0.8")]
use ::avian2d as avian;
#[cfg(feature = "avian2d-0.7")]
use ::avian2d_0_7 as avian;
#[cfg(feature = "avian2d-0.8")]
use avian::dynamics::joints::joint_graph;
#[cfg(feature = "avian2d-0.7")]
use avian::dynamics::solver::joint_graph;

/// How many dimensions the boxes have.
const DIMENSIONS: usize = 2;

#[path = "avian/plugin.rs"]
mod plugin;
#[path = "avian/rule.rs"]
mod rule;
#[path = "avian/search.rs"]
mod search;
#[path = "avian/tracked.rs"]
mod tracked;

pub use plugin::SweepAndPruneBroadPhasePlugin;
pub use search::PairSearch;
