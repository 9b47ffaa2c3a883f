//! Boxes from arrays, tuples and other crates' vectors, and back: the min corner, then the max corner.

use super::{Aabb, Scalar};

/// Conversions between a box and a type, given as the pattern of its values, and of the two corners
/// that it holds, which convert to and from arrays.
macro_rules! conversions {
    ($([$($generics:tt)*] $dimensions:tt, $scalar:ty, $corner:ty:
       $type:ty = $value:tt, $min:tt, $max:tt;)*) => {$(
        impl<$($generics)*> From<$type> for Aabb<$dimensions, $scalar> {
            #[doc = concat!("A box from `", stringify!($value), "`.")]
            #[inline]
            fn from($value: $type) -> Self {
                Self { min: $min.into(), max: $max.into() }
            }
        }

        impl<$($generics)*> From<Aabb<$dimensions, $scalar>> for $type {
            #[doc = concat!("The corners of the box as `", stringify!($value), "`.")]
            #[inline]
            fn from(aabb: Aabb<$dimensions, $scalar>) -> Self {
                let ($min, $max): ($corner, $corner) = (aabb.min.into(), aabb.max.into());
                $value
            }
        }
    )*};
}

conversions! {
    [const D: usize, T: Scalar] D, T, [T; D]: [[T; D]; 2] = [min, max], min, max;
    [const D: usize, T: Scalar] D, T, [T; D]: ([T; D], [T; D]) = (min, max), min, max;
    [T: Scalar] 1, T, [T; 1]: [T; 2] = [min, max], [min], [max];
    [T: Scalar] 2, T, [T; 2]: [T; 4] = [min_x, min_y, max_x, max_y], [min_x, min_y], [max_x, max_y];
    [T: Scalar] 3, T, [T; 3]: [T; 6] = [min_x, min_y, min_z, max_x, max_y, max_z],
        [min_x, min_y, min_z], [max_x, max_y, max_z];
}

/// Conversions between a box and a tuple or an array of two of these vectors.
#[allow(unused_macros, reason = "which are used depends on features")]
macro_rules! corners {
    ($($vector:ty, $dimensions:literal, $scalar:ty;)*) => {
        conversions! {$(
            [] $dimensions, $scalar, $vector: ($vector, $vector) = (min, max), min, max;
            [] $dimensions, $scalar, $vector: [$vector; 2] = [min, max], min, max;
        )*}
    };
}

/// Conversions of one version of glam.
macro_rules! glam {
    ($($feature:literal, $glam:ident;)*) => {$(
        #[cfg(feature = $feature)]
        corners! {
            $glam::Vec2, 2, f32;
            $glam::Vec3, 3, f32;
            $glam::Vec3A, 3, f32;
            $glam::DVec2, 2, f64;
            $glam::DVec3, 3, f64;
        }
    )*};
}

glam! {
    "glam030", glam030;
    "glam031", glam031;
    "glam032", glam032;
    "glam033", glam033;
    "glam034", glam034;
}

#[cfg(feature = "mint")]
corners! {
    mint::Point2<f32>, 2, f32;
    mint::Point3<f32>, 3, f32;
    mint::Vector2<f32>, 2, f32;
    mint::Vector3<f32>, 3, f32;
    mint::Point2<f64>, 2, f64;
    mint::Point3<f64>, 3, f64;
    mint::Vector2<f64>, 2, f64;
    mint::Vector3<f64>, 3, f64;
}
