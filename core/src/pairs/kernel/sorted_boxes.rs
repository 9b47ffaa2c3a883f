//! Boxes in sweep order, as a structure of arrays: what the kernels read.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;

use crate::Scalar;
use crate::memory::grow;

/// How many items stand behind the last box, so that a vector may be loaded at any position up to and
/// including the end: as many as the widest vector has lanes.
pub const PAD: usize = 16;

/// At most this many axes are tested beside the sweep axis: all three when nothing is swept.
const MAX_OTHERS: usize = 3;

/// Boxes in sweep order: those of a column of the grid, or all of a set. Every array is `len + PAD` long at least.
///
/// Behind the last box the left edges are NaN, which is `<=` nothing: unlike an infinite
/// sentinel it also stops the sweep of a box that reaches to infinity.
#[derive(Debug, Default)]
pub struct SortedBoxes<T> {
    len: usize,
    /// Left and right edges on the sweep axis; the left ones ascend.
    pub left: Vec<T>,
    pub right: Vec<T>,
    /// Edges on the other axes.
    pub min: [Vec<T>; MAX_OTHERS],
    pub max: [Vec<T>; MAX_OTHERS],
    /// The caller's index of each box.
    pub id: Vec<u32>,
    /// On which cut axes each box began in an earlier column. Two boxes whose bitmaps share a bit are
    /// no pair here: another column reports it.
    pub dedup: Vec<u32>,
}

impl<T: Scalar> SortedBoxes<T> {
    pub fn len(&self) -> usize {
        self.len
    }

    /// Sets the length, padding included, and writes the sentinels behind the last box. The caller
    /// writes what stands before them. The arrays only ever grow.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn reset(&mut self, len: usize, others: usize) -> Result<(), TryReserveError> {
        let size = len + PAD;
        grow(&mut self.left, size, T::default())?;
        grow(&mut self.right, size, T::default())?;
        for axis in 0..others {
            grow(&mut self.min[axis], size, T::default())?;
            grow(&mut self.max[axis], size, T::default())?;
        }
        grow(&mut self.id, size, 0)?;
        grow(&mut self.dedup, size, 0)?;
        self.left[len..size].fill(T::from_f64(f64::NAN));
        self.len = len;
        Ok(())
    }

    /// Whether every array that a sweep over `others` axes reads is long enough, and the
    /// sentinels stand: what the kernels rely on.
    pub fn is_ready(&self, others: usize) -> bool {
        let size = self.len + PAD;
        self.left.len() >= size
            && self.right.len() >= size
            && self.id.len() >= size
            && self.dedup.len() >= size
            && (0..others).all(|k| self.min[k].len() >= size && self.max[k].len() >= size)
            && self.left[self.len..size].iter().all(|left| left.partial_cmp(left).is_none())
    }
}
