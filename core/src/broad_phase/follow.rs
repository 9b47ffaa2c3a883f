//! The update when few bodies left their fat boxes: look at those, and at the candidates of those
//! that moved.

use super::BroadPhase;
use super::options::{contains, hull};
use super::proxy::flag;
use super::seating::JUMP_WEAR;
use super::update::{overlap, push_wanted};
use super::updater::{Scratch, TreeState, Updater};
use super::warm::warm;
use crate::Scalar;

/// To go from one candidate of a body to the next takes as long as to test so many in a row.
const MANY: usize = 20;

/// A search of a tree with leaves twice too large costs so many times more than it should what
/// building the tree costs for a body.
const WORSE: usize = 4;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, given who changed, escaped and left.
    pub(super) fn follow(&mut self) {
        let is_few = self.changed.len() * MANY < self.updater.candidates.pairs.len();
        if !self.updater.scratch.escaped.is_empty() {
            self.updater.tree_uses += self.updater.scratch.escaped.len();
            self.ready_tree();
        }
        if !is_few && self.can_stretch() {
            self.stretch_escaped();
        } else {
            self.updater.candidates.link(self.slots.len());
            self.drop_leaving();
            self.replace_escaped();
        }
        if is_few {
            for index in 0..self.changed.len() {
                self.test_candidates_of(self.changed[index]);
            }
        } else {
            self.test_all_candidates();
        }
    }

    /// Whether candidates need only be added, which takes no links: all that are known stay, and who
    /// left his fat box did not go far.
    fn can_stretch(&self) -> bool {
        let Updater { candidates, scratch, prediction, previous, .. } = &self.updater;
        !candidates.is_linked()
            && self.leaving.is_empty()
            && scratch.escaped.iter().all(|&seat| {
                let at = seat as usize;
                !self.slots.has(seat, flag::NEW | flag::REFILTERED)
                    && !prediction.is_jump(&previous[at], &self.boxes[at])
            })
    }

    /// Makes the fat boxes of the bodies that left theirs larger, and adds the candidates that they
    /// so get. A pair is a candidate if its fat boxes overlap: so it is new if they did not before.
    fn stretch_escaped(&mut self) {
        let Updater { candidates, tree, fat, previous, prediction, scratch, begun, .. } =
            &mut self.updater;
        candidates.make_room();
        for &seat in &scratch.escaped {
            let at = seat as usize;
            let before = fat[at];
            let ahead = prediction.alone(&previous[at], &self.boxes[at], &self.options);
            fat[at] = hull(&before, &ahead);
            tree.set(seat, &fat[at]);
            tree.overlapping(&fat[at], &mut scratch.found);
            for &other in &scratch.found {
                let (first, second) = (at.min(other as usize), at.max(other as usize));
                let is_new = first != second
                    && !overlap(&before, &fat[other as usize])
                    && (!self.any_filter || self.filters[first].allows(&self.filters[second]));
                if is_new {
                    let is_live = overlap(&self.boxes[first], &self.boxes[second]);
                    let pair = [first as u32, second as u32];
                    candidates.pairs.push(pair);
                    candidates.live.push(is_live);
                    if is_live {
                        begun.push(pair);
                    }
                }
            }
        }
    }

    /// Gives the bodies that left their fat boxes new ones, and finds their candidates.
    fn replace_escaped(&mut self) {
        let escaped = core::mem::take(&mut self.updater.scratch.escaped);
        let Updater { tree, fat, previous, prediction, wear, .. } = &mut self.updater;
        for &seat in &escaped {
            let at = seat as usize;
            let is_new = self.slots.has(seat, flag::NEW);
            let before = if is_new { &self.boxes[at] } else { &previous[at] };
            if prediction.is_jump(before, &self.boxes[at]) {
                *wear = wear.saturating_add(JUMP_WEAR);
            }
            fat[at] = prediction.alone(before, &self.boxes[at], &self.options);
            tree.set(seat, &fat[at]);
        }
        for &seat in &escaped {
            self.rematch(seat);
        }
        self.updater.scratch.escaped = escaped;
    }

    /// Ends the pairs of bodies that were removed.
    fn drop_leaving(&mut self) {
        let Updater { candidates, tree, ended, .. } = &mut self.updater;
        for &seat in &self.leaving {
            tree.remove(seat);
            let mut next = candidates.first(seat);
            while let Some(index) = next {
                next = candidates.step(index, seat).1;
                if candidates.live[index as usize] {
                    ended.push(candidates.pairs[index as usize]);
                }
                candidates.remove(index);
            }
        }
    }

    /// Gives a body with a new fat box its candidates: some of those it had, and new ones.
    fn rematch(&mut self, seat: u32) {
        let Updater { candidates, tree, fat, scratch, begun, ended, .. } = &mut self.updater;
        let is_allowed = |other: u32| {
            !self.any_filter || self.filters[seat as usize].allows(&self.filters[other as usize])
        };
        let (found, is_old) = (&mut scratch.found, &mut scratch.is_old);
        tree.overlapping(&fat[seat as usize], found);
        found.retain(|&other| other != seat && is_allowed(other));
        found.sort_unstable();
        is_old.clear();
        is_old.resize(found.len(), false);
        let mut next = candidates.first(seat);
        while let Some(index) = next {
            let (other, later) = candidates.step(index, seat);
            next = later;
            if let Ok(place) = found.binary_search(&other) {
                is_old[place] = true;
            } else {
                if candidates.live[index as usize] {
                    ended.push(candidates.pairs[index as usize]);
                }
                candidates.remove(index);
            }
        }
        for (&other, _) in found.iter().zip(is_old).filter(|(_, is_old)| !**is_old) {
            let is_live = overlap(&self.boxes[seat as usize], &self.boxes[other as usize]);
            if is_live {
                begun.push([seat, other]);
            }
            candidates.add(seat, other, is_live);
        }
    }

    /// Tests the candidates of one body.
    fn test_candidates_of(&mut self, seat: u32) {
        let Updater { candidates, begun, ended, .. } = &mut self.updater;
        let aabb = &self.boxes[seat as usize];
        let mut next = candidates.first(seat);
        while let Some(index) = next {
            let (other, later) = candidates.step(index, seat);
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
        let Updater { candidates, scratch, begun, ended, .. } = &mut self.updater;
        let (pairs, live) = (&candidates.pairs, &mut candidates.live);
        let changed = &mut scratch.pairs;
        changed.clear();
        warm(&self.boxes);
        push_wanted(changed, pairs, |index, [a, b]| {
            let is_live = overlap(&self.boxes[a as usize], &self.boxes[b as usize]);
            ([a, b], core::mem::replace(&mut live[index], is_live) != is_live)
        });
        for pair in changed.iter() {
            let [a, b] = pair.map(|seat| seat as usize);
            let is_live = overlap(&self.boxes[a], &self.boxes[b]);
            if is_live { &mut *begun } else { &mut *ended }.push(*pair);
        }
    }

    /// Has the tree hold the fat boxes of all bodies that are not new.
    fn ready_tree(&mut self) {
        let Updater { tree, tree_state, tree_uses, fat, scratch, .. } = &mut self.updater;
        match *tree_state {
            TreeState::Fresh { .. } => return,
            // A tree whose leaves have become large costs time whenever it is searched.
            TreeState::Old
                if (tree.refit(fat) - 1.0) * (*tree_uses * WORSE) as f64 <= tree.len() as f64 => {}
            _ => {
                *tree_uses = 0;
                let is_known = |seat: &u32| {
                    self.slots.has(*seat, flag::LIVE) && !self.slots.has(*seat, flag::NEW)
                };
                scratch.seats.clear();
                scratch.seats.extend((0..self.slots.len() as u32).filter(is_known));
                tree.build(&mut scratch.seats, fat);
            }
        }
        *tree_state = TreeState::Fresh { known: 0 };
    }

    /// Has the tree hold every body with a box around its own, for queries.
    pub(super) fn refresh_tree(&mut self) {
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
