//! WebAssembly's simd128, where the crate is built with it. A vector here is two of the engine's,
//! 8 `f32` or 4 `f64`: most scans are then over after one turn, which the processor foretells.

use core::arch::wasm32::*;

use super::vector::{Reporter, Vector};

/// Eight `f32`.
#[derive(Clone, Copy)]
pub(super) struct F32x8([v128; 2]);

/// Four `f64`.
#[derive(Clone, Copy)]
pub(super) struct F64x4([v128; 2]);

macro_rules! vector {
    ($name:ident, $scalar:ty, $lanes:literal, $splat:ident, $le:ident, $bits:ident) => {
        // SAFETY: loads of exactly LANES coordinates; `report` reads ids and marks of lanes below
        // LANES, and writes a pair for each hit and, where there is none, one.
        unsafe impl Vector<$scalar> for $name {
            const LANES: usize = $lanes;
            type Mask = [v128; 2];

            #[inline(always)]
            unsafe fn splat(value: $scalar) -> Self {
                Self([$splat(value); 2])
            }

            #[inline(always)]
            unsafe fn load(from: *const $scalar) -> Self {
                let from: *const v128 = from.cast();
                // SAFETY: the caller has LANES coordinates at `from`; no alignment is needed.
                Self(unsafe { [v128_load(from), v128_load(from.add(1))] })
            }

            #[inline(always)]
            unsafe fn le(a: Self, b: Self) -> [v128; 2] {
                [$le(a.0[0], b.0[0]), $le(a.0[1], b.0[1])]
            }

            #[inline(always)]
            unsafe fn and_le(mask: [v128; 2], a: Self, b: Self) -> [v128; 2] {
                [v128_and(mask[0], $le(a.0[0], b.0[0])), v128_and(mask[1], $le(a.0[1], b.0[1]))]
            }

            #[inline(always)]
            unsafe fn bits(mask: [v128; 2]) -> u32 {
                $bits(mask[0], mask[1])
            }

            #[inline(always)]
            unsafe fn report(
                hits: [v128; 2],
                probe: &Reporter,
                ids: *const u32,
                marks: *const u32,
                out: *mut [u32; 2],
            ) -> usize {
                // SAFETY: the caller has LANES ids and marks, and room for LANES pairs.
                unsafe {
                    let mut bits = Self::bits(hits);
                    let pair_of = |bits: u32| {
                        // Without a bit it is lane 0.
                        let lane = bits.trailing_zeros() as usize & (Self::LANES - 1);
                        (probe.pair(*ids.add(lane)), *marks.add(lane) & probe.marks == 0)
                    };
                    // The first hit without asking whether there is one, which cannot be foretold:
                    // that saves a fifth of the whole search.
                    let (pair, counts) = pair_of(bits);
                    *out = pair;
                    let mut count = usize::from(counts & (bits != 0));
                    bits &= bits.wrapping_sub(1);
                    while bits != 0 {
                        let (pair, counts) = pair_of(bits);
                        *out.add(count) = pair;
                        count += usize::from(counts);
                        bits &= bits - 1;
                    }
                    count
                }
            }
        }
    };
}

vector!(F32x8, f32, 8, f32x4_splat, f32x4_le, bits_of_eight);
vector!(F64x4, f64, 4, f64x2_splat, f64x2_le, bits_of_four);

#[inline(always)]
fn bits_of_eight(low: v128, high: v128) -> u32 {
    u32::from(i16x8_bitmask(i16x8_narrow_i32x4(low, high)))
}

#[inline(always)]
fn bits_of_four(low: v128, high: v128) -> u32 {
    u32::from(i32x4_bitmask(i32x4_shuffle::<0, 2, 4, 6>(low, high)))
}
