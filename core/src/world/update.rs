//! The update: from boxes that changed to the pairs that began and ended.
//!
//! Every body has a fat box around its box, and the pairs of fat boxes are kept as candidates. As
//! long as bodies stay within their fat boxes only candidates can begin or end, and an update goes
//! through the list of them; those of bodies that rest are not in it (`sleep`). A body that leaves
//! its fat box gets a new one, which reaches ahead in the direction of its motion, and a tree tells
//! what that overlaps (`follow`). When so many leave that it is cheaper, the finder finds all
//! candidates anew (`rebuild`). Where that is so again and again, fat boxes do not pay (`effort`), and
//! for some updates the pairs of the boxes themselves are found and compared (`anew`).
//!
//! Neither the fat boxes nor the choice of the way show in what is reported. A pair is live if
//! the last update knew both bodies, their boxes then overlapped and their filters then allowed
//! it: that is a fact about boxes and filters, whatever else is kept.
//!
//! The steps of an update are compiled apart from each other: in one they are larger and no faster.

use alloc::vec::Vec;

use super::BroadPhase;
use super::changes::Changes;
use super::edit::differ;
use super::options::contains;
use super::proxy::{ProxyId, flag};
use super::seating::Deal;
use super::sort::PairSorter;
use super::updater::{TreeState, Updater, in_order};
use crate::memory::preload;
use crate::{Aabb, Scalar};

/// To follow a body that left its fat box costs as much as to find the candidates of so many
/// bodies anew.
pub(super) const REBUILD: usize = 24;

/// If one in so many bodies changed, all are gone through to find them in the order of the seats.
pub(super) const MOST: usize = 4;

/// So many at a time.
const CHUNK: usize = 64;

/// Who changed and is one of these needs a new fat box in any case.
const ODD: u16 = flag::NEW | flag::REFILTERED | flag::ASLEEP;
/// The flags that an update leaves as they are.
const SETTLED: u16 = !(flag::CHANGED | flag::KNOWN);

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports the pairs that began and ended since the last update.
    ///
    /// Time in proportion to the bodies that changed and their neighbours, and not much more than
    /// finding all pairs takes.
    pub fn update(&mut self) -> Changes<'_> {
        self.updater.begun.clear();
        self.updater.ended.clear();
        let listed = self.changed.len() + self.leaving.len();
        let changed = if self.unlisted { listed.max(self.len()) } else { listed };
        let mut deal = if changed > 0 { self.find_changes(changed) } else { Deal::No };
        if self.end_update() && deal == Deal::No {
            deal = Deal::ByPlace;
        }
        match deal {
            Deal::No => {}
            Deal::ByPlace => self.deal_seats(),
            Deal::BySlot => self.deal_seats_by_slot(),
        }
        let Updater { begun, ended, .. } = &self.updater;
        Changes { slots: &self.slots, begun, ended }
    }

    /// Lists what begins and ends, given that about so many bodies changed or left. Says how seats
    /// should be dealt.
    fn find_changes(&mut self, changed: usize) -> Deal {
        if self.updater.effort.is_without(changed, self.len()) || self.goes_on_anew() {
            self.find_anew();
            return Deal::No;
        }
        self.updater.refresh_fat();
        self.updater.candidates.unsort();
        self.find_escaped();
        let moves = self.updater.scratch.escaped.len() + self.leaving.len();
        let deal = if moves * REBUILD > self.len() { self.rebuild() } else { self.follow() };
        let slots = self.slots.len();
        let Updater { scratch, begun, ended, .. } = &mut self.updater;
        for pairs in [begun, ended] {
            self.slots.name_pairs(pairs);
            scratch.sorter.sort(pairs, slots);
        }
        deal
    }

    /// Lists the bodies that need a new fat box: those that left theirs, are new, or may pair with
    /// others than before. Leaves each changed body that lives in the list of the changed, once.
    #[inline(never)]
    fn find_escaped(&mut self) {
        let Updater { fat, previous, scratch, front, .. } = &mut self.updater;
        scratch.escaped.clear();
        let slots = &mut self.slots;
        let boxes = &self.boxes;
        if core::mem::take(&mut self.unlisted) || self.changed.len() * MOST > slots.len() {
            // In the order of the seats, which is faster than that of the calls.
            self.changed.clear();
            for start in (0..slots.len()).step_by(CHUNK) {
                let seats = start..slots.len().min(start + CHUNK);
                let (flags, boxes) = (&mut slots.flags[seats.clone()], &boxes[seats.clone()]);
                let (mut changed, mut escaped) = ([0; CHUNK], [0; CHUNK]);
                for (changed, (aabb, before)) in
                    changed.iter_mut().zip(boxes.iter().zip(&previous[seats.clone()]))
                {
                    *changed = u16::from(differ(aabb, before));
                }
                for (escaped, (aabb, fat)) in
                    escaped.iter_mut().zip(boxes.iter().zip(&fat[seats.clone()]))
                {
                    *escaped = u16::from(!contains(fat, aabb));
                }
                let lists = [&mut self.changed, &mut scratch.escaped];
                list_chunk(start, flags, &mut changed, &mut escaped, lists);
            }
            return;
        }
        let read = in_order(self.changed.len(), *front, slots.len());
        preload(&boxes[..read]);
        preload(&fat[..read]);
        self.changed.retain(|&seat| {
            let at = seat as usize;
            let flags = slots.flags[at];
            slots.flags[at] = flags & SETTLED | flag::RECENT;
            let is_first = flags & (flag::CHANGED | flag::LIVE) == flag::CHANGED | flag::LIVE;
            if is_first && (flags & ODD != 0 || !contains(&fat[at], &boxes[at])) {
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
        let mut read = in_order(self.changed.len(), *front, self.slots.len());
        if core::mem::take(&mut self.unlisted) {
            read = previous.len();
        }
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
        // Where all pairs are found anew nobody sleeps.
        let is_apart = !self.updater.candidates.are_sorted && self.settle_down(moved);
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

/// Lists whose boxes changed of a chunk of seats, given whose boxes differ from those of the last update,
/// and whose of these are not within their fat boxes.
#[inline(never)]
fn list_chunk(
    start: usize,
    flags: &mut [u16],
    changed: &mut [u16; CHUNK],
    escaped: &mut [u16; CHUNK],
    lists: [&mut Vec<u32>; 2],
) {
    let (mut changes, mut escapes) = (0, 0);
    for (flags, (changed, escaped)) in flags.iter_mut().zip(changed.iter_mut().zip(&mut *escaped)) {
        let is = |flag| u16::from(*flags & flag != 0);
        let any = *changed | is(flag::CHANGED);
        *changed = any & is(flag::LIVE);
        *escaped = *changed & (*escaped | is(ODD));
        *flags = *flags & SETTLED | (any * flag::RECENT);
        changes += *changed;
        escapes += *escaped;
    }
    let start = start as u32;
    let [all_changed, all_escaped] = lists;
    for (list, count, is_in) in [(all_changed, changes, changed), (all_escaped, escapes, escaped)] {
        if usize::from(count) == flags.len() {
            list.extend(start..start + u32::from(count));
        } else if count > 0 {
            let seats = (start..).zip(&is_in[..flags.len()]);
            list.extend(seats.filter(|(_, is_in)| **is_in != 0).map(|(seat, _)| seat));
        }
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
    a.overlaps_branch_free(b)
}
