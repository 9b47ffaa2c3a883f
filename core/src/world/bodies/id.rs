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
const FEW: usize = 20;

/// Sorts ids, as numbers if there are many: each type that the standard library sorts takes a kilobyte of a WebAssembly
/// file.
#[inline(never)]
pub fn sort_ids(ids: &mut [ProxyId]) {
    if ids.len() <= FEW {
        for end in 1..ids.len() {
            let mut at = end;
            while at > 0 && ids[at] < ids[at - 1] {
                ids.swap(at, at - 1);
                at -= 1;
            }
        }
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
