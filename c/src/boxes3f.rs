//! Boxes of the kind `3f`.

use sweep_and_prune::Aabb;

use crate::failure::Failure;
use crate::memory::{array, one};

/// An axis-aligned box. It is valid if `min <= max` on each axis; points, flat boxes and infinite edges are valid, NaN is not.
/// Boxes that touch each other overlap.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct sap_aabb3f {
    /// The min corner.
    pub min: [f32; 3],
    /// The max corner.
    pub max: [f32; 3],
}

const _: () = assert!(size_of::<sap_aabb3f>() == size_of::<Aabb<3, f32>>());
const _: () = assert!(align_of::<sap_aabb3f>() == align_of::<Aabb<3, f32>>());

impl From<Aabb<3, f32>> for sap_aabb3f {
    fn from(Aabb { min, max }: Aabb<3, f32>) -> Self {
        Self { min, max }
    }
}

/// A box.
///
/// # Safety `aabb` is null or points to a box.
pub unsafe fn aabb_at(
    aabb: *const sap_aabb3f,
    name: &'static str,
) -> Result<Aabb<3, f32>, Failure> {
    // SAFETY: as promised above; both types of box are laid out alike.
    unsafe { one(aabb.cast(), name).copied() }
}

/// Boxes.
///
/// # Safety `boxes` is null or points to `count` boxes, which nothing changes while the result is in use.
pub unsafe fn boxes_at<'a>(
    boxes: *const sap_aabb3f,
    count: usize,
    name: &'static str,
) -> Result<&'a [Aabb<3, f32>], Failure> {
    // SAFETY: as promised above; both types of box are laid out alike.
    unsafe { array(boxes.cast(), count, name) }
}

/// The numbers of a point, one for each axis.
///
/// # Safety `numbers` is null or points to 3 numbers.
pub unsafe fn point_at(numbers: *const f32, name: &'static str) -> Result<[f32; 3], Failure> {
    // SAFETY: as promised above.
    unsafe { one(numbers.cast::<[f32; 3]>(), name).copied() }
}
