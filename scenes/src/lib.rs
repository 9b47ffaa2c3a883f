//! Seeded scenes of boxes, at rest and in motion: the one source for tests, benches, the site and
//! Python.
//!
//! ```
//! use sweep_and_prune_scenes::{Motion, Scene};
//!
//! let boxes = Scene::Clustered.boxes::<2, f32>(1000, 7).unwrap();
//! assert_eq!(boxes.len(), 1000);
//!
//! let mut moving = Motion::Drift.start::<3, f64>(1000, 7).unwrap();
//! let before = moving.boxes().to_vec();
//! moving.advance();
//! assert_ne!(moving.boxes(), before);
//! ```
//!
//! The same seed gives the same bits on every platform, in every build. For that, everything is
//! computed in `f64` with operations that IEEE 754 rounds exactly (`+ - * /` and the square root)
//! and with `libm`'s software functions, and rounded to the coordinate type once, at the end; the
//! `f32` boxes of a scene are the rounded `f64` boxes, except for the two scenes that are made of
//! the limits of the type. `golden.txt` holds the results; [`golden_report`] computes them.

mod brute_force;
mod golden;
mod motion;
mod random;
mod recipes;
mod scene;
#[cfg(feature = "testing")]
pub mod testing;

pub use brute_force::brute_force;
pub use golden::{golden_report, hash, hash_boxes, hash_pairs};
pub use motion::{Motion, Moving};
pub use random::Random;
pub use scene::Scene;

/// The Rust examples of the project's README, run as doc tests. They stand here because the published
/// crate does not contain that file.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
