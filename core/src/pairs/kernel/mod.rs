//! The innermost loop on each instruction set, and the choice among them.
//!
//! `scan.rs` has the loop once, over the vectors of `scalar.rs`, `x86.rs`, `neon.rs` and `wasm.rs`.
//! What this folder offers to others is safe: a [`Kernel`] exists only where its instructions do, and
//! its methods check all that the loop relies on.
#![allow(unsafe_code)]

mod dispatch;
#[cfg(target_arch = "aarch64")]
mod neon;
mod output;
mod scalar;
mod scan;
mod scatter;
#[cfg(test)]
mod software;
mod sorted_boxes;
mod vector;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm;
#[cfg(target_arch = "x86_64")]
mod x86;

pub use dispatch::Kernel;
pub use scan::Cursor;
pub use scatter::{ColumnSlots, CountedPlacements, Placement, assign_slots};
pub use sorted_boxes::{PAD, SortedBoxes};
pub use vector::PairOrder;
#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
pub use wasm::quantize_by_four;
