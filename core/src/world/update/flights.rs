//! Bodies that fly: few among many that rest, and so fast that no fat AABB lasts.
//!
//! They are not in the tree. In each update the finder finds their pairs among themselves, and the tree those with
//! others. Of what rests nothing is copied or scanned. A body that is no longer fast is put into the tree again.

use alloc::vec::Vec;

use crate::Scalar;
use crate::world::bodies::{Bodies, flag};
use crate::world::tracking::{Scratch, Tracking};

/// The flags of bodies that do not fly yet.
const GROUNDED: u16 = flag::NEW | flag::ASLEEP;

impl<const D: usize, T: Scalar> Tracking<D, T> {
    /// Chooses which of the bodies that left their fat AABBs fly, if any may, and lists with those the other bodies that flew.
    /// Returns how many fly.
    #[inline(never)]
    pub fn choose_flying(&mut self, bodies: &mut Bodies<D, T>, may_fly: bool) -> usize {
        let Self { flying, motion, policy, scratch: Scratch { escaped, .. }, .. } = self;
        if !may_fly && flying.is_empty() {
            return 0;
        }
        for &index in &*escaped {
            bodies.slots.raise(index, flag::MARKED);
        }
        let moving = escaped.len();
        for &index in &*flying {
            if bodies.slots.flags[index as usize] & (flag::LIVE | flag::MARKED) == flag::LIVE {
                // It did not change, but its candidates may.
                bodies.edits.changed_mut().push(index);
                escaped.push(index);
            }
        }
        // Not too many are looked up at once: the finder would find all candidates, and no body would fly any more. So where
        // some fly, slow ones fly as well, and land a few at a time; those that rest, which are last in the list, first.
        let (mut slow, mut grounded) = (0, bodies.edits.leaving().len());
        for &index in &*escaped {
            let row = index as usize;
            let flags = &mut bodies.slots.flags[row];
            let is_grounded = *flags & GROUNDED != 0;
            grounded += usize::from(is_grounded);
            let (before, now) = (&bodies.boxes.previous()[row], &bodies.boxes.now()[row]);
            if is_grounded || !motion.is_fast(before, now) {
                // Only fast ones stay marked.
                *flags &= !flag::MARKED;
                slow += usize::from(*flags & flag::FLYING == 0);
            }
        }
        // Where tracking is skipped, since too many of them left their fat AABBs, slow ones fly as well, and it need not be.
        let may_land_all = slow == escaped.len() && !policy.is_skipping();
        let most = policy.most_look_ups(bodies.edits.changed().len(), bodies.slots.live);
        let spared = (escaped.len() - moving).min(most / 2);
        let looked_up = slow + bodies.edits.leaving().len();
        let stay = looked_up + spared <= most;
        let looked_up = if stay { looked_up } else { grounded.max(most / 2) };
        let mut landings = most.max(1).saturating_sub(looked_up);
        let mut count = 0;
        for &index in escaped.iter().rev() {
            let flags = &mut bodies.slots.flags[index as usize];
            let (flew, is_fast) = (*flags & flag::FLYING != 0, *flags & flag::MARKED != 0);
            *flags &= !(flag::MARKED | flag::FLYING);
            if !may_fly || *flags & GROUNDED != 0 {
                continue;
            }
            let may_land = may_land_all || if flew { landings > 0 } else { stay };
            if may_land && !is_fast {
                landings -= usize::from(flew);
                continue;
            }
            *flags |= flag::FLYING;
            count += 1;
            if !flew {
                flying.push(index);
            }
        }
        count
    }

    /// Finds the pairs that bodies which fly have among themselves, unless these are found already. Returns false if there are more
    /// than `most`, or than fit into memory.
    #[inline(never)]
    pub fn find_among_flying(
        &mut self,
        bodies: &Bodies<D, T>,
        begun: &mut Vec<[u32; 2]>,
        are_found: bool,
        most: usize,
    ) -> bool {
        let Self { finder, flying, scratch, .. } = self;
        let fly = |index: &u32| {
            const FLY: u16 = flag::LIVE | flag::FLYING;
            bodies.slots.flags[*index as usize] & FLY == FLY
        };
        flying.retain(fly);
        if flying.is_empty() || are_found {
            return true;
        }
        let Ok(Some(pairs)) = finder.find_some(flying, bodies, most) else {
            return false;
        };
        for &pair in pairs {
            scratch.added.push((pair, true));
            if !bodies.was_live(pair) {
                begun.push(pair);
            }
        }
        true
    }

    /// Ends all flights. The tree then lacks bodies.
    pub fn land_all(&mut self, bodies: &mut Bodies<D, T>) {
        while let Some(index) = self.flying.pop() {
            bodies.slots.lower(index, flag::FLYING);
            self.tree.abandon();
        }
    }

    /// Ends all flights, and puts the bodies into the tree.
    pub fn land_in_tree(&mut self, bodies: &mut Bodies<D, T>) {
        while let Some(index) = self.flying.pop() {
            bodies.slots.lower(index, flag::FLYING);
            // The pairs that a body had which left since are still listed.
            if bodies.slots.has(index, flag::LIVE | flag::LEAVING) {
                self.tree.tree_mut().set(index, &self.fat[index as usize]);
            }
        }
    }
}
