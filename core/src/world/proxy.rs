//! The ids of bodies, and the slots behind them.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Reverse;

use crate::Error;
use crate::geometry::check_count;

/// The name of a body in a [`BroadPhase`](super::BroadPhase): a slot and a generation.
///
/// A slot is used again after its body was removed, under the next generation, so an id never
/// comes to mean another body. Ids are ordered by slot and then by generation; a pair holds the
/// smaller first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProxyId {
    slot: u32,
    generation: u32,
}

impl ProxyId {
    /// The index of the body, less than the greatest number of bodies there ever were at once
    /// (those counted in that were removed since the last update): for a table of one's own.
    #[inline]
    pub const fn slot(self) -> u32 {
        self.slot
    }

    /// How many bodies have had the slot, this one included: at least 1.
    #[inline]
    pub const fn generation(self) -> u32 {
        self.generation
    }

    /// The id as one number, generation above slot; never 0.
    #[inline]
    pub const fn to_bits(self) -> u64 {
        (self.generation as u64) << 32 | self.slot as u64
    }

    /// The id of a number. Any number is taken; one that was never given out is a stale id.
    #[inline]
    pub const fn from_bits(bits: u64) -> Self {
        Self { slot: bits as u32, generation: (bits >> 32) as u32 }
    }
}

/// What is true of a slot, as bits.
pub(super) mod flag {
    /// A body lives here.
    pub const LIVE: u16 = 1;
    /// Its body was removed since the last update, which has yet to report its ended pairs.
    pub const LEAVING: u16 = 2;
    /// Its box or filter changed since the last update, or it is new: it stands in the list of
    /// the changed.
    pub const CHANGED: u16 = 4;
    /// The last update did not know its body.
    pub const NEW: u16 = 8;
    /// The last update knew its body with another filter.
    pub const REFILTERED: u16 = 64;
    /// The tree knows its box since it changed.
    pub const KNOWN: u16 = 128;
    /// Its box is swept until the next update.
    pub const SWEPT: u16 = 16;
    /// A mark of the update at work; never set between two calls.
    pub const MARKED: u16 = 32;
    /// Its body rests, and no update need look at it until it changes.
    pub const ASLEEP: u16 = 256;
    /// Its body changed since bodies last went to sleep.
    pub const RECENT: u16 = CHANGED << 7;
}

/// Who is where. A *slot* is what an id names; a *seat* is where what is known of its body stands
/// in the tables. Seats are dealt anew now and then so that bodies that are near in space are near
/// in memory; slots stay.
#[derive(Clone, Debug, Default)]
pub(super) struct Slots {
    /// By slot, how many bodies have had it.
    pub generations: Vec<u32>,
    /// By slot, the generation of the body that lives, or 0.
    living: Vec<u32>,
    /// By slot, its seat.
    pub seats: Vec<u32>,
    /// By seat, its slot.
    pub slots: Vec<u32>,
    /// By seat.
    pub flags: Vec<u16>,
    /// Whether seats were dealt: else all are those of the slots of the same number.
    pub are_dealt: bool,
    /// The least free slot is given out first, so which it is follows from which are free.
    free: BinaryHeap<Reverse<u32>>,
    pub live: usize,
}

impl Slots {
    /// How many slots there are, free ones counted in; and as many seats.
    #[inline]
    pub fn len(&self) -> usize {
        self.flags.len()
    }

    #[inline]
    pub fn has(&self, seat: u32, flags: u16) -> bool {
        self.flags[seat as usize] & flags != 0
    }

    #[inline]
    pub fn raise(&mut self, seat: u32, flags: u16) {
        self.flags[seat as usize] |= flags;
    }

    #[inline]
    pub fn lower(&mut self, seat: u32, flags: u16) {
        self.flags[seat as usize] &= !flags;
    }

    /// The id of the body that is, or was last, in a slot.
    #[inline]
    pub fn id_of_slot(&self, slot: u32) -> ProxyId {
        ProxyId { slot, generation: self.generations[slot as usize] }
    }

    /// The id of the body that has, or had last, a seat.
    #[inline]
    pub fn id(&self, seat: u32) -> ProxyId {
        self.id_of_slot(self.slots[seat as usize])
    }

    /// The seat of a living body.
    #[inline]
    pub fn find(&self, id: ProxyId) -> Option<u32> {
        self.is_living(id).then(|| self.seats[id.slot as usize])
    }

    /// Whether an id names a living body.
    #[inline]
    pub fn is_living(&self, id: ProxyId) -> bool {
        self.living
            .get(id.slot as usize)
            .is_some_and(|&living| (living == id.generation) & (living != 0))
    }

    /// The seat of the body of the id at `index` of what was passed.
    #[inline]
    pub fn check(&self, id: ProxyId, index: usize) -> Result<u32, Error> {
        self.find(id).ok_or(Error::StaleProxy { index, id: id.to_bits() })
    }

    /// Whether `count` more bodies have room.
    pub fn check_room(&self, count: usize) -> Result<(), Error> {
        let more = count.saturating_sub(self.free.len());
        let total = self.len().saturating_add(more);
        check_count(total)
    }

    /// The seat for a new body; the last one if no slot was free.
    pub fn take(&mut self) -> u32 {
        let seat = if let Some(Reverse(slot)) = self.free.pop() {
            self.generations[slot as usize] += 1;
            self.seats[slot as usize]
        } else {
            self.add(1)
        };
        self.flags[seat as usize] = 0;
        self.enliven(seat);
        seat
    }

    /// Begins a body's life.
    pub fn enliven(&mut self, seat: u32) {
        let slot = self.slots[seat as usize] as usize;
        self.live += 1;
        self.living[slot] = self.generations[slot];
        self.raise(seat, flag::LIVE);
    }

    /// Adds a slot that is not in use, with the last seat.
    pub fn add(&mut self, generation: u32) -> u32 {
        let slot = self.len() as u32;
        self.generations.push(generation);
        self.living.push(0);
        self.seats.push(slot);
        self.slots.push(slot);
        self.flags.push(0);
        slot
    }

    /// Ends a body's life; its slot stays taken until [`release`](Self::release).
    pub fn retire(&mut self, seat: u32) {
        self.live -= 1;
        self.living[self.slots[seat as usize] as usize] = 0;
        self.lower(seat, flag::LIVE | flag::SWEPT);
        self.raise(seat, flag::LEAVING);
    }

    /// Makes the slot of a body that is no more free. A slot whose generations are used up stays
    /// out of use.
    pub fn release(&mut self, seat: u32) {
        self.flags[seat as usize] = 0;
        let slot = self.slots[seat as usize];
        if self.generations[slot as usize] < u32::MAX {
            self.free.push(Reverse(slot));
        }
    }

    /// Turns pairs of seats into pairs of slots, smaller first.
    pub fn name_pairs(&self, pairs: &mut [[u32; 2]]) {
        for pair in pairs {
            let [a, b] = pair.map(|seat| self.slots[seat as usize]);
            *pair = [a.min(b), a.max(b)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_whose_generations_are_used_up_is_not_given_out_again() {
        let mut slots = Slots::default();
        assert_eq!(slots.take(), 0);
        slots.generations[0] = u32::MAX - 1;
        slots.retire(0);
        slots.release(0);
        assert_eq!((slots.take(), slots.generations[0]), (0, u32::MAX));
        slots.retire(0);
        slots.release(0);
        assert_eq!((slots.take(), slots.len()), (1, 2));
    }

    #[test]
    fn ids_survive_the_trip_through_a_number() {
        let id = ProxyId { slot: 7, generation: u32::MAX };
        assert_eq!(ProxyId::from_bits(id.to_bits()), id);
    }
}
