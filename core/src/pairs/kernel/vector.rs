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

    /// Whether it can [`pack`](Self::pack), and when that pays.
    const PACKS: Packs = Packs::Never;

    /// Writes the pairs of the lanes in `hits` whose dedup bitmaps share no bit with the probe's, in lane
    /// order. Returns how many. Up to `LANES` pairs may be overwritten at `out`.
    #[inline(always)]
    unsafe fn pack(
        _hits: u32,
        _probe: &Reporter,
        _ids: *const u32,
        _dedup: *const u32,
        _out: *mut [u32; 2],
    ) -> usize {
        unreachable!("it does not pack")
    }
}

/// Implements [`Vector`]: a vector, its lanes, the instructions on it, its mask, and, if it can pack, the
/// function that packs pairs and how it takes its ids and bitmaps from memory.
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
macro_rules! vector {
    ($name:ident<$vector:ty>, $lanes:literal, $scalar:ty, $splat:ident, $load:ident,
     $mask:ty, $le:expr, |$and:ident, $a:ident, $b:ident| $and_le:expr, $bits:expr
     $(, $pack:ident, |$from:ident| $numbers:expr)?) => {
        // SAFETY: one load of exactly LANES coordinates; `pack`, where it is, reads LANES
        // ids and bitmaps and writes LANES pairs.
        unsafe impl Vector<$scalar> for $name<$vector> {
            const LANES: usize = $lanes;
            type Mask = $mask;

            #[inline(always)]
            unsafe fn splat(value: $scalar) -> Self {
                // SAFETY: the caller has the instructions.
                Self(unsafe { $splat(value) })
            }

            #[inline(always)]
            unsafe fn load(from: *const $scalar) -> Self {
                // SAFETY: the caller has the instructions, and LANES coordinates at `from`.
                Self(unsafe { $load(from) })
            }

            #[inline(always)]
            unsafe fn le(a: Self, b: Self) -> $mask {
                // SAFETY: the caller has the instructions.
                unsafe { $le(a.0, b.0) }
            }

            #[inline(always)]
            unsafe fn and_le($and: $mask, $a: Self, $b: Self) -> $mask {
                // SAFETY: the caller has the instructions.
                unsafe { $and_le }
            }

            #[inline(always)]
            #[allow(unused_unsafe)] // The masks of AVX-512 are numbers.
            unsafe fn bits(mask: $mask) -> u32 {
                // SAFETY: the caller has the instructions.
                unsafe { $bits(mask) as u32 }
            }

            $(
                const PACKS: Packs = Packs::Always;

                #[inline(always)]
                unsafe fn pack(
                    hits: u32,
                    probe: &Reporter,
                    ids: *const u32,
                    dedup: *const u32,
                    out: *mut [u32; 2],
                ) -> usize {
                    // SAFETY: the caller has the instructions, LANES ids and bitmaps, and space for
                    // LANES pairs.
                    unsafe {
                        let ids = { let $from = ids; $numbers };
                        let dedup = { let $from = dedup; $numbers };
                        $pack(hits, ids, dedup, probe, out, $lanes)
                    }
                }
            )?
        }
    };
}

#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
pub(super) use vector;

/// When a vector packs the pairs of its lanes, in place of writing them one by one.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Packs {
    Never,
    /// Where vectors with hits have several.
    Dense,
    Always,
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
