//! Finds every overlapping pair of axis-aligned boxes in 1D, 2D and 3D, fast.
//!
//! This is the *broad phase* of collision detection, which also serves editors, spatial joins and
//! simulations. Boxes are [`Aabb`]s of `f32` or `f64`.
//!
//! ```
//! use sweep_and_prune::{Aabb, find_pairs};
//!
//! let boxes = [
//!     Aabb::new([0.0, 0.0], [2.0, 2.0]),
//!     Aabb::new([5.0, 5.0], [6.0, 6.0]),
//!     Aabb::new([2.0, 1.0], [3.0, 4.0]), // touches the first box: that is an overlap
//! ];
//! assert_eq!(find_pairs(&boxes)?, [[0, 2]]); // indices of boxes
//! # Ok::<(), sweep_and_prune::Error>(())
//! ```
//!
//! # Which call do I want?
//!
//! | you have | call |
//! |---|---|
//! | boxes, once | [`find_pairs`] |
//! | two sets, such as bullets and targets | [`find_pairs_between`] |
//! | a question that only needs the number of pairs | [`count_pairs`] |
//! | boxes again in every frame, without allocating | [`PairFinder`] |
//! | more pairs than fit in memory, a progress bar, a search that may stop early, threads | [`PairFinder`] |
//! | bodies that persist and move: which pairs began, which ended? | [`BroadPhase`] |
//! | rays, shape casts, nearest bodies, regions | [`BroadPhase::queries`] |
//! | a classic algorithm to read, count and watch | [`algorithms`] |
//!
//! # Two sets
//!
//! [`find_pairs_between`] finds the pairs of one box from each set. A pair holds the index in the
//! first set, then the index in the second.
//!
//! ```
//! use sweep_and_prune::{Aabb, find_pairs_between};
//!
//! let bullets = [Aabb::new([1.0, 1.0], [1.1, 1.1]), Aabb::new([7.0, 1.0], [7.1, 1.1])];
//! let targets = [Aabb::new([9.0, 0.0], [10.0, 2.0]), Aabb::new([6.0, 0.0], [8.0, 2.0])];
//! assert_eq!(find_pairs_between(&bullets, &targets)?, [[1, 1]]);
//! # Ok::<(), sweep_and_prune::Error>(())
//! ```
//!
//! # Bodies that move
//!
//! A [`BroadPhase`] keeps bodies from update to update and reports which pairs began and which ended.
//! Set the boxes that moved, then call [`update`](BroadPhase::update).
//!
//! ```
//! use sweep_and_prune::{Aabb, BroadPhase};
//!
//! let mut world = BroadPhase::<2>::new();
//! let player = world.insert(Aabb::new([0.0, 0.0], [1.0, 2.0]))?;
//! let enemy = world.insert(Aabb::new([3.0, 0.0], [4.0, 2.0]))?;
//! assert!(world.update().is_empty());
//!
//! world.set(player, Aabb::new([2.5, 0.0], [3.5, 2.0]))?;
//! for [a, b] in world.update().begun() {
//!     assert_eq!([a, b], [player, enemy]);
//! }
//!
//! world.remove(enemy)?;
//! assert!(world.update().ended().eq([[player, enemy]]));
//! # Ok::<(), sweep_and_prune::Error>(())
//! ```
//!
//! A world also has collision filters ([`Filter`]), margins ([`Options`]), boxes swept along a motion
//! ([`BroadPhase::set_swept`]), and snapshots from which it continues bit for bit.
//!
//! # Rules
//!
//! - Intervals are closed: touching boxes overlap. Points, flat boxes and boxes with infinite
//!   coordinates are valid. `-0.0` equals `0.0`.
//! - Each pair is reported once, smaller index first. The order of pairs is the same on every machine,
//!   with any vector instructions and any number of threads.
//! - Coordinates are compared exactly as given, without an epsilon.
//! - NaN and inverted boxes are refused with an [`Error`] that names the box. No input panics, and
//!   after an error nothing has changed.
//!
//! # Limits
//!
//! - Boxes have one, two or three dimensions; others do not compile.
//! - One set holds at most 2^32 - 1 boxes.
//! - Boxes are axis-aligned. Whether two rotated or curved shapes inside them touch is for the narrow
//!   phase to decide, which this crate does not have.
//!
//! # Features
//!
//! | feature | default | what it adds |
//! |---|---|---|
//! | `std` | yes | chooses vector instructions (AVX2, AVX-512) at run time; without it the crate is `no_std` with `alloc` |
//! | `parallel` | no | threads, by `rayon` |
//! | `serde` | no | `Serialize` and `Deserialize` for boxes, ids, filters and worlds |
//! | `glam` | no | conversions between boxes and pairs of `Vec2`, `Vec3`, `Vec3A`, `DVec2` or `DVec3` of `glam` 0.30 |
//! | `mint` | no | conversions between boxes and pairs of `mint`'s points or vectors: for other math libraries |
//! | `bytemuck` | no | `Pod` and `Zeroable` for boxes: a `&[f32]` can be cast to a `&[Aabb<2>]` without a copy |
//!
//! No feature changes which pairs are found or their order.
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]

extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod algorithms;
mod error;
mod geometry;
mod memory;
mod pairs;
mod world;

pub use error::{Error, SnapshotFault, Value};
pub use geometry::{Aabb, Scalar, validate};
pub use pairs::{Kernel, PairFinder, Search, count_pairs, find_pairs, find_pairs_between};
pub use world::{
    BroadPhase, Cast, Changes, Filter, Hit, Lists, Neighbor, Options, Pairs, ProxyId, Queries,
    Report, SnapshotInfo,
};

/// The examples of the README, run as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
