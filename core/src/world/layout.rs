//! The order of bodies in memory: that in which the finder reports their candidates, so that a scan of
//! the candidates reads memory in order. It changes nothing but the time.

use super::bodies::{Bodies, flag};
use super::tracking::{Scratch, Tracking};
use crate::Scalar;

// Measured on mostly-still in 3D, together with branch-free tests: an update takes 0.27 of finding all pairs
// instead of 0.33 at 10,000 bodies, and 0.42 instead of 0.65 at 100,000.

/// How many new fat AABBs per body make the order useless.
const DECAY: usize = 16;
/// With this many times as many, storage is reordered in an update that found all candidates; until then it waits for one that
/// takes less time. New bodies, those of a level that was loaded, do not wait.
const OVERDUE: usize = 2;
/// With fewer candidates than one for this many bodies the order does not matter.
const BODIES_A_CANDIDATE: usize = 4;
/// How much a body decays the order that jumped away from its neighbors in memory, in new fat AABBs.
const JUMP_DECAY: usize = 10 * DECAY;

/// Whether and how to reorder storage at the end of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reorder {
    No,
    /// Bodies that are near in space get indices that are near.
    BySpace,
    /// Tracking is skipped from now on: each body gets the index of its slot in the next update, which has less to do
    /// than this one.
    Later,
}

/// Notes that this many bodies jumped.
pub fn note_jumps(decay: &mut usize, jumped: usize) {
    *decay = decay.saturating_add(jumped.saturating_mul(JUMP_DECAY));
}

/// Notes that the finder found the candidates of `moved` bodies with new fat AABBs, `new` of them new. Returns whether to reorder
/// storage at once and whether to do so in an update that takes less time, given the numbers of bodies and of candidates.
pub fn note_rebuild(
    decay: &mut usize,
    [moved, new]: [usize; 2],
    [bodies, candidates]: [usize; 2],
) -> [bool; 2] {
    *decay = decay.saturating_add(moved).saturating_add(2 * OVERDUE * DECAY * new);
    let matters = candidates * BODIES_A_CANDIDATE > bodies;
    let is_overdue = matters && *decay > OVERDUE * DECAY * bodies;
    [is_overdue, matters && *decay > DECAY * bodies]
}

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Reorders storage. To be called at the end of an update. O(n + pairs) time.
    pub fn reorder(&mut self, bodies: &mut Bodies<D, T>, reorder: Reorder) {
        match reorder {
            Reorder::No => {}
            Reorder::BySpace => {
                (self.locality_decay, self.is_order_due) = (0, false);
                self.order_by_space(bodies);
                self.apply_order(bodies);
                bodies.slots.is_reordered = true;
            }
            Reorder::Later => {
                self.locality_decay = DECAY * bodies.slots.len() + 1;
                self.tree.abandon();
            }
        }
    }

    /// Gives each body the index of its slot, if they differ; then fat AABBs are stale. O(n + pairs) time.
    pub fn order_by_slot(&mut self, bodies: &mut Bodies<D, T>) {
        if bodies.slots.is_reordered {
            self.fat.clear();
            self.is_fat_stale = true;
            self.scratch.permutation.copy(&bodies.slots.index_of, &bodies.slots.slot_of);
            self.apply_order(bodies);
            bodies.slots.is_reordered = false;
        }
    }

    /// Makes the order of the candidates that of the bodies: first the awake ones with candidates, then
    /// the other awake ones, then the sleeping ones.
    #[inline(never)]
    fn order_by_space(&mut self, bodies: &mut Bodies<D, T>) {
        let Self { candidates, scratch: Scratch { permutation, .. }, .. } = self;
        let flags = &bodies.slots.flags;
        let is_awake =
            |&index: &u32| flags[index as usize] & (flag::LIVE | flag::ASLEEP) == flag::LIVE;
        let all = 0..bodies.slots.len() as u32;
        let paired = || candidates.listed().iter().flatten().copied();
        permutation.begin(bodies.slots.len());
        let mut add = |old: u32| permutation.add(old);
        paired().filter(is_awake).for_each(&mut add);
        all.clone().filter(is_awake).for_each(&mut add);
        paired().for_each(&mut add);
        all.clone().for_each(&mut add);
        bodies.front = all.filter(is_awake).count();
    }

    /// Moves all rows to their new indices.
    fn apply_order(&mut self, bodies: &mut Bodies<D, T>) {
        let permutation = &mut self.scratch.permutation;
        let Bodies { slots, boxes, edits, displacements, sweeps, .. } = bodies;
        let ([shapes, origins], [moved, too_wide]) = displacements.stored();
        let (ends, swept) = sweeps.stored();
        let [now, previous] = boxes.stored();
        for table in [now, previous, shapes, origins, ends, &mut self.fat] {
            permutation.move_boxes(table);
        }
        for table in bodies.rules.tables() {
            permutation.move_filters(table);
        }
        permutation.move_flags(&mut slots.flags);
        permutation.move_words(&mut slots.slot_of);
        let [changed, leaving] = edits.lists();
        let flying = &mut self.flying;
        for list in [&mut slots.index_of, changed, leaving, swept, moved, too_wide, flying] {
            permutation.rename(list);
        }
        self.candidates.rename(permutation.new_indices());
        self.tree.tree_mut().rename(permutation.new_indices());
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;

    #[test]
    fn storage_is_reordered_at_once_only_if_bodies_are_new_or_it_waited_for_long() {
        let (bodies, candidates) = (1000, 500);
        let mut decay = 0;
        let mut note =
            |moved: usize, new: usize| note_rebuild(&mut decay, [moved, new], [bodies, candidates]);
        let rebuilds: Vec<_> = (0..=2 * DECAY).map(|_| note(bodies, 0)).collect();
        let first = |which: usize| rebuilds.iter().position(|is| is[which]).unwrap();
        assert_eq!((first(1), first(0)), (DECAY, OVERDUE * DECAY));
        assert_eq!(note_rebuild(&mut 0, [bodies, bodies], [bodies, candidates]), [true, true]);
        // Where few bodies have candidates the order does not matter.
        assert_eq!(note_rebuild(&mut 0, [bodies, bodies], [bodies, 10]), [false, false]);
    }
}
