//! Splits boxes by size, where no width of columns suits all of them.

use alloc::vec::Vec;

use super::grid::Grid;
use super::plan::SizeSplit;
use super::source::{Record, Source};
use super::task::Stop;
use crate::{Aabb, Scalar};

/// If a grid would make too many records, boxes wider than this many of its columns are split from the rest.
const WIDE_BOX_COLUMNS: f64 = 8.0;

/// The small and the large boxes of one set, and all boxes of the other set, if there are two: copied,
/// so that all groups are of one type.
#[derive(Debug, Default)]
pub(super) struct Groups<const D: usize, T> {
    pub small: Vec<Record<D, T>>,
    pub large: Vec<Record<D, T>>,
    pub other: Vec<Record<D, T>>,
}

impl<const D: usize, T: Scalar> Groups<D, T> {
    /// Splits one or two sets.
    ///
    /// # Errors
    /// [`Stop::Invalid`] or [`Stop::Memory`].
    pub fn fill<S: Source<D, T>>(&mut self, sets: &[&[S]], split: SizeSplit) -> Result<(), Stop> {
        let Self { small, large, other } = self;
        [&mut *small, &mut *large, &mut *other].into_iter().for_each(Vec::clear);
        let mut valid = true;
        for (set, &source) in sets.iter().enumerate() {
            if set != split.set {
                other.try_reserve(source.len())?;
            }
            for (i, each) in source.iter().enumerate() {
                let record = each.record(i);
                valid &= record.aabb.is_valid();
                let group = if set != split.set {
                    &mut *other
                } else if extent(&record.aabb, split.axis) > split.size {
                    &mut *large
                } else {
                    &mut *small
                };
                group.try_reserve(1)?;
                group.push(record);
            }
        }
        if valid { Ok(()) } else { Err(Stop::Invalid) }
    }
}

/// A split of the boxes that are wide for a grid from the rest, if there are any of both.
pub(super) fn wide_boxes<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    grid: &Grid<T>,
) -> Option<SizeSplit> {
    grid.widths().find_map(|(axis, width)| {
        let size = WIDE_BOX_COLUMNS * width;
        let wide = |each: &S| extent(each.aabb(), axis) > size;
        let divides = |source: &&[S]| source.iter().any(wide) && !source.iter().all(wide);
        Some(SizeSplit { set: sets.iter().position(divides)?, axis, size })
    })
}

/// The size of a box on an axis; NaN if it lies at infinity.
fn extent<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, axis: usize) -> f64 {
    aabb.max[axis].to_f64() - aabb.min[axis].to_f64()
}
