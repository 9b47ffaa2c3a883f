//! What an update reports.

use core::slice;

use super::proxy::{ProxyId, Slots};

/// The pairs that began and those that ended between two updates.
///
/// Each pair comes once, its smaller id first, and both lists are sorted. A pair that began and
/// ended between the two is in neither.
#[derive(Clone, Copy, Debug)]
pub struct Changes<'w> {
    pub(super) slots: &'w Slots,
    pub(super) begun: &'w [[u32; 2]],
    pub(super) ended: &'w [[u32; 2]],
}

impl<'w> Changes<'w> {
    /// The pairs that overlap now and did not at the last update.
    pub fn begun(&self) -> Pairs<'w> {
        Pairs { slots: self.slots, pairs: self.begun.iter() }
    }

    /// The pairs that overlapped at the last update and do not now. The ids of bodies that were
    /// removed since are among them, and stale.
    pub fn ended(&self) -> Pairs<'w> {
        Pairs { slots: self.slots, pairs: self.ended.iter() }
    }

    /// Whether nothing began and nothing ended.
    pub fn is_empty(&self) -> bool {
        self.begun.is_empty() && self.ended.is_empty()
    }
}

/// Pairs of ids, smaller first, sorted.
#[derive(Clone, Debug)]
pub struct Pairs<'w> {
    slots: &'w Slots,
    pairs: slice::Iter<'w, [u32; 2]>,
}

impl Pairs<'_> {
    /// The pairs that are left, as pairs of [slots](ProxyId::slot): the cheapest form.
    pub fn slots(&self) -> &[[u32; 2]] {
        self.pairs.as_slice()
    }
}

impl Iterator for Pairs<'_> {
    type Item = [ProxyId; 2];

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.pairs.next().map(|pair| pair.map(|slot| self.slots.id_of_slot(slot)))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.pairs.size_hint()
    }
}

impl DoubleEndedIterator for Pairs<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        self.pairs.next_back().map(|pair| pair.map(|slot| self.slots.id_of_slot(slot)))
    }
}

impl ExactSizeIterator for Pairs<'_> {}
