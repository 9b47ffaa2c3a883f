//! Which boxes overlap? All pairs of a set of axis-aligned boxes, in one, two or three
//! dimensions, `f32` or `f64`.
//!
//! ```
//! use sweep_and_prune::{Aabb, find_pairs};
//!
//! let boxes = [
//!     Aabb::new([0.0, 0.0], [2.0, 2.0]),
//!     Aabb::new([5.0, 5.0], [6.0, 6.0]),
//!     Aabb::new([2.0, 1.0], [3.0, 4.0]), // touches the first: intervals are closed
//! ];
//! assert_eq!(find_pairs(&boxes)?, [[0, 2]]);
//! # Ok::<(), sweep_and_prune::Error>(())
//! ```
//!
//! Data flows one way: boxes, order, sweep, pairs. [`find_pairs`] is the fast road;
//! [`algorithms`] holds the classic variants of the field, each in its own short file and
//! observable step by step.
#![no_std]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod algorithms;
mod error;
mod geometry;
mod memory;
mod pairs;
mod world;

pub use error::{Error, SnapshotFault};
pub use geometry::{Aabb, Scalar, validate};
pub use pairs::{Kernel, PairFinder, count_pairs, find_pairs, find_pairs_between};
pub use world::{
    BroadPhase, Cast, Changes, Filter, Hit, Lists, Neighbour, Options, Pairs, ProxyId, Queries,
    Report, SnapshotInfo,
};

/// The examples of the README, run as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
