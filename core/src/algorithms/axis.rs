//! Along which axis to sweep: where the boxes are most widely spread.

use crate::{Aabb, Error, Scalar};

/// How to choose the sweep axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Axis {
    /// This one, less than the number of dimensions.
    Fixed(usize),
    /// The longest axis of the scene: from the least minimum to the greatest maximum. One
    /// outlier decides it. O(n).
    LongestExtent,
    /// The axis on which the centres have the largest variance. O(n).
    #[default]
    LargestVariance,
}

impl Axis {
    /// The axis for these valid boxes. Of equals the first is taken.
    ///
    /// # Errors
    /// [`Error::InvalidAxis`] if a fixed axis is not below `D`.
    pub fn choose<const D: usize, T: Scalar>(self, boxes: &[Aabb<D, T>]) -> Result<usize, Error> {
        match self {
            Axis::Fixed(axis) if axis < D => Ok(axis),
            Axis::Fixed(axis) => Err(Error::InvalidAxis { axis, dimensions: D }),
            Axis::LongestExtent => Ok(greatest(extents(boxes))),
            Axis::LargestVariance => Ok(greatest(variances(boxes))),
        }
    }
}

/// The index of the greatest value, the first of equals.
fn greatest<const D: usize>(values: [f64; D]) -> usize {
    (1..D).fold(0, |best, axis| if values[axis] > values[best] { axis } else { best })
}

/// From the least minimum to the greatest maximum on each axis, finite coordinates only.
fn extents<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> [f64; D] {
    core::array::from_fn(|axis| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for aabb in boxes {
            for at in [aabb.min[axis].to_f64(), aabb.max[axis].to_f64()] {
                if at.is_finite() {
                    low = low.min(at);
                    high = high.max(at);
                }
            }
        }
        // Halved, so that the span of the whole f64 range does not overflow.
        if low <= high { high / 2.0 - low / 2.0 } else { 0.0 }
    })
}

/// The variance of the centres on each axis, in units of the longest extent, so that neither
/// huge nor tiny coordinates overflow. Boxes with an infinite edge have no centre and do not
/// count.
fn variances<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> [f64; D] {
    let unit = extents(boxes).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    core::array::from_fn(|axis| {
        let centres = || {
            boxes
                .iter()
                .map(|aabb| {
                    aabb.min[axis].to_f64() / unit * 0.5 + aabb.max[axis].to_f64() / unit * 0.5
                })
                .filter(|centre| centre.is_finite())
        };
        let count = centres().count().max(1) as f64;
        let mean = centres().sum::<f64>() / count;
        centres().map(|centre| (centre - mean) * (centre - mean)).sum::<f64>() / count
    })
}
