//! A pair finder of any dimensions and precision.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use sweep_and_prune::{Error, InParts, PairFinder, Scalar, Search};

use crate::rows::{Coordinates, Rows};

/// A pair finder with the rows that it reads: set 0, or the sets 0 and 1.
///
/// `a` and `b` are how many rows of the sets 0 and 1 are searched. Without `b`, a pair is two boxes of set 0; with it, a box of
/// set 0 and a box of set 1.
pub trait AnyPairFinder: Send {
    /// Where to write `count` rows of a set, valid until the next call of this method for the same
    /// set; `None` for a set other than 0 and 1, or if there is no memory.
    fn rows(&mut self, set: usize, count: usize) -> Option<*mut u8>;

    /// Calls `each` with chunks of pairs, in their order, until it breaks. Stores no pairs.
    ///
    /// # Errors
    /// [`Error::InvalidBox`], which names the set, before the first chunk. [`Error::OutOfMemory`].
    fn for_each_chunk(
        &mut self,
        a: usize,
        b: Option<usize>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Error>;
}

/// Receives the progress of a search, from 0 to 1, and cancels the search by breaking. Other threads call it.
pub type Progress<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// A pair finder whose boxes are copied from arrays. It has the errors of [`for_each_chunk`](AnyPairFinder::for_each_chunk).
pub trait ArrayPairFinder: AnyPairFinder {
    /// Copies boxes to the rows of set 0 or 1, and returns how many there are.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    ///
    /// # Panics
    /// For a set other than 0 and 1.
    fn write_rows(&mut self, set: usize, coordinates: Coordinates<'_>) -> Result<usize, Error>;

    /// The nanoseconds that a search takes on one thread, by the model of its plan.
    fn expected_ns(&mut self, a: usize, b: Option<usize>) -> f64;

    /// All pairs; `None` if the search was cancelled.
    #[allow(clippy::missing_errors_doc)]
    fn find(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<&[[u32; 2]]>, Error>;

    /// Calls `each` with chunks of pairs, in their order, until it breaks. Stores no pairs. `None` if the search was cancelled.
    #[allow(clippy::missing_errors_doc)]
    fn stream(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<Option<ControlFlow<()>>, Error>;

    /// Prepares the search for pairs of `smaller` rows of one set and a larger set that comes in parts. The first rows of the
    /// other set are the sample of the larger one. Returns how many boxes each part has to have, but for the last; None if
    /// these sets have to be searched in another way.
    #[allow(clippy::missing_errors_doc)]
    fn prepare_parts(&mut self, smaller: usize, larger: InParts) -> Result<Option<usize>, Error>;

    /// Calls `each` with chunks of the pairs of the next part, whose boxes are the first `count` rows of the larger set. `first`
    /// is the index of the first of them. Nothing else has been searched for since
    /// [`prepare_parts`](ArrayPairFinder::prepare_parts). `None` if the search was cancelled, or if a box is invalid.
    #[allow(clippy::missing_errors_doc)]
    fn stream_part(
        &mut self,
        larger: InParts,
        count: usize,
        first: usize,
        progress: Progress<'_>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<Option<ControlFlow<()>>, Error>;

    /// The pairs of the last call of [`find`](ArrayPairFinder::find), without a copy.
    fn take_pairs(&mut self) -> Vec<[u32; 2]>;

    /// How many pairs there are; `None` if the search was cancelled. Stores no pairs.
    #[allow(clippy::missing_errors_doc)]
    fn count(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<u64>, Error>;

    /// How many boxes each box of set 0 overlaps; `None` if the search was cancelled. Stores no pairs.
    #[allow(clippy::missing_errors_doc)]
    fn counts(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<Vec<u32>>, Error>;

    /// Uses at most `threads` threads from now on: without the feature `parallel`, one. Keeps what it can of the buffers.
    fn use_threads(&mut self, threads: usize);

    /// Drops what a call that panicked left half done. The rows stay.
    fn reset(&mut self);
}

/// The implementation for one type of box.
pub struct TypedPairFinder<const D: usize, T: Scalar> {
    finder: PairFinder<D, T>,
    sets: [Rows<D, T>; 2],
    threads: usize,
}

impl<const D: usize, T: Scalar> TypedPairFinder<D, T> {
    /// A finder that uses at most `threads` threads: without the feature `parallel`, one.
    pub fn new(threads: usize) -> Self {
        let finder = with_threads(PairFinder::new(), threads);
        Self { finder, sets: [Rows::new(), Rows::new()], threads }
    }
}

fn with_threads<const D: usize, T: Scalar>(
    finder: PairFinder<D, T>,
    threads: usize,
) -> PairFinder<D, T> {
    #[cfg(feature = "parallel")]
    return finder.threads(threads);
    #[cfg(not(feature = "parallel"))]
    return (finder, threads).0;
}

/// A search of the first rows of one set, or of two.
fn search<'a, const D: usize, T: Scalar>(
    finder: &'a mut PairFinder<D, T>,
    sets: &'a [Rows<D, T>; 2],
    a: usize,
    b: Option<usize>,
) -> Search<'a, 'a, D, T> {
    let search = finder.search(sets[0].first(a));
    match b {
        None => search,
        Some(b) => search.against(sets[1].first(b)),
    }
}

/// The smaller set, and the larger one, which comes in parts.
fn sets_by_size<const D: usize, T>(
    [first, second]: &[Rows<D, T>; 2],
    larger: InParts,
) -> (&Rows<D, T>, &Rows<D, T>) {
    if larger.is_first { (second, first) } else { (first, second) }
}

fn unless_cancelled<R>(result: Result<R, Error>) -> Result<Option<R>, Error> {
    match result {
        Err(Error::Cancelled) => Ok(None),
        result => result.map(Some),
    }
}

impl<const D: usize, T: Scalar> AnyPairFinder for TypedPairFinder<D, T> {
    fn rows(&mut self, set: usize, count: usize) -> Option<*mut u8> {
        self.sets.get_mut(set)?.reserve(count)
    }

    fn for_each_chunk(
        &mut self,
        a: usize,
        b: Option<usize>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, Error> {
        search(&mut self.finder, &self.sets, a, b).for_each_chunk(each)
    }
}

impl<const D: usize, T: Scalar> ArrayPairFinder for TypedPairFinder<D, T> {
    fn write_rows(&mut self, set: usize, coordinates: Coordinates<'_>) -> Result<usize, Error> {
        self.sets[set].write(coordinates)
    }

    fn expected_ns(&mut self, a: usize, b: Option<usize>) -> f64 {
        search(&mut self.finder, &self.sets, a, b).expected_ns()
    }

    fn find(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<&[[u32; 2]]>, Error> {
        unless_cancelled(search(&mut self.finder, &self.sets, a, b).progress(progress).pairs())
    }

    fn count(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<u64>, Error> {
        unless_cancelled(search(&mut self.finder, &self.sets, a, b).progress(progress).count())
    }

    fn counts(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
    ) -> Result<Option<Vec<u32>>, Error> {
        unless_cancelled(search(&mut self.finder, &self.sets, a, b).progress(progress).counts())
    }

    fn stream(
        &mut self,
        a: usize,
        b: Option<usize>,
        progress: Progress<'_>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<Option<ControlFlow<()>>, Error> {
        let search = search(&mut self.finder, &self.sets, a, b).progress(progress);
        unless_cancelled(search.for_each_chunk(each))
    }

    fn prepare_parts(&mut self, smaller: usize, larger: InParts) -> Result<Option<usize>, Error> {
        let Self { finder, sets, .. } = self;
        let (others, sample) = sets_by_size(sets, larger);
        let sample = sample.first(larger.sample().len());
        finder.prepare_parts(others.first(smaller), larger, sample)
    }

    fn stream_part(
        &mut self,
        larger: InParts,
        count: usize,
        first: usize,
        progress: Progress<'_>,
        each: &mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
    ) -> Result<Option<ControlFlow<()>>, Error> {
        let Self { finder, sets, .. } = self;
        let part = sets_by_size(sets, larger).1.first(count);
        let searched = finder.for_each_chunk_of_part(larger, part, first, progress, each);
        unless_cancelled(searched).map(Option::flatten)
    }

    fn take_pairs(&mut self) -> Vec<[u32; 2]> {
        self.finder.take_pairs()
    }

    fn use_threads(&mut self, threads: usize) {
        if threads != self.threads {
            self.finder = with_threads(core::mem::take(&mut self.finder), threads);
            self.threads = threads;
        }
    }

    fn reset(&mut self) {
        self.finder = with_threads(PairFinder::new(), self.threads);
    }
}
