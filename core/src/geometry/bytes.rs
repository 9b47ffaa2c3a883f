//! bytemuck: slices of coordinates and of bytes as slices of boxes, without a copy.
#![allow(unsafe_code)]

use bytemuck::{Pod, Zeroable};

use super::{Aabb, Scalar};

// SAFETY: `Aabb` is `repr(C)` and holds two arrays of `T` and nothing else. `T: Zeroable` says that
// a `T` of zero bytes is a value, so a box of zero bytes is one.
unsafe impl<const D: usize, T: Scalar + Zeroable> Zeroable for Aabb<D, T> {}

// SAFETY: `Aabb` is `repr(C)`. Its two fields are arrays of `T` with the same length and alignment,
// so it has no padding. `T: Pod` says that every bit pattern is a `T` and that `T` has no padding or
// interior mutability; the same follows for the box. `Aabb` is `Copy` and `'static` where `T` is.
unsafe impl<const D: usize, T: Scalar + Pod> Pod for Aabb<D, T> {}
