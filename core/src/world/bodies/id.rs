//! The ids of bodies.

use core::fmt;

use alloc::vec::Vec;

/// The id of a body in a [`BroadPhase`](crate::BroadPhase): a slot and a generation.
///
/// A slot is reused after its body was removed, under the next generation, so an id never comes to
/// mean another body of the same world. Ids are ordered by slot and then by generation; a pair holds the
/// smaller first. Printed, an id is its slot and its generation: `3v1`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProxyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
}

/// Up to this many ids are sorted by insertion.
const VERY_FEW: usize = 8;
/// Up to this many are sorted by their ranks, which takes half to a quarter of the time: no branch depends on them.
const FEW: usize = 64;

/// Sorts ids of different slots, as numbers if there are many: each type that the standard library sorts takes a kilobyte of a
/// WebAssembly file.
#[inline(never)]
pub fn sort_ids(ids: &mut [ProxyId]) {
    if ids.len() <= VERY_FEW {
        for end in 1..ids.len() {
            let mut at = end;
            while at > 0 && ids[at] < ids[at - 1] {
                ids.swap(at, at - 1);
                at -= 1;
            }
        }
        return;
    }
    if ids.len() <= FEW {
        sort_by_rank(ids);
        return;
    }
    if !cfg!(target_arch = "wasm32") {
        // In place: queries that write to kept lists do not allocate.
        ids.sort_unstable_by_key(|id| id.to_key());
        return;
    }
    // A WebAssembly file has a sort of numbers anyway, and a second sort would make it larger.
    let mut keys: Vec<_> = ids.iter().map(|id| id.to_key()).collect();
    keys.sort_unstable();
    for (id, key) in ids.iter_mut().zip(keys) {
        *id = ProxyId::from_key(key);
    }
}

/// Puts each id behind as many others as have a lesser slot. Written so that compilers compare several slots at once.
fn sort_by_rank(ids: &mut [ProxyId]) {
    let (mut slots, mut generations) = ([u32::MAX; FEW], [0; FEW]);
    for ((slot, generation), id) in slots.iter_mut().zip(&mut generations).zip(&*ids) {
        (*slot, *generation) = (id.slot, id.generation);
    }
    let compared = &slots[..ids.len().next_multiple_of(8)];
    for (&slot, &generation) in slots.iter().zip(&generations).take(ids.len()) {
        let rank: u32 = compared.iter().map(|&other| u32::from(other < slot)).sum();
        ids[rank as usize] = ProxyId { slot, generation };
    }
}

impl ProxyId {
    /// The slot of the body: an index for tables of your own. It is less than the largest number of
    /// bodies that the world ever held at once, removed ones included until the next update.
    #[inline]
    pub const fn slot(self) -> u32 {
        self.slot
    }

    /// How many bodies have had this slot, including this one: at least 1.
    #[inline]
    pub const fn generation(self) -> u32 {
        self.generation
    }

    /// The id as one number, generation above slot; never 0.
    #[inline]
    pub const fn to_bits(self) -> u64 {
        (self.generation as u64) << 32 | self.slot as u64
    }

    /// The id as a number in the order of ids.
    pub(in crate::world) const fn to_key(self) -> u64 {
        self.to_bits().rotate_left(32)
    }

    /// The id of such a number.
    pub(in crate::world) const fn from_key(key: u64) -> Self {
        Self::from_bits(key.rotate_left(32))
    }

    /// The id of a number. Any number is accepted; one that was never given out is a stale id.
    #[inline]
    pub const fn from_bits(bits: u64) -> Self {
        Self { slot: bits as u32, generation: (bits >> 32) as u32 }
    }
}

impl fmt::Display for ProxyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}v{}", self.slot, self.generation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_sorted_by_slot_however_many_there_are() {
        let id = |slot: u32| ProxyId { slot, generation: slot % 3 };
        for count in 0..2 * FEW as u32 {
            // Up to the last slot that there can be.
            for offset in [0, u32::MAX - count] {
                let sorted: Vec<_> = (0..count).map(|slot| id(slot + offset)).collect();
                let mut ids: Vec<_> =
                    (0..count).map(|at| sorted[(at * 7 % count) as usize]).collect();
                if count.is_multiple_of(7) {
                    ids = sorted.iter().rev().copied().collect();
                }
                sort_ids(&mut ids);
                assert_eq!(ids, sorted, "{count} ids");
            }
        }
    }
}
