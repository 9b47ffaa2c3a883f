//! Lists of lists, as one.

use alloc::vec::Vec;
use core::ops::Index;

/// The results of many queries, a list for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Lists<V> {
    pub(super) ends: Vec<usize>,
    pub(super) values: Vec<V>,
}

impl<V> Lists<V> {
    pub(super) fn new() -> Self {
        Self { ends: Vec::new(), values: Vec::new() }
    }

    /// Ends the list of the values that were added since the last one.
    pub(super) fn end(&mut self) {
        self.ends.push(self.values.len());
    }

    /// How many lists there are: one a query.
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Whether no query was asked.
    pub fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    /// The lists in the order of the queries.
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

impl<V> Index<usize> for Lists<V> {
    type Output = [V];

    fn index(&self, query: usize) -> &[V] {
        let start = if query == 0 { 0 } else { self.ends[query - 1] };
        &self.values[start..self.ends[query]]
    }
}
