//! What a kernel needs of a processor: a vector of coordinates, compared lane by lane.

/// A vector of `LANES` coordinates.
///
/// # Safety
/// An implementation must read exactly `LANES` coordinates in `load`, `LANES` ids and marks in
/// `report`, and write no more than `LANES` pairs there. Each function may be called only where
/// the instructions of the implementation are present.
pub(super) unsafe trait Vector<T: Copy>: Copy {
    /// Coordinates in one vector, at most [`PAD`](super::column::PAD).
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

    /// Writes the pairs of the lanes in `hits` whose marks share no bit with the probe's, in lane
    /// order. Returns how many. Up to `LANES` pairs may be overwritten at `out`.
    #[inline(always)]
    unsafe fn report(
        hits: Self::Mask,
        probe: &Reporter,
        ids: *const u32,
        marks: *const u32,
        out: *mut [u32; 2],
    ) -> usize {
        // SAFETY: the caller's promise, and only set bits below LANES are looked at.
        unsafe {
            let mut bits = Self::bits(hits);
            let mut count = 0;
            while bits != 0 {
                let lane = bits.trailing_zeros() as usize;
                bits &= bits - 1;
                // Written whether it counts or not: cheaper than a branch that cannot be foretold.
                *out.add(count) = probe.pair(*ids.add(lane));
                count += usize::from(*marks.add(lane) & probe.marks == 0);
            }
            count
        }
    }
}

/// How the two ids of a pair are arranged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrange {
    /// Two boxes of one set: smaller id first.
    Ascending,
    /// Boxes of two sets: the first column's first.
    BySet,
}

/// The part of the probing box that its pairs are made of.
#[derive(Clone, Copy)]
pub(super) struct Reporter {
    pub id: u32,
    pub marks: u32,
    /// Exchange the two ids where the other is smaller; in any case.
    pub swap_if_smaller: bool,
    pub swap_always: bool,
}

impl Reporter {
    #[inline(always)]
    pub fn pair(&self, other: u32) -> [u32; 2] {
        if self.swap_always | (self.swap_if_smaller & (other < self.id)) {
            [other, self.id]
        } else {
            [self.id, other]
        }
    }
}
