//! The larger of two sets on a line comes in parts, so that it need not be in memory as boxes: the Python package converts a
//! part at a time. (Of the time for ten million intervals against a million, new memory for the boxes was a quarter.)

use core::ops::ControlFlow;

use super::brute::is_brute_force_between;
use super::driver::is_valid;
use super::finder::PairFinder;
use super::in_order::is_sorted;
use super::kernel::PairOrder;
use super::lookup::{are_few, may_pay, sampled};
use super::search::{Buffers, error, stream_to};
use super::task::{Progress, ProgressCallback, Task};
use crate::geometry::check_count;
use crate::{Aabb, Error, Scalar};

/// The larger set, which comes in parts.
#[doc(hidden)]
#[derive(Clone, Copy, Debug)]
pub struct InParts {
    /// How many boxes it has in all.
    pub boxes: usize,
    /// Whether it is the first set, so that pairs begin with its boxes.
    pub is_first: bool,
}

impl InParts {
    /// The positions of its boxes of which [`PairFinder::prepare_parts`] needs a sample.
    pub fn sample(self) -> impl ExactSizeIterator<Item = usize> {
        sampled(self.boxes)
    }

    /// Whether there are enough for this number of others; if not, [`PairFinder::prepare_parts`] returns None.
    pub fn suit(self, others: usize) -> bool {
        others < self.boxes
            && !is_brute_force_between(others, self.boxes)
            && are_few(others, self.boxes)
    }
}

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// Prepares the search for pairs between a set of boxes and a larger one, which comes in parts. Returns how many boxes each
    /// part has to have, but for the last; then the pairs are those of
    /// [`find_between`](PairFinder::find_between), in the same order. None if that is no way to search these sets, or
    /// perhaps one of them is invalid.
    ///
    /// # Errors
    /// [`Error::TooManyBoxes`], [`Error::OutOfMemory`].
    #[doc(hidden)]
    pub fn prepare_parts(
        &mut self,
        smaller: &[Aabb<D, T>],
        larger: InParts,
        sample: &[Aabb<D, T>],
    ) -> Result<Option<usize>, Error> {
        [smaller.len(), larger.boxes].into_iter().try_for_each(check_count)?;
        let is_lookup = D == 1
            && larger.suit(smaller.len())
            && is_valid(&smaller)
            && is_valid(&sample)
            && !(is_sorted(smaller) && is_sorted(sample))
            && may_pay(smaller, larger.boxes);
        if !is_lookup {
            return Ok(None);
        }
        let driver = &mut self.0.driver;
        let begins = sample.iter().map(|aabb| aabb.min[0]);
        let is_ready = driver.prepare_lookups(smaller, begins).map_err(error)?;
        Ok(driver.boxes_at_a_time().filter(|_| is_ready))
    }

    /// Calls `each` with chunks of the pairs of a part of the larger set, until it breaks. `first` is the index of the part's
    /// first box. Nothing else has been searched for since [`prepare_parts`](Self::prepare_parts). None, with nothing sent, if a
    /// box is invalid.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`], [`Error::Cancelled`].
    #[doc(hidden)]
    pub fn for_each_chunk_of_part(
        &mut self,
        larger: InParts,
        part: &[Aabb<D, T>],
        first: usize,
        progress: ProgressCallback<'_>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<Option<ControlFlow<()>>, Error> {
        if !is_valid(&part) {
            return Ok(None);
        }
        let Buffers { driver, buffer, .. } = &mut self.0;
        let progress = Progress::new(progress);
        let task = Task::new(PairOrder::BySet, Some(&progress));
        let end = stream_to(each, buffer, |stream| {
            driver.look_up_prepared(part, first, !larger.is_first, task, stream).map_err(error)
        });
        end.map(Some)
    }
}
