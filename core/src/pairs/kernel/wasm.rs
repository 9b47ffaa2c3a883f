//! WebAssembly's simd128, where the crate is built with it. A vector here is two of the engine's,
//! 8 `f32` or 4 `f64`: most scans are then over after one turn, which the processor foretells.

use core::arch::wasm32::*;

use super::super::numbers::{BLOCK, Ruler};
use super::vector::Vector;

/// Eight `f32`.
#[derive(Clone, Copy)]
pub(super) struct F32x8([v128; 2]);

/// Four `f64`.
#[derive(Clone, Copy)]
pub(super) struct F64x4([v128; 2]);

macro_rules! vector {
    ($name:ident, $scalar:ty, $lanes:literal, $splat:ident, $le:ident, $bits:ident) => {
        // SAFETY: loads of exactly LANES coordinates.
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

/// As [`Number::spans`](super::super::numbers::Number::spans), which the compiler makes vectors of
/// only where it does not go for size.
pub fn spans_by_four(
    [low, high]: [&[f32; BLOCK]; 2],
    ruler: &Ruler<f32>,
    step: u32,
    bin: &mut [u32; BLOCK],
    more: &mut [u32; BLOCK],
) -> bool {
    let (unit, origin) = (f32x4_splat(ruler.unit), f32x4_splat(ruler.origin));
    let (scale, last) = (f32x4_splat(ruler.scale), f32x4_splat(ruler.last));
    let anchor = f32x4_splat((1 << (f32::MANTISSA_DIGITS - 1)) as f32);
    let cell = |at| {
        let place = f32x4_mul(f32x4_sub(f32x4_mul(at, unit), origin), scale);
        // In this order the first also turns a NaN into 0.
        let place = f32x4_pmin(last, f32x4_pmax(f32x4_splat(0.0), place));
        v128_xor(f32x4_add(place, anchor), anchor)
    };
    let mut valid = u32x4_splat(u32::MAX);
    for i in (0..BLOCK).step_by(4) {
        // SAFETY: all four are arrays of BLOCK, a multiple of four.
        unsafe {
            let low = v128_load(low.as_ptr().add(i).cast());
            let high = v128_load(high.as_ptr().add(i).cast());
            let bin: *mut v128 = bin.as_mut_ptr().add(i).cast();
            let more: *mut v128 = more.as_mut_ptr().add(i).cast();
            valid = v128_and(valid, f32x4_le(low, high));
            let first = cell(low);
            let behind = i32x4_mul(first, u32x4_splat(step));
            v128_store(bin, i32x4_add(v128_load(bin), behind));
            v128_store(more, i32x4_sub(u32x4_max(cell(high), first), first));
        }
    }
    i32x4_all_true(valid)
}
