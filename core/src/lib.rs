#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

mod cloning;
#[cfg(not(target_arch = "wasm32"))]
mod compiled;
mod error;
mod float;
mod geometry;
mod memory;
mod pairs;
mod sampling;
mod setters;
mod world;

pub use error::{Error, SnapshotFault, Value};
pub use geometry::{Aabb, Scalar, validate};
#[doc(hidden)]
pub use pairs::InParts;
pub use pairs::{Kernel, PairFinder, Search, count_pairs, find_pairs, find_pairs_between};
pub use world::{
    BroadPhase, Cast, Changes, Filter, Hit, Lists, Neighbor, Options, Pairs, ProxyId, Queries,
    Report, SnapshotInfo,
};
