//! Turns the hits of a sweep into pairs. Vectors that can pack their lanes write pairs at once. For the
//! others hits are noted, and made pairs many at a time: how many hits a vector has is unpredictable, so
//! the processor mispredicts the end of a loop over the hits of each vector. It does not mispredict one
//! loop over all hits that were noted.

use core::hint::black_box;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

use super::sorted_boxes::SortedBoxes;
use super::vector::{Reporter, Vector};

/// The most vectors with hits that are noted before their pairs are written (0.983 of the time on the
/// classic scene in WebAssembly, compared with fewer).
const MOST: usize = 256;

/// The hits of a box in one vector.
#[derive(Clone, Copy)]
struct Note {
    /// The position of the first lane. (Boxes are counted by 32 bits.)
    at: u32,
    /// One bit a lane.
    bits: u32,
    /// The id of the probe.
    id: u32,
    /// Its dedup bitmap, and [`IN_FIRST`].
    dedup: u32,
}

/// Beside the dedup bits, which are not that many: the other boxes are those of the first of two sets.
const IN_FIRST: u32 = 1 << 31;

/// Space for notes, and for two behind them, which are read before it is known that they are none.
/// Apart from [`Output`], so that the compiler may keep that in registers.
pub(super) struct Notes([MaybeUninit<Note>; MOST + 2]);

impl Notes {
    #[inline(always)]
    pub fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; MOST + 2])
    }
}

/// Takes hits.
pub(super) struct Output<'a, T, V> {
    pairs: &'a mut [[u32; 2]],
    written: usize,
    noted: usize,
    /// For so many notes there is space.
    most: usize,
    vector: PhantomData<(T, V)>,
}

impl<'a, T: Copy, V: Vector<T>> Output<'a, T, V> {
    /// For pairs of the vectors `V`, at least one.
    #[inline(always)]
    pub fn new(pairs: &'a mut [[u32; 2]]) -> Self {
        let most = MOST.min(pairs.len() / V::LANES);
        Self { pairs, written: 0, noted: 0, most, vector: PhantomData }
    }

    /// Takes the hits in the vector at a position.
    ///
    /// # Safety
    /// The instructions of `V` are present, and its lanes are positions of `boxes`; it is not
    /// [full](Self::is_full).
    #[inline(always)]
    pub unsafe fn take(
        &mut self,
        hits: V::Mask,
        probe: &Reporter,
        boxes: &SortedBoxes<T>,
        at: usize,
        notes: &mut Notes,
    ) {
        // SAFETY: the caller's promise.
        unsafe {
            if V::PACKS {
                let (ids, dedup) = (boxes.id.as_ptr().add(at), boxes.dedup.as_ptr().add(at));
                let out = self.pairs.as_mut_ptr().add(self.written);
                self.written += V::pack(hits, probe, ids, dedup, out);
            } else {
                let bits = V::bits(hits);
                let dedup = probe.dedup | if probe.in_first { IN_FIRST } else { 0 };
                let note = Note { at: at as u32, bits, id: probe.id, dedup };
                notes.0.get_unchecked_mut(self.noted).write(note);
                self.noted += usize::from(bits != 0);
            }
        }
    }

    /// Whether it takes no more before a [flush](Self::flush).
    #[inline(always)]
    pub fn is_full(&self) -> bool {
        if V::PACKS { !self.has_space() } else { self.noted >= self.most }
    }

    /// Writes what is noted. False if there is no space for more. The sets are the one or two that are
    /// swept; with one the smaller id comes first in any case.
    ///
    /// # Safety
    /// All was taken from these sets.
    #[inline(always)]
    pub unsafe fn flush<const N: usize>(
        &mut self,
        sets: [&SortedBoxes<T>; N],
        ascending: bool,
        notes: &mut Notes,
    ) -> bool {
        if !V::PACKS {
            // SAFETY: the caller's promise; there is space for `most` vectors full of pairs.
            unsafe {
                let out = self.pairs.as_mut_ptr().add(self.written);
                self.written += write(notes, self.noted, sets, ascending, out);
            }
            self.noted = 0;
            self.most = MOST.min((self.pairs.len() - self.written) / V::LANES);
        }
        self.has_space()
    }

    #[inline(always)]
    fn has_space(&self) -> bool {
        self.written + V::LANES <= self.pairs.len()
    }

    /// How many pairs are written.
    pub fn written(&self) -> usize {
        self.written
    }
}

/// Writes the pairs of the first `noted` notes, in their order, apart from those that share a dedup
/// bit. Returns how many. One that is no pair may be written behind them.
///
/// # Safety
/// So many notes were made, at most [`MOST`]. The lanes of all bits are positions in their sets, and
/// there is space at `out` for as many pairs as there are bits.
#[inline(never)]
unsafe fn write<T, const N: usize>(
    notes: &mut Notes,
    noted: usize,
    sets: [&SortedBoxes<T>; N],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    let none = Note { at: 0, bits: 0, id: 0, dedup: 0 };
    notes.0[noted].write(none);
    notes.0[noted + 1].write(none);
    let mut note = notes.0.as_ptr().cast::<Note>();
    // SAFETY: the caller's promise: notes are read up to those two. `count` is less than the number
    // of bits so far.
    unsafe {
        let end = note.add(noted);
        let mut count = 0;
        let mut bits = (*note).bits;
        // Otherwise compilers load it where it is used, and make that a branch.
        let mut next = black_box((*note.add(1)).bits);
        while note < end {
            let Note { at, id, dedup, .. } = *note;
            let in_first = N == 1 || dedup & IN_FIRST != 0;
            let boxes = sets[usize::from(!in_first)];
            let position = at as usize + bits.trailing_zeros() as usize;
            let other = *boxes.id.as_ptr().add(position);
            // Written whether it counts or not, and without a branch: what is smaller, what counts,
            // and when the next note is due are unpredictable.
            let low = if N == 1 || ascending {
                id.min(other)
            } else if in_first {
                other
            } else {
                id
            };
            *out.add(count) = [low, id ^ other ^ low];
            count += usize::from(*boxes.dedup.as_ptr().add(position) & dedup == 0);
            bits &= bits - 1;
            let is_last = bits == 0;
            bits = if is_last { next } else { bits };
            note = note.add(usize::from(is_last));
            next = (*note.add(1)).bits;
        }
        count
    }
}
