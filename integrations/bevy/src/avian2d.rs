//! The broad phase for `avian2d`: it takes the place of Avian's `BvhBroadPhasePlugin`.
//!
//! Both crates of Avian have the same items, so `src/avian` is compiled once for each.

use ::avian2d as avian;

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
