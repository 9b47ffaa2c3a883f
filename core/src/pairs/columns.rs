//! The columns of a grid, filled with copies of the boxes that touch them: count, prefix sum, scatter.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::grid::Grid;
use super::kernel::{ColumnSlots, CountedPlacements, Placement, assign_slots};
use super::parallel::Kept;
use super::placements::Placements;
use super::sort::Sorter;
use super::source::{Record, Source};
use super::task::Stop;
use crate::memory::grow_to;
use crate::{Aabb, Scalar};

/// The most records per box, on average. Uniform boxes become 1.2 to 1.6 records each.
const MOST_RECORDS_PER_BOX: u64 = 4;
/// This many more records are allowed for all boxes together.
const MOST_EXTRA_RECORDS: u64 = 512;

/// The records of all columns. Those of one column stand in the order of the source.
#[derive(Debug, Default)]
pub(super) struct Columns<const D: usize, T> {
    pub records: Records<D, T>,
    /// Where each column ends.
    pub ends: Vec<u32>,
    /// Where in each column the boxes of a chunk end: of each chunk but the last, if threads each take a chunk.
    pub chunk_ends: Kept<Vec<u32>>,
}

impl<const D: usize, T: Scalar> Columns<D, T> {
    /// Copies the boxes of a source to the columns of a grid. If there is another set, only to
    /// columns that hold boxes of it: elsewhere there are no pairs.
    ///
    /// # Errors
    /// A [`Stop`].
    pub fn fill<S: Source<D, T>>(
        &mut self,
        source: &[S],
        grid: &Grid<T>,
        other: Option<&Self>,
        placements: &mut Placements,
    ) -> Result<(), Stop> {
        placements.list(source, 0..source.len(), grid, most_records(source.len()))?;
        if let Some(other) = other {
            placements.retain(|column| !other.column(column).is_empty());
        }
        let mut counted = [placements.count(&mut self.ends)?];
        self.records.slots(&mut counted)?.for_each(|slots| write(source, slots));
        Ok(())
    }

    /// Sorts each column of the grid by left edge, and gives back spare memory.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn sort(&mut self, grid: &Grid<T>, sorter: &mut Sorter<T>) -> Result<(), TryReserveError> {
        let mut sorted = Vec::new();
        sorted.try_reserve_exact(self.len())?;
        for column in (0..grid.len()).map(|column| self.column(column)) {
            if !column.is_empty() {
                sorted.extend(sorter.order(column, grid.sweep)?.map(|at| column[at]));
            }
        }
        self.records.array = sorted;
        Ok(())
    }

    /// How many records all columns have.
    pub fn len(&self) -> usize {
        self.records.len
    }

    /// How many records the columns before this one have.
    #[inline]
    fn before(&self, column: usize) -> usize {
        if column == 0 { 0 } else { self.ends[column - 1] as usize }
    }

    /// The records of a column.
    pub fn column(&self, column: usize) -> &[Record<D, T>] {
        &self.records.array[self.before(column)..self.before(column + 1)]
    }
}

/// The records of all columns; behind `len` the array is scratch.
#[derive(Debug, Default)]
pub(super) struct Records<const D: usize, T> {
    array: Vec<Record<D, T>>,
    len: usize,
}

impl<const D: usize, T: Scalar> Records<D, T> {
    /// Makes the array large enough for the placements, and gives each list of them its slots. There
    /// must be less than 2^32 placements.
    pub fn slots<'a>(
        &'a mut self,
        counted: &mut [CountedPlacements<'a>],
    ) -> Result<impl Iterator<Item = ColumnSlots<'a, Record<D, T>>>, TryReserveError> {
        self.len = counted.iter().map(CountedPlacements::len).sum();
        if self.array.len() < self.len {
            let aabb = Aabb::new([T::default(); D], [T::default(); D]);
            // Plans for boxes that move differ by that much.
            let size = self.len + self.len / 4;
            grow_to(&mut self.array, size, Record { aabb, id: 0, dedup: 0 })?;
        }
        Ok(assign_slots(counted, &mut self.array[..self.len]))
    }
}

/// Writes the records of a source to their slots.
#[inline(always)]
pub(super) fn write<const D: usize, T: Scalar, S: Source<D, T>>(
    source: &[S],
    slots: ColumnSlots<'_, Record<D, T>>,
) {
    slots.write(|placement: Placement| {
        let at = placement.of as usize;
        let record = source[at].record(at);
        Record { dedup: record.dedup | placement.dedup(), ..record }
    });
}

/// The most records that this many boxes may become.
pub(super) fn most_records(boxes: usize) -> u64 {
    (MOST_RECORDS_PER_BOX * boxes as u64 + MOST_EXTRA_RECORDS).min(u32::MAX.into())
}

/// The columns of a grid, filled with the boxes of one set or two.
pub(super) struct Filled<'a, const D: usize, T> {
    /// Of each set.
    columns: &'a [Columns<D, T>],
    pub grid: &'a Grid<T>,
    /// A column with more records is planned again.
    pub crowd: usize,
}

impl<'a, const D: usize, T: Scalar> Filled<'a, D, T> {
    /// The columns of one set or two. None if a set has no records, as when two sets share no column: then there are no
    /// pairs.
    pub fn new(columns: &'a [Columns<D, T>], grid: &'a Grid<T>, crowd: usize) -> Option<Self> {
        let all_have = columns.iter().all(|columns| columns.records.len > 0);
        all_have.then_some(Self { columns, grid, crowd })
    }

    /// The records of a column in each set, and how many sets there are.
    #[inline(never)]
    pub fn column(&self, column: usize) -> ([&'a [Record<D, T>]; 2], usize) {
        let of = |set: usize| self.columns.get(set).map_or(&[][..], |set| set.column(column));
        ([of(0), of(1)], self.columns.len())
    }

    /// The first of some columns in which each set has records. Between two sparse sets most columns have
    /// none: to pass over them here takes a sixth of the time that it takes to sweep nothing. (Not inline:
    /// it is the same for all sinks.)
    #[inline(never)]
    pub fn next_shared(&self, mut columns: Range<usize>) -> Option<usize> {
        let has_records = |set: &Columns<D, T>, at| set.before(at) < set.before(at + 1);
        columns.find(|&column| self.columns.iter().all(|set| has_records(set, column)))
    }

    /// Which share of the records of the first set some columns have.
    pub fn share(&self, columns: Range<usize>) -> f64 {
        let first = &self.columns[0];
        let records = first.before(columns.end) - first.before(columns.start);
        records as f64 / first.records.len as f64
    }
}

/// Fills the columns with the boxes of one set or two: with those of the larger set only where the
/// smaller set has boxes.
pub(super) fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    columns: &mut [Columns<D, T>; 2],
    mut fill: impl FnMut(&[S], &mut Columns<D, T>, Option<&Columns<D, T>>) -> Result<(), Stop>,
) -> Result<(), Stop> {
    let [first_columns, last_columns] = columns;
    let &[first, last] = sets else {
        return fill(sets[0], first_columns, None);
    };
    if first.len() <= last.len() {
        fill(first, first_columns, None)?;
        fill(last, last_columns, Some(first_columns))
    } else {
        fill(last, last_columns, None)?;
        fill(first, first_columns, Some(last_columns))
    }
}
