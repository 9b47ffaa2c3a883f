//! The update when few bodies left their fat boxes: test the candidates, and look those few up in the
//! tree.
//!
//! Where most bodies move, the fat box of one that left it is stretched: its candidates stay, and
//! some more come. Where few do it gets a new one, and all its candidates are dropped and found anew:
//! it costs a pass through the list, but else the fat boxes would grow for ever.

use core::hint::black_box;
use core::slice::Iter;

use super::BroadPhase;
use super::options::{contains, hull};
use super::proxy::flag;
use super::seating::{Deal, JUMP_WEAR};
use super::tree::{BATCH, TOGETHER};
use super::update::{REBUILD, overlap, push_wanted};
use super::updater::{SOME, Scratch, TreeState, Updater};
use crate::Scalar;
use crate::memory::{prefetch_item, prefetch_pays, preload};

/// A search of a tree with leaves twice too large costs so many times more than it should what
/// building the tree costs for a body.
const WORSE: usize = 3;

/// What the candidate so many places further on needs is called from memory.
const AHEAD: usize = 24;

/// To find the candidates of a body among others takes as long as to test so many in a row.
const MANY: usize = 12;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, given who changed, escaped and left. Says how seats should be
    /// dealt.
    #[inline(never)]
    pub(super) fn follow(&mut self) -> Deal {
        let changed = self.changed.len() + self.leaving.len();
        let escaped = core::mem::take(&mut self.updater.scratch.escaped);
        let is_sleeper = |seat: &&u32| self.slots.has(**seat, flag::ASLEEP);
        let sleepers = escaped.iter().chain(&self.leaving).filter(is_sleeper).count();
        if !escaped.is_empty() || sleepers > 0 {
            self.updater.tree_uses += escaped.len();
            self.ready_tree();
        }
        let stretches = sleepers == 0 && self.can_stretch(&escaped);
        let marks = &mut self.updater.scratch.marks;
        marks.resize(self.slots.len());
        escaped.iter().chain(&self.leaving).for_each(|&seat| marks.set(seat));
        if sleepers > 0 {
            self.wake(&escaped, sleepers);
        }
        let tests = if changed > 0 { self.test_candidates(!stretches) } else { 0 };
        let jumped = self.move_in_tree(&escaped, stretches);
        self.add_candidates(stretches);
        let marks = &mut self.updater.scratch.marks;
        escaped.iter().chain(&self.leaving).for_each(|&seat| marks.clear(seat));
        let (bodies, escapes) = (self.len(), escaped.len());
        self.updater.scratch.escaped = escaped;
        match self.updater.effort.note_follow(bodies, changed, tests, escapes, jumped) {
            true => Deal::BySlot,
            false => Deal::No,
        }
    }

    /// Wakes the bodies that are marked, of which so many were asleep, and ends what ends between
    /// one of these and another that was asleep: such pairs are in no list.
    #[inline(never)]
    fn wake(&mut self, escaped: &[u32], count: usize) {
        let mut ended = core::mem::take(&mut self.updater.ended);
        let Updater { previous, scratch, .. } = &mut self.updater;
        let queries = &mut scratch.queries;
        let sleepers = escaped.iter().chain(&self.leaving).copied();
        let sleepers = sleepers.filter(|&seat| self.slots.has(seat, flag::ASLEEP));
        queries.clear();
        queries.extend(sleepers.map(|seat| (seat, previous[seat as usize])));
        for start in (0..count).step_by(BATCH) {
            let Updater { tree, scratch, .. } = &mut self.updater;
            let Scratch { queries, leaves, pairs: found, .. } = scratch;
            let batch = &queries[start..count.min(start + BATCH)];
            tree.overlapping_many(batch, leaves, found);
            let scratch = &self.updater.scratch;
            let pairs = scratch
                .pairs
                .iter()
                .map(|&[query, other]| [scratch.queries[start + query as usize].0, other]);
            ended.extend(pairs.filter(|&[seat, other]| {
                self.slots.has(other, flag::ASLEEP)
                    && (seat < other || seat != other && !scratch.marks.has(other))
                    && self.was_live(seat, other)
                    && !self.is_live(seat, other)
            }));
        }
        for &seat in escaped.iter().chain(&self.leaving) {
            self.slots.lower(seat, flag::ASLEEP);
        }
        self.updater.sleep.count -= count;
        self.updater.sleep.woke += count;
        self.updater.ended = ended;
    }

    /// Whether two bodies are there, overlap, and may pair.
    fn is_live(&self, a: u32, b: u32) -> bool {
        let (first, second) = (a as usize, b as usize);
        self.slots.has(a, flag::LIVE)
            && self.slots.has(b, flag::LIVE)
            && overlap(&self.boxes[first], &self.boxes[second])
            && (!self.any_filter || self.filters[first].allows(&self.filters[second]))
    }

    /// Lists the places of the candidates of the bodies that escaped or left, if `drops`, and tests
    /// the other candidates of those that changed. Returns how many tests that were.
    #[inline(never)]
    fn test_candidates(&mut self, drops: bool) -> usize {
        let tests = match (self.changed.len() * MANY > self.updater.candidates.pairs.len(), drops) {
            (true, true) => self.list_flips::<true>(),
            (true, false) => self.list_flips::<false>(),
            (false, _) => self.list_moved(),
        };
        let Updater { candidates, scratch, begun, ended, .. } = &mut self.updater;
        let Scratch { marks, places, dropped, .. } = scratch;
        dropped.reserve(candidates.pairs.capacity() / 4);
        for &at in &*places {
            let [a, b] = candidates.pairs[at];
            if drops && marks.has(a) | marks.has(b) {
                dropped.push(at);
                continue;
            }
            let is_live = overlap(&self.boxes[a as usize], &self.boxes[b as usize]);
            if candidates.live[at] != is_live {
                candidates.live[at] = is_live;
                if is_live { &mut *begun } else { &mut *ended }.push([a, b]);
            }
        }
        self.end_dropped();
        tests
    }

    /// Lists the places of the candidates of those that changed or left, to be tested. Returns how many.
    fn list_moved(&mut self) -> usize {
        let Updater { candidates, scratch, .. } = &mut self.updater;
        let Scratch { moved, places, .. } = scratch;
        let seats = || self.changed.iter().chain(&self.leaving);
        moved.resize(self.slots.len());
        seats().for_each(|&seat| moved.set(seat));
        places.clear();
        places.reserve(candidates.pairs.capacity() / 4);
        push_wanted(places, &candidates.pairs, |at, [a, b]| (at, moved.has(a) | moved.has(b)));
        seats().for_each(|&seat| moved.clear(seat));
        places.len()
    }

    /// Tests all candidates, and lists the places of those that begin or end and, if `DROPS`, of those of the
    /// bodies that are marked. Returns how many tests that were.
    fn list_flips<const DROPS: bool>(&mut self) -> usize {
        if self.updater.candidates.pairs.len() * SOME > self.boxes.len() {
            preload(&self.boxes);
        }
        let is_far = prefetch_pays(&self.boxes);
        let Updater { candidates, scratch, .. } = &mut self.updater;
        let Scratch { marks, places, .. } = scratch;
        places.clear();
        places.reserve(candidates.pairs.capacity() / 4);
        // Without a branch: it is hard to guess what begins, ends or is dropped.
        push_wanted(places, &candidates.pairs, |at, [a, b]| {
            if is_far && let Some(&[_, later]) = candidates.pairs.get(at + AHEAD) {
                // The first seats of neighbours in the list are near each other.
                prefetch_item(&self.boxes, later as usize);
            }
            let is_live = overlap(&self.boxes[a as usize], &self.boxes[b as usize]);
            let is_dropped = DROPS && marks.has(a) | marks.has(b);
            (at, (is_live != candidates.live[at]) | is_dropped)
        });
        candidates.pairs.len()
    }

    /// Ends what ends of the candidates that are dropped. Their places will be those of others.
    fn end_dropped(&mut self) {
        let mut ended = core::mem::take(&mut self.updater.ended);
        let dropped = core::mem::take(&mut self.updater.scratch.dropped);
        for &at in &dropped {
            let pair @ [a, b] = self.updater.candidates.pairs[at];
            if self.updater.candidates.live[at] && !self.is_live(a, b) {
                ended.push(pair);
            }
        }
        self.updater.scratch.dropped = dropped;
        self.updater.ended = ended;
    }

    /// Whether candidates need only be added, since all that are known stay: if those who left their
    /// fat boxes did not go far, these may become larger. Where few move they would be large for ever.
    fn can_stretch(&self, escaped: &[u32]) -> bool {
        let Updater { prediction, previous, .. } = &self.updater;
        let is_odd = flag::NEW | flag::REFILTERED;
        self.changed.len() * 2 > self.len()
            && self.leaving.is_empty()
            && escaped.iter().all(|&seat| {
                let at = seat as usize;
                !self.slots.has(seat, is_odd) && !prediction.is_jump(&previous[at], &self.boxes[at])
            })
    }

    /// Tells the tree of those who left the world, and of the new fat boxes of those who left theirs,
    /// which are to be looked up. Returns how many jumped.
    #[inline(never)]
    fn move_in_tree(&mut self, escaped: &[u32], stretches: bool) -> usize {
        let mut jumped = 0;
        let Updater { tree, fat, previous, prediction, wear, scratch, .. } = &mut self.updater;
        for &seat in &self.leaving {
            tree.remove(seat);
        }
        scratch.queries.clear();
        scratch.queries.reserve(self.slots.live / REBUILD + 1);
        for (index, &seat) in escaped.iter().enumerate() {
            if index % TOGETHER == 0 {
                escaped[index..].iter().take(TOGETHER).for_each(|&seat| tree.call_leaf_of(seat));
            }
            let at = seat as usize;
            let is_new = self.slots.has(seat, flag::NEW);
            let before = if is_new { &self.boxes[at] } else { &previous[at] };
            if prediction.is_jump(before, &self.boxes[at]) {
                *wear = wear.saturating_add(JUMP_WEAR);
                jumped += 1;
            }
            let ahead = prediction.alone(seat, before, &self.boxes[at], &self.options);
            let aabb = if stretches { hull(&fat[at], &ahead) } else { ahead };
            scratch.queries.push((seat, aabb));
            tree.set(seat, &aabb);
        }
        jumped
    }

    /// Gives the bodies that are to be looked up their new fat boxes, and adds their candidates: if
    /// these boxes stretch the old ones, those whose fat boxes did not overlap before.
    fn add_candidates(&mut self, stretches: bool) {
        self.updater.candidates.reserve();
        let mut dropped = core::mem::take(&mut self.updater.scratch.dropped);
        let mut places = dropped.iter();
        for start in (0..self.updater.scratch.queries.len()).step_by(BATCH) {
            let Updater { tree, scratch, .. } = &mut self.updater;
            let Scratch { queries, leaves, pairs: found, .. } = scratch;
            let stop = queries.len().min(start + BATCH);
            tree.overlapping_many(&queries[start..stop], leaves, found);
            self.add_found(start, stretches, &mut places);
        }
        let Updater { fat, scratch, candidates, .. } = &mut self.updater;
        candidates.remove(places.as_slice());
        dropped.clear();
        scratch.dropped = dropped;
        for (seat, aabb) in &scratch.queries {
            fat[*seat as usize] = *aabb;
        }
    }

    /// Adds what was found for the bodies that were looked up, from one on, in the places of those that were
    /// dropped as long as there are any.
    #[inline(never)]
    fn add_found(&mut self, start: usize, stretches: bool, places: &mut Iter<usize>) {
        let mut begun = core::mem::take(&mut self.updater.begun);
        let mut candidates = core::mem::take(&mut self.updater.candidates);
        let Updater { fat, scratch, .. } = &self.updater;
        for found in scratch.pairs.chunks(TOGETHER) {
            for &[_, other] in found {
                black_box(fat[other as usize].min[0]);
                if !self.slots.has(other, flag::ASLEEP) {
                    black_box(self.boxes[other as usize].min[0]);
                }
            }
            for &[query, other] in found {
                let (seat, aabb) = &scratch.queries[start + query as usize];
                let (first, second) = (*seat as usize, other as usize);
                // The tree knows the new fat box of one who is marked; of others it may know larger.
                let is_marked = scratch.marks.has(other);
                let is_near = if is_marked { *seat < other } else { overlap(aabb, &fat[second]) };
                let is_candidate = is_near
                    && !(stretches && overlap(&fat[first], &fat[second]))
                    && (!self.any_filter || self.filters[first].allows(&self.filters[second]));
                if is_candidate {
                    let pair = [other.min(*seat), other.max(*seat)];
                    let is_live = overlap(&self.boxes[first], self.at_hand(other, &self.boxes));
                    candidates.put(places.next(), pair, is_live);
                    if is_live && !self.was_live(*seat, other) {
                        begun.push(pair);
                    }
                }
            }
        }
        self.updater.candidates = candidates;
        self.updater.begun = begun;
    }

    /// Has the tree hold the fat boxes of all bodies that are not new.
    #[inline(never)]
    pub(super) fn ready_tree(&mut self) {
        self.updater.refresh_fat();
        let Updater { tree, tree_state, tree_uses, fat, .. } = &mut self.updater;
        match *tree_state {
            TreeState::Fresh { .. } => return,
            // A tree whose leaves have become large costs time whenever it is searched.
            TreeState::Old
                if (tree.refit(fat) - 1.0) * (*tree_uses * WORSE) as f64 <= tree.len() as f64 => {}
            _ => {
                *tree_uses = 0;
                let is_known = |seat: &u32| {
                    self.slots.has(*seat, flag::LIVE | flag::LEAVING)
                        && !self.slots.has(*seat, flag::NEW)
                };
                tree.build((0..self.slots.len() as u32).filter(is_known), fat);
            }
        }
        *tree_state = TreeState::Fresh { known: 0 };
    }

    /// Has the tree hold every body with a box around its own, for queries.
    pub(super) fn refresh_tree(&mut self) {
        self.list_changed();
        // Who asks once may ask often.
        self.updater.tree_uses += self.len() / 4;
        self.ready_tree();
        let Updater { tree, tree_state, fat, .. } = &mut self.updater;
        let TreeState::Fresh { known } = tree_state else { return };
        while let Some(&seat) = self.changed.get(*known) {
            *known += 1;
            let at = seat as usize;
            if !self.slots.has(seat, flag::LIVE) {
                continue;
            }
            self.slots.raise(seat, flag::KNOWN);
            if self.slots.has(seat, flag::NEW) {
                tree.set(seat, &self.boxes[at]);
            } else if !contains(&fat[at], &self.boxes[at]) {
                tree.set(seat, &hull(&fat[at], &self.boxes[at]));
            }
        }
    }

    /// Notes that all fat boxes are new.
    #[inline(never)]
    pub(super) fn age_tree(&mut self) {
        let Updater { tree, tree_state, scratch, fat, previous, prediction, .. } =
            &mut self.updater;
        if *tree_state == TreeState::Unbuilt {
            return;
        }
        for &seat in &self.leaving {
            tree.remove(seat);
        }
        // A body that is far from where it was must not stretch the leaf where it was.
        let is_elsewhere = |seat: u32| {
            let at = seat as usize;
            self.slots.has(seat, flag::NEW) || prediction.is_jump(&previous[at], &self.boxes[at])
        };
        let Scratch { escaped, seats, .. } = scratch;
        seats.clear();
        seats.extend(escaped.iter().copied().filter(|&seat| is_elsewhere(seat)));
        if seats.len() * 2 > tree.len() {
            *tree_state = TreeState::Unbuilt;
            return;
        }
        for &seat in seats.iter() {
            tree.set(seat, &fat[seat as usize]);
        }
        *tree_state = TreeState::Old;
    }
}
