//! The axis-aligned box, the overlap rule, and what a valid box is.

use super::Scalar;
use crate::error::Error;

/// An axis-aligned box in `D` dimensions: the closed intervals `min[axis] ..= max[axis]`.
///
/// A box is valid if `min <= max` on each axis. Points and flat boxes are boxes, and infinite
/// coordinates are allowed (a ground half-space). NaN and inverted boxes are not valid; every
/// public function that takes boxes refuses them with the index at fault.
///
/// In memory a box is a row of `2 * D` scalars, the minimum corner and then the maximum corner.
///
/// ```
/// use sweep_and_prune::Aabb;
///
/// let crate_ = Aabb::new([0.0, 0.0], [1.0, 2.0]);
/// let ground = Aabb::new([f32::NEG_INFINITY, f32::NEG_INFINITY], [f32::INFINITY, 0.0]);
/// assert!(crate_.overlaps(&ground)); // touching boxes overlap
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb<const D: usize, T = f32> {
    /// The least corner.
    pub min: [T; D],
    /// The greatest corner.
    pub max: [T; D],
}

impl<const D: usize, T: Scalar> Aabb<D, T> {
    /// A box from its least and its greatest corner. Any values are taken; see
    /// [`is_valid`](Self::is_valid).
    #[inline]
    pub const fn new(min: [T; D], max: [T; D]) -> Self {
        Self { min, max }
    }

    /// Whether two boxes share a point. Intervals are closed: touching boxes overlap.
    ///
    /// A separating axis is enough to reject, so the axes are tried in turn and the first that
    /// separates ends the test.
    #[inline]
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..D).all(|axis| self.overlaps_on(axis, other))
    }

    /// [`overlaps`](Self::overlaps) without a branch: every axis is compared. Faster where the result
    /// cannot be predicted.
    #[inline]
    pub(crate) fn overlaps_branch_free(&self, other: &Self) -> bool {
        (0..D).fold(true, |all, axis| {
            all & (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis])
        })
    }

    /// Whether every point of `inner` lies in this box.
    #[inline]
    pub fn contains(&self, inner: &Self) -> bool {
        (0..D).fold(true, |all, axis| {
            all & (self.min[axis] <= inner.min[axis]) & (inner.max[axis] <= self.max[axis])
        })
    }

    /// The smallest box that contains both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let mut union = *self;
        for axis in 0..D {
            if other.min[axis] < union.min[axis] {
                union.min[axis] = other.min[axis];
            }
            if other.max[axis] > union.max[axis] {
                union.max[axis] = other.max[axis];
            }
        }
        union
    }

    /// Whether the intervals of two boxes share a point on one axis. This line is the overlap
    /// rule of the whole project: closed on both sides.
    ///
    /// # Panics
    /// If `axis >= D`.
    #[inline]
    pub fn overlaps_on(&self, axis: usize, other: &Self) -> bool {
        self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis]
    }

    /// Whether `min <= max` on each axis, which NaN never is.
    #[inline]
    pub fn is_valid(&self) -> bool {
        self.invalid_axis().is_none()
    }

    /// The first axis on which the box is inverted or NaN.
    #[inline]
    pub fn invalid_axis(&self) -> Option<usize> {
        (0..D).find(|&axis| !is_interval(self.min[axis], self.max[axis]))
    }
}

/// `min <= max`, which is false for a NaN on either side.
#[inline]
fn is_interval<T: Scalar>(min: T, max: T) -> bool {
    min <= max
}

/// Checks a set of boxes at the door: each is valid, and their indices fit in a `u32`.
///
/// # Errors
/// [`Error::TooManyBoxes`], or [`Error::InvalidBox`] with the least index at fault and its first
/// bad axis. O(n) time.
pub fn validate<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<(), Error> {
    check_count(boxes.len())?;
    for (index, aabb) in boxes.iter().enumerate() {
        if let Some(axis) = aabb.invalid_axis() {
            return Err(Error::InvalidBox { index, axis });
        }
    }
    Ok(())
}

/// Checks that so many boxes can be told apart by a `u32`.
///
/// # Errors
/// [`Error::TooManyBoxes`].
pub(crate) fn check_count(count: usize) -> Result<(), Error> {
    // Not `count > BOX_LIMIT`, which is absurd where addresses have 32 bits.
    u32::try_from(count).map(|_| ()).map_err(|_| Error::TooManyBoxes { count })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_boxes_overlap_and_negative_zero_is_zero() {
        let a = Aabb::new([0.0f32], [0.0]);
        let b = Aabb::new([-0.0f32], [-0.0]);
        let c = Aabb::new([0.0f32], [1.0]);
        assert!(a.overlaps(&b) && b.overlaps(&c) && c.overlaps(&a));
    }

    #[test]
    fn infinite_boxes_overlap_what_they_should() {
        let inf = f64::INFINITY;
        let everything = Aabb::new([-inf, -inf], [inf, inf]);
        let point_at_infinity = Aabb::new([inf, inf], [inf, inf]);
        let point = Aabb::new([3.0, 4.0], [3.0, 4.0]);
        assert!(everything.is_valid() && point_at_infinity.is_valid());
        assert!(everything.overlaps(&point_at_infinity));
        assert!(everything.overlaps(&point));
        assert!(!point.overlaps(&point_at_infinity));
    }

    #[test]
    fn validation_names_the_box_and_the_axis() {
        let good = Aabb::new([0.0f32, 0.0], [1.0, 1.0]);
        let nan = Aabb::new([0.0f32, f32::NAN], [1.0, 1.0]);
        let inverted = Aabb::new([2.0f32, 0.0], [1.0, 1.0]);
        assert_eq!(validate(&[good, good]), Ok(()));
        assert_eq!(validate(&[good, nan]), Err(Error::InvalidBox { index: 1, axis: 1 }));
        assert_eq!(validate(&[good, good, inverted]), Err(Error::InvalidBox { index: 2, axis: 0 }));
    }
}
