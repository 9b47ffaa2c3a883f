//! NEON, part of every 64-bit ARM processor: 4 `f32` or 2 `f64`.

use core::arch::aarch64::*;

use super::vector::Vector;

/// A vector of NEON.
#[derive(Clone, Copy)]
pub(super) struct Neon<V>(V);

// SAFETY: one load of exactly four coordinates.
unsafe impl Vector<f32> for Neon<float32x4_t> {
    const LANES: usize = 4;
    type Mask = uint32x4_t;

    #[inline(always)]
    unsafe fn splat(value: f32) -> Self {
        // SAFETY: NEON is part of the baseline.
        Self(unsafe { vdupq_n_f32(value) })
    }

    #[inline(always)]
    unsafe fn load(from: *const f32) -> Self {
        // SAFETY: the caller has four coordinates at `from`.
        Self(unsafe { vld1q_f32(from) })
    }

    #[inline(always)]
    unsafe fn le(a: Self, b: Self) -> uint32x4_t {
        // SAFETY: NEON is part of the baseline.
        unsafe { vcleq_f32(a.0, b.0) }
    }

    #[inline(always)]
    unsafe fn and_le(mask: uint32x4_t, a: Self, b: Self) -> uint32x4_t {
        // SAFETY: NEON is part of the baseline.
        unsafe { vandq_u32(mask, vcleq_f32(a.0, b.0)) }
    }

    #[inline(always)]
    unsafe fn bits(mask: uint32x4_t) -> u32 {
        // SAFETY: NEON is part of the baseline; the array holds four numbers.
        unsafe { vaddvq_u32(vandq_u32(mask, vld1q_u32([1, 2, 4, 8].as_ptr()))) }
    }
}

// SAFETY: one load of exactly two coordinates.
unsafe impl Vector<f64> for Neon<float64x2_t> {
    const LANES: usize = 2;
    type Mask = uint64x2_t;

    #[inline(always)]
    unsafe fn splat(value: f64) -> Self {
        // SAFETY: NEON is part of the baseline.
        Self(unsafe { vdupq_n_f64(value) })
    }

    #[inline(always)]
    unsafe fn load(from: *const f64) -> Self {
        // SAFETY: the caller has two coordinates at `from`.
        Self(unsafe { vld1q_f64(from) })
    }

    #[inline(always)]
    unsafe fn le(a: Self, b: Self) -> uint64x2_t {
        // SAFETY: NEON is part of the baseline.
        unsafe { vcleq_f64(a.0, b.0) }
    }

    #[inline(always)]
    unsafe fn and_le(mask: uint64x2_t, a: Self, b: Self) -> uint64x2_t {
        // SAFETY: NEON is part of the baseline.
        unsafe { vandq_u64(mask, vcleq_f64(a.0, b.0)) }
    }

    #[inline(always)]
    unsafe fn bits(mask: uint64x2_t) -> u32 {
        // SAFETY: NEON is part of the baseline; the array holds two numbers.
        unsafe { vaddvq_u64(vandq_u64(mask, vld1q_u64([1, 2].as_ptr()))) as u32 }
    }
}
