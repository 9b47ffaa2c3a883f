//! The pairs whose fat boxes overlap: those that may begin or end without anyone leaving his fat
//! box. Each knows whether it is live, that is whether the last update counted it as overlapping.
//!
//! Those of which a body is awake stand in one flat list, which every update with motion goes
//! through from front to back. Of two bodies asleep (`sleep`) only what is live is kept, for whoever
//! asks: before one of them can begin or end a pair it wakes, and the tree tells its candidates.

use alloc::vec::Vec;

use super::proxy::{Slots, flag};
use super::sort::PairSorter;

#[derive(Clone, Debug, Default)]
pub(super) struct Candidates {
    /// Seats, smaller first: the pairs, each once, whose fat boxes overlap, whose filters allow them
    /// and of which at least one body is awake.
    pub pairs: Vec<[u32; 2]>,
    /// By pair.
    pub live: Vec<bool>,
    /// The live pairs of bodies that are both asleep, and some of which one woke or left.
    pub asleep: Vec<[u32; 2]>,
    /// Where all pairs are found anew (`anew`), the live ones, sorted: then the lists are empty, nobody
    /// is asleep, and seats are slots.
    pub sorted: Vec<[u32; 2]>,
    /// Whether it is so.
    pub are_sorted: bool,
}

impl Candidates {
    /// Lists the live pairs, as slots, sorted, and forgets all others.
    pub fn sort(&mut self, slots: &Slots, sorter: &mut PairSorter) {
        if !self.are_sorted {
            let mut sorted = core::mem::take(&mut self.sorted);
            sorted.extend(self.live_pairs(slots));
            slots.name_pairs(&mut sorted);
            sorter.sort(&mut sorted, slots.len());
            self.clear();
            (self.sorted, self.are_sorted) = (sorted, true);
        }
    }

    /// Makes those that are [sorted](Self::sort) the candidates again.
    pub fn unsort(&mut self) {
        if core::mem::take(&mut self.are_sorted) {
            self.pairs.append(&mut self.sorted);
            self.live.resize(self.pairs.len(), true);
        }
    }

    /// Forgets all pairs.
    pub fn clear(&mut self) {
        self.pairs.clear();
        self.live.clear();
        self.asleep.clear();
    }

    /// The live pairs, in no particular order.
    pub fn live_pairs<'a>(&'a self, slots: &'a Slots) -> impl Iterator<Item = [u32; 2]> + 'a {
        let awake = self.pairs.iter().zip(&self.live).filter(|(_, is_live)| **is_live);
        let awake = awake.map(|(&pair, _)| pair).chain(self.asleep_pairs(slots));
        awake.chain(self.sorted.iter().copied())
    }

    /// The live pairs of bodies that are both asleep.
    pub fn asleep_pairs<'a>(&'a self, slots: &'a Slots) -> impl Iterator<Item = [u32; 2]> + 'a {
        self.asleep.iter().copied().filter(|pair| are_asleep(slots, pair))
    }

    /// Gives the bodies other seats.
    pub fn rename(&mut self, renamed: &[u32]) {
        for pair in self.pairs.iter_mut().chain(&mut self.asleep) {
            let [a, b] = pair.map(|seat| renamed[seat as usize]);
            *pair = [a.min(b), a.max(b)];
        }
    }

    /// Makes room for what moving bodies add, so that it need not be found later.
    pub fn reserve(&mut self) {
        let count = self.pairs.len();
        if self.pairs.capacity() - count < count / 4 {
            self.pairs.reserve(count);
        }
        self.live.reserve(self.pairs.capacity() - self.live.len());
    }

    /// Puts a pair into a place that is free, or else to the end.
    #[inline]
    pub fn put(&mut self, place: Option<&usize>, pair: [u32; 2], is_live: bool) {
        if let Some(&at) = place {
            self.pairs[at] = pair;
            self.live[at] = is_live;
        } else {
            self.pairs.push(pair);
            self.live.push(is_live);
        }
    }

    /// Removes the pairs at these places, which ascend. The others keep their order, which is that of
    /// their boxes in memory, more or less.
    pub fn remove(&mut self, places: &[usize]) {
        let Some(&first) = places.first() else { return };
        let mut kept = first;
        for (index, &place) in places.iter().enumerate() {
            let end = places.get(index + 1).map_or(self.pairs.len(), |&next| next);
            self.pairs.copy_within(place + 1..end, kept);
            self.live.copy_within(place + 1..end, kept);
            kept += end - place - 1;
        }
        self.pairs.truncate(kept);
        self.live.truncate(kept);
    }

    /// Takes the pairs of bodies that are both asleep out of the list, and those that `is_near` does
    /// not hold for.
    pub fn put_to_sleep(&mut self, slots: &Slots, is_near: impl Fn([u32; 2]) -> bool) {
        let mut kept = 0;
        for at in 0..self.pairs.len() {
            let (pair, is_live) = (self.pairs[at], self.live[at]);
            let sleeps = are_asleep(slots, &pair);
            if sleeps && is_live {
                self.asleep.push(pair);
            }
            self.pairs[kept] = pair;
            self.live[kept] = is_live;
            kept += usize::from(!sleeps && is_near(pair));
        }
        self.pairs.truncate(kept);
        self.live.truncate(kept);
    }
}

pub(super) fn are_asleep(slots: &Slots, pair: &[u32; 2]) -> bool {
    pair.iter().all(|&seat| slots.has(seat, flag::ASLEEP))
}
