//! The classic sweep-and-prune algorithms, each in its own short file and observable step by step.
//!
//! They are here to be read, compared and shown. If you only need the pairs, use
//! [`find_pairs`](sweep_and_prune::find_pairs) of the crate `sweep-and-prune`, which is much faster. "The article" in their files is Lean's
//! [*Sort, sweep, and prune*](https://leanrada.com/notes/sweep-and-prune/) of 2023.
//!
//! Every algorithm runs over the same boxes through one interface, the [`Runner`], and reports what
//! it does to an [`Observer`]: [`Counts`] counts it, [`Trace`] records it, [`Player`] plays the
//! recording forward and backward. All of them agree on what a pair is: intervals are closed, and
//! each pair is reported once, smaller index first.
//!
//! ```
//! use sweep_and_prune::Aabb;
//! use sweep_and_prune_algorithms::{Counts, Method, Runner, RunnerOptions, Sort};
//!
//! let boxes: Vec<_> = (0..100).map(|i| Aabb::new([i as f32], [i as f32 + 1.0])).collect();
//! let mut counts = Counts::default();
//! let options = RunnerOptions::new(Method::SortedPairwise).sort(Sort::Insertion).persistent(true);
//! let mut runner = Runner::new(options);
//! runner.step(&boxes, &mut counts).unwrap();
//! assert_eq!((counts.tests, counts.swaps), (99, 0)); // brute force tests 4,950 pairs
//! ```
//!
//! Read the files in this order: `pairwise.rs`, `sorted_pairwise.rs`, `endpoint_array.rs`,
//! `one_to_n.rs`, `endpoint_sweep.rs`, `axis_sweeps.rs`, `swap_sweep.rs`.

#![no_std]

extern crate alloc;

mod axis;
mod axis_sweeps;
mod counts;
mod endpoint;
mod endpoint_array;
mod endpoint_sweep;
mod error;
mod observer;
mod one_to_n;
mod pair_map;
mod pairwise;
mod player;
mod runner;
mod sorted_pairwise;
mod sorts;
mod swap_sweep;
mod touching;
mod trace;

pub use axis::Axis;
pub use counts::Counts;
pub use endpoint::{Edge, Endpoint, Side};
pub use error::Error;
pub use observer::{Observer, Separation};
pub use player::{Player, PlayerState};
pub use runner::{Method, Runner, RunnerOptions, Step};
pub use sorts::Sort;
pub use trace::{Event, Trace, TracedArray};
