//! What the bindings to JavaScript and to Python share: [`BroadPhase`] and [`PairFinder`] behind
//! object-safe traits, so that dimensions and precision can be chosen at run time.
//!
//! | trait | implemented by | for |
//! |---|---|---|
//! | [`AnyPairFinder`] | [`TypedPairFinder`] | all bindings: boxes in rows, pairs in chunks |
//! | [`ArrayPairFinder`] | the same | bindings that copy arrays and report progress |
//! | [`TrackBodies`] | [`TypedBroadPhase`] | all bindings: bodies, and the pairs that begin and end |
//! | [`AnyBroadPhase`] | the same | bindings that answer queries and save the state |
//! | [`ArrayBroadPhase`] | the same | bindings that copy arrays |
//!
//! There are two traits for each, because everything in a trait object is compiled into a
//! WebAssembly file, whether it is called or not.
//!
//! Boxes go in through *rows* that the object owns: a row holds the min corner and then the max
//! corner of a box, in the object's own precision. A binding either writes them to the memory that
//! `rows` returns, or has them copied from a slice by `write_rows`. Few numbers (one box, a
//! query) go in as `f64`, which holds every `f32`. Ids come out in the binding's own form, an [`Id`].
//!
//! [`BroadPhase`]: sweep_and_prune::BroadPhase
//! [`PairFinder`]: sweep_and_prune::PairFinder
#![no_std]

extern crate alloc;

mod broad_phase;
mod choose;
mod filter;
mod id;
mod kind;
mod pair_finder;
mod queries;
mod rows;

pub use broad_phase::{AnyBroadPhase, ArrayBroadPhase, TrackBodies, TypedBroadPhase};
pub use filter::filter;
pub use id::Id;
pub use kind::Kind;
pub use pair_finder::{AnyPairFinder, ArrayPairFinder, Progress, TypedPairFinder};
pub use queries::{Answer, Query};
pub use rows::Coordinates;
