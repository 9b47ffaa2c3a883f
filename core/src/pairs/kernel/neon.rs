//! NEON, part of every 64-bit ARM processor: 4 `f32` or 2 `f64`.

use core::arch::aarch64::*;

use super::vector::Vector;

/// A vector of NEON.
#[derive(Clone, Copy)]
pub(super) struct Neon<V>(V);

/// A vector, its mask, the instructions on both, and the weight of each lane in a bitmap.
macro_rules! vector {
    ($vector:ty, $lanes:literal, $scalar:ty, $splat:ident, $load:ident,
     $mask:ty, $le:ident, $and:ident, $sum:ident, $load_mask:ident, $weights:expr) => {
        // SAFETY: one load of exactly LANES coordinates.
        unsafe impl Vector<$scalar> for Neon<$vector> {
            const LANES: usize = $lanes;
            type Mask = $mask;

            #[inline(always)]
            unsafe fn splat(value: $scalar) -> Self {
                // SAFETY: NEON is part of the baseline.
                Self(unsafe { $splat(value) })
            }

            #[inline(always)]
            unsafe fn load(from: *const $scalar) -> Self {
                // SAFETY: the caller has LANES coordinates at `from`.
                Self(unsafe { $load(from) })
            }

            #[inline(always)]
            unsafe fn le(a: Self, b: Self) -> $mask {
                // SAFETY: NEON is part of the baseline.
                unsafe { $le(a.0, b.0) }
            }

            #[inline(always)]
            unsafe fn and_le(mask: $mask, a: Self, b: Self) -> $mask {
                // SAFETY: NEON is part of the baseline.
                unsafe { $and(mask, $le(a.0, b.0)) }
            }

            #[inline(always)]
            unsafe fn bits(mask: $mask) -> u32 {
                // SAFETY: NEON is part of the baseline; there are LANES weights.
                unsafe { $sum($and(mask, $load_mask($weights.as_ptr()))) as u32 }
            }
        }
    };
}

vector! {
    float32x4_t, 4, f32, vdupq_n_f32, vld1q_f32,
    uint32x4_t, vcleq_f32, vandq_u32, vaddvq_u32, vld1q_u32, [1, 2, 4, 8]
}
vector! {
    float64x2_t, 2, f64, vdupq_n_f64, vld1q_f64,
    uint64x2_t, vcleq_f64, vandq_u64, vaddvq_u64, vld1q_u64, [1, 2]
}
