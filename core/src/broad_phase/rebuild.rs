//! The update when many bodies left their fat boxes: find all candidates anew.

use super::BroadPhase;
use super::filter::Filter;
use super::options::hull;
use super::proxy::flag;
use super::update::overlap;
use super::updater::{Scratch, Updater};
use crate::Scalar;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, given who changed, escaped and left.
    pub(super) fn rebuild(&mut self) {
        let has_same_bodies = self.leaving.is_empty() && !self.updater.any_refiltered;
        let is_new = |slot: &u32| self.slots.has(*slot, flag::NEW);
        let has_new = self.updater.scratch.escaped.iter().any(is_new);

        let Updater { candidates, ended, .. } = &mut self.updater;
        for pair in candidates.live_pairs() {
            let [a, b] = pair.map(|slot| slot as usize);
            let may_go_on = has_same_bodies
                || self.slots.flags[a] & self.slots.flags[b] & flag::LIVE != 0
                    && self.filters[a].allows(&self.filters[b]);
            if !(may_go_on && overlap(&self.boxes[a], &self.boxes[b])) {
                ended.push(pair);
            }
        }

        self.fatten_all();
        self.find_candidates(|flags| flags & flag::LIVE != 0);
        let filters = &self.filters;
        self.updater
            .candidates
            .pairs
            .retain(|&[a, b]| filters[a as usize].allows(&filters[b as usize]));

        let mut begun = core::mem::take(&mut self.updater.begun);
        let Updater { candidates, previous, .. } = &mut self.updater;
        candidates.live.clear();
        for pair in &candidates.pairs {
            let [a, b] = pair.map(|slot| slot as usize);
            let is_live = overlap(&self.boxes[a], &self.boxes[b]);
            candidates.live.push(is_live);
            if is_live && !overlap(&previous[a], &previous[b]) {
                begun.push(*pair);
            }
        }
        if has_new || !has_same_bodies {
            // The boxes alone do not say what was live.
            begun.clear();
            begun.extend(
                self.updater.candidates.live_pairs().filter(|&[a, b]| !self.was_live(a, b)),
            );
        }
        self.updater.begun = begun;
        self.age_tree();
    }

    /// Gives all bodies new fat boxes; the fat box of a body that rests is its own.
    fn fatten_all(&mut self) {
        let Updater { fat, previous, prediction, .. } = &mut self.updater;
        fat.copy_from_slice(&self.boxes);
        let known = |slot: &&u32| !self.slots.has(**slot, flag::NEW);
        prediction.look(self.changed.iter().filter(known).map(|&slot| {
            let at = slot as usize;
            (&previous[at], &self.boxes[at])
        }));
        for &slot in self.changed.iter().filter(known) {
            let at = slot as usize;
            fat[at] = prediction.together(&previous[at], &self.boxes[at], &self.options);
        }
    }

    /// Replaces the candidates by all pairs of fat boxes of the slots with such flags.
    fn find_candidates(&mut self, takes_part: impl Fn(u8) -> bool) {
        let Updater { fat, candidates, scratch, .. } = &mut self.updater;
        let Scratch { finder, boxes, slots, .. } = scratch;
        candidates.clear();
        let flags = &self.slots.flags;
        // Boxes were checked when they came and fat boxes are no worse: the finder takes them.
        if flags.iter().all(|&flags| takes_part(flags)) {
            candidates.pairs.extend_from_slice(finder.find(fat).unwrap_or_default());
            return;
        }
        slots.clear();
        slots.extend((0..flags.len() as u32).filter(|&slot| takes_part(flags[slot as usize])));
        boxes.clear();
        boxes.extend(slots.iter().map(|&slot| fat[slot as usize]));
        let pairs = finder.find(boxes).unwrap_or_default();
        candidates.pairs.extend(pairs.iter().map(|pair| pair.map(|index| slots[index as usize])));
    }

    /// Whether a pair was live at the last update.
    fn was_live(&self, a: u32, b: u32) -> bool {
        let previous = &self.updater.previous;
        !self.slots.has(a, flag::NEW)
            && !self.slots.has(b, flag::NEW)
            && overlap(&previous[a as usize], &previous[b as usize])
            && self.old_filter(a).allows(self.old_filter(b))
    }

    /// The filter of a body at the last update.
    pub(super) fn old_filter(&self, slot: u32) -> &Filter {
        if self.slots.has(slot, flag::REFILTERED) {
            &self.updater.old_filters[slot as usize]
        } else {
            &self.filters[slot as usize]
        }
    }

    /// Makes up what follows from the world of the last update, which was read from a snapshot.
    pub(super) fn restore_candidates(&mut self) {
        let Updater { fat, previous, .. } = &mut self.updater;
        for slot in 0..self.slots.len() {
            let is_live = self.slots.flags[slot] & flag::LIVE != 0;
            fat[slot] = previous[slot];
            if is_live {
                fat[slot] = hull(&previous[slot], &self.boxes[slot]);
            }
        }
        self.find_candidates(|flags| {
            flags & (flag::LIVE | flag::LEAVING) != 0 && flags & flag::NEW == 0
        });
        let mut candidates = core::mem::take(&mut self.updater.candidates);
        candidates.pairs.retain(|&[a, b]| {
            self.filters[a as usize].allows(&self.filters[b as usize])
                || self.old_filter(a).allows(self.old_filter(b))
        });
        candidates.live = candidates.pairs.iter().map(|&[a, b]| self.was_live(a, b)).collect();
        self.updater.candidates = candidates;
    }
}
