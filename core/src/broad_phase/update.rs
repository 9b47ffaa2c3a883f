//! The update: from boxes that changed to the pairs that began and ended.
//!
//! Every body has a fat box around its box, and the pairs of fat boxes are kept as candidates. As
//! long as bodies stay within their fat boxes only candidates can begin or end, and an update goes
//! through the list of them; those of bodies that rest are not in it (`sleep`). A body that leaves
//! its fat box gets a new one, which reaches ahead in the direction of its motion, and a tree tells
//! what that overlaps (`follow`). When so many leave that it is cheaper, the finder finds all
//! candidates anew (`rebuild`).
//!
//! Neither the fat boxes nor the choice of the way show in what is reported. A pair is live if
//! the last update knew both bodies, their boxes then overlapped and their filters then allowed
//! it: that is a fact about boxes and filters, whatever else is kept.
//!
//! The steps of an update are compiled apart from each other: in one they are larger and no faster.

use alloc::vec::Vec;

use super::BroadPhase;
use super::changes::Changes;
use super::options::contains;
use super::proxy::{ProxyId, flag};
use super::sort::PairSorter;
use super::updater::{TreeState, Updater, in_order};
use super::warm::warm;
use crate::{Aabb, Scalar};

/// To follow a body that left its fat box costs as much as to find the candidates of so many
/// bodies anew.
pub(super) const REBUILD: usize = 24;

/// If one in so many bodies changed, all are gone through to find them in the order of the seats.
const MOST: usize = 4;

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
        is_worn |= self.end_update();
        if is_worn {
            self.deal_seats();
        }
        let Updater { begun, ended, .. } = &self.updater;
        Changes { slots: &self.slots, begun, ended }
    }

    /// Lists the bodies that need a new fat box: those that left theirs, are new, or may pair with
    /// others than before. Leaves each changed body that lives in the list of the changed, once.
    #[inline(never)]
    fn find_escaped(&mut self) {
        let Updater { fat, scratch, front, .. } = &mut self.updater;
        scratch.escaped.clear();
        let slots = &mut self.slots;
        let boxes = &self.boxes;
        let settled = !(flag::CHANGED | flag::KNOWN);
        // Who changed and is one of these needs a new fat box in any case.
        let odd = flag::NEW | flag::REFILTERED | flag::ASLEEP;
        if self.changed.len() * MOST > slots.len() {
            // In the order of the seats, which is faster than that of the calls.
            const CHUNK: usize = 256;
            let is_changed = flag::CHANGED | flag::LIVE;
            let escaped = &mut scratch.escaped;
            self.changed.clear();
            for (index, chunk) in slots.flags.chunks_mut(CHUNK).enumerate() {
                let start = index * CHUNK;
                let (mut changes, mut escapes) = (self.changed.len(), escaped.len());
                self.changed.resize(changes + chunk.len(), 0);
                escaped.resize(escapes + chunk.len(), 0);
                let sides = boxes[start..].iter().zip(&fat[start..]);
                for (at, (flags, (aabb, fat))) in chunk.iter_mut().zip(sides).enumerate() {
                    let seat = (start + at) as u32;
                    let changed = *flags & is_changed == is_changed;
                    let escaped_now = (*flags & odd != 0) | !contains(fat, aabb);
                    self.changed[changes] = seat;
                    changes += usize::from(changed);
                    escaped[escapes] = seat;
                    escapes += usize::from(changed & escaped_now);
                    *flags = *flags & settled | (*flags & flag::CHANGED) << 7;
                }
                self.changed.truncate(changes);
                escaped.truncate(escapes);
            }
            return;
        }
        let read = in_order(self.changed.len(), *front, slots.len());
        warm(&boxes[..read]);
        warm(&fat[..read]);
        self.changed.retain(|&seat| {
            let at = seat as usize;
            let flags = slots.flags[at];
            slots.flags[at] = flags & settled | flag::RECENT;
            let is_first = flags & (flag::CHANGED | flag::LIVE) == flag::CHANGED | flag::LIVE;
            if is_first && (flags & odd != 0 || !contains(&fat[at], &boxes[at])) {
                scratch.escaped.push(seat);
            }
            is_first
        });
    }

    /// Makes the world of now the world of the last update. Says whether seats should be dealt anew.
    #[inline(never)]
    fn end_update(&mut self) -> bool {
        let Updater { previous, tree_state, any_refiltered, any_new, front, .. } =
            &mut self.updater;
        // The others' are the same, or mean nothing.
        let read = in_order(self.changed.len(), *front, self.slots.len());
        previous[..read].copy_from_slice(&self.boxes[..read]);
        if read < previous.len() {
            for &seat in self.changed.iter().filter(|&&seat| seat as usize >= read) {
                previous[seat as usize] = self.boxes[seat as usize];
            }
        }
        if core::mem::take(any_refiltered) | core::mem::take(any_new) {
            for &seat in &self.changed {
                self.slots.lower(seat, flag::NEW | flag::REFILTERED);
            }
        }
        let moved = self.changed.len();
        self.changed.clear();
        if let TreeState::Fresh { known } = tree_state {
            *known = 0;
        }
        let is_apart = self.settle_down(moved);
        for seat in self.leaving.drain(..) {
            self.slots.release(seat);
        }
        self.settle();
        is_apart
    }

    /// The pairs that overlapped at the last update, sorted. O(pairs) time.
    pub fn pairs(&self) -> Vec<[ProxyId; 2]> {
        let mut pairs: Vec<_> = self.updater.candidates.live_pairs(&self.slots).collect();
        self.slots.name_pairs(&mut pairs);
        PairSorter::default().sort(&mut pairs, self.slots.len());
        pairs.into_iter().map(|pair| pair.map(|slot| self.slots.id_of_slot(slot))).collect()
    }

    /// The bodies that overlapped this one at the last update, sorted.
    ///
    /// O(log n) time and that of its neighbours; after an update in which most bodies left their
    /// neighbourhood, once O(n log n).
    ///
    /// # Errors
    /// [`Error::StaleProxy`](crate::Error::StaleProxy).
    pub fn pairs_of(&mut self, id: ProxyId) -> Result<Vec<ProxyId>, crate::Error> {
        let seat = self.slots.check(id, 0)?;
        let mut others = Vec::new();
        if !self.slots.has(seat, flag::NEW) {
            self.ready_tree();
            let Updater { tree, previous, .. } = &self.updater;
            let (mut leaves, mut found) = (Vec::new(), Vec::new());
            tree.overlapping_many(&[(seat, previous[seat as usize])], &mut leaves, &mut found);
            found.retain(|&[_, other]| other != seat && self.was_live(seat, other));
            others.extend(found.into_iter().map(|[_, other]| self.slots.id(other)));
            others.sort_unstable();
        }
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
