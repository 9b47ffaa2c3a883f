//! WebAssembly's simd128, where the crate is built with it. A vector here is two of the engine's,
//! 8 `f32` or 4 `f64`: most scans then end after one turn, which the processor predicts.

use core::arch::wasm32::*;

use super::vector::{Packs, Reporter, Vector};
use crate::geometry::Quantizer;

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

            const PACKS: Packs = Packs::Dense;

            #[inline(always)]
            unsafe fn pack(
                hits: u32,
                probe: &Reporter,
                ids: *const u32,
                dedup: *const u32,
                out: *mut [u32; 2],
            ) -> usize {
                let mut count = 0;
                for lane in (0..$lanes).step_by(4) {
                    // SAFETY: the caller has LANES ids and bitmaps, and space for LANES pairs.
                    unsafe {
                        let (ids, dedup) = (ids.add(lane), dedup.add(lane));
                        count += pack_four(hits >> lane, probe, ids, dedup, out.add(count));
                    }
                }
                count
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

/// The pairs of the lanes in the lowest four bits of `hits`, packed to the front without a branch.
///
/// # Safety
/// Four ids and bitmaps, and space for four pairs.
#[inline(always)]
unsafe fn pack_four(
    hits: u32,
    probe: &Reporter,
    ids: *const u32,
    dedup: *const u32,
    out: *mut [u32; 2],
) -> usize {
    // SAFETY: four numbers are one vector, and so are two pairs.
    unsafe {
        let (ids, own) = (v128_load(ids.cast()), u32x4_splat(probe.id));
        let shared = v128_and(v128_load(dedup.cast()), u32x4_splat(probe.dedup));
        let reported_here = i32x4_bitmask(i32x4_eq(shared, u32x4_splat(0)));
        let reported = hits as usize & usize::from(reported_here);
        let front = v128_load(FRONT[reported & 15].as_ptr().cast());
        let (first, second) = if probe.ascending {
            (u32x4_min(ids, own), u32x4_max(ids, own))
        } else if probe.in_first {
            (ids, own)
        } else {
            (own, ids)
        };
        let (first, second) = (i8x16_swizzle(first, front), i8x16_swizzle(second, front));
        v128_store(out.cast(), i32x4_shuffle::<0, 4, 1, 5>(first, second));
        v128_store(out.add(2).cast(), i32x4_shuffle::<2, 6, 3, 7>(first, second));
        reported.count_ones() as usize
    }
}

/// The bytes of the lanes in a mask of four, from the front.
static FRONT: [[u8; 16]; 16] = {
    let mut table = [[0; 16]; 16];
    let mut mask = 0;
    while mask < table.len() {
        let (mut lane, mut at) = (0, 0);
        while lane < 4 {
            if mask >> lane & 1 == 1 {
                let mut byte = 0;
                while byte < 4 {
                    table[mask][4 * at + byte] = (4 * lane + byte) as u8;
                    byte += 1;
                }
                at += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

/// Adds `step` times the first cell of each interval to its column, and computes how many more cells
/// it touches. False if an interval is inverted or NaN. The compiler makes vectors of the loop in
/// `grid.rs`, which does the same, only where it does not optimize for size.
pub fn quantize_by_four<const N: usize>(
    [low, high]: [&[f32; N]; 2],
    quantizer: &Quantizer<f32>,
    step: u32,
    column: &mut [u32; N],
    more: &mut [u32; N],
) -> bool {
    const { assert!(N.is_multiple_of(4)) };
    let (unit, origin) = (f32x4_splat(quantizer.unit), f32x4_splat(quantizer.origin));
    let (scale, last) = (f32x4_splat(quantizer.scale), f32x4_splat(quantizer.last));
    let anchor = f32x4_splat((1 << (f32::MANTISSA_DIGITS - 1)) as f32);
    let cell = |at| {
        let at = f32x4_mul(f32x4_sub(f32x4_mul(at, unit), origin), scale);
        // In this order the first also turns a NaN into 0.
        let at = f32x4_pmin(last, f32x4_pmax(f32x4_splat(0.0), at));
        v128_xor(f32x4_add(at, anchor), anchor)
    };
    let mut valid = u32x4_splat(u32::MAX);
    for i in (0..N).step_by(4) {
        // SAFETY: all four are arrays of N, a multiple of four.
        unsafe {
            let low = v128_load(low.as_ptr().add(i).cast());
            let high = v128_load(high.as_ptr().add(i).cast());
            let column: *mut v128 = column.as_mut_ptr().add(i).cast();
            let more: *mut v128 = more.as_mut_ptr().add(i).cast();
            valid = v128_and(valid, f32x4_le(low, high));
            let first = cell(low);
            let behind = i32x4_mul(first, u32x4_splat(step));
            v128_store(column, i32x4_add(v128_load(column), behind));
            v128_store(more, i32x4_sub(u32x4_max(cell(high), first), first));
        }
    }
    i32x4_all_true(valid)
}
