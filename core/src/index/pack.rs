//! The order of boxes in the leaves: boxes that are near in space share a leaf, and near leaves a node.
//!
//! All boxes are cut into slices along one axis, then each slice along the same axis or another, and so
//! on, until sixteen boxes are left. That is STR (Leutenegger, Lopez and Edgington 1997), but each slice is
//! cut along the axis on which its boxes spread most, as in a k-d tree. A slice holds sixteen boxes times a
//! power of two, so that all nodes are full.
//!
//! To cut, it counts centers in equal columns along the axis and moves each to its column. Where a slice
//! ends within a column, it takes any of the boxes there, unless these are many; then it sorts the column.
//! So a cut takes O(n) time, if most boxes do not lie in a few columns.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;

use crate::geometry::{Arithmetic, Quantizer};
use crate::memory::{prefetch_item, prefetch_pays, reserved};
use crate::pairs::LANES;
use crate::{Aabb, Scalar};

/// A cut makes at most two to the power of this many slices. More make higher nodes long and thin.
const MOST_HALVINGS: u32 = 6;
/// The most columns that a cut counts in: their counts stay in the first-level cache.
const COLUMNS: usize = 1024;
/// From so many centers a cut estimates how far the boxes spread.
const SAMPLE: usize = 128;

/// The center of a box, times two, and the index of the box.
#[derive(Clone, Copy, Debug)]
pub struct Center<const D: usize, T> {
    at: [T; D],
    pub index: u32,
}

/// Calls `leaf` with the boxes of each leaf, in order.
///
/// # Errors
/// If there is not enough memory.
pub fn pack<const D: usize, T: Scalar>(
    boxes: &[Aabb<D, T>],
    leaf: impl FnMut(&[Center<D, T>]),
) -> Result<(), TryReserveError> {
    let mut centers = reserved(boxes.len())?;
    centers.extend(boxes.iter().zip(0..).map(|(aabb, index)| {
        let mut at = aabb.min;
        for axis in 0..D {
            let sum = aabb.min[axis] + aabb.max[axis];
            // A NaN, of an axis from negative to positive infinity, has other bits on other machines.
            at[axis] = if sum <= T::INFINITY { sum } else { T::default() };
        }
        Center { at, index }
    }));
    let mut other: Vec<_> = reserved(boxes.len())?;
    other.extend_from_slice(&centers); // not `resize`, which costs 8 ns a box
    if boxes.is_empty() {
        return Ok(());
    }
    Packer { boxes, counts: [0; COLUMNS], leaf }.split(&mut centers, &mut other);
    Ok(())
}

struct Packer<'a, const D: usize, T, F> {
    boxes: &'a [Aabb<D, T>],
    counts: [u32; COLUMNS],
    leaf: F,
}

impl<const D: usize, T: Scalar, F: FnMut(&[Center<D, T>])> Packer<'_, D, T, F> {
    /// Cuts the centers until 16 are left; `other` is as long, and its content is lost.
    fn split(&mut self, centers: &mut [Center<D, T>], other: &mut [Center<D, T>]) {
        if centers.len() <= LANES {
            (self.leaf)(centers);
            return;
        }
        let slice = self.cut(centers, other);
        for (centers, other) in centers.chunks_mut(slice).zip(other.chunks_mut(slice)) {
            self.split(other, centers);
        }
    }

    /// Copies centers to `to`, slice by slice. Returns how many are in a slice.
    fn cut(&mut self, centers: &[Center<D, T>], to: &mut [Center<D, T>]) -> usize {
        let leaves_log2 = centers.len().div_ceil(LANES).next_power_of_two().trailing_zeros();
        let spread = Spread::of(centers);
        let (axis, halvings) = spread.plan(leaves_log2);
        let slice = LANES << (leaves_log2 - halvings);
        let columns = (centers.len() / 2).next_power_of_two().clamp(32, COLUMNS);
        let quantizer = spread.quantizer(axis, columns);
        let column = |center: &Center<D, T>| {
            T::Arithmetic::cell(center.at[axis], &quantizer) as usize % COLUMNS
        };
        let counts = &mut self.counts;
        counts[..columns].fill(0);
        for center in centers {
            counts[column(center)] += 1;
        }
        let mut sum = 0;
        for count in &mut counts[..columns] {
            sum += core::mem::replace(count, sum);
        }
        let prefetches = slice == LANES && prefetch_pays(self.boxes); // leaves read their boxes soon
        for center in centers {
            let end = &mut counts[column(center)];
            to[*end as usize] = *center;
            *end += 1;
            if prefetches {
                prefetch_item(self.boxes, center.index as usize);
            }
        }
        // Now the counts are the ends of the columns.
        let (mut column, mut start, mut is_sorted) = (0, 0, false);
        for end in (slice..centers.len()).step_by(slice) {
            while counts[column] as usize <= end {
                (start, is_sorted) = (counts[column] as usize, false);
                column += 1;
            }
            let both = &mut to[start..counts[column] as usize];
            if both.len() > slice / 2 && start < end && !is_sorted {
                both.sort_unstable_by_key(|center| {
                    T::Arithmetic::key(center.at[axis], center.index)
                });
                is_sorted = true;
            }
        }
        slice
    }
}

/// How far the centers of a sample spread.
struct Spread<const D: usize> {
    min: [f64; D],
    max: [f64; D],
}

impl<const D: usize> Spread<D> {
    /// One center of each of [`SAMPLE`] equal chunks, from changing positions there.
    fn of<T: Scalar>(centers: &[Center<D, T>]) -> Self {
        let (mut min, mut max) = ([T::INFINITY; D], [T::NEG_INFINITY; D]);
        let chunk = centers.len().div_ceil(SAMPLE);
        let mut random = 0u32;
        for start in (0..centers.len()).step_by(chunk) {
            random = random.wrapping_add(0x9e37_79b9); // the golden ratio: spread evenly
            let position = start + ((u64::from(random) * chunk as u64) >> 32) as usize;
            let at = &centers[position.min(centers.len() - 1)].at;
            for axis in 0..D {
                min[axis] = if at[axis] < min[axis] { at[axis] } else { min[axis] };
                max[axis] = if at[axis] > max[axis] { at[axis] } else { max[axis] };
            }
        }
        Self { min: min.map(T::to_f64), max: max.map(T::to_f64) }
    }

    fn extent(&self) -> [f64; D] {
        let mut extent = [0.0; D];
        for axis in 0..D {
            extent[axis] = self.max[axis] - self.min[axis];
        }
        extent
    }

    /// Halving the longest side again and again makes the leaves cubes. The axis of the first cut, and how
    /// often to halve there.
    fn plan(&self, leaves_log2: u32) -> (usize, u32) {
        let mut extent = self.extent();
        let longest = |extent: &[f64; D]| {
            (1..D).fold(0, |best, axis| if extent[axis] > extent[best] { axis } else { best })
        };
        let axis = longest(&extent);
        let mut halvings = 0;
        for _ in 0..leaves_log2 {
            let next = longest(&extent);
            extent[next] *= 0.5;
            halvings += u32::from(next == axis);
        }
        (axis, halvings.div_ceil(halvings.div_ceil(MOST_HALVINGS)))
    }

    fn quantizer<T: Scalar>(&self, axis: usize, columns: usize) -> Quantizer<T> {
        let scale = columns as f64 / self.extent()[axis];
        Quantizer {
            unit: T::from_f64(1.0),
            origin: T::from_f64(self.min[axis] + 0.5 / scale),
            scale: T::from_f64(if scale < f64::INFINITY { scale } else { 0.0 }),
            last: T::from_f64((columns - 1) as f64),
        }
    }
}
