//! What a kernel needs from a processor: a vector of coordinates, compared lane by lane.

/// A vector of `LANES` coordinates.
///
/// # Safety
/// An implementation must read exactly `LANES` coordinates in `load`, `LANES` ids and dedup bitmaps in
/// `pack`, and write no more than `LANES` pairs there. Each function may be called only where
/// the instructions of the implementation are present.
pub(super) unsafe trait Vector<T: Copy>: Copy {
    /// Coordinates in one vector, at most [`PAD`](super::sorted_boxes::PAD).
    const LANES: usize;
    /// One boolean a lane.
    type Mask: Copy;

    /// The same coordinate in every lane.
    unsafe fn splat(value: T) -> Self;
    /// `LANES` coordinates from memory, no alignment asked.
    unsafe fn load(from: *const T) -> Self;
    /// Where `a <= b`. False for a NaN.
    unsafe fn le(a: Self, b: Self) -> Self::Mask;
    /// Where `mask` and `a <= b`.
    unsafe fn and_le(mask: Self::Mask, a: Self, b: Self) -> Self::Mask;
    /// One bit a lane, the first lane lowest.
    unsafe fn bits(mask: Self::Mask) -> u32;

    /// Whether it can [`pack`](Self::pack).
    const PACKS: bool = false;

    /// Writes the pairs of the lanes in `hits` whose dedup bitmaps share no bit with the probe's, in lane
    /// order. Returns how many. Up to `LANES` pairs may be overwritten at `out`.
    #[inline(always)]
    unsafe fn pack(
        _hits: Self::Mask,
        _probe: &Reporter,
        _ids: *const u32,
        _dedup: *const u32,
        _out: *mut [u32; 2],
    ) -> usize {
        unreachable!("it does not pack")
    }
}

/// The order of the two ids of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairOrder {
    /// Two boxes of one set: smaller id first.
    Ascending,
    /// Boxes of two sets: that of the first set first.
    BySet,
}

/// The part of the probing box that its pairs are made of.
#[derive(Clone, Copy)]
pub(super) struct Reporter {
    pub id: u32,
    pub dedup: u32,
    /// Whether the smaller id comes first, or else that of the first set.
    pub ascending: bool,
    /// Whether the other boxes are those of the first of two sets.
    pub in_first: bool,
}

impl Reporter {
    #[inline(always)]
    pub fn pair(&self, other: u32) -> [u32; 2] {
        let swaps = (self.ascending & (other < self.id)) | (!self.ascending & self.in_first);
        if swaps { [other, self.id] } else { [self.id, other] }
    }
}
