//! SSE2, AVX2 and AVX-512 for x86-64: 4, 8 and 16 `f32`, or half as many `f64`.

use core::arch::x86_64::*;
pub(super) use core::arch::x86_64::{__m128, __m128d, __m256, __m256d, __m512, __m512d};

use super::vector::{Packs, Reporter, Vector, vector};

/// A vector of SSE2, part of every x86-64 processor.
#[derive(Clone, Copy)]
pub(super) struct Sse2<V>(V);

/// A vector of AVX2.
#[derive(Clone, Copy)]
pub(super) struct Avx2<V>(V);

/// A vector of AVX-512 F.
#[derive(Clone, Copy)]
pub(super) struct Avx512<V>(V);

vector! {
    Sse2<__m128>, 4, f32, _mm_set1_ps, _mm_loadu_ps,
    __m128, _mm_cmple_ps, |mask, a, b| _mm_and_ps(mask, _mm_cmple_ps(a.0, b.0)), _mm_movemask_ps
}
vector! {
    Sse2<__m128d>, 2, f64, _mm_set1_pd, _mm_loadu_pd,
    __m128d, _mm_cmple_pd, |mask, a, b| _mm_and_pd(mask, _mm_cmple_pd(a.0, b.0)), _mm_movemask_pd
}
vector! {
    Avx2<__m256>, 8, f32, _mm256_set1_ps, _mm256_loadu_ps,
    __m256, _mm256_cmp_ps::<_CMP_LE_OQ>,
    |mask, a, b| _mm256_and_ps(mask, _mm256_cmp_ps::<_CMP_LE_OQ>(a.0, b.0)),
    _mm256_movemask_ps, pack, |from| _mm256_loadu_si256(from.cast())
}
vector! {
    Avx2<__m256d>, 4, f64, _mm256_set1_pd, _mm256_loadu_pd,
    __m256d, _mm256_cmp_pd::<_CMP_LE_OQ>,
    |mask, a, b| _mm256_and_pd(mask, _mm256_cmp_pd::<_CMP_LE_OQ>(a.0, b.0)),
    _mm256_movemask_pd, pack, |from| _mm256_castsi128_si256(_mm_loadu_si128(from.cast()))
}
vector! {
    Avx512<__m512>, 16, f32, _mm512_set1_ps, _mm512_loadu_ps,
    __mmask16, _mm512_cmp_ps_mask::<_CMP_LE_OQ>,
    |mask, a, b| _mm512_mask_cmp_ps_mask::<_CMP_LE_OQ>(mask, a.0, b.0),
    u32::from, compress, |from| _mm512_loadu_si512(from.cast())
}
vector! {
    Avx512<__m512d>, 8, f64, _mm512_set1_pd, _mm512_loadu_pd,
    __mmask8, _mm512_cmp_pd_mask::<_CMP_LE_OQ>,
    |mask, a, b| _mm512_mask_cmp_pd_mask::<_CMP_LE_OQ>(mask, a.0, b.0),
    u32::from, compress, |from| _mm512_castsi256_si512(_mm256_loadu_si256(from.cast()))
}

/// The pairs of the lanes in `hits`, packed to the front without a branch: what AVX2 has no
/// instruction for is looked up. Of the ids and bitmaps only the first `lanes` matter.
///
/// # Safety
/// AVX2; space for `lanes` (4 or 8) pairs at `out`; no hit beyond `lanes`.
#[inline(always)]
unsafe fn pack(
    hits: u32,
    ids: __m256i,
    dedup: __m256i,
    probe: &Reporter,
    out: *mut [u32; 2],
    lanes: usize,
) -> usize {
    // SAFETY: the caller has the instructions, and space for `lanes` pairs at `out`; four pairs are one vector.
    unsafe {
        let own = _mm256_set1_epi32(probe.id as i32);
        let shared = _mm256_and_si256(dedup, _mm256_set1_epi32(probe.dedup as i32));
        let reported_here = _mm256_cmpeq_epi32(shared, _mm256_setzero_si256());
        let reported = hits & _mm256_movemask_ps(_mm256_castsi256_ps(reported_here)) as u32;
        let (first, second) = if probe.ascending {
            (_mm256_min_epu32(ids, own), _mm256_max_epu32(ids, own))
        } else if probe.in_first {
            (ids, own)
        } else {
            (own, ids)
        };
        let front = FRONT[reported as usize].as_ptr();
        let front = _mm256_cvtepu8_epi32(_mm_loadl_epi64(front.cast()));
        let first = _mm256_permutevar8x32_epi32(first, front);
        let second = _mm256_permutevar8x32_epi32(second, front);
        // Of each half of both.
        let low = _mm256_unpacklo_epi32(first, second);
        let high = _mm256_unpackhi_epi32(first, second);
        _mm256_storeu_si256(out.cast(), _mm256_permute2x128_si256::<0x20>(low, high));
        if lanes == 8 {
            let rest = _mm256_permute2x128_si256::<0x31>(low, high);
            _mm256_storeu_si256(out.add(4).cast(), rest);
        }
        reported.count_ones() as usize
    }
}

/// Which lanes are in a mask, from the front.
static FRONT: [[u8; 8]; 256] = {
    let mut table = [[0; 8]; 256];
    let mut mask = 0;
    while mask < table.len() {
        let (mut lane, mut at) = (0, 0);
        while lane < 8 {
            if mask >> lane & 1 == 1 {
                table[mask][at] = lane as u8;
                at += 1;
            }
            lane += 1;
        }
        mask += 1;
    }
    table
};

/// The pairs of the lanes in `hits`, packed to the front without a branch.
///
/// # Safety
/// AVX-512 F; space for `lanes` (8 or 16) pairs at `out`; no hit beyond `lanes`.
#[inline(always)]
unsafe fn compress(
    hits: u32,
    ids: __m512i,
    dedup: __m512i,
    probe: &Reporter,
    out: *mut [u32; 2],
    lanes: usize,
) -> usize {
    // SAFETY: the caller has the instructions, and space for `lanes` pairs at `out`; eight pairs are one vector.
    unsafe {
        let own = _mm512_set1_epi32(probe.id as i32);
        let reported =
            _mm512_mask_testn_epi32_mask(hits as u16, dedup, _mm512_set1_epi32(probe.dedup as i32));
        let swapped = if probe.ascending {
            _mm512_cmplt_epu32_mask(ids, own)
        } else {
            (probe.in_first as u16).wrapping_neg()
        };
        let first =
            _mm512_maskz_compress_epi32(reported, _mm512_mask_blend_epi32(swapped, own, ids));
        let second =
            _mm512_maskz_compress_epi32(reported, _mm512_mask_blend_epi32(swapped, ids, own));
        let low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
        _mm512_storeu_si512(out.cast(), _mm512_permutex2var_epi32(first, low, second));
        if lanes == 16 {
            let high =
                _mm512_setr_epi32(8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
            _mm512_storeu_si512(out.add(8).cast(), _mm512_permutex2var_epi32(first, high, second));
        }
        reported.count_ones() as usize
    }
}
