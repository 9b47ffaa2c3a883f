//! Stage 1, first step: which boxes go to which bins, box by box.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::bins::{Bins, Refusal, Source};
use super::grid::{Grid, Places};
use super::kernel::{Copied, Counted};
use super::numbers::BLOCK;
use crate::Scalar;
use crate::memory::{grow, grow_to};

/// The copies that boxes become.
#[derive(Debug)]
pub(super) struct List {
    /// What goes where, in the order of the boxes; behind `len` it is scratch.
    copies: Vec<Copied>,
    len: usize,
    /// How many bins they are listed for.
    bins: usize,
}

impl List {
    pub const fn new() -> Self {
        Self { copies: Vec::new(), len: 0, bins: 0 }
    }

    /// Lists the copies that these boxes of the source become, and returns how many.
    ///
    /// # Errors
    /// A [`Refusal`]; of more than `limit` copies as soon as there are.
    pub fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
        &mut self,
        source: S,
        boxes: Range<usize>,
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<u64, Refusal> {
        self.bins = grid.len();
        let [above, beside, _] = grid.steps();
        let [above_mark, beside_mark, _] = grid.marks();
        let mut places = Places::new();
        let mut valid = true;
        let mut len = 0;
        for start in boxes.clone().step_by(BLOCK) {
            let block = BLOCK.min(boxes.end - start);
            valid &= places.fill(source.aabbs(start..start + block), grid);
            for at in 0..block {
                if len + 4 > self.copies.len() {
                    let room = 2 * self.copies.len() + 1024;
                    grow_to(&mut self.copies, room, Copied::default())?;
                }
                let (of, bin) = ((start + at) as u32, places.bin[at]);
                let more = [places.more[0][at], places.more[1][at], places.more[2][at]];
                if more[0] <= 1 && more[1] <= 1 && more[2] == 0 {
                    // Nearly always. How many copies there are cannot be foretold, and a branch
                    // would cost more than writing all four; those that are none are overwritten
                    // by the next.
                    let to = &mut self.copies[len..len + 4];
                    let row = 1 + more[1] as usize;
                    to[0] = Copied::new(bin, of);
                    if D > 1 {
                        to[1] = Copied::new(bin + beside + beside_mark, of);
                    }
                    if D > 2 {
                        let marks = above_mark + beside_mark;
                        to[row] = Copied::new(bin + above + above_mark, of);
                        to[row + 1] = Copied::new(bin + above + beside + marks, of);
                    }
                    len += row << more[0];
                } else {
                    len = self.many(len, of, bin, more, grid, limit)?;
                }
            }
        }
        self.len = len;
        match (valid, len as u64 <= limit) {
            (true, true) => Ok(len as u64),
            (true, false) => Err(Refusal::TooMany),
            (false, _) => Err(Refusal::Invalid),
        }
    }

    /// Lists the copies of a box that touches any number of bins, from position `len` on. Returns
    /// the position behind them.
    #[cold]
    fn many<T: Scalar>(
        &mut self,
        mut len: usize,
        of: u32,
        bin: u32,
        more: [u32; 3],
        grid: &Grid<T>,
        limit: u64,
    ) -> Result<usize, Refusal> {
        let marks = grid.marks();
        let mark = |axis: usize, at: u32| if at > 0 { marks[axis] } else { 0 };
        for i in 0..=more[0] {
            for j in 0..=more[1] {
                if len as u64 > limit {
                    return Err(Refusal::TooMany);
                }
                let end = len + more[2] as usize + 1;
                if end > self.copies.len() {
                    grow_to(&mut self.copies, 2 * end, Copied::default())?;
                }
                let first = bin + grid.bin([i, j, 0]);
                for (k, to) in (0..).zip(&mut self.copies[len..end]) {
                    *to = Copied::new(first + k + mark(0, i) + mark(1, j) + mark(2, k), of);
                }
                len = end;
            }
        }
        Ok(len)
    }

    /// Drops the copies that were listed for bins in which another set has none: there are no pairs.
    pub fn keep_shared<const D: usize, T: Scalar>(&mut self, other: &Bins<D, T>) {
        let mut len = 0;
        for index in 0..self.len {
            let copy = self.copies[index];
            self.copies[len] = copy;
            len += usize::from(!other.bin(copy.bin()).is_empty());
        }
        self.len = len;
    }

    /// Counts the copies of each bin, with these counters.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn count<'a>(&'a self, ends: &'a mut Vec<u32>) -> Result<Counted<'a>, TryReserveError> {
        grow(ends, self.bins, 0)?;
        Ok(Counted::new(&self.copies[..self.len], &mut ends[..self.bins]))
    }
}
