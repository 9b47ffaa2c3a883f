//! The update where fat boxes do not pay (`effort`): finds all pairs of the boxes themselves, and
//! compares them with those of the last update.
//!
//! Seats are slots meanwhile: boxes are set in the order of the calls, and pairs need no other names.
//! Nobody sleeps. Fat boxes are the boxes of the last update, and are written only if somebody asks.

use super::BroadPhase;
use super::proxy::flag;
use super::rebuild::{found, is_live};
use super::updater::{Scratch, TreeState, Updater};
use crate::Scalar;

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Reports what begins and ends, sorted, given the boxes and who left.
    #[inline(never)]
    pub(super) fn find_anew(&mut self) {
        let slots = self.slots.len();
        let Updater { candidates, scratch, .. } = &mut self.updater;
        candidates.sort(&self.slots, &mut scratch.sorter);
        let mut before = core::mem::take(&mut scratch.before);
        core::mem::swap(&mut before, &mut candidates.sorted);
        self.note_changed();
        self.wake_all();

        let is_whole = !self.any_filter && self.len() == slots;
        if !is_whole {
            self.find_candidates(true, is_live);
            self.drop_forbidden();
        }
        let Updater { candidates, begun, ended, scratch, .. } = &mut self.updater;
        let Scratch { finder, sorter, .. } = scratch;
        let found = if is_whole { found(finder.find(&self.boxes)) } else { &candidates.pairs };
        sorter.sort_into(found, &mut candidates.sorted, slots);
        candidates.clear();
        sorter.differences(&before, &candidates.sorted, ended, begun);
        scratch.before = before;
        self.updater.are_fat_old = true;
        if self.updater.tree_state != TreeState::Unbuilt {
            self.updater.fat.copy_from_slice(&self.boxes);
            self.age_tree();
        }
    }

    /// Whether to go on so, given that it is time to try fat boxes again and how bodies move.
    #[inline(never)]
    pub(super) fn goes_on_anew(&mut self) -> bool {
        if !self.updater.candidates.are_sorted || self.options.margin > T::default() {
            return false;
        }
        self.list_changed();
        self.look_at_motion();
        let bodies = self.len();
        let Updater { candidates, effort, prediction, previous, .. } = &mut self.updater;
        let jumps = |&&seat: &&u32| {
            let at = seat as usize;
            !self.slots.has(seat, flag::NEW) && prediction.is_jump(&previous[at], &self.boxes[at])
        };
        let jumped = self.changed.iter().filter(jumps).count();
        let pairs = candidates.sorted.len();
        effort.goes_on(bodies, self.changed.len(), pairs, jumped, prediction.steps())
    }

    /// Notes who changed, as far as it matters: to a tree that is in use.
    fn note_changed(&mut self) {
        self.updater.scratch.escaped.clear();
        if self.updater.tree_state != TreeState::Unbuilt {
            self.list_changed();
            let living = self.changed.iter().filter(|&&seat| self.slots.has(seat, flag::LIVE));
            self.updater.scratch.escaped.extend(living);
        }
        for &seat in &self.changed {
            self.slots.lower(seat, flag::CHANGED | flag::KNOWN);
        }
    }
}
