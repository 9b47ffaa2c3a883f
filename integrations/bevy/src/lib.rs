#![doc = include_str!("../README.md")]

#[cfg(feature = "2d")]
pub mod avian2d;
#[cfg(feature = "3d")]
#[cfg_attr(
    feature = "2d",
    expect(clippy::duplicate_mod, reason = "the same source for both crates of Avian")
)]
pub mod avian3d;

pub mod index;

pub use sweep_and_prune;
