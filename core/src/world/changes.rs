//! What an update reports.

use alloc::vec::Vec;
use core::slice;

use super::bodies::{ProxyId, Slots};
use crate::cloning::clone_fields;

/// What the last update found, as slots.
#[derive(Debug, Default)]
pub(super) struct Events {
    pub begun: Vec<[u32; 2]>,
    pub ended: Vec<[u32; 2]>,
    /// The bodies that were removed before that update, sorted: their slots may have new bodies.
    pub removed: Vec<ProxyId>,
}

clone_fields! {
    [] Events {
        begun, ended, removed,
    }
}

/// The pairs that began and those that ended between two updates.
///
/// Each pair comes once, its smaller id first, and both lists are sorted. A pair that began and
/// ended between the two updates is in neither list.
#[derive(Clone, Copy, Debug)]
pub struct Changes<'w> {
    pub(super) slots: &'w Slots,
    pub(super) events: &'w Events,
}

impl<'w> Changes<'w> {
    /// The pairs that overlap at this update and did not at the one before.
    pub fn begun(&self) -> Pairs<'w> {
        self.named(&self.events.begun)
    }

    /// The pairs that overlapped at the update before and do not at this one. They include pairs of
    /// removed bodies, whose ids are stale.
    pub fn ended(&self) -> Pairs<'w> {
        self.named(&self.events.ended)
    }

    /// Whether nothing began and nothing ended.
    pub fn is_empty(&self) -> bool {
        self.events.begun.is_empty() && self.events.ended.is_empty()
    }

    fn named(&self, pairs: &'w [[u32; 2]]) -> Pairs<'w> {
        Pairs { slots: self.slots, removed: &self.events.removed, pairs: pairs.iter() }
    }
}

/// Pairs of ids, smaller first, sorted.
#[derive(Clone, Debug)]
pub struct Pairs<'w> {
    slots: &'w Slots,
    removed: &'w [ProxyId],
    pairs: slice::Iter<'w, [u32; 2]>,
}

impl Pairs<'_> {
    /// The remaining pairs as pairs of [slots](ProxyId::slot): the cheapest form.
    pub fn slots(&self) -> &[[u32; 2]] {
        self.pairs.as_slice()
    }

    #[inline]
    fn name(&self, pair: &[u32; 2]) -> [ProxyId; 2] {
        pair.map(|slot| {
            if self.removed.is_empty() {
                return self.slots.id_of_slot(slot);
            }
            let found = self.removed.binary_search_by_key(&slot, |id| id.slot());
            found.map_or_else(|_| self.slots.id_of_slot(slot), |at| self.removed[at])
        })
    }
}

impl Iterator for Pairs<'_> {
    type Item = [ProxyId; 2];

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        self.pairs.next().map(|pair| self.name(pair))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.pairs.size_hint()
    }
}

impl DoubleEndedIterator for Pairs<'_> {
    fn next_back(&mut self) -> Option<Self::Item> {
        self.pairs.next_back().map(|pair| self.name(pair))
    }
}

impl ExactSizeIterator for Pairs<'_> {}
