//! The box, its coordinates, and the rules that hold for boxes: what is valid, what overlaps.

mod aabb;
mod arithmetic;
#[cfg(feature = "bytemuck")]
mod bytes;
mod conversions;
mod scalar;
#[cfg(feature = "serde")]
mod serde;

pub(crate) use aabb::check_count;
pub use aabb::{Aabb, validate};
pub(crate) use arithmetic::{Arithmetic, Quantizer};
pub(crate) use scalar::Key;
pub use scalar::Scalar;
