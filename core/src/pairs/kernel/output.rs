//! Turns the hits of a sweep into pairs. Vectors that can pack their lanes write pairs at once. The others note
//! their hits, and many notes are turned into pairs at a time:
//!
//! ```text
//! for each note                          (a vector with hits)
//!     for each hit of the note
//!         write its pair; advance unless the two boxes share a dedup bit
//! ```
//!
//! How many hits a vector has is unpredictable, so the processor would mispredict the end of the inner loop for each
//! vector. So both loops are one loop over all hits, without a branch for the end of a note. Vectors that pack their lanes
//! only slowly do so with the notes where most have several hits (in WebAssembly a search of boxes at one place takes 0.36 of
//! the time, and a lattice 0.88).

use core::hint::black_box;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

use super::sorted_boxes::SortedBoxes;
use super::vector::{Packs, Reporter, Vector};

/// The most vectors with hits that are noted before their pairs are written. (With fewer, a search of the classic scene
/// took longer in WebAssembly: this many take 0.983 of the time.)
const MOST_NOTES: usize = 256;

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

/// Notes are packed where the last ones had more pairs than this, a note. Measured in WebAssembly on all scenes, 60,000
/// boxes: with 2 a lattice takes 1.03 of the time, with 1 uniform boxes take up to 1.05.
const DENSE: f32 = 1.5;

/// Flag in the high bit of `dedup`, which the dedup bits never reach: the other box belongs to the first of two sets.
const IN_FIRST: u32 = 1 << 31;

/// Space for notes, and for two more: these are read before it is known that they are no notes.
/// It is apart from [`Output`], so that the compiler can keep the output in registers.
pub(super) struct Notes([MaybeUninit<Note>; MOST_NOTES + 2]);

impl Notes {
    #[inline(always)]
    pub fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; MOST_NOTES + 2])
    }
}

/// Takes hits.
pub(super) struct Output<'a, T, V> {
    pairs: &'a mut [[u32; 2]],
    written: usize,
    noted: usize,
    /// How many notes fit before a flush.
    most: usize,
    /// Whether the last notes had several pairs each.
    is_dense: bool,
    vector: PhantomData<(T, V)>,
}

impl<'a, T: Copy, V: Vector<T>> Output<'a, T, V> {
    /// For pairs of the vectors `V`, at least one.
    #[inline(always)]
    pub fn new(pairs: &'a mut [[u32; 2]]) -> Self {
        let most = MOST_NOTES.min(pairs.len() / V::LANES);
        Self { pairs, written: 0, noted: 0, most, is_dense: false, vector: PhantomData }
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
        // SAFETY: the caller has the instructions, and LANES boxes at `at`. The output is not full, so there is space
        // for LANES more pairs, or for one more note.
        unsafe {
            let bits = V::bits(hits);
            if V::PACKS == Packs::Always {
                let (ids, dedup) = (boxes.id.as_ptr().add(at), boxes.dedup.as_ptr().add(at));
                let out = self.pairs.as_mut_ptr().add(self.written);
                self.written += V::pack(bits, probe, ids, dedup, out);
            } else {
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
        if V::PACKS == Packs::Always { !self.has_space() } else { self.noted >= self.most }
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
        if V::PACKS != Packs::Always {
            // SAFETY: the hits are lanes of these sets, at most `most` vectors of them, and there is space for `most`
            // vectors full of pairs.
            unsafe {
                let out = self.pairs.as_mut_ptr().add(self.written);
                let written = if V::PACKS == Packs::Dense && self.is_dense {
                    pack::<T, V, N>(notes, self.noted, sets, ascending, out)
                } else {
                    write(notes, self.noted, sets, ascending, out)
                };
                self.written += written;
                self.is_dense = written as f32 > DENSE * self.noted as f32;
            }
            self.noted = 0;
            self.most = MOST_NOTES.min((self.pairs.len() - self.written) / V::LANES);
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
/// `noted` notes were written, at most [`MOST_NOTES`]. The lanes of all bits are positions in their sets, and
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
    // SAFETY: all notes up to `noted` are written, and the two behind them are written above. `count` is less than the number
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

/// Writes what [`write`] does, all lanes of a note at once.
///
/// # Safety
/// The instructions of `V` are present, `noted` notes were written, at most [`MOST_NOTES`], each of a whole vector of its set, and
/// there is space at `out` for as many pairs as these have lanes.
#[inline(never)]
unsafe fn pack<T: Copy, V: Vector<T>, const N: usize>(
    notes: &Notes,
    noted: usize,
    sets: [&SortedBoxes<T>; N],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    let mut count = 0;
    for note in &notes.0[..noted] {
        // SAFETY: the note is written, its lanes are positions of its set, and of the space for `noted` vectors of pairs no more
        // than those before it have taken theirs.
        unsafe {
            let Note { at, bits, id, dedup } = note.assume_init();
            let in_first = dedup & IN_FIRST != 0;
            let boxes = sets[usize::from(N == 2 && !in_first)];
            let probe =
                Reporter { id, dedup: dedup & !IN_FIRST, ascending: N == 1 || ascending, in_first };
            let (ids, dedup) =
                (boxes.id.as_ptr().add(at as usize), boxes.dedup.as_ptr().add(at as usize));
            count += V::pack(bits, &probe, ids, dedup, out.add(count));
        }
    }
    count
}
