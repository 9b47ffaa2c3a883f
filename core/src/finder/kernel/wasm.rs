//! WebAssembly's simd128, where the crate is built with it: 4 `f32` or 2 `f64`.

use core::arch::wasm32::*;

use super::vector::Vector;

/// Four `f32`.
#[derive(Clone, Copy)]
pub(super) struct F32x4(v128);

/// Two `f64`.
#[derive(Clone, Copy)]
pub(super) struct F64x2(v128);

macro_rules! vector {
    ($name:ident, $scalar:ty, $lanes:literal, $splat:ident, $le:ident, $bits:ident) => {
        // SAFETY: one load of exactly LANES coordinates; `report` is the trait's own.
        unsafe impl Vector<$scalar> for $name {
            const LANES: usize = $lanes;
            type Mask = v128;

            #[inline(always)]
            unsafe fn splat(value: $scalar) -> Self {
                Self($splat(value))
            }

            #[inline(always)]
            unsafe fn load(from: *const $scalar) -> Self {
                // SAFETY: the caller has LANES coordinates at `from`; no alignment is needed.
                Self(unsafe { v128_load(from.cast()) })
            }

            #[inline(always)]
            unsafe fn le(a: Self, b: Self) -> v128 {
                $le(a.0, b.0)
            }

            #[inline(always)]
            unsafe fn and_le(mask: v128, a: Self, b: Self) -> v128 {
                v128_and(mask, $le(a.0, b.0))
            }

            #[inline(always)]
            unsafe fn bits(mask: v128) -> u32 {
                u32::from($bits(mask))
            }
        }
    };
}

vector!(F32x4, f32, 4, f32x4_splat, f32x4_le, i32x4_bitmask);
vector!(F64x2, f64, 2, f64x2_splat, f64x2_le, i64x2_bitmask);
