//! The finder, and functions that find the pairs of one or two sets once.

use alloc::vec::Vec;
use core::mem::take;

use super::brute::find_few;
#[cfg(feature = "parallel")]
use super::driver::Driver;
#[cfg(feature = "std")]
use super::kernel::Kernel;
use super::search::{Buffers, Search, store};
use super::sink::Store;
use crate::{Aabb, Error, Scalar};

/// Finds all pairs of boxes that overlap, each once, smaller index first, in a deterministic order.
///
/// Touching boxes overlap. Takes O(n log n + pairs) time on typical inputs, and O(n + pairs) memory. A
/// [`PairFinder`] keeps its memory from call to call.
///
/// # Errors
/// [`Error::InvalidBox`] with the index of the first box that is inverted or NaN,
/// [`Error::TooManyBoxes`], or [`Error::OutOfMemory`].
#[cfg_attr(not(target_arch = "wasm32"), inline(never))]
pub fn find_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<Vec<[u32; 2]>, Error> {
    let mut few = Store::default();
    if find_few(boxes, &mut few) {
        return Ok(few.into_pairs());
    }
    let mut buffers = Buffers::new();
    store(&mut buffers, &[boxes], None, true)?;
    Ok(buffers.store.into_pairs())
}

/// Finds all pairs of a box of `a` and a box of `b` that overlap, as `[index in a, index in b]`, each
/// once, in a deterministic order.
///
/// Otherwise as [`find_pairs`].
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
/// As [`find_pairs`]. [`Error::InvalidBox`] names the set: 0 for `a`, 1 for `b`.
#[cfg_attr(not(target_arch = "wasm32"), inline(never))]
pub fn find_pairs_between<const D: usize, T: Scalar>(
    a: &[Aabb<D, T>],
    b: &[Aabb<D, T>],
) -> Result<Vec<[u32; 2]>, Error> {
    let mut buffers = Buffers::new();
    store(&mut buffers, &[a, b], None, true)?;
    Ok(buffers.store.into_pairs())
}

/// Counts the pairs that [`find_pairs`] would find, without storing them.
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
#[cfg_attr(not(target_arch = "wasm32"), inline(never))]
pub fn count_pairs<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<u64, Error> {
    PairFinder::new().search(boxes).count()
}

/// Finds pairs again and again, and keeps its buffers between calls: a steady state allocates nothing.
///
/// The pairs and their order depend on the boxes alone: not on the processor, the number of threads, or
/// what the finder found before.
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
pub struct PairFinder<const D: usize, T: Scalar = f32>(pub(super) Buffers<D, T>);

impl<const D: usize, T: Scalar> PairFinder<D, T> {
    /// A finder with empty buffers, one thread, and the best kernel of this processor.
    pub fn new() -> Self {
        Self(Buffers::new())
    }

    /// Uses this kernel, for tests and comparisons. Without `std` there is no choice: only the best
    /// kernel is compiled.
    #[cfg(feature = "std")]
    #[must_use]
    pub fn kernel(mut self, kernel: Kernel) -> Self {
        let driver = &mut self.0.driver;
        driver.kernel = kernel;
        driver.helpers.for_each(|helper| helper.kernel = kernel);
        self
    }

    /// Uses this many threads of rayon's current pool; 0 counts as 1. [`Search::for_each`],
    /// [`Search::for_each_chunk`], and sets too small to profit use one. Pairs wait for those before them.
    /// In the first call, this takes as much memory again as the pairs; in later calls most are stored in
    /// their final place. Each call allocates a few short lists, without memory for which the program ends.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        let driver = &mut self.0.driver;
        let kernel = driver.kernel;
        driver.helpers.resize(threads.max(1) - 1, || Driver::new(kernel));
        self
    }

    /// Uses all threads of rayon's current pool, which has one for each processor unless you made it: see
    /// [`threads`](Self::threads).
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn all_threads(self) -> Self {
        self.threads(rayon::current_num_threads())
    }

    /// Finds the pairs of [`find_pairs`], in a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs`].
    #[inline]
    pub fn find(&mut self, boxes: &[Aabb<D, T>]) -> Result<&[[u32; 2]], Error> {
        // A call for a handful of boxes takes little longer than their tests.
        if !find_few(boxes, &mut self.0.store) {
            store(&mut self.0, &[boxes], None, true)?;
        }
        Ok(self.0.store.pairs())
    }

    /// Finds the pairs of [`find_pairs_between`], in a buffer that stays valid until the next call.
    ///
    /// # Errors
    /// As [`find_pairs_between`].
    #[cfg_attr(not(target_arch = "wasm32"), inline(never))]
    pub fn find_between(
        &mut self,
        a: &[Aabb<D, T>],
        b: &[Aabb<D, T>],
    ) -> Result<&[[u32; 2]], Error> {
        self.search(a).against(b).pairs()
    }

    /// The pairs of the last search, without a copy: the finder gives up their buffer, and the next
    /// search begins with an empty one. After a search that ended with an error there are none.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, PairFinder};
    ///
    /// let mut finder = PairFinder::new();
    /// finder.find(&[Aabb::new([0.0], [1.0]); 3])?;
    /// assert_eq!(finder.take_pairs(), [[0, 1], [0, 2], [1, 2]]);
    /// assert_eq!(finder.take_pairs(), [[0; 2]; 0]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    pub fn take_pairs(&mut self) -> Vec<[u32; 2]> {
        take(&mut self.0.store).into_pairs()
    }

    /// How many pairs fit the memory that is kept for them.
    pub(crate) fn capacity(&self) -> usize {
        self.0.store.capacity()
    }

    /// A search with options, whose pairs can also be counted or received one by one: see [`Search`].
    pub fn search<'f, 'b>(&'f mut self, boxes: &'b [Aabb<D, T>]) -> Search<'f, 'b, D, T> {
        Search::new(&mut self.0, boxes)
    }
}

impl<const D: usize, T: Scalar> Default for PairFinder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}
