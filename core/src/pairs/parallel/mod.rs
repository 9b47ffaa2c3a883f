//! Several threads for one search.

mod gather;
mod schedule;
mod sweep;
mod threads;

pub(super) use gather::{Gather, jobs_on_threads};
pub(super) use schedule::Schedule;
pub(super) use sweep::sweep_on_threads;
pub(super) use threads::{copy, for_each_on_threads, on_threads};
