#![doc = include_str!("../README.md")]

#[cfg(feature = "bevy-0.19")]
extern crate bevy_0_19 as bevy;

mod versions;

#[cfg(any(feature = "avian2d-0.7", feature = "avian2d-0.8"))]
pub mod avian2d;
#[cfg(any(feature = "avian3d-0.7", feature = "avian3d-0.8"))]
#[cfg_attr(
    any(feature = "avian2d-0.7", feature = "avian2d-0.8"),
    expect(clippy::duplicate_mod, reason = "the same source for both crates of Avian")
)]
pub mod avian3d;

pub mod index;

pub use sweep_and_prune;
