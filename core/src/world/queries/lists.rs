//! Lists of lists, as one.

use alloc::vec::Vec;
use core::ops::{ControlFlow, Index};

use crate::memory::{OutOfMemory, reserve_for};

/// The results of many queries, a list for each, or the pairs of each body. Passed to queries again, they keep their memory.
///
/// ```
/// use sweep_and_prune::{Aabb, BroadPhase, Lists};
///
/// let mut world = BroadPhase::<1>::new();
/// let ids = world.insert_many(&[Aabb::new([0.0], [1.0]); 2], Default::default())?;
/// let mut lists = Lists::new();
/// for _frame in 0..3 {
///     world.queries().containing_many(&[[0.5], [7.0]], &mut lists)?;
///     assert_eq!((&lists[0], &lists[1]), (&ids[..], &[][..]));
/// }
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lists<V> {
    pub(super) ends: Vec<usize>,
    pub(super) values: Vec<V>,
}

impl<V> Lists<V> {
    /// No lists, without memory.
    pub const fn new() -> Self {
        Self { ends: Vec::new(), values: Vec::new() }
    }

    /// Lists of these values, one after another, and where each ends.
    pub(in crate::world) fn from_parts(ends: Vec<usize>, values: Vec<V>) -> Self {
        Self { ends, values }
    }

    /// Replaces the lists by one for each query, whose values `list` appends.
    ///
    /// # Errors
    /// [`OutOfMemory`] if `list` breaks, or there is no memory for a number for each query: then there are no lists, and no
    /// memory is kept.
    #[inline]
    pub(super) fn replace<Q>(
        &mut self,
        queries: &[Q],
        mut list: impl FnMut(&Q, &mut Vec<V>) -> ControlFlow<()>,
    ) -> Result<(), OutOfMemory> {
        self.begin(queries.len())?;
        for query in queries {
            if list(query, &mut self.values).is_break() {
                return self.fail();
            }
            self.ends.push(self.values.len());
        }
        Ok(())
    }

    #[inline(never)]
    fn begin(&mut self, count: usize) -> Result<(), OutOfMemory> {
        self.ends.clear();
        self.values.clear();
        reserve_for(&mut self.ends, count).or_else(|_| self.fail())
    }

    /// Drops the lists and their memory.
    ///
    /// # Errors
    /// Always.
    #[cold]
    #[inline(never)]
    pub(super) fn fail(&mut self) -> Result<(), OutOfMemory> {
        *self = Self::new();
        Err(OutOfMemory)
    }

    /// How many lists there are: one a query or slot.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether there is no list.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The lists in the order of the queries or slots.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[V]> {
        (0..self.len()).map(|query| &self[query])
    }

    /// All lists one after another.
    pub fn values(&self) -> &[V] {
        &self.values
    }

    /// Where each list ends in [`values`](Self::values); it begins where the one before ends.
    pub fn ends(&self) -> &[usize] {
        &self.ends
    }
}

impl<V> Default for Lists<V> {
    fn default() -> Self {
        Self::new()
    }
}

impl<V> Index<usize> for Lists<V> {
    type Output = [V];

    fn index(&self, query: usize) -> &[V] {
        let start = if query == 0 { 0 } else { self.ends[query - 1] };
        &self.values[start..self.ends[query]]
    }
}
