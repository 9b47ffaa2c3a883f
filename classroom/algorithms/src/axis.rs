//! Along which axis to sweep: where the boxes are most widely spread.

use alloc::vec::Vec;

use crate::error::Error;
use sweep_and_prune::{Aabb, Scalar};

/// How to choose the sweep axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Axis {
    /// This one, less than the number of dimensions.
    Fixed(usize),
    /// The axis on which the scene is longest, from the smallest min to the largest max. A single
    /// outlier can decide it. O(n).
    LongestExtent,
    /// The axis on which the centers have the largest variance. It ignores the sizes of the boxes.
    /// O(n).
    #[default]
    LargestVariance,
    /// The axis with the fewest overlaps among a sample of 1,024 boxes, or among all if there are no
    /// more. A fixed rule draws the sample, and its overlaps are counted exactly. Time and memory do
    /// not grow with n.
    FewestOverlaps,
}

impl Axis {
    /// Every way to choose, with axis 0 for the fixed one.
    pub const ALL: [Axis; 4] =
        [Axis::Fixed(0), Axis::LongestExtent, Axis::LargestVariance, Axis::FewestOverlaps];

    /// The name for readers.
    pub const fn name(self) -> &'static str {
        match self {
            Axis::Fixed(_) => "fixed axis",
            Axis::LongestExtent => "longest extent",
            Axis::LargestVariance => "largest variance",
            Axis::FewestOverlaps => "fewest expected overlaps",
        }
    }

    /// The way to choose of this [`name`](Self::name); axis 0 for the fixed one.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|axis| axis.name() == name)
    }

    /// The axis for these boxes, which must be valid. The first of equal axes wins.
    ///
    /// # Errors
    /// [`Error::InvalidAxis`] if a fixed axis is not below `D`, or if there is none at all.
    pub fn choose<const D: usize, T: Scalar>(self, boxes: &[Aabb<D, T>]) -> Result<usize, Error> {
        let ids: Vec<u32> = match self {
            Axis::Fixed(_) => Vec::new(),
            _ => (0..boxes.len() as u32).collect(),
        };
        self.choose_among(boxes, &ids)
    }

    /// The axis for the boxes `ids`.
    pub(crate) fn choose_among<const D: usize, T: Scalar>(
        self,
        boxes: &[Aabb<D, T>],
        ids: &[u32],
    ) -> Result<usize, Error> {
        let chosen = ids.iter().map(|&id| &boxes[id as usize]);
        match self {
            Axis::Fixed(axis) if axis < D => Ok(axis),
            Axis::Fixed(axis) => Err(Error::InvalidAxis { axis, dimensions: D }),
            _ if D == 0 => Err(Error::InvalidAxis { axis: 0, dimensions: 0 }),
            Axis::LongestExtent => Ok(greatest(extents(chosen))),
            Axis::LargestVariance => Ok(greatest(variances(chosen))),
            Axis::FewestOverlaps => Ok(greatest(sampled_gaps(boxes, ids))),
        }
    }
}

/// The index of the greatest value, the first of equals.
fn greatest<const D: usize, V: PartialOrd>(values: [V; D]) -> usize {
    (1..D).fold(0, |best, axis| if values[axis] > values[best] { axis } else { best })
}

/// From the least minimum to the greatest maximum on each axis, finite coordinates only.
fn extents<'a, const D: usize, T: Scalar>(
    boxes: impl Iterator<Item = &'a Aabb<D, T>> + Clone,
) -> [f64; D] {
    core::array::from_fn(|axis| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for aabb in boxes.clone() {
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

/// The variance of the centers on each axis, in units of the longest extent, so that neither
/// huge nor tiny coordinates overflow. Boxes with an infinite edge have no center and do not
/// count.
fn variances<'a, const D: usize, T: Scalar>(
    boxes: impl Iterator<Item = &'a Aabb<D, T>> + Clone,
) -> [f64; D] {
    let unit = extents(boxes.clone()).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    core::array::from_fn(|axis| {
        let centers = || {
            boxes
                .clone()
                .map(|aabb| {
                    aabb.min[axis].to_f64() / unit * 0.5 + aabb.max[axis].to_f64() / unit * 0.5
                })
                .filter(|center| center.is_finite())
        };
        let count = centers().count().max(1) as f64;
        let mean = centers().sum::<f64>() / count;
        centers().map(|center| (center - mean) * (center - mean)).sum::<f64>() / count
    })
}

/// How many boxes [`Axis::FewestOverlaps`] looks at.
const SAMPLE: usize = 1024;

/// How many pairs of a sample are apart on each axis: each box that ended before another began.
fn sampled_gaps<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], ids: &[u32]) -> [u64; D] {
    let mut lefts: Vec<T> = Vec::new();
    let mut rights: Vec<T> = Vec::new();
    core::array::from_fn(|axis| {
        lefts.clear();
        rights.clear();
        for aabb in sample(ids).map(|id| &boxes[id as usize]) {
            lefts.push(aabb.min[axis]);
            rights.push(aabb.max[axis]);
        }
        lefts.sort_unstable_by(|a, b| a.to_f64().total_cmp(&b.to_f64()));
        rights.sort_unstable_by(|a, b| a.to_f64().total_cmp(&b.to_f64()));
        let mut ended = 0;
        let mut gaps = 0;
        for left in &lefts {
            while rights.get(ended).is_some_and(|right| right < left) {
                ended += 1;
            }
            gaps += ended as u64;
        }
        gaps
    })
}

/// All the ids, or `SAMPLE` of them, always the same ones. They are drawn as if by chance (a
/// Weyl sequence, mixed), because every k-th box of a grid may be one column of it.
fn sample(ids: &[u32]) -> impl Iterator<Item = u32> {
    (0..ids.len().min(SAMPLE)).map(|k| {
        if ids.len() <= SAMPLE {
            return ids[k];
        }
        let mut x = (k as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
        ids[((u128::from(x) * ids.len() as u128) >> 64) as usize]
    })
}
