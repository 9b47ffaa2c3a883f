//! Find pairs: the road that users take. For now it is the sorted pairwise sweep on the axis of
//! largest variance.

use alloc::vec::Vec;

use crate::algorithms::{Axis, Method, Runner, RunnerOptions, Sort};
use crate::{Aabb, Error, Scalar};

/// All pairs of boxes that overlap, each once, smaller index first, in a deterministic order.
///
/// Touching boxes overlap. Time O(n log n + overlaps on the sweep axis), memory O(n + pairs).
///
/// # Errors
/// [`Error::InvalidBox`] with the index of the first box that is inverted or NaN.
pub fn find_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<Vec<[u32; 2]>, Error> {
    let mut finder = PairFinder::new();
    Ok(finder.find(boxes)?.to_vec())
}

/// Finds all pairs again and again, and keeps its buffers between calls.
#[derive(Debug)]
pub struct PairFinder<const D: usize, T = f32> {
    runner: Runner<D, T>,
}

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// A finder with empty buffers.
    pub fn new() -> Self {
        Self {
            runner: Runner::new(RunnerOptions {
                method: Method::SortedPairwise,
                sort: Sort::Standard,
                axis: Axis::LargestVariance,
                persistent: false,
            }),
        }
    }

    /// As [`find_pairs`], into a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs`]; after an error the buffers are unchanged.
    pub fn find(&mut self, boxes: &[Aabb<D, T>]) -> Result<&[[u32; 2]], Error> {
        Ok(self.runner.step(boxes, &mut ())?.pairs)
    }
}

impl<const D: usize, T: Scalar> Default for PairFinder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}
