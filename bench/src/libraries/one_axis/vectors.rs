//! The sweep with AVX-512 and with AVX2.

// Vectors are loaded from and stored to memory through pointers.
#![allow(unsafe_code)]

use std::arch::x86_64::*;

use super::sorted::{SENTINEL, SENTINELS, Sorted};

/// A sweep: it writes the pairs of the first boxes and returns how many there are.
type Sweep<const D: usize> = fn(&Sorted<D>, usize, &mut Vec<[u32; 2]>) -> usize;

/// The sweeps that this processor can run, the widest first.
pub fn available<const D: usize>() -> impl Iterator<Item = Sweep<D>> {
    let counts = is_x86_feature_detected!("popcnt");
    let wide = counts && is_x86_feature_detected!("avx512f");
    let narrow = counts && is_x86_feature_detected!("avx2");
    let wide = wide.then_some::<Sweep<D>>(|sorted, count, pairs| {
        sorted.check(count);
        // SAFETY: the processor has AVX-512F and POPCNT, and `check` has found all arrays long enough.
        unsafe { sweep_avx512(sorted, count, pairs) }
    });
    let narrow = narrow.then_some::<Sweep<D>>(|sorted, count, pairs| {
        sorted.check(count);
        // SAFETY: the processor has AVX2 and POPCNT, and `check` has found all arrays long enough.
        unsafe { sweep_avx2(sorted, count, pairs) }
    });
    wide.into_iter().chain(narrow)
}

/// Runs the widest sweep; `None` if the processor has none.
pub fn sweep<const D: usize>(
    sorted: &Sorted<D>,
    count: usize,
    pairs: &mut Vec<[u32; 2]>,
) -> Option<usize> {
    available().next().map(|sweep| sweep(sorted, count, pairs))
}

impl<const D: usize> Sorted<D> {
    /// Panics if an array is too short for a vector that begins at the last box or just after it.
    fn check(&self, count: usize) {
        let long = |len: usize| len >= count + SENTINELS;
        assert!(long(self.ids.len()), "ids without sentinels");
        assert!(self.min.iter().chain(&self.max).all(|array| long(array.len())), "no sentinels");
        // The sentinels end each sweep at the first vector that reaches them.
        assert!(self.min[0][count..].iter().all(|&min| min == SENTINEL), "no sentinels");
    }
}

/// Makes `pairs` longer than `found` by at least a vector.
#[cold]
#[inline(never)]
fn grow(pairs: &mut Vec<[u32; 2]>, found: usize) {
    pairs.resize(2 * found + 1024, [0; 2]);
}

/// # Safety
///
/// The arrays of `sorted` passed [`Sorted::check`] with `count`, and no max on the first axis is a sentinel.
#[target_feature(enable = "avx512f,popcnt")]
unsafe fn sweep_avx512<const D: usize>(
    sorted: &Sorted<D>,
    count: usize,
    pairs: &mut Vec<[u32; 2]>,
) -> usize {
    const LANES: usize = 16;
    // SAFETY: `b` is at most `count` when a sweep begins. It moves on by a vector only if all lanes of the last one
    // lie below a max, so that none of them was a sentinel. A vector at `b` therefore ends at most at
    // `count + LANES`, within the sentinels.
    let load =
        |array: &Vec<i32>, b: usize| unsafe { _mm512_loadu_si512(array.as_ptr().add(b).cast()) };
    // Which lanes of (hits, a) are interleaved to pairs.
    let low = _mm512_setr_epi32(16, 0, 16, 1, 16, 2, 16, 3, 16, 4, 16, 5, 16, 6, 16, 7);
    let high = _mm512_setr_epi32(16, 8, 16, 9, 16, 10, 16, 11, 16, 12, 16, 13, 16, 14, 16, 15);
    let mut found = 0;
    for a in 0..count {
        // SAFETY: `a` is below `count`, which is below the length of each array.
        let at = |array: &Vec<i32>| unsafe { _mm512_set1_epi32(*array.get_unchecked(a)) };
        let min = sorted.min.each_ref().map(at);
        let max = sorted.max.each_ref().map(at);
        // SAFETY: as above.
        let id = _mm512_set1_epi32(unsafe { *sorted.ids.get_unchecked(a) } as i32);
        let mut b = a + 1;
        loop {
            let ahead = _mm512_cmple_epi32_mask(load(&sorted.min[0], b), max[0]);
            let mut hits = ahead;
            for axis in 1..D {
                hits = _mm512_mask_cmple_epi32_mask(hits, load(&sorted.min[axis], b), max[axis]);
                hits = _mm512_mask_cmple_epi32_mask(hits, min[axis], load(&sorted.max[axis], b));
            }
            if found + LANES > pairs.len() {
                grow(pairs, found);
            }
            // SAFETY: as for `load`; `ids` is as long.
            let ids = unsafe { _mm512_loadu_si512(sorted.ids.as_ptr().add(b).cast()) };
            let ids = _mm512_maskz_compress_epi32(hits, ids);
            // SAFETY: `pairs` is longer than `found` by at least a vector.
            let to = unsafe { pairs.as_mut_ptr().add(found) };
            let (first, second) =
                (_mm512_permutex2var_epi32(ids, low, id), _mm512_permutex2var_epi32(ids, high, id));
            // SAFETY: 16 pairs of 8 bytes are two vectors, which `pairs` has space for.
            unsafe {
                _mm512_storeu_si512(to.cast(), first);
                _mm512_storeu_si512(to.add(LANES / 2).cast(), second);
            }
            found += hits.count_ones() as usize;
            if ahead != u16::MAX {
                break;
            }
            b += LANES;
        }
    }
    found
}

/// For each set of lanes, the indices of these lanes.
static COMPRESS: [[u32; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut set = 0;
    while set < 256 {
        let (mut lane, mut to) = (0, 0);
        while lane < 8 {
            if set >> lane & 1 == 1 {
                table[set][to] = lane;
                to += 1;
            }
            lane += 1;
        }
        set += 1;
    }
    table
};

/// # Safety
///
/// As of [`sweep_avx512`].
#[target_feature(enable = "avx2,popcnt")]
unsafe fn sweep_avx2<const D: usize>(
    sorted: &Sorted<D>,
    count: usize,
    pairs: &mut Vec<[u32; 2]>,
) -> usize {
    const LANES: usize = 8;
    // SAFETY: as in `sweep_avx512`, with shorter vectors.
    let load =
        |array: &Vec<i32>, b: usize| unsafe { _mm256_loadu_si256(array.as_ptr().add(b).cast()) };
    let mut found = 0;
    for a in 0..count {
        // SAFETY: `a` is below `count`, which is below the length of each array.
        let at = |array: &Vec<i32>| unsafe { _mm256_set1_epi32(*array.get_unchecked(a)) };
        let min = sorted.min.each_ref().map(at);
        let max = sorted.max.each_ref().map(at);
        // SAFETY: as above.
        let id = _mm256_set1_epi32(unsafe { *sorted.ids.get_unchecked(a) } as i32);
        let mut b = a + 1;
        loop {
            let beyond = _mm256_cmpgt_epi32(load(&sorted.min[0], b), max[0]);
            let mut apart = beyond;
            for axis in 1..D {
                let above = _mm256_cmpgt_epi32(load(&sorted.min[axis], b), max[axis]);
                let below = _mm256_cmpgt_epi32(min[axis], load(&sorted.max[axis], b));
                apart = _mm256_or_si256(apart, _mm256_or_si256(above, below));
            }
            let hits = !_mm256_movemask_ps(_mm256_castsi256_ps(apart)) as u8;
            if found + LANES > pairs.len() {
                grow(pairs, found);
            }
            // SAFETY: as for `load`; `ids` is as long, and a row of the table is a vector.
            let (ids, lanes) = unsafe {
                let row: *const __m256i = COMPRESS[usize::from(hits)].as_ptr().cast();
                (_mm256_loadu_si256(sorted.ids.as_ptr().add(b).cast()), _mm256_loadu_si256(row))
            };
            let ids = _mm256_permutevar8x32_epi32(ids, lanes);
            // Pairs 0, 1, 4, 5 and 2, 3, 6, 7.
            let (even, odd) = (_mm256_unpacklo_epi32(id, ids), _mm256_unpackhi_epi32(id, ids));
            // SAFETY: 8 pairs of 8 bytes are two vectors, which `pairs` has space for.
            unsafe {
                let to: *mut __m256i = pairs.as_mut_ptr().add(found).cast();
                _mm256_storeu_si256(to, _mm256_permute2x128_si256::<0x20>(even, odd));
                _mm256_storeu_si256(to.add(1), _mm256_permute2x128_si256::<0x31>(even, odd));
            }
            found += hits.count_ones() as usize;
            if _mm256_testz_si256(beyond, beyond) == 0 {
                break;
            }
            b += LANES;
        }
    }
    found
}
