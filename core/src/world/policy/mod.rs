//! The policy: when an update tracks bodies by fat AABBs and when it finds all pairs from scratch, how
//! far fat AABBs reach, and when bodies fall asleep. It counts work instead of reading a clock, so
//! results and memory are the same in every run.

mod cost;
mod motion;
mod sleep;
mod usage;

pub use cost::{LOOK_UP, Policy, TRIES_SAMPLES, refit_pays};
pub use motion::{Motion, longest_side};
pub use sleep::Sleep;
pub use usage::Usage;
