//! Avian with its own broad phase and with this one, in the same world and in each step: both add the same contact
//! pairs, with the same bodies and flags. The oracle is Avian's own system.

#[cfg(feature = "bevy-0.19")]
extern crate bevy_0_19 as bevy;

mod support;
#[cfg(any(feature = "avian3d-0.7", feature = "avian3d-0.8"))]
#[cfg_attr(
    any(feature = "avian2d-0.7", feature = "avian2d-0.8"),
    expect(clippy::duplicate_mod, reason = "the same tests for both crates of Avian")
)]
mod three;
#[cfg(any(feature = "avian2d-0.7", feature = "avian2d-0.8"))]
mod two;
