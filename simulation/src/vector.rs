//! Arithmetic on `[f32; D]`: sums, products and square roots only, in a fixed order, so that
//! every platform computes the same bits.

use std::array::from_fn;

#[inline]
pub fn difference<const D: usize>(a: [f32; D], b: [f32; D]) -> [f32; D] {
    from_fn(|axis| a[axis] - b[axis])
}

#[inline]
pub fn dot<const D: usize>(a: [f32; D], b: [f32; D]) -> f32 {
    let mut sum = a[0] * b[0];
    for axis in 1..D {
        sum += a[axis] * b[axis];
    }
    sum
}

#[inline]
pub fn add_scaled<const D: usize>(a: &mut [f32; D], b: [f32; D], scale: f32) {
    for axis in 0..D {
        a[axis] += b[axis] * scale;
    }
}

/// The greater; the second if they are equal. `f32::max` may return either zero of `-0.0` and
/// `0.0`, and different platforms do.
#[inline]
pub fn greater(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// The lesser; the second if they are equal.
#[inline]
pub fn lesser(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}
