//! Find pairs: the fast road.
mod bins;
mod kernel;
mod numbers;
mod order;
mod plan;
mod search;
mod sink;
mod sweep;
#[cfg(feature = "parallel")]
mod threads;
mod watch;

use alloc::vec::Vec;
use core::ops::ControlFlow;

use crate::{Aabb, Error, Scalar, validate};
use kernel::Arrange;
pub use kernel::Kernel;
pub use numbers::Number;
use search::{Search, Stop, Task};
use sink::{Count, Sink, Store, Stream};
use watch::Watch;

/// All pairs of boxes that overlap, each once, smaller index first, in a deterministic order.
///
/// Touching boxes overlap. O(n log n + pairs) time on scenes that anything helps with, and memory
/// O(n + pairs): see [`PairFinder`], which keeps its memory from call to call.
///
/// # Errors
/// [`Error::InvalidBox`] with the index of the first box that is inverted or NaN, or
/// [`Error::TooManyBoxes`].
pub fn find_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<Vec<[u32; 2]>, Error> {
    let mut finder = PairFinder::new();
    finder.find(boxes)?;
    Ok(finder.store.into_pairs())
}

/// All pairs of a box of `a` and a box of `b` that overlap, as `[index in a, index in b]`, each
/// once, in a deterministic order. Otherwise as [`find_pairs`].
///
/// ```
/// use sweep_and_prune::{Aabb, find_pairs_between};
///
/// let bullets = [Aabb::new([0.0, 0.0], [0.1, 0.1]), Aabb::new([5.0, 5.0], [5.1, 5.1])];
/// let targets = [Aabb::new([4.0, 4.0], [6.0, 6.0])];
/// assert_eq!(find_pairs_between(&bullets, &targets)?, [[1, 0]]);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
///
/// # Errors
/// As [`find_pairs`]; the boxes of `b` are counted after those of `a`: the index of the first of
/// them is `a.len()`.
pub fn find_pairs_between<const D: usize, T: Scalar>(
    a: &[Aabb<D, T>],
    b: &[Aabb<D, T>],
) -> Result<Vec<[u32; 2]>, Error> {
    let mut finder = PairFinder::new();
    finder.find_between(a, b)?;
    Ok(finder.store.into_pairs())
}

/// How many pairs [`find_pairs`] would find. Stores none of them.
///
/// # Errors
/// As [`find_pairs`].
///
/// ```
/// use sweep_and_prune::{Aabb, count_pairs};
///
/// let boxes = [Aabb::new([0.0], [1.0]); 1000];
/// assert_eq!(count_pairs(&boxes)?, 499_500);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
pub fn count_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<u64, Error> {
    PairFinder::new().count(boxes)
}

/// Finds pairs again and again, and keeps its buffers between calls.
///
/// The pairs and their order depend on the boxes alone: not on the processor, the number of
/// threads, or what the finder found before.
///
/// ```
/// use sweep_and_prune::{Aabb, PairFinder};
///
/// let mut finder = PairFinder::new();
/// let mut boxes = [Aabb::new([0.0, 0.0], [1.0, 1.0]), Aabb::new([2.0, 0.0], [3.0, 1.0])];
/// for _ in 0..3 {
///     println!("{:?}", finder.find(&boxes)?);
///     boxes[0].max[0] += 0.5;
/// }
/// assert_eq!(finder.find(&boxes)?, [[0, 1]]);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Debug)]
pub struct PairFinder<const D: usize, T: Scalar = f32> {
    search: Search<D, T>,
    store: Store,
}

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// A finder with empty buffers, one thread, and the best kernel of this processor.
    pub fn new() -> Self {
        Self { search: Search::new(Kernel::best()), store: Store::default() }
    }

    /// The same finder with a kernel of choice, for tests and comparisons.
    #[must_use]
    pub fn kernel(mut self, kernel: Kernel) -> Self {
        self.search.kernel = kernel;
        self
    }

    /// The same finder at work on so many threads of rayon's current pool, one if 0 is given.
    /// [`for_each`](Self::for_each), and sets too small to profit, stay with one.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.search.team.threads = threads.max(1);
        self
    }

    /// As [`find_pairs`], into a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs`].
    pub fn find(&mut self, boxes: &[Aabb<D, T>]) -> Result<&[[u32; 2]], Error> {
        self.find_of(&[boxes], None)?;
        Ok(self.store.pairs())
    }

    /// As [`find_pairs_between`], into a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    pub fn find_between(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
    ) -> Result<&[[u32; 2]], Error> {
        self.find_of(&[a, b], None)?;
        Ok(self.store.pairs())
    }

    /// As [`find`](Self::find), and tells `watch` now and then which share of the work is done,
    /// from 0 to 1, on whichever thread does it. The watch may end the search: then there are no
    /// pairs to return.
    ///
    /// # Errors
    /// As [`find_pairs`].
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let boxes = vec![Aabb::new([0.0], [1.0]); 1000];
    /// let mut finder = PairFinder::new();
    /// let found = finder.find_watched(&boxes, &|_share| ControlFlow::Break(()))?;
    /// assert!(found.is_none());
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn find_watched(
        &mut self,
        boxes: &[Aabb<D, T>],
        watch: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> Result<Option<&[[u32; 2]]>, Error> {
        let complete = self.find_of(&[boxes], Some(&Watch::new(watch)))?;
        Ok(complete.then(|| self.store.pairs()))
    }

    /// How many pairs [`find`](Self::find) would find. Stores none of them.
    ///
    /// # Errors
    /// As [`find_pairs`].
    pub fn count(&mut self, boxes: &[Aabb<D, T>]) -> Result<u64, Error> {
        let mut sink = Count::new();
        run(&mut self.search, &[boxes], None, &mut sink)?;
        Ok(sink.count)
    }

    /// How many pairs [`find_between`](Self::find_between) would find. Stores none of them.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    pub fn count_between(&mut self, a: &[Aabb<D, T>], b: &[Aabb<D, T>]) -> Result<u64, Error> {
        let mut sink = Count::new();
        run(&mut self.search, &[a, b], None, &mut sink)?;
        Ok(sink.count)
    }

    /// Calls `each` with every pair, in the order of [`find`](Self::find), until it breaks. Stores
    /// no pairs but a small buffer of them: the memory does not depend on their number.
    ///
    /// # Errors
    /// As [`find_pairs`]; then `each` has not been called.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let boxes = [Aabb::new([0.0], [1.0]); 1000];
    /// let first_of_7 = PairFinder::new().for_each(&boxes, |[a, b]| {
    ///     if a == 7 { ControlFlow::Break(b) } else { ControlFlow::Continue(()) }
    /// })?;
    /// assert_eq!(first_of_7, ControlFlow::Break(8));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn for_each<B>(
        &mut self,
        boxes: &[Aabb<D, T>],
        each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_of(&[boxes], each)
    }

    /// As [`for_each`](Self::for_each), with the pairs of [`find_between`](Self::find_between).
    ///
    /// # Errors
    /// As [`find_pairs_between`]; then `each` has not been called.
    pub fn for_each_between<B>(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
        each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_of(&[a, b], each)
    }

    fn find_of(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        watch: Option<&Watch<'_>>,
    ) -> Result<bool, Error> {
        self.store.clear();
        run(&mut self.search, sets, watch, &mut self.store)
    }

    fn for_each_of<B>(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        mut each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let mut end = ControlFlow::Continue(());
        let mut sink = Stream::new(|pair| match each(pair) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            ControlFlow::Break(with) => {
                end = ControlFlow::Break(with);
                ControlFlow::Break(())
            }
        });
        run(&mut self.search, sets, None, &mut sink)?;
        Ok(end)
    }
}

impl<const D: usize, T: Scalar> Default for PairFinder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Checks the sets as far as the search does not, and searches. False if it was ended early.
fn run<const D: usize, T: Scalar, O: Sink>(
    search: &mut Search<D, T>,
    sets: &[&[Aabb<D, T>]],
    watch: Option<&Watch<'_>>,
    sink: &mut O,
) -> Result<bool, Error> {
    if sets.iter().all(|set| set.len() <= search::FEW) || sets.iter().any(|set| set.is_empty()) {
        check(sets)?;
    }
    if let Some(set) = sets.iter().find(|set| set.len() > Error::BOX_LIMIT) {
        return Err(Error::TooManyBoxes { count: set.len() });
    }
    let arrange = if sets.len() == 1 { Arrange::Ascending } else { Arrange::BySet };
    match search.run(sets, Task::new(arrange, watch), sink) {
        Ok(()) => Ok(true),
        Err(Stop::Enough) => Ok(false),
        // Only now is it worth a look which box it is.
        Err(Stop::Invalid) => check(sets).map(|()| false),
    }
}

/// Validates the sets in turn. Indices go on from set to set.
fn check<const D: usize, T: Scalar>(sets: &[&[Aabb<D, T>]]) -> Result<(), Error> {
    let mut before = 0;
    for set in sets {
        validate(set).map_err(|error| match error {
            Error::InvalidBox { index, axis } => Error::InvalidBox { index: before + index, axis },
            error => error,
        })?;
        before += set.len();
    }
    Ok(())
}
