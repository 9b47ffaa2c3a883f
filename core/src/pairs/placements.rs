//! Which columns each box is copied to, box by box. No branch depends on where a box lies.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::grid::{BLOCK, CellCoordinates, Grid};
use super::kernel::{CountedPlacements, Placement};
use super::source::Source;
use super::task::Stop;
use crate::Scalar;
use crate::memory::{grow, grow_to};

/// The placements of the boxes of a set, or of a chunk of them.
#[derive(Debug, Default)]
pub(super) struct Placements {
    /// In the order of the boxes; behind `len` it is scratch.
    all: Vec<Placement>,
    len: usize,
    /// How many columns there are.
    columns: usize,
}

impl Placements {
    /// Lists the columns that these boxes of the source touch, and returns how many placements there
    /// are.
    ///
    /// # Errors
    /// A [`Stop`]; [`Stop::TooMany`] as soon as there are more than `limit`.
    pub fn list<const D: usize, T: Scalar, S: Source<D, T>>(
        &mut self,
        source: &[S],
        boxes: Range<usize>,
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<u64, Stop> {
        self.columns = grid.len();
        let [above, beside, _] = grid.steps();
        let dedup = grid.axes().map(Placement::dedup_bit);
        let [dedup_above, dedup_beside, _] = dedup;
        let mut cells = CellCoordinates::new();
        let mut valid = true;
        let mut len = 0;
        for start in boxes.clone().step_by(BLOCK) {
            let block = BLOCK.min(boxes.end - start);
            valid &= cells.fill(&source[start..start + block], grid);
            for at in 0..block {
                if len + 4 > self.all.len() {
                    let size = 2 * self.all.len() + 1024;
                    grow_to(&mut self.all, size, Placement::default())?;
                }
                let (of, column) = ((start + at) as u32, cells.column[at]);
                let more = [cells.more[0][at], cells.more[1][at], cells.more[2][at]];
                if more[0] <= 1 && more[1] <= 1 && more[2] == 0 {
                    // Nearly always. How many placements there are is unpredictable, and a branch
                    // would cost more than writing all four; the next box overwrites the rest.
                    let to = &mut self.all[len..len + 4];
                    let row = 1 + more[1] as usize;
                    to[0] = Placement::new(column, of);
                    if D > 1 {
                        to[1] = Placement::new(column + beside + dedup_beside, of);
                    }
                    if D > 2 {
                        let both = dedup_above + dedup_beside;
                        to[row] = Placement::new(column + above + dedup_above, of);
                        to[row + 1] = Placement::new(column + above + beside + both, of);
                    }
                    len += row << more[0];
                } else {
                    len = self.list_many(len, of, column, more, grid, limit)?;
                }
            }
        }
        self.len = len;
        match (valid, len as u64 <= limit) {
            (true, true) => Ok(len as u64),
            (true, false) => Err(Stop::TooMany),
            (false, _) => Err(Stop::Invalid),
        }
    }

    /// Lists the columns of a box that touches any number of them, from position `len` on. Returns
    /// the position behind them.
    #[cold]
    fn list_many<T: Scalar>(
        &mut self,
        mut len: usize,
        of: u32,
        column: u32,
        more: [u32; 3],
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<usize, Stop> {
        let steps = grid.steps();
        let dedup = grid.axes().map(Placement::dedup_bit);
        let dedup = |axis: usize, at: u32| if at > 0 { dedup[axis] } else { 0 };
        for i in 0..=more[0] {
            for j in 0..=more[1] {
                if len as u64 > limit {
                    return Err(Stop::TooMany);
                }
                let end = len + more[2] as usize + 1;
                if end > self.all.len() {
                    grow_to(&mut self.all, 2 * end, Placement::default())?;
                }
                let first = column + i * steps[0] + j * steps[1];
                for (k, to) in (0..).zip(&mut self.all[len..end]) {
                    let dedup = dedup(0, i) + dedup(1, j) + dedup(2, k);
                    *to = Placement::new(first + k + dedup, of);
                }
                len = end;
            }
        }
        Ok(len)
    }

    /// Drops the placements in columns that do not matter.
    pub fn retain(&mut self, matters: impl Fn(usize) -> bool) {
        let mut len = 0;
        for index in 0..self.len {
            let placement = self.all[index];
            self.all[len] = placement;
            len += usize::from(matters(placement.column()));
        }
        self.len = len;
    }

    /// Counts the placements in each column, with these counters.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn count<'a>(
        &'a self,
        ends: &'a mut Vec<u32>,
    ) -> Result<CountedPlacements<'a>, TryReserveError> {
        grow(ends, self.columns, 0)?;
        Ok(CountedPlacements::new(&self.all[..self.len], &mut ends[..self.columns]))
    }
}
