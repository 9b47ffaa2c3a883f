//! Arithmetic on `[f32; D]`: sums, products and square roots only, in a fixed order, so that
//! every platform computes the same bits.

use std::array::from_fn;

use sweep_and_prune::Aabb;

/// Coordinates that are worked on together, of whole vectors in 1, 2 and 3 dimensions: without a
/// branch, and without regard to where a vector begins, so that compilers use vector instructions.
pub const BLOCK: usize = 48;

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

/// A vector of up to three dimensions, stored in four coordinates, which a processor's vector instructions process at
/// once. Each user says what the last coordinates hold.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(16))]
pub struct Row(pub [f32; 4]);

impl Row {
    /// The vector, and `rest` in all further coordinates.
    #[inline]
    pub fn new<const D: usize>(vector: [f32; D], rest: f32) -> Self {
        Self(from_fn(|axis| if axis < D { vector[axis] } else { rest }))
    }

    /// The vector again.
    #[inline]
    pub fn vector<const D: usize>(&self) -> [f32; D] {
        from_fn(|axis| self.0[axis])
    }

    /// [`difference`], also of the further coordinates.
    #[inline]
    pub fn minus(&self, other: &Self) -> Self {
        Self(difference(self.0, other.0))
    }

    /// [`dot`] of the first `D` coordinates.
    #[inline]
    pub fn dot<const D: usize>(&self, other: &Self) -> f32 {
        let products: [f32; 4] = from_fn(|axis| self.0[axis] * other.0[axis]);
        products[1..D].iter().fold(products[0], |sum, product| sum + product)
    }

    /// [`add_scaled`], also to the further coordinates.
    #[inline]
    pub fn add_scaled(&mut self, other: &Self, scale: f32) {
        add_scaled(&mut self.0, other.0, scale);
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

/// The coordinates, repeated to fill the array.
#[inline]
pub fn repeated<const D: usize, const N: usize>(vector: [f32; D]) -> [f32; N] {
    from_fn(|i| vector[i % D])
}

/// The smallest box that holds all points; inverted if there are none.
pub fn bounding_box<const D: usize>(points: &[[f32; D]]) -> Aabb<D> {
    let (mut min, mut max) = ([f32::INFINITY; BLOCK], [f32::NEG_INFINITY; BLOCK]);
    for block in points.as_flattened().chunks(BLOCK) {
        for (i, &at) in block.iter().enumerate() {
            min[i] = lesser(at, min[i]);
            max[i] = greater(at, max[i]);
        }
    }
    let on = |axis| (axis..BLOCK).step_by(D);
    Aabb::new(
        from_fn(|axis| on(axis).fold(f32::INFINITY, |least, i| lesser(min[i], least))),
        from_fn(|axis| on(axis).fold(f32::NEG_INFINITY, |most, i| greater(max[i], most))),
    )
}
