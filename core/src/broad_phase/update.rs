//! The update: from boxes that changed to the pairs that began and ended.
//!
//! Every body has a fat box around its box, and the pairs of fat boxes are kept as candidates. As
//! long as bodies stay within their fat boxes only candidates can begin or end, and an update
//! tests those of the bodies that moved. A body that leaves its fat box gets a new one, which
//! reaches ahead in the direction of its motion, and a tree tells what that overlaps (`follow`).
//! When so many leave that it is cheaper, the finder finds all candidates anew (`rebuild`).
//!
//! Neither the fat boxes nor the choice of the way show in what is reported. A pair is live if
//! the last update knew both bodies, their boxes then overlapped and their filters then allowed
//! it: that is a fact about boxes and filters, whatever else is kept.

use alloc::vec::Vec;

use super::BroadPhase;
use super::changes::Changes;
use super::options::contains;
use super::proxy::{ProxyId, flag};
use super::sort::PairSorter;
use super::updater::{TreeState, Updater};
use super::warm::warm;
use crate::{Aabb, Scalar};

/// To follow a body that left its fat box costs as much as to find the candidates of so many
/// bodies anew.
const REBUILD: usize = 6;

/// To look at a body out of order takes as long as to pass over so many in order.
pub(super) const SOME: usize = 16;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports the pairs that began and ended since the last update.
    ///
    /// Time in proportion to the bodies that changed and their neighbours, and not much more than
    /// finding all pairs takes.
    pub fn update(&mut self) -> Changes<'_> {
        self.updater.begun.clear();
        self.updater.ended.clear();
        self.find_escaped();
        let moves = self.updater.scratch.escaped.len() + self.leaving.len();
        let mut is_worn = false;
        if moves * REBUILD > self.len() {
            is_worn = self.rebuild();
        } else {
            self.follow();
        }
        let slots = self.slots.len();
        let Updater { scratch, begun, ended, .. } = &mut self.updater;
        for pairs in [begun, ended] {
            self.slots.name_pairs(pairs);
            scratch.sorter.sort(pairs, slots);
        }
        self.end_update();
        if is_worn {
            self.deal_seats();
        }
        let Updater { begun, ended, .. } = &self.updater;
        Changes { slots: &self.slots, begun, ended }
    }

    /// Lists the bodies that need a new fat box: those that left theirs, are new, or may pair with
    /// others than before. Leaves each changed body that lives in the list of the changed, once.
    fn find_escaped(&mut self) {
        let Updater { fat, scratch, .. } = &mut self.updater;
        scratch.escaped.clear();
        let slots = &mut self.slots;
        let boxes = &self.boxes;
        let settled = !(flag::CHANGED | flag::KNOWN);
        // Whether a body that changed needs a new fat box.
        let escapes = |flags: u8, at: usize| {
            (flags & (flag::NEW | flag::REFILTERED) != 0) | !contains(&fat[at], &boxes[at])
        };
        if self.changed.len() * SOME > slots.len() {
            // In the order of the seats, which is faster than that of the calls.
            self.changed.clear();
            push_wanted(&mut self.changed, &slots.flags, |seat, flags| {
                (seat as u32, flags & (flag::CHANGED | flag::LIVE) == flag::CHANGED | flag::LIVE)
            });
            warm(boxes);
            warm(fat);
            push_wanted(&mut scratch.escaped, &self.changed, |_, seat| {
                let at = seat as usize;
                (seat, escapes(slots.flags[at], at))
            });
            slots.flags.iter_mut().for_each(|flags| *flags &= settled);
            return;
        }
        self.changed.retain(|&seat| {
            let at = seat as usize;
            let flags = slots.flags[at];
            slots.flags[at] &= settled;
            let is_first = flags & (flag::CHANGED | flag::LIVE) == flag::CHANGED | flag::LIVE;
            if is_first && escapes(flags, at) {
                scratch.escaped.push(seat);
            }
            is_first
        });
    }

    /// Makes the world of now the world of the last update.
    fn end_update(&mut self) {
        let Updater { previous, tree_state, any_refiltered, .. } = &mut self.updater;
        if self.changed.len() * SOME > self.slots.len() {
            // The others' are the same, or mean nothing.
            previous.copy_from_slice(&self.boxes);
            let known = !(flag::NEW | flag::REFILTERED);
            self.slots.flags.iter_mut().for_each(|flags| *flags &= known);
        } else {
            for &seat in &self.changed {
                previous[seat as usize] = self.boxes[seat as usize];
                self.slots.lower(seat, flag::NEW | flag::REFILTERED);
            }
        }
        self.changed.clear();
        *any_refiltered = false;
        if let TreeState::Fresh { known } = tree_state {
            *known = 0;
        }
        for seat in self.leaving.drain(..) {
            self.slots.release(seat);
        }
        self.settle();
    }

    /// The pairs that overlapped at the last update, sorted. O(pairs) time.
    pub fn pairs(&self) -> Vec<[ProxyId; 2]> {
        let mut pairs: Vec<_> = self.updater.candidates.live_pairs().collect();
        self.slots.name_pairs(&mut pairs);
        PairSorter::default().sort(&mut pairs, self.slots.len());
        pairs.into_iter().map(|pair| pair.map(|slot| self.slots.id_of_slot(slot))).collect()
    }

    /// The bodies that overlapped this one at the last update, sorted.
    ///
    /// Time in proportion to their number and that of near misses; after an update in which most
    /// bodies left their neighbourhood, once O(pairs).
    ///
    /// # Errors
    /// [`Error::StaleProxy`](crate::Error::StaleProxy).
    pub fn pairs_of(&mut self, id: ProxyId) -> Result<Vec<ProxyId>, crate::Error> {
        let seat = self.slots.check(id, 0)?;
        let candidates = &mut self.updater.candidates;
        candidates.link(self.slots.len());
        let mut others = Vec::new();
        let mut next = candidates.first(seat);
        while let Some(index) = next {
            let (other, later) = candidates.step(index, seat);
            if candidates.live[index as usize] {
                others.push(self.slots.id(other));
            }
            next = later;
        }
        others.sort_unstable();
        Ok(others)
    }
}

/// Appends what `choose` makes of each item and its index, if it says so, without a branch: it is
/// hard to guess whether a candidate begins or ends.
#[inline]
pub(super) fn push_wanted<I: Copy, O: Copy + Default>(
    out: &mut Vec<O>,
    items: &[I],
    mut choose: impl FnMut(usize, I) -> (O, bool),
) {
    const CHUNK: usize = 256;
    for (chunk, items) in items.chunks(CHUNK).enumerate() {
        let mut end = out.len();
        out.resize(end + items.len(), O::default());
        for (index, &item) in items.iter().enumerate() {
            let (made, is_wanted) = choose(chunk * CHUNK + index, item);
            out[end] = made;
            end += usize::from(is_wanted);
        }
        out.truncate(end);
    }
}

/// Whether two boxes overlap, without a branch.
#[inline]
pub(super) fn overlap<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    (0..D).fold(true, |all, axis| all & (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]))
}
