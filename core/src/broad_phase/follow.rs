//! The update when few bodies left their fat boxes: look at those, and at the candidates of those
//! that moved.

use super::BroadPhase;
use super::options::{contains, hull};
use super::proxy::flag;
use super::update::overlap;
use super::updater::{TreeState, Updater};
use crate::Scalar;

/// If more than one in so many bodies moved, it is faster to test all candidates in a row.
const MANY: usize = 4;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, given who changed, escaped and left.
    pub(super) fn follow(&mut self) {
        let is_few = self.changed.len() * MANY < self.len();
        let escaped = core::mem::take(&mut self.updater.scratch.escaped);
        if is_few || !escaped.is_empty() || !self.leaving.is_empty() {
            self.updater.candidates.link(self.slots.len());
        }
        self.drop_leaving();
        if !escaped.is_empty() {
            self.ready_tree();
        }
        let Updater { tree, fat, previous, prediction, .. } = &mut self.updater;
        for &slot in &escaped {
            let at = slot as usize;
            let is_new = self.slots.has(slot, flag::NEW);
            let before = if is_new { &self.boxes[at] } else { &previous[at] };
            fat[at] = prediction.alone(before, &self.boxes[at], &self.options);
            tree.set(slot, &fat[at]);
        }
        for &slot in &escaped {
            self.rematch(slot);
        }
        self.updater.scratch.escaped = escaped;
        if is_few {
            for index in 0..self.changed.len() {
                self.test_candidates_of(self.changed[index]);
            }
        } else {
            self.test_all_candidates();
        }
    }

    /// Ends the pairs of bodies that were removed.
    fn drop_leaving(&mut self) {
        let Updater { candidates, tree, ended, .. } = &mut self.updater;
        for &slot in &self.leaving {
            tree.remove(slot);
            let mut next = candidates.first(slot);
            while let Some(index) = next {
                next = candidates.step(index, slot).1;
                if candidates.live[index as usize] {
                    ended.push(candidates.pairs[index as usize]);
                }
                candidates.remove(index);
            }
        }
    }

    /// Gives a body with a new fat box its candidates: some of those it had, and new ones.
    fn rematch(&mut self, slot: u32) {
        let Updater { candidates, tree, fat, scratch, begun, ended, .. } = &mut self.updater;
        let (aabb, own_fat) = (&self.boxes[slot as usize], &fat[slot as usize]);
        let filter = &self.filters[slot as usize];
        let search = scratch.begin_search(self.slots.len());
        let (seen, found) = (&mut scratch.seen, &mut scratch.found);
        seen[slot as usize] = search;
        let mut next = candidates.first(slot);
        while let Some(index) = next {
            let (other, later) = candidates.step(index, slot);
            next = later;
            let at = other as usize;
            if filter.allows(&self.filters[at]) && overlap(own_fat, &fat[at]) {
                seen[at] = search;
            } else {
                if candidates.live[index as usize] {
                    ended.push(candidates.pairs[index as usize]);
                }
                candidates.remove(index);
            }
        }
        found.clear();
        tree.overlapping(own_fat, &mut |other| found.push(other));
        for &other in found.iter() {
            let at = other as usize;
            if seen[at] != search && filter.allows(&self.filters[at]) {
                let is_live = overlap(aabb, &self.boxes[at]);
                if is_live {
                    begun.push([slot.min(other), slot.max(other)]);
                }
                candidates.add(slot, other, is_live);
            }
        }
    }

    /// Tests the candidates of one body.
    #[inline]
    fn test_candidates_of(&mut self, slot: u32) {
        let Updater { candidates, begun, ended, .. } = &mut self.updater;
        let aabb = &self.boxes[slot as usize];
        let mut next = candidates.first(slot);
        while let Some(index) = next {
            let (other, later) = candidates.step(index, slot);
            next = later;
            let is_live = overlap(aabb, &self.boxes[other as usize]);
            let at = index as usize;
            if is_live != candidates.live[at] {
                candidates.live[at] = is_live;
                if is_live { &mut *begun } else { &mut *ended }.push(candidates.pairs[at]);
            }
        }
    }

    /// Tests all candidates.
    fn test_all_candidates(&mut self) {
        let Updater { candidates, begun, ended, .. } = &mut self.updater;
        for (pair, was_live) in candidates.pairs.iter().zip(&mut candidates.live) {
            let is_live = overlap(&self.boxes[pair[0] as usize], &self.boxes[pair[1] as usize]);
            if is_live != *was_live {
                *was_live = is_live;
                if is_live { &mut *begun } else { &mut *ended }.push(*pair);
            }
        }
    }

    /// Has the tree hold the fat boxes of all bodies that are not new.
    fn ready_tree(&mut self) {
        let Updater { tree, tree_state, fat, scratch, .. } = &mut self.updater;
        match *tree_state {
            TreeState::Fresh { .. } => return,
            TreeState::Old if !tree.refit(fat) => {}
            _ => {
                let is_known = |slot: &u32| {
                    self.slots.has(*slot, flag::LIVE) && !self.slots.has(*slot, flag::NEW)
                };
                scratch.slots.clear();
                scratch.slots.extend((0..self.slots.len() as u32).filter(is_known));
                tree.build(&mut scratch.slots, fat);
            }
        }
        *tree_state = TreeState::Fresh { known: 0 };
    }

    /// Has the tree hold every body with a box around its own, for queries.
    pub(super) fn refresh_tree(&mut self) {
        self.ready_tree();
        let Updater { tree, tree_state, fat, .. } = &mut self.updater;
        let TreeState::Fresh { known } = tree_state else { return };
        while let Some(&slot) = self.changed.get(*known) {
            *known += 1;
            let at = slot as usize;
            if !self.slots.has(slot, flag::LIVE) {
                continue;
            }
            self.slots.raise(slot, flag::KNOWN);
            if self.slots.has(slot, flag::NEW) {
                tree.set(slot, &self.boxes[at]);
            } else if !contains(&fat[at], &self.boxes[at]) {
                tree.set(slot, &hull(&fat[at], &self.boxes[at]));
            }
        }
    }

    /// Notes that all fat boxes are new.
    pub(super) fn age_tree(&mut self) {
        let Updater { tree, tree_state, scratch, fat, .. } = &mut self.updater;
        if *tree_state == TreeState::Unbuilt {
            return;
        }
        for &slot in &self.leaving {
            tree.remove(slot);
        }
        let newcomers = || scratch.escaped.iter().filter(|&&slot| self.slots.has(slot, flag::NEW));
        if newcomers().count() * 2 > tree.len() {
            *tree_state = TreeState::Unbuilt;
            return;
        }
        for &slot in newcomers() {
            tree.set(slot, &fat[slot as usize]);
        }
        *tree_state = TreeState::Old;
    }
}
