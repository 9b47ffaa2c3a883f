//! Find pairs: the fast road.
//!
//! ```text
//! boxes -> plan -> bins -> order -> sweep -> pairs
//! ```
//!
//! One sweep along one axis tests every box against all that overlap it on that axis: n^(5/3) of
//! them in space, hopeless at a million. So the other axes are cut into columns, each of which is
//! swept by itself, small enough for the caches:
//!
//! 1. [`plan`] draws a sample of at most 256 boxes and chooses the sweep axis and the number of
//!    columns on the others for which a model of the cost is least.
//! 2. [`bins`] lists the copies of each box, one for each column that it touches, and scatters
//!    them as records, one column's side by side. Neither loop has a branch that depends on where
//!    a box lies. Boxes are validated on the way.
//! 3. [`order`] sorts a column by left edge, in linear time if the edges are spread at all evenly,
//!    and lays it out as a structure of arrays.
//! 4. [`sweep`] has a kernel test each box against those ahead, 1 to 16 at a time on all axes,
//!    until a left edge passes its right edge.
//!
//! A pair that meets in several columns is reported by the one that holds the lower corner of the
//! two boxes' intersection: where at least one of the two begins, on each cut axis. A bit for each
//! axis tells that, and is tested along with the edges.
//!
//! # Why it is never slow
//! **Copies.** A box of size s touches 1 + s / w columns of width w on the average, so the mean
//! size of the boxes, not the largest, says how many copies there will be: a plan that pays makes
//! 1.2 to 1.6 of each. The sample estimates the mean; what it missed is found when the copies are
//! listed: at more than 4 a box the plan is dropped, and the boxes that are wider than 8 columns
//! are parted from the rest.
//!
//! **Tests.** Where no width of columns suits all the boxes (one in ten spans the scene), the model
//! finds a plan dear, and looks for a size on some axis that parts the small boxes from the large.
//! Then pairs within the small ones, within the large ones and between the two are three searches,
//! each with the axis and the columns that suit it; and each may part again. That takes care of
//! needles along every axis and of power laws.
//!
//! **Clusters.** Columns of one width do not suit a scene that is dense here and sparse there. The
//! model knows how likely two boxes are to share a column from a histogram of the sample at eleven
//! resolutions; and a bin that holds far more boxes than expected, or whose sweep would test far
//! more candidates (probes of the ordered column tell), is planned anew by itself, as if it were
//! the whole. Plans are nested at most 12 deep. A cluster in a cluster costs one more pass over the
//! boxes in it.
//!
//! **Long columns** (a tower has only one) are cut along the sweep axis too, into slabs that fit the
//! caches and that threads can share.
//!
//! **A few against very many**: of the larger set only those are copied to a column that meet one of
//! the smaller there, and the model knows that: 100 boxes against 100,000 get so many columns that
//! most are empty, and take a third of the time that all pairs of the 100,000 do.
//!
//! **Coincident and nested boxes** are pairs, all of them; nothing is tested in vain.
//!
//! # Why it is the same everywhere
//! Cells come of one monotone function of a coordinate, so that a box cannot begin after it ends,
//! whatever rounds, overflows or is infinite; what they decide is where a pair is found, never
//! whether it is one: that takes comparisons of the coordinates as given. The plan depends on the
//! boxes alone, the order in a column is total (left edge, then position), and the vectors' lanes
//! are reported in turn: so the order of the pairs depends on neither processor nor threads. Behind
//! the last box of a column stand NaN edges, which are `<=` nothing: unlike infinite sentinels they
//! stop the sweep of an infinite box too.
//!
//! # Threads
//! Each lists which bins a stretch of the boxes goes to and counts them; the counts of all give each
//! its places in every bin, so that all copy their boxes into the same array, in the order in which
//! one thread would. Then each takes the next group of bins, the calling thread from the first on,
//! whose pairs it stores where they belong, the others from the last; their pairs are put behind
//! when all is done.
//!
//! # Memory
//! A record is a box, its index and a word: 32 bytes for a 3D `f32` box. With 1.2 to 1.6 copies of
//! each, the list of them (8 bytes a copy), and one bin laid out at a time, a finder holds less than
//! four times what the boxes themselves take, beside the pairs and 32 bytes a box. Where plans nest
//! (giants, half-spaces, scales within scales) each holds its own records: at most 4 copies of its
//! boxes, and one more where it parts them. On the scenes of the tests that comes to 10 times what
//! the boxes take, and to 34 times for needles that cross each other in the plane. All of it is
//! kept for the next call: a steady state allocates nothing. Streaming and counting take the same,
//! and nothing for the pairs, whose buffer doubles when it is full. On Linux arrays of megabytes ask
//! for pages of 2 MiB, whole ones only: a million boxes are found in 0.92 to 0.95 of the time, and in
//! the first call in two thirds. Where the system refuses memory
//! the call ends with [`Error::OutOfMemory`] and the buffer of pairs is given back.
//!
//! # Sources
//! Baraff 1992 (sort and sweep); Terdiman 2017, *Box pruning revisited* (structure of arrays,
//! sentinels, vector tests, buckets); Dittrich and Seeger 2000, *Data redundancy and duplicate
//! detection in spatial join processing* (a pair is reported where the lower corner of its
//! intersection lies).

mod bins;
#[cfg(feature = "parallel")]
mod gather;
mod grid;
mod kernel;
mod list;
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

use crate::geometry::check_count;
use crate::{Aabb, Error, Scalar, validate};
use kernel::Arrange;
pub use kernel::Kernel;
pub use numbers::Number;
use search::{Search, Stop, Task, few, is_direct, is_tiny, very_few};
use sink::{Buffer, Count, Sink, Store, Stream};
use watch::Watch;

/// All pairs of boxes that overlap, each once, smaller index first, in a deterministic order.
///
/// Touching boxes overlap. O(n log n + pairs) time on scenes that anything helps with, and memory
/// O(n + pairs): see [`PairFinder`], which keeps its memory from call to call.
///
/// # Errors
/// [`Error::InvalidBox`] with the index of the first box that is inverted or NaN,
/// [`Error::TooManyBoxes`], or [`Error::OutOfMemory`].
pub fn find_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<Vec<[u32; 2]>, Error> {
    let mut store = Store::default();
    if few(boxes, &mut store) {
        return Ok(store.into_pairs());
    }
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
    count: Count,
    buffer: Buffer,
}

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// A finder with empty buffers, one thread, and the best kernel of this processor.
    pub fn new() -> Self {
        Self {
            search: Search::new(Kernel::best()),
            store: Store::default(),
            count: Count::default(),
            buffer: Buffer::default(),
        }
    }

    /// The same finder with a kernel of choice, for tests and comparisons. Without `std` there is
    /// no choice: others than the best are not compiled.
    #[cfg(feature = "std")]
    #[must_use]
    pub fn kernel(mut self, kernel: Kernel) -> Self {
        self.search.kernel = kernel;
        self
    }

    /// The same finder at work on so many threads of rayon's current pool, one if 0 is given.
    /// [`for_each`](Self::for_each), and sets too small to profit, stay with one.
    ///
    /// Pairs wait for those before them: in the first call that takes as much memory again as they
    /// do, in later calls most find their places made. Each call allocates a few short lists.
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
    #[inline]
    pub fn find(&mut self, boxes: &[Aabb<D, T>]) -> Result<&[[u32; 2]], Error> {
        // A call for a handful of boxes takes little longer than their tests.
        if !few(boxes, &mut self.store) {
            self.find_of(&[boxes], None)?;
        }
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
    /// pairs to return. Searches that take no time to speak of are not watched.
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

    /// As [`find_between`](Self::find_between), watched as [`find_watched`](Self::find_watched) is.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    pub fn find_between_watched(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
        watch: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> Result<Option<&[[u32; 2]]>, Error> {
        let complete = self.find_of(&[a, b], Some(&Watch::new(watch)))?;
        Ok(complete.then(|| self.store.pairs()))
    }

    /// How many pairs [`find`](Self::find) would find. Stores none of them.
    ///
    /// # Errors
    /// As [`find_pairs`].
    pub fn count(&mut self, boxes: &[Aabb<D, T>]) -> Result<u64, Error> {
        self.count_of(&[boxes], None).map(|count| count.unwrap_or(0))
    }

    /// As [`count`](Self::count), watched as [`find_watched`](Self::find_watched) is.
    ///
    /// # Errors
    /// As [`find_pairs`].
    pub fn count_watched(
        &mut self,
        boxes: &[Aabb<D, T>],
        watch: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> Result<Option<u64>, Error> {
        self.count_of(&[boxes], Some(&Watch::new(watch)))
    }

    /// How many pairs [`find_between`](Self::find_between) would find. Stores none of them.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    pub fn count_between(&mut self, a: &[Aabb<D, T>], b: &[Aabb<D, T>]) -> Result<u64, Error> {
        self.count_of(&[a, b], None).map(|count| count.unwrap_or(0))
    }

    /// As [`count_between`](Self::count_between), watched as [`find_watched`](Self::find_watched)
    /// is.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    pub fn count_between_watched(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
        watch: &(dyn Fn(f64) -> ControlFlow<()> + Sync),
    ) -> Result<Option<u64>, Error> {
        self.count_of(&[a, b], Some(&Watch::new(watch)))
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
        mut each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_slice(boxes, |pairs| pairs.iter().try_for_each(|&pair| each(pair)))
    }

    /// As [`for_each`](Self::for_each), with the pairs of [`find_between`](Self::find_between).
    ///
    /// # Errors
    /// As [`find_pairs_between`]; then `each` has not been called.
    pub fn for_each_between<B>(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
        mut each: impl FnMut([u32; 2]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_slice_between(a, b, |pairs| pairs.iter().try_for_each(|&pair| each(pair)))
    }

    /// As [`for_each`](Self::for_each), some pairs at a time, as they are found: at least one and
    /// at most 4096. To copy them takes less time so than one by one.
    ///
    /// # Errors
    /// As [`find_pairs`]; then `each` has not been called.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let boxes = [Aabb::new([0.0], [1.0]); 1000];
    /// let mut pairs = 0;
    /// let end = PairFinder::new().for_each_slice(&boxes, |some| {
    ///     pairs += some.len();
    ///     ControlFlow::<()>::Continue(())
    /// })?;
    /// assert_eq!((pairs, end), (499_500, ControlFlow::Continue(())));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn for_each_slice<B>(
        &mut self,
        boxes: &[Aabb<D, T>],
        each: impl FnMut(&[[u32; 2]]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_of(&[boxes], each)
    }

    /// As [`for_each_slice`](Self::for_each_slice), with the pairs of
    /// [`find_between`](Self::find_between).
    ///
    /// # Errors
    /// As [`find_pairs_between`]; then `each` has not been called.
    pub fn for_each_slice_between<B>(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
        each: impl FnMut(&[[u32; 2]]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        self.for_each_of(&[a, b], each)
    }

    /// All that [`count`](Self::count) does of more than a few hundred boxes but the sweep, for
    /// benchmarks that tell the stages apart.
    ///
    /// # Errors
    /// As [`find_pairs`].
    #[cfg(feature = "std")]
    #[doc(hidden)]
    pub fn order(&mut self, boxes: &[Aabb<D, T>]) -> Result<(), Error> {
        run(&mut self.search, &[boxes], None, &mut sink::Unswept).map(|_| ())
    }

    /// Not inline, so that `find` has little to save and restore for a handful of boxes.
    #[inline(never)]
    fn find_of(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        watch: Option<&Watch<'_>>,
    ) -> Result<bool, Error> {
        self.store.clear();
        let complete = run(&mut self.search, sets, watch, &mut self.store);
        if complete == Err(Error::OutOfMemory) {
            // What was reserved for pairs is what others may lack.
            self.store = Store::default();
        }
        complete
    }

    /// None if the watch ended it.
    fn count_of(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        watch: Option<&Watch<'_>>,
    ) -> Result<Option<u64>, Error> {
        self.count.count = 0;
        let complete = run(&mut self.search, sets, watch, &mut self.count)?;
        Ok(complete.then_some(self.count.count))
    }

    fn for_each_of<B>(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        mut each: impl FnMut(&[[u32; 2]]) -> ControlFlow<B>,
    ) -> Result<ControlFlow<B>, Error> {
        let mut end = ControlFlow::Continue(());
        let each = |pairs: &[[u32; 2]]| match each(pairs) {
            ControlFlow::Continue(()) => ControlFlow::Continue(()),
            ControlFlow::Break(with) => {
                end = ControlFlow::Break(with);
                ControlFlow::Break(())
            }
        };
        let mut sink = Stream { buffer: &mut self.buffer, each };
        run(&mut self.search, sets, None, &mut sink)?;
        Ok(end)
    }
}

impl<const D: usize, T: Scalar> Default for PairFinder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}

/// Searches sets that may be invalid. False if it was ended early.
#[inline]
fn run<const D: usize, T: Scalar, O: Sink>(
    search: &mut Search<D, T>,
    sets: &[&[Aabb<D, T>]],
    watch: Option<&Watch<'_>>,
    sink: &mut O,
) -> Result<bool, Error> {
    let arrange = if sets.len() == 1 { Arrange::Ascending } else { Arrange::BySet };
    if is_tiny(sets) && sets.iter().all(|set| set.iter().all(Aabb::is_valid)) {
        return ended(very_few(sets, arrange, sink));
    }
    run_many(search, sets, Task::new(arrange, watch), sink)
}

/// Checks the sets as far as the search does not, and searches.
#[inline(never)]
fn run_many<const D: usize, T: Scalar, O: Sink>(
    search: &mut Search<D, T>,
    sets: &[&[Aabb<D, T>]],
    task: Task<'_>,
    sink: &mut O,
) -> Result<bool, Error> {
    sets.iter().try_for_each(|set| check_count(set.len()))?;
    // Others are validated on the way.
    if is_direct(sets) {
        check(sets)?;
    }
    match search.run(sets, task, sink) {
        // Only now is it worth a look which box it is.
        Err(Stop::Invalid) => check(sets).map(|()| false),
        end => ended(end),
    }
}

/// Whether a search of valid boxes came to its end.
#[inline]
fn ended(end: Result<(), Stop>) -> Result<bool, Error> {
    match end {
        Ok(()) => Ok(true),
        Err(Stop::Memory) => Err(Error::OutOfMemory),
        Err(_) => Ok(false),
    }
}

/// Validates the sets in turn. Indices go on from set to set.
fn check<const D: usize, T: Scalar>(sets: &[&[Aabb<D, T>]]) -> Result<(), Error> {
    let mut before = 0;
    for set in sets {
        validate(set).map_err(|error| match error {
            Error::InvalidBox { index, axis, min, max } => {
                Error::InvalidBox { index: before + index, axis, min, max }
            }
            error => error,
        })?;
        before += set.len();
    }
    Ok(())
}
