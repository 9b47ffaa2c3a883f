//! Avian with its own broad phase and with this one, in the same world and in each step: both add the same contact
//! pairs, with the same bodies and flags. The oracle is Avian's own system.

mod support;
#[cfg(feature = "3d")]
#[cfg_attr(
    feature = "2d",
    expect(clippy::duplicate_mod, reason = "the same tests for both crates of Avian")
)]
mod three;
#[cfg(feature = "2d")]
mod two;
