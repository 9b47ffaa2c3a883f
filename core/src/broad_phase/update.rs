//! The update: from boxes to the pairs that began and ended.

use alloc::vec::Vec;

use super::BroadPhase;
use super::changes::Changes;
use super::proxy::{ProxyId, flag};
use crate::finder::PairFinder;
use crate::{Aabb, Error, Scalar};

/// What updates keep from one to the next.
#[derive(Debug)]
pub(super) struct Updater<const D: usize, T: Scalar> {
    finder: PairFinder<D, T>,
    dense: Vec<Aabb<D, T>>,
    slot_of: Vec<u32>,
    live: Vec<[u32; 2]>,
    found: Vec<[u32; 2]>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

impl<const D: usize, T: Scalar> Clone for Updater<D, T> {
    fn clone(&self) -> Self {
        Self { live: self.live.clone(), ..Self::new() }
    }
}

impl<const D: usize, T: Scalar> Updater<D, T> {
    pub fn new() -> Self {
        Self {
            finder: PairFinder::new(),
            dense: Vec::new(),
            slot_of: Vec::new(),
            live: Vec::new(),
            found: Vec::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    /// Learns of a new body.
    pub fn add(&mut self, _slot: u32, _aabb: Aabb<D, T>) {}

    /// Takes over the live pairs of a snapshot, which are sorted.
    pub fn restore(&mut self, live: Vec<[u32; 2]>) {
        self.live = live;
    }

    /// The live pairs as slots, sorted.
    pub fn live(&self) -> &[[u32; 2]] {
        &self.live
    }
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports the pairs that began and ended since the last update.
    pub fn update(&mut self) -> Changes<'_> {
        let Updater { finder, dense, slot_of, live, found, begun, ended } = &mut self.updater;
        dense.clear();
        slot_of.clear();
        for slot in 0..self.slots.len() as u32 {
            if self.slots.has(slot, flag::LIVE) {
                dense.push(self.boxes[slot as usize]);
                slot_of.push(slot);
            }
        }
        found.clear();
        if let Ok(pairs) = finder.find(dense) {
            let as_slots = |&[a, b]: &[u32; 2]| [slot_of[a as usize], slot_of[b as usize]];
            let filters = &self.filters;
            let allowed = |[a, b]: &[u32; 2]| filters[*a as usize].allows(&filters[*b as usize]);
            found.extend(pairs.iter().map(as_slots).filter(allowed));
        }
        found.sort_unstable();
        begun.clear();
        ended.clear();
        let mut before = live.iter().copied().peekable();
        for &pair in found.iter() {
            while let Some(gone) = before.next_if(|&old| old < pair) {
                ended.push(gone);
            }
            if before.next_if_eq(&pair).is_none() {
                begun.push(pair);
            }
        }
        ended.extend(before);
        core::mem::swap(live, found);

        for slot in self.changed.drain(..) {
            self.slots.lower(slot, flag::CHANGED | flag::IRREGULAR);
        }
        for slot in self.leaving.drain(..) {
            self.slots.release(slot);
        }
        self.settle();
        let Updater { begun, ended, .. } = &self.updater;
        Changes { slots: &self.slots, begun, ended }
    }

    /// The pairs that overlapped at the last update, sorted.
    pub fn pairs(&self) -> Vec<[ProxyId; 2]> {
        let id = |slot| self.slots.id(slot);
        self.updater.live.iter().map(|pair| pair.map(id)).collect()
    }

    /// The bodies that overlapped this one at the last update, sorted.
    ///
    /// # Errors
    /// [`Error::StaleProxy`].
    pub fn pairs_of(&mut self, id: ProxyId) -> Result<Vec<ProxyId>, Error> {
        let slot = self.slots.check(id, 0)?;
        let others = self
            .updater
            .live
            .iter()
            .filter_map(|&[a, b]| if a == slot { Some(b) } else { (b == slot).then_some(a) });
        let mut others: Vec<_> = others.map(|slot| self.slots.id(slot)).collect();
        others.sort_unstable();
        Ok(others)
    }
}
