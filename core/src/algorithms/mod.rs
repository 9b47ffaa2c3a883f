//! The algorithms of the field, each in its own short file, observable step by step.
//!
//! They are here to be read, compared and shown. To only get the pairs, fast, use
//! [`find_pairs`](crate::find_pairs).
//!
//! Every algorithm runs over the same boxes through one interface, the [`Runner`], and tells an
//! [`Observer`] what it does. All agree on what a pair is: closed intervals, each pair once, the
//! smaller index first.

mod axis;
mod endpoint;
mod observer;
mod pairwise;
mod runner;
mod sorted_pairwise;
mod sorts;

pub use axis::Axis;
pub use endpoint::{Edge, Endpoint, Side};
pub use observer::{Counts, Observer, Separation};
pub use pairwise::{pairwise, pairwise_observed};
pub use runner::{Method, Runner, RunnerOptions, Step};
pub use sorted_pairwise::SortedPairwise;
pub use sorts::Sort;
