//! NEON, part of every 64-bit ARM processor: 4 `f32` or 2 `f64`.

use core::arch::aarch64::*;
pub(super) use core::arch::aarch64::{float32x4_t, float64x2_t};

use super::vector::{Vector, vector};

/// A vector of NEON.
#[derive(Clone, Copy)]
pub(super) struct Neon<V>(V);

// A bitmap is the sum of the weights of the lanes in a mask: one for each lane.
vector! {
    Neon<float32x4_t>, 4, f32, vdupq_n_f32, vld1q_f32,
    uint32x4_t, vcleq_f32, |mask, a, b| vandq_u32(mask, vcleq_f32(a.0, b.0)),
    |mask| vaddvq_u32(vandq_u32(mask, vld1q_u32([1, 2, 4, 8].as_ptr())))
}
vector! {
    Neon<float64x2_t>, 2, f64, vdupq_n_f64, vld1q_f64,
    uint64x2_t, vcleq_f64, |mask, a, b| vandq_u64(mask, vcleq_f64(a.0, b.0)),
    |mask| vaddvq_u64(vandq_u64(mask, vld1q_u64([1, 2].as_ptr())))
}
