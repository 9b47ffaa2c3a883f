//! Boxes from arrays and tuples of coordinates, and back.

use super::{Aabb, Scalar};

impl<const D: usize, T: Scalar> From<[[T; D]; 2]> for Aabb<D, T> {
    /// A box from `[min, max]`.
    #[inline]
    fn from([min, max]: [[T; D]; 2]) -> Self {
        Self { min, max }
    }
}

impl<const D: usize, T: Scalar> From<Aabb<D, T>> for [[T; D]; 2] {
    /// The corners as `[min, max]`.
    #[inline]
    fn from(aabb: Aabb<D, T>) -> Self {
        [aabb.min, aabb.max]
    }
}

impl<const D: usize, T: Scalar> From<([T; D], [T; D])> for Aabb<D, T> {
    /// A box from `(min, max)`.
    #[inline]
    fn from((min, max): ([T; D], [T; D])) -> Self {
        Self { min, max }
    }
}

impl<const D: usize, T: Scalar> From<Aabb<D, T>> for ([T; D], [T; D]) {
    /// The corners as `(min, max)`.
    #[inline]
    fn from(aabb: Aabb<D, T>) -> Self {
        (aabb.min, aabb.max)
    }
}

impl<T: Scalar> From<[T; 2]> for Aabb<1, T> {
    /// A box from `[min, max]`.
    #[inline]
    fn from([min, max]: [T; 2]) -> Self {
        Self { min: [min], max: [max] }
    }
}

impl<T: Scalar> From<Aabb<1, T>> for [T; 2] {
    /// The coordinates as `[min, max]`.
    #[inline]
    fn from(Aabb { min: [min], max: [max] }: Aabb<1, T>) -> Self {
        [min, max]
    }
}

impl<T: Scalar> From<[T; 4]> for Aabb<2, T> {
    /// A box from `[min_x, min_y, max_x, max_y]`.
    #[inline]
    fn from([min_x, min_y, max_x, max_y]: [T; 4]) -> Self {
        Self { min: [min_x, min_y], max: [max_x, max_y] }
    }
}

impl<T: Scalar> From<Aabb<2, T>> for [T; 4] {
    /// The coordinates as `[min_x, min_y, max_x, max_y]`.
    #[inline]
    fn from(Aabb { min: [min_x, min_y], max: [max_x, max_y] }: Aabb<2, T>) -> Self {
        [min_x, min_y, max_x, max_y]
    }
}

impl<T: Scalar> From<[T; 6]> for Aabb<3, T> {
    /// A box from `[min_x, min_y, min_z, max_x, max_y, max_z]`.
    #[inline]
    fn from([min_x, min_y, min_z, max_x, max_y, max_z]: [T; 6]) -> Self {
        Self { min: [min_x, min_y, min_z], max: [max_x, max_y, max_z] }
    }
}

impl<T: Scalar> From<Aabb<3, T>> for [T; 6] {
    /// The coordinates as `[min_x, min_y, min_z, max_x, max_y, max_z]`.
    #[inline]
    fn from(aabb: Aabb<3, T>) -> Self {
        let Aabb { min: [min_x, min_y, min_z], max: [max_x, max_y, max_z] } = aabb;
        [min_x, min_y, min_z, max_x, max_y, max_z]
    }
}
