//! The box, its coordinates, and the rules that hold for boxes: what is valid, what overlaps.

mod aabb;
mod scalar;

pub(crate) use aabb::check_count;
pub use aabb::{Aabb, validate};
pub use scalar::Scalar;
