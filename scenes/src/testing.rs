//! What tests share: all dimensions and types, and random boxes on few distinct coordinates.

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Scalar};

/// One test for each dimension and coordinate type, from a generic `fn check<const D: usize, T: Scalar>()`.
#[macro_export]
macro_rules! in_all_dimensions {
    ($name:ident, $check:ident) => {
        mod $name {
            #[test]
            fn in_1d_f32() {
                super::$check::<1, f32>();
            }
            #[test]
            fn in_2d_f32() {
                super::$check::<2, f32>();
            }
            #[test]
            fn in_3d_f32() {
                super::$check::<3, f32>();
            }
            #[test]
            fn in_1d_f64() {
                super::$check::<1, f64>();
            }
            #[test]
            fn in_2d_f64() {
                super::$check::<2, f64>();
            }
            #[test]
            fn in_3d_f64() {
                super::$check::<3, f64>();
            }
        }
    };
}

/// Few values, so that ties are common: both zeros and infinities, neighbors in either type, and
/// the limits of both types, which fall together with others when rounded to `f32`.
const COORDINATES: [f64; 16] = [
    f64::NEG_INFINITY,
    f64::MIN,
    -1.0,
    -0.0,
    0.0,
    5e-324,
    1e-45,
    1.0,
    1.0 + f64::EPSILON,
    1.0 + f32::EPSILON as f64,
    2.0,
    3.0,
    4.0,
    f32::MAX as f64,
    f64::MAX,
    f64::INFINITY,
];

/// One of few values, most often a small whole number.
pub fn coordinate<T: Scalar>() -> impl Strategy<Value = T> {
    prop_oneof![prop::sample::select(&COORDINATES[..]), (0..5i32).prop_map(f64::from)]
        .prop_map(T::from_f64)
}

/// A valid box on few coordinates; one interval in four or so is a point.
pub fn valid_box<const D: usize, T: Scalar>() -> impl Strategy<Value = Aabb<D, T>> {
    let interval = (coordinate(), coordinate(), 0..5).prop_map(|(a, b, point): (T, T, i32)| {
        if point == 0 {
            [a, a]
        } else if b < a {
            [b, a]
        } else {
            [a, b]
        }
    });
    prop::array::uniform::<_, D>(interval)
        .prop_map(|intervals| Aabb::new(intervals.map(|i| i[0]), intervals.map(|i| i[1])))
}

/// Up to `most` valid boxes on few coordinates.
pub fn valid_boxes<const D: usize, T: Scalar>(
    most: usize,
) -> impl Strategy<Value = Vec<Aabb<D, T>>> {
    prop::collection::vec(valid_box(), 0..=most)
}
