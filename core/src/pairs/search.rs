//! One search: its options, and the ways to receive its pairs.

use alloc::vec::Vec;
use core::fmt;
#[cfg(feature = "std")]
use core::mem::replace;
use core::ops::ControlFlow;
use core::slice;

use super::brute::{is_brute_force, is_few, send_few};
use super::driver::{Driver, is_valid};
use super::kernel::{Kernel, PairOrder};
use super::near::Near;
#[cfg(feature = "std")]
use super::parallel::Helpers;
use super::parallel::Receiver;
use super::plan::{Among, plan};
use super::probe::Probe;
#[cfg(feature = "std")]
use super::probe::SortOnly;
use super::ranks::Ranks;
use super::sink::{Buffer, Count, Store, Stream};
use super::task::{Progress, ProgressCallback, Stop, Task};
use crate::geometry::check_count;
use crate::{Aabb, Error, Scalar, validate};

/// Whether updates, too, leave out of many boxes what lies near none of a few. Not in WebAssembly: that takes 2 KB after gzip,
/// which the smallest files do not have left. (Of updates only `pairs_unsorted` shows in what order pairs are found.)
const LEAVES_OUT_IN_UPDATES: bool = cfg!(not(target_arch = "wasm32"));

/// What a finder keeps between searches.
#[derive(Debug)]
pub(super) struct Buffers<const D: usize, T: Scalar> {
    pub driver: Driver<D, T>,
    near: Near<D, T>,
    pub store: Store,
    count: Count,
    ranks: Ranks<T>,
    pub buffer: Buffer,
}

impl<const D: usize, T: Scalar> Buffers<D, T> {
    pub fn new() -> Self {
        Self {
            driver: Driver::new(Kernel::best()),
            near: Near::default(),
            store: Store::default(),
            count: Count::default(),
            ranks: Ranks::default(),
            buffer: Buffer::default(),
        }
    }
}

/// A search for pairs, made by [`PairFinder::search`](crate::PairFinder::search): choose its options,
/// then how to receive the pairs.
///
/// ```
/// use std::ops::ControlFlow;
/// use sweep_and_prune::{Aabb, Error, PairFinder};
///
/// let boxes = vec![Aabb::new([0.0], [1.0]); 1000];
/// let mut finder = PairFinder::new();
/// assert_eq!(finder.search(&boxes).count()?, 499_500);
/// assert_eq!(finder.search(&boxes[..2]).against(&boxes).pairs()?.len(), 2000);
///
/// let cancel = |_done: f64| ControlFlow::Break(());
/// assert_eq!(finder.search(&boxes).progress(&cancel).count(), Err(Error::Cancelled));
/// # Ok::<(), Error>(())
/// ```
#[must_use = "a search does nothing before `pairs`, `count`, `for_each` or `for_each_chunk`"]
pub struct Search<'f, 'b, const D: usize, T: Scalar = f32> {
    buffers: &'f mut Buffers<D, T>,
    sets: Sets<'b, D, T>,
    progress: Option<ProgressCallback<'b>>,
}

/// The boxes of one set, or of two.
#[derive(Clone, Copy)]
struct Sets<'b, const D: usize, T: Scalar> {
    both: [&'b [Aabb<D, T>]; 2],
    are_two: bool,
}

impl<'b, const D: usize, T: Scalar> Sets<'b, D, T> {
    fn as_slice(&self) -> &[&'b [Aabb<D, T>]] {
        if self.are_two { &self.both } else { slice::from_ref(&self.both[0]) }
    }
}

impl<'f, 'b, const D: usize, T: Scalar> Search<'f, 'b, D, T> {
    #[inline]
    pub(super) fn new(buffers: &'f mut Buffers<D, T>, boxes: &'b [Aabb<D, T>]) -> Self {
        Self { buffers, sets: Sets { both: [boxes, &[]], are_two: false }, progress: None }
    }

    /// Searches for pairs of a box of the first set and a box of this one, instead of pairs within
    /// the first: `[index in the first set, index in this one]`.
    pub fn against(mut self, others: &'b [Aabb<D, T>]) -> Self {
        self.sets = Sets { both: [self.sets.both[0], others], are_two: true };
        self
    }

    /// Calls `report` now and then with the share of the work that is done, from 0 to 1, on whichever
    /// thread does the work. If it breaks, the search ends with [`Error::Cancelled`]. Short searches
    /// report nothing.
    pub fn progress(mut self, report: &'b (dyn Fn(f64) -> ControlFlow<()> + Sync)) -> Self {
        self.progress = Some(report);
        self
    }

    /// The nanoseconds that the search takes on one thread, by the model of its plan: of use to decide whether threads
    /// pay. 0 if a set is empty. Takes as long as a plan, some microseconds.
    #[doc(hidden)]
    pub fn expected_ns(&self) -> f64 {
        let sets = self.sets.as_slice();
        if sets.iter().any(|set| set.is_empty()) {
            return 0.0;
        }
        plan(sets, Among::All { is_crowded: false }).1
    }

    /// Finds the pairs, in a buffer that stays valid until the next search. They and their order are
    /// those of [`PairFinder::find`](crate::PairFinder::find).
    ///
    /// # Errors
    /// [`Error::InvalidBox`], [`Error::TooManyBoxes`], [`Error::OutOfMemory`], [`Error::Cancelled`].
    pub fn pairs(self) -> Result<&'f [[u32; 2]], Error> {
        let Self { buffers, sets, progress } = self;
        store(buffers, sets.as_slice(), progress, true)?;
        Ok(buffers.store.pairs())
    }

    /// Finds the pairs as [`pairs`](Self::pairs) does, unless there are more than `most`: then it gives up when it has found
    /// these and a buffer more on each thread, and there are none.
    pub(crate) fn pairs_up_to(self, most: usize) -> Result<Option<&'f mut [[u32; 2]]>, Error> {
        let Self { buffers, sets, .. } = self;
        buffers.store.most = most;
        let result = store(buffers, sets.as_slice(), None, LEAVES_OUT_IN_UPDATES);
        buffers.store.most = usize::MAX;
        match result {
            Err(Error::Cancelled) => Ok(None),
            // A buffer of an earlier search may have had space for more, on which the result must not depend.
            result => {
                result.map(|()| (buffers.store.len <= most).then(|| buffers.store.pairs_mut()))
            }
        }
    }

    /// Counts the pairs without storing them. In 1D without finding them: O(n) time where boxes are spread,
    /// however many pairs there are.
    ///
    /// # Errors
    /// As [`pairs`](Self::pairs).
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn count(self) -> Result<u64, Error> {
        let Self { buffers: Buffers { driver, near, count, ranks, .. }, sets, progress } = self;
        let sets = sets.as_slice();
        count.count = 0;
        if D == 1 && !is_brute_force(sets) && sets.iter().all(|set| !set.is_empty()) {
            return on_line(sets, progress, |task| ranks.pairs(sets, task, &driver.helpers));
        }
        run(driver, Some(near), sets, progress, count)?;
        Ok(count.count)
    }

    /// Counts for each box of the first set the boxes of the other set that overlap it; within one set, the other boxes. Stores
    /// no pairs. In 1D it does not find them either: O(n) time where boxes are spread, however many pairs there are. One thread.
    ///
    /// # Errors
    /// As [`pairs`](Self::pairs).
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let reads = [Aabb::new([0.0], [5.0]), Aabb::new([6.0], [9.0]), Aabb::new([20.0], [30.0])];
    /// let genes = [Aabb::new([1.0], [2.0]), Aabb::new([4.0], [7.0])];
    /// let mut finder = PairFinder::new();
    /// assert_eq!(finder.search(&reads).against(&genes).counts()?, [2, 1, 0]);
    /// assert_eq!(finder.search(&genes).counts()?, [0, 0]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn counts(self) -> Result<Vec<u32>, Error> {
        let copied = self.sets;
        let sets = copied.as_slice();
        if D == 1 && sets.iter().all(|set| !set.is_empty()) {
            let Buffers { ranks, .. } = self.buffers;
            return on_line(sets, self.progress, |task| ranks.counts(sets, task));
        }
        let mut counts = Vec::new();
        counts.try_reserve_exact(sets[0].len()).map_err(|_| Error::OutOfMemory)?;
        counts.resize(sets[0].len(), 0);
        let is_one = sets.len() == 1;
        let end = self.for_each_chunk(|pairs| {
            for &[a, b] in pairs {
                counts[a as usize] += 1;
                if is_one {
                    counts[b as usize] += 1;
                }
            }
            ControlFlow::<()>::Continue(())
        });
        end.map(|_| counts)
    }

    /// Calls `each` with every pair, in the order of [`pairs`](Self::pairs), until it breaks. Stores
    /// only a small buffer of pairs, so the memory does not depend on their number. One thread.
    ///
    /// # Errors
    /// As [`pairs`](Self::pairs). If a box is invalid, `each` has not been called.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let boxes = [Aabb::new([0.0], [1.0]); 1000];
    /// let first_of_7 = PairFinder::new().search(&boxes).for_each(|[a, b]| {
    ///     if a == 7 { ControlFlow::Break(b) } else { ControlFlow::Continue(()) }
    /// })?;
    /// assert_eq!(first_of_7, ControlFlow::Break(8));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn for_each<B>(
        self,
        mut each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_chunk(|pairs| pairs.iter().try_for_each(|&pair| each(pair)))
    }

    /// Calls `each` with chunks of 1 to 4096 pairs, in the order of [`pairs`](Self::pairs), until it
    /// breaks. Copying chunks takes less time than copying pairs one by one. One thread.
    ///
    /// # Errors
    /// As [`pairs`](Self::pairs). If a box is invalid, `each` has not been called.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let boxes = [Aabb::new([0.0], [1.0]); 1000];
    /// let mut pairs = 0;
    /// let end = PairFinder::new().search(&boxes).for_each_chunk(|chunk| {
    ///     pairs += chunk.len();
    ///     ControlFlow::<()>::Continue(())
    /// })?;
    /// assert_eq!((pairs, end), (499_500, ControlFlow::Continue(())));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn for_each_chunk<B>(
        self,
        each: impl FnMut(&[[u32; 2]]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let Self { buffers: Buffers { driver, near, buffer, .. }, sets, progress } = self;
        stream_to(each, buffer, |stream| {
            run_to_stream(driver, near, sets.as_slice(), progress, stream)
        })
    }

    /// Does all that [`count`](Self::count) does on one thread for more than a few hundred boxes, apart from
    /// the sweep: for benchmarks of the stages.
    ///
    /// # Errors
    /// As [`pairs`](Self::pairs).
    #[cfg(feature = "std")]
    #[doc(hidden)]
    pub fn sort_only(self) -> Result<(), Error> {
        let driver = &mut self.buffers.driver;
        let helpers = replace(&mut driver.helpers, Helpers::new());
        let other = Driver::new(driver.kernel);
        let mut sorting = replace(driver, other).with_probe::<SortOnly>();
        let mut count = Count::default();
        let near = Some(&mut self.buffers.near);
        let result = run(&mut sorting, near, self.sets.as_slice(), self.progress, &mut count);
        *driver = sorting.with_probe();
        driver.helpers = helpers;
        result
    }
}

impl<const D: usize, T: Scalar> fmt::Debug for Search<'_, '_, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let against = self.sets.as_slice().get(1);
        f.debug_struct("Search")
            .field("boxes", &self.sets.both[0].len())
            .field("against", &against.map(|set| set.len()))
            .field("progress", &self.progress.is_some())
            .finish_non_exhaustive()
    }
}

/// Stores the pairs. Not inline, so that `find` has little to save and restore for a few boxes.
#[inline(never)]
pub(super) fn store<const D: usize, T: Scalar>(
    buffers: &mut Buffers<D, T>,
    sets: &[&[Aabb<D, T>]],
    progress: Option<ProgressCallback<'_>>,
    leaves_out: bool,
) -> Result<(), Error> {
    let Buffers { driver, near, store, .. } = buffers;
    store.clear();
    let result = run(driver, leaves_out.then_some(near), sets, progress, store);
    match result {
        // Others may need what was reserved for pairs.
        Err(Error::OutOfMemory) => buffers.store = Store::default(),
        // How many were found before depends on the threads.
        Err(_) => buffers.store.clear(),
        Ok(()) => {}
    }
    result
}

/// Has `search` stream its pairs to `each` until that breaks, and returns how it ended.
pub(super) fn stream_to<B>(
    mut each: impl FnMut(&[[u32; 2]]) -> ControlFlow<B>,
    buffer: &mut Buffer,
    search: impl FnOnce(&mut Stream<'_>) -> Result<(), Error>,
) -> Result<ControlFlow<B>, Error> {
    let mut end = ControlFlow::Continue(());
    let mut each = |pairs: &[[u32; 2]]| match each(pairs) {
        ControlFlow::Continue(()) => ControlFlow::Continue(()),
        ControlFlow::Break(with) => {
            end = ControlFlow::Break(with);
            ControlFlow::Break(())
        }
    };
    match search(&mut Stream { buffer, each: &mut each }) {
        Err(Error::Cancelled) if end.is_break() => Ok(end),
        result => result.map(|()| end),
    }
}

/// A search for a function of the user, compiled once for all of them.
#[inline(never)]
fn run_to_stream<const D: usize, T: Scalar>(
    driver: &mut Driver<D, T>,
    near: &mut Near<D, T>,
    sets: &[&[Aabb<D, T>]],
    progress: Option<ProgressCallback<'_>>,
    stream: &mut Stream<'_>,
) -> Result<(), Error> {
    run(driver, Some(near), sets, progress, stream)
}

/// Searches sets that may be invalid.
#[inline]
pub(super) fn run<const D: usize, T: Scalar, P: Probe, O: Receiver>(
    driver: &mut Driver<D, T, P>,
    near: Option<&mut Near<D, T>>,
    sets: &[&[Aabb<D, T>]],
    progress: Option<ProgressCallback<'_>>,
    sink: &mut O,
) -> Result<(), Error> {
    let pair_order = if sets.len() == 1 { PairOrder::Ascending } else { PairOrder::BySet };
    if is_few(sets) && sets.iter().all(|set| set.iter().all(Aabb::is_valid)) {
        return send_few(sets, pair_order, sink).map_err(error);
    }
    run_many(driver, near, sets, pair_order, progress, sink)
}

/// Counts something of one or two sets of boxes on a line, which may be invalid.
#[inline(never)]
fn on_line<const D: usize, T: Scalar, R>(
    sets: &[&[Aabb<D, T>]],
    progress: Option<ProgressCallback<'_>>,
    count: impl FnOnce(Task<'_>) -> Result<R, Stop>,
) -> Result<R, Error> {
    sets.iter().try_for_each(|set| check_count(set.len()))?;
    let progress = progress.map(Progress::new);
    count(Task::new(PairOrder::BySet, progress.as_ref())).map_err(|stop| {
        let invalid = if stop == Stop::Invalid { check(sets) } else { Ok(()) };
        invalid.err().unwrap_or_else(|| error(stop))
    })
}

/// Checks what the driver does not check, and searches.
#[inline(never)]
fn run_many<const D: usize, T: Scalar, P: Probe, O: Receiver>(
    driver: &mut Driver<D, T, P>,
    near: Option<&mut Near<D, T>>,
    sets: &[&[Aabb<D, T>]],
    pair_order: PairOrder,
    progress: Option<ProgressCallback<'_>>,
    sink: &mut O,
) -> Result<(), Error> {
    sets.iter().try_for_each(|set| check_count(set.len()))?;
    let progress = progress.map(Progress::new);
    let task = Task::new(pair_order, progress.as_ref());
    let kept = near.map_or(Ok(None), |near| near.fill(sets));
    let end = kept.and_then(|kept| match kept {
        Some(kept) => driver.run(&kept, Task { is_checked: true, ..task }, sink),
        // The driver checks other sets on the way.
        None if is_brute_force(sets) && !sets.iter().all(is_valid) => Err(Stop::Invalid),
        None => driver.run(sets, task, sink),
    });
    match end {
        // Only now it is worth while to look for the box.
        Err(Stop::Invalid) => check(sets),
        end => end.map_err(error),
    }
}

/// The error of a search of valid boxes.
pub(super) fn error(stop: Stop) -> Error {
    match stop {
        Stop::Memory => Error::OutOfMemory,
        Stop::Invalid | Stop::TooMany | Stop::Cancelled => Error::Cancelled,
    }
}

/// Validates the sets in turn.
fn check<const D: usize, T: Scalar>(sets: &[&[Aabb<D, T>]]) -> Result<(), Error> {
    sets.iter().enumerate().try_for_each(|(set, boxes)| {
        validate(boxes).map_err(|error| match error {
            Error::InvalidBox { index, axis, min, max, .. } => {
                Error::InvalidBox { set, index, axis, min, max }
            }
            error => error,
        })
    })
}

#[cfg(test)]
mod tests {
    use crate::{Aabb, PairFinder};

    #[test]
    fn whether_there_are_too_many_pairs_depends_on_the_boxes_alone() {
        // All pairs fit in the first buffer.
        let few = [Aabb::new([0.0; 2], [1.0; 2]); 20];
        let many = [few[0]; 100];
        let mut used = PairFinder::new();
        used.find(&many).unwrap();
        for finder in [&mut PairFinder::new(), &mut used] {
            for (most, expected) in
                [(0, None), (189, None), (190, Some(190)), (usize::MAX, Some(190))]
            {
                let found = finder.search(&few).pairs_up_to(most).unwrap();
                assert_eq!(found.map(|pairs| pairs.len()), expected, "at most {most}");
            }
            assert_eq!(finder.find(&few).unwrap().len(), 190);
        }
    }
}
