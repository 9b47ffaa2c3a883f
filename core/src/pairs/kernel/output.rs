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
//! only slowly do so with the notes where most have several hits (in WebAssembly a search of boxes at one place takes 0.40 of
//! the time, and a lattice 0.94).

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

/// Notes are packed where the last ones had more than 3 / 2 pairs each. Measured in WebAssembly on all scenes, 60,000 boxes: with
/// 2 a lattice takes 1.03 of the time, with 1 uniform boxes take up to 1.05.
const DENSE: [usize; 2] = [3, 2];

/// Flag in the high bit of `dedup`, which the dedup bits never reach: the other box belongs to the first of two sets.
const IN_FIRST: u32 = 1 << 31;

/// Space for notes, and for two more: these are read before it is known that they are no notes.
/// It is apart from [`Output`], so that the compiler can keep the output in registers.
pub(super) struct Notes {
    list: [MaybeUninit<Note>; MOST_NOTES + 2],
    /// Whether the last ones had several pairs each.
    are_dense: bool,
}

impl Notes {
    #[inline(always)]
    pub fn new() -> Self {
        Self { list: [const { MaybeUninit::uninit() }; MOST_NOTES + 2], are_dense: false }
    }
}

/// Takes hits.
pub(super) struct Output<'a, T, V> {
    pairs: &'a mut [[u32; 2]],
    written: usize,
    noted: usize,
    /// How many notes fit before a flush.
    most: usize,
    vector: PhantomData<(T, V)>,
}

impl<'a, T: Copy, V: Vector<T>> Output<'a, T, V> {
    /// For pairs of the vectors `V`, at least one.
    #[inline(always)]
    pub fn new(pairs: &'a mut [[u32; 2]]) -> Self {
        let most = MOST_NOTES.min(pairs.len() / V::LANES);
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
                notes.list.get_unchecked_mut(self.noted).write(note);
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
                self.written += write::<T, V, N>(notes, self.noted, sets, ascending, out);
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
/// The instructions of `V` are present. `noted` notes were written, at most [`MOST_NOTES`], each of a vector of its set, and there is
/// space at `out` for as many pairs as these have lanes.
#[inline(never)]
unsafe fn write<T: Copy, V: Vector<T>, const N: usize>(
    notes: &mut Notes,
    noted: usize,
    sets: [&SortedBoxes<T>; N],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    // SAFETY: as promised by our caller, to both.
    let count = unsafe {
        if V::PACKS == Packs::Dense && notes.are_dense {
            pack::<T, V>(notes, noted, [sets[0], sets[N - 1]], N == 1 || ascending, out)
        } else {
            write_each(notes, noted, sets, ascending, out)
        }
    };
    notes.are_dense = count * DENSE[1] > noted * DENSE[0];
    count
}

/// Writes the pairs one by one.
///
/// # Safety
/// That of [`write()`].
#[inline(always)]
unsafe fn write_each<T, const N: usize>(
    notes: &mut Notes,
    noted: usize,
    sets: [&SortedBoxes<T>; N],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    let none = Note { at: 0, bits: 0, id: 0, dedup: 0 };
    notes.list[noted].write(none);
    notes.list[noted + 1].write(none);
    let mut note = notes.list.as_ptr().cast::<Note>();
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

/// Writes the pairs of a note at once, and then those of the next. One set is given twice.
///
/// # Safety
/// That of [`write()`].
#[inline(never)]
unsafe fn pack<T: Copy, V: Vector<T>>(
    notes: &Notes,
    noted: usize,
    sets: [&SortedBoxes<T>; 2],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    let mut count = 0;
    for note in 0..noted {
        // SAFETY: the note is written, its lanes are positions of its set, and of the space for `noted` vectors of pairs no more
        // than those before it have taken theirs.
        unsafe {
            let Note { at, bits, id, dedup } = notes.list.get_unchecked(note).assume_init();
            let in_first = dedup & IN_FIRST != 0;
            let boxes = sets[usize::from(!in_first)];
            let probe = Reporter { id, dedup: dedup & !IN_FIRST, ascending, in_first };
            let (ids, dedup) =
                (boxes.id.as_ptr().add(at as usize), boxes.dedup.as_ptr().add(at as usize));
            count += V::pack(bits, &probe, ids, dedup, out.add(count));
        }
    }
    count
}
