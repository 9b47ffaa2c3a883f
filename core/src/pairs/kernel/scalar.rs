//! The definition: one box at a time. Every other kernel gives the same pairs in the same order.

use super::vector::{Packs, Reporter, Vector};

/// A vector of one.
#[derive(Clone, Copy)]
pub(super) struct One<T>(T);

// SAFETY: reads one coordinate, id and bitmap, writes one pair; no instructions beyond the baseline.
unsafe impl<T: Copy + PartialOrd> Vector<T> for One<T> {
    const LANES: usize = 1;
    type Mask = bool;

    #[inline(always)]
    unsafe fn splat(value: T) -> Self {
        One(value)
    }

    #[inline(always)]
    unsafe fn load(from: *const T) -> Self {
        // SAFETY: the caller has a coordinate at `from`.
        One(unsafe { *from })
    }

    #[inline(always)]
    unsafe fn le(a: Self, b: Self) -> bool {
        a.0 <= b.0
    }

    #[inline(always)]
    unsafe fn and_le(mask: bool, a: Self, b: Self) -> bool {
        mask && a.0 <= b.0
    }

    #[inline(always)]
    unsafe fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }

    const PACKS: Packs = Packs::Always;

    #[inline(always)]
    unsafe fn pack(
        hits: u32,
        probe: &Reporter,
        id: *const u32,
        dedup: *const u32,
        out: *mut [u32; 2],
    ) -> usize {
        if hits == 0 {
            return 0;
        }
        // SAFETY: the caller has an id and a bitmap, and space for a pair.
        unsafe {
            *out = probe.pair(*id);
            usize::from(*dedup & probe.dedup == 0)
        }
    }
}
