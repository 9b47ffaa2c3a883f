//! Random inputs against brute force.
//!
//! A target (`TARGETS`) turns bytes into calls of the library, and panics where a result differs from that of a model or
//! of brute force. So one target serves three drivers: the random driver of this crate (`main.rs`), which runs on
//! stable Rust and shortens the inputs that it finds; the test that replays `corpus/`; and libFuzzer, by cargo-fuzz
//! (`libfuzzer/`).

#[cfg(feature = "targets")]
mod broad_phase;
#[cfg(feature = "targets")]
mod finder;
#[cfg(feature = "targets")]
mod input;
mod model;
#[cfg(feature = "targets")]
mod run;
#[cfg(feature = "targets")]
mod snapshot;

#[cfg(feature = "targets")]
pub use input::{Input, Space};
#[cfg(feature = "targets")]
use model::missing;
pub use model::{Body, Model, Pair};
#[cfg(feature = "targets")]
pub use run::{Failure, TARGETS, Target, random_input, run, shorten};

/// A function of the dimensions and the coordinate type that the input chooses.
#[cfg(feature = "targets")]
macro_rules! in_any_dimension {
    ($input:ident, $function:ident) => {
        match $input.below(6) {
            0 => $function::<2, f32>($input),
            1 => $function::<1, f64>($input),
            2 => $function::<3, f32>($input),
            3 => $function::<2, f64>($input),
            4 => $function::<1, f32>($input),
            _ => $function::<3, f64>($input),
        }
    };
}
#[cfg(feature = "targets")]
pub(crate) use in_any_dimension;
