//! Deals seats anew, in the order in which the finder comes upon the bodies: then to go through
//! the candidates is to go through memory from front to back.
//!
//! In which order they are dealt shows in nothing but the speed.

use alloc::vec::Vec;

use super::BroadPhase;
use super::loners::NONE;
use super::proxy::flag;
use super::updater::{Scratch, TreeState, Updater};
use crate::Scalar;
use crate::memory::reserve;

/// The new seat of one who has a candidate, until it is dealt.
const PAIRED: u32 = NONE - 1;

/// Fewer bodies are near each other in memory whatever their order.
const FEW: usize = 64;
/// How often each body may get a new fat box before seats are dealt anew.
const WEAR: usize = 16;
/// What a body wears that jumped away from those whose seats are next to its own.
pub(super) const JUMP_WEAR: usize = 10 * WEAR;

/// Whether and how seats are dealt at the end of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Deal {
    No,
    /// Near in space is near in memory.
    ByPlace,
    /// Each slot gets the seat of its number.
    BySlot,
}

impl<const D: usize, T: Scalar> BroadPhase<D, T> {
    /// Notes that the finder just found the candidates of so many bodies that got new fat boxes,
    /// some of them new; says whether the order of the seats is worn out by that.
    pub(super) fn wear_seating(&mut self, moved: usize, new: usize) -> bool {
        let bodies = self.len();
        let wear = &mut self.updater.wear;
        *wear = wear.saturating_add(moved).saturating_add(2 * WEAR * new);
        let is_worn = *wear > WEAR * bodies && bodies >= FEW;
        if is_worn {
            *wear = 0;
        }
        is_worn
    }

    /// Deals seats in the order of the candidates, first to those who are awake; who has none comes
    /// after somebody near. To be called at the end of an update. O(n + pairs) time.
    #[inline(never)]
    pub(super) fn deal_seats(&mut self) {
        let Updater { scratch, candidates, front, .. } = &mut self.updater;
        let Scratch { seats: order, found: renamed, loners, .. } = scratch;
        order.clear();
        renamed.clear();
        renamed.resize(self.slots.len(), NONE);
        let everyone = 0..self.slots.len() as u32;
        let (flags, boxes) = (&self.slots.flags, &self.boxes);
        let is_up = |seat: u32| flags[seat as usize] & (flag::LIVE | flag::ASLEEP) == flag::LIVE;
        let paired = || candidates.pairs.iter().flatten().copied();
        paired().for_each(|seat| renamed[seat as usize] = PAIRED);
        let lonely = everyone.clone().filter(|&seat| renamed[seat as usize] == NONE);
        *front = everyone.clone().filter(|&seat| is_up(seat)).count();
        let centre = |seat: u32, axis| boxes[seat as usize].centre(axis);
        order.extend(lonely.filter(|&seat| is_up(seat)));
        loners.gather(order, self.slots.len(), D, &centre);
        order.clear();
        let mut deal = |old: u32| {
            let new = &mut renamed[old as usize];
            let is_first = *new >= PAIRED;
            if is_first {
                *new = order.len() as u32;
                order.push(old);
            }
            is_first
        };
        for old in paired().filter(|&seat| is_up(seat)) {
            if deal(old) {
                loners.take_near(old, &centre).for_each(|seat| _ = deal(seat));
            }
        }
        for old in everyone.clone().filter(|&seat| is_up(seat)).chain(paired()).chain(everyone) {
            deal(old);
        }
        self.take_seats();
    }

    /// Deals each slot the seat of its number. To be called at the end of an update. O(n + pairs) time.
    #[inline(never)]
    pub(super) fn deal_seats_by_slot(&mut self) {
        // Those who are near in space will be all over the tables.
        self.updater.wear = usize::MAX;
        self.updater.tree_state = TreeState::Unbuilt;
        if self.slots.are_dealt {
            let Scratch { seats: order, found: renamed, .. } = &mut self.updater.scratch;
            order.clone_from(&self.slots.seats);
            renamed.clone_from(&self.slots.slots);
            self.take_seats();
            self.slots.are_dealt = false;
        }
    }

    /// Moves bodies to their new seats, given who was in the seat of each and which is whose.
    fn take_seats(&mut self) {
        let Updater { scratch, candidates, tree, previous, fat, .. } = &mut self.updater;
        let Scratch { boxes: spare, seats: order, found: renamed, .. } = scratch;
        self.slots.are_dealt = true;
        for table in [&mut self.boxes, &mut self.shapes, previous, fat] {
            reorder(table, order, spare);
        }
        reorder(&mut self.filters, order, &mut scratch.filters);
        reorder(&mut self.slots.flags, order, &mut scratch.flags);
        reorder(&mut self.slots.slots, order, &mut scratch.names);
        for seat in self.slots.seats.iter_mut().chain(&mut self.changed) {
            *seat = renamed[*seat as usize];
        }
        candidates.rename(renamed);
        tree.rename(renamed);
    }
}

/// Puts a table into a new order; an empty one stays empty.
fn reorder<V: Copy>(table: &mut Vec<V>, order: &[u32], spare: &mut Vec<V>) {
    if !table.is_empty() {
        spare.clear();
        reserve(spare, order.len());
        spare.extend(order.iter().map(|&old| table[old as usize]));
        core::mem::swap(table, spare);
    }
}
