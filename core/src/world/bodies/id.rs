//! The ids of bodies.

/// The id of a body in a [`BroadPhase`](crate::BroadPhase): a slot and a generation.
///
/// A slot is reused after its body was removed, under the next generation, so an id never comes to
/// mean another body of the same world. Ids are ordered by slot and then by generation; a pair holds the
/// smaller first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProxyId {
    pub(super) slot: u32,
    pub(super) generation: u32,
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

    /// The id of a number. Any number is accepted; one that was never given out is a stale id.
    #[inline]
    pub const fn from_bits(bits: u64) -> Self {
        Self { slot: bits as u32, generation: (bits >> 32) as u32 }
    }
}
