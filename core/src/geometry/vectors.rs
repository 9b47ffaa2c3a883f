//! Boxes from pairs of glam's or mint's vectors, and back: the min corner, then the max corner.

use super::Aabb;

/// Conversions between a box and two corners of one vector type, which converts to and from arrays.
macro_rules! corners {
    ($($vector:ty, $dimensions:literal, $scalar:ty;)*) => {$(
        impl From<($vector, $vector)> for Aabb<$dimensions, $scalar> {
            /// A box from `(min, max)`.
            #[inline]
            fn from((min, max): ($vector, $vector)) -> Self {
                Self { min: min.into(), max: max.into() }
            }
        }

        impl From<Aabb<$dimensions, $scalar>> for ($vector, $vector) {
            /// The corners as `(min, max)`.
            #[inline]
            fn from(aabb: Aabb<$dimensions, $scalar>) -> Self {
                (aabb.min.into(), aabb.max.into())
            }
        }

        impl From<[$vector; 2]> for Aabb<$dimensions, $scalar> {
            /// A box from `[min, max]`.
            #[inline]
            fn from([min, max]: [$vector; 2]) -> Self {
                Self { min: min.into(), max: max.into() }
            }
        }

        impl From<Aabb<$dimensions, $scalar>> for [$vector; 2] {
            /// The corners as `[min, max]`.
            #[inline]
            fn from(aabb: Aabb<$dimensions, $scalar>) -> Self {
                [aabb.min.into(), aabb.max.into()]
            }
        }
    )*};
}

#[cfg(feature = "glam")]
corners! {
    glam::Vec2, 2, f32;
    glam::Vec3, 3, f32;
    glam::Vec3A, 3, f32;
    glam::DVec2, 2, f64;
    glam::DVec3, 3, f64;
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
