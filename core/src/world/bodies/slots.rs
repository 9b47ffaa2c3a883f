//! Slots and storage indices of bodies, and their flags.

use alloc::collections::BinaryHeap;
use alloc::vec::Vec;
use core::cmp::Reverse;

use super::id::{ProxyId, sort_ids};
use crate::Error;
use crate::cloning::clone_fields;
use crate::geometry::check_count;

/// What is true of a body, as bits.
pub mod flag {
    /// The body is there.
    pub const LIVE: u16 = 1;
    /// The body was removed since the last update, which has yet to report its ended pairs.
    pub const LEAVING: u16 = 2;
    /// Its box or filter changed since the last update, or it is new: it is in the list of changes.
    pub const CHANGED: u16 = 4;
    /// The body was inserted since the last update.
    pub const NEW: u16 = 8;
    /// Its box is swept until the next update.
    pub const SWEPT: u16 = 16;
    /// Temporary, within one call.
    pub const MARKED: u16 = 32;
    /// Its filter changed since the last update.
    pub const REFILTERED: u16 = 64;
    /// The tree has its box since it changed.
    pub const IN_TREE: u16 = 128;
    /// The body rests, and updates skip it until it changes.
    pub const ASLEEP: u16 = 256;
    /// It is in the list of bodies that were given a box since the last update; only where fat AABBs are reported.
    pub const MOVED: u16 = 1024;
    /// The body moves so far in each update that no fat AABB lasts: it is not in the tree.
    pub const FLYING: u16 = 2048;
    /// A pair of the body is, or was, excluded.
    pub const EXCLUDES: u16 = 4096;
    /// The body changed since bodies last fell asleep.
    pub const RECENT: u16 = CHANGED << 7;
    /// What a slot keeps that is free: in which lists it is, and how.
    pub const LISTED: u16 = CHANGED | IN_TREE | MOVED;
}

/// Which body is where. An id names a *slot*. All tables are in the order of *storage indices*, which
/// are reassigned now and then so that bodies that are near in space are near in memory.
#[derive(Debug, Default)]
pub struct Slots {
    /// By slot, how many bodies have had it.
    pub generations: Vec<u32>,
    /// By slot, the generation of the living body, or 0.
    living: Vec<u32>,
    /// By slot.
    pub index_of: Vec<u32>,
    /// By index.
    pub slot_of: Vec<u32>,
    /// By index.
    pub flags: Vec<u16>,
    /// Whether indices may differ from slots.
    pub is_reordered: bool,
    /// The smallest free slot is given out first, so equal sets of free slots give equal ids.
    free: BinaryHeap<Reverse<u32>>,
    /// How many bodies live.
    pub live: usize,
}

clone_fields! {
    [] Slots {
        generations, living, index_of, slot_of, flags, is_reordered, free, live,
    }
}

impl Slots {
    /// How many slots there are, including free ones; equally many indices.
    #[inline]
    pub fn len(&self) -> usize {
        self.flags.len()
    }

    #[inline]
    pub fn has(&self, index: u32, flags: u16) -> bool {
        self.flags[index as usize] & flags != 0
    }

    #[inline]
    pub fn raise(&mut self, index: u32, flags: u16) {
        self.flags[index as usize] |= flags;
    }

    #[inline]
    pub fn lower(&mut self, index: u32, flags: u16) {
        self.flags[index as usize] &= !flags;
    }

    /// The id of the body that is, or was last, in a slot.
    #[inline]
    pub fn id_of_slot(&self, slot: u32) -> ProxyId {
        ProxyId { slot, generation: self.generations[slot as usize] }
    }

    /// The id of the body that has, or had last, an index.
    #[inline]
    pub fn id(&self, index: u32) -> ProxyId {
        self.id_of_slot(self.slot_of[index as usize])
    }

    /// The ids of bodies, sorted.
    #[inline(never)]
    pub fn sorted_ids(&self, indices: &[u32]) -> Vec<ProxyId> {
        let mut ids: Vec<_> = indices.iter().map(|&index| self.id(index)).collect();
        sort_ids(&mut ids);
        ids
    }

    /// Whether an id names a living body.
    #[inline]
    pub fn is_living(&self, id: ProxyId) -> bool {
        self.living
            .get(id.slot as usize)
            .is_some_and(|&living| (living == id.generation) & (living != 0))
    }

    /// Whether these are the ids of living bodies, one of each slot and in their order: then no slot is free.
    pub fn are_all(&self, ids: &[ProxyId]) -> bool {
        let is_own = |((slot, id), &living): ((u32, &ProxyId), &u32)| {
            (id.slot == slot) & (id.generation == living) & (living != 0)
        };
        let slots = (0..).zip(ids).zip(&self.living);
        ids.len() == self.len() && slots.map(is_own).fold(true, |all, each| all & each)
    }

    /// The index of a living body; `position` is that of its id in the argument, for the error.
    #[inline]
    pub fn check(&self, id: ProxyId, position: usize) -> Result<u32, Error> {
        let error = Error::StaleProxy { index: position, id: id.to_bits() };
        if self.is_living(id) { Ok(self.index_of[id.slot as usize]) } else { Err(error) }
    }

    /// Whether there are slots for `count` more bodies.
    pub fn check_capacity(&self, count: usize) -> Result<(), Error> {
        let more = count.saturating_sub(self.free.len());
        check_count(self.len().saturating_add(more))
    }

    /// The index for a new body; the last one if no slot was free.
    pub fn take(&mut self) -> u32 {
        let index = if let Some(Reverse(slot)) = self.free.pop() {
            self.generations[slot as usize] += 1;
            self.index_of[slot as usize]
        } else {
            self.add(1)
        };
        // A new body in a slot that is still listed as changed is listed again only if the tree knows of the change.
        self.flags[index as usize] &= flag::LISTED;
        self.activate(index);
        index
    }

    /// Makes the body of a slot live.
    pub fn activate(&mut self, index: u32) {
        let slot = self.slot_of[index as usize] as usize;
        self.live += 1;
        self.living[slot] = self.generations[slot];
        self.raise(index, flag::LIVE);
    }

    /// Adds a slot that is not in use, with the last index.
    pub fn add(&mut self, generation: u32) -> u32 {
        let slot = self.len() as u32;
        self.generations.push(generation);
        self.living.push(0);
        self.index_of.push(slot);
        self.slot_of.push(slot);
        self.flags.push(0);
        slot
    }

    /// Removes a body; its slot stays taken until [`release`](Self::release).
    pub fn retire(&mut self, index: u32) {
        self.live -= 1;
        self.living[self.slot_of[index as usize] as usize] = 0;
        self.lower(index, flag::LIVE | flag::SWEPT);
        self.raise(index, flag::LEAVING);
    }

    /// Frees the slot of a removed body, and keeps these of its flags. A slot whose generations are
    /// used up stays out of use.
    pub fn release(&mut self, index: u32, kept: u16) {
        self.flags[index as usize] &= kept;
        let slot = self.slot_of[index as usize];
        if self.generations[slot as usize] < u32::MAX {
            self.free.push(Reverse(slot));
        }
    }

    /// Turns pairs of indices into pairs of slots, smaller first.
    pub fn to_slots(&self, pairs: &mut [[u32; 2]]) {
        pairs.iter_mut().for_each(|pair| *pair = self.pair(*pair));
    }

    /// The slots of two indices, smaller first.
    #[inline]
    pub fn pair(&self, pair: [u32; 2]) -> [u32; 2] {
        let [a, b] = pair.map(|index| self.slot_of[index as usize]);
        [a.min(b), a.max(b)]
    }
}
