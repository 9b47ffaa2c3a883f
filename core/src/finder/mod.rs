//! Find pairs: the road that users take. For now it is the sorted pairwise sweep on the axis of
//! largest variance, called by itself: through [`Runner`](crate::algorithms::Runner) every other
//! algorithm would come along, which triples what a page has to download.

use alloc::vec::Vec;

use crate::algorithms::{Axis, EndpointArray, Sort, sorted_pairwise};
use crate::{Aabb, Error, Scalar, validate};

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
    ids: Vec<u32>,
    lefts: EndpointArray<T>,
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// A finder with empty buffers.
    pub fn new() -> Self {
        Self { ids: Vec::new(), lefts: EndpointArray::default(), pairs: Vec::new() }
    }

    /// As [`find_pairs`], into a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs`]; after an error the buffers are unchanged.
    pub fn find(&mut self, boxes: &[Aabb<D, T>]) -> Result<&[[u32; 2]], Error> {
        validate(boxes)?;
        let Self { ids, lefts, pairs } = self;
        ids.clear();
        ids.extend(0..boxes.len() as u32);
        let axis = Axis::LargestVariance.choose_among(boxes, ids)?;
        lefts.endpoints.clear();
        lefts.append_lefts(ids);
        pairs.clear();
        sorted_pairwise(boxes, lefts, axis, Sort::Standard, &mut (), pairs);
        Ok(pairs)
    }
}

impl<const D: usize, T: Scalar> Default for PairFinder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}
