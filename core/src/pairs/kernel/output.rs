//! Where a sweep's hits become pairs. Vectors that can pack their lanes write pairs at once. For the
//! others hits are noted, and made pairs of many at a time: how many hits a vector has cannot be
//! foretold, and a loop over them that ends with each vector is guessed wrong as often as not; one
//! over all that were noted is not.

use core::hint::black_box;
use core::marker::PhantomData;
use core::mem::MaybeUninit;

use super::column::Column;
use super::vector::{Reporter, Vector};

/// So many vectors with hits are noted before their pairs are written.
const MOST: usize = 256;

/// The hits of a box in one vector.
#[derive(Clone, Copy)]
struct Note {
    /// The position of the first lane. (A column has a box once at most, and boxes are counted by 32
    /// bits.)
    at: u32,
    /// One bit a lane.
    bits: u32,
    /// Of the box that was tested.
    id: u32,
    /// Its marks, and [`IN_FIRST`].
    marks: u32,
}

/// Beside the marks, which are not that many: the other boxes are those of the first of two columns.
const IN_FIRST: u32 = 1 << 31;

/// Room for notes, and for two behind them, which are read before it is known that they are none.
/// Apart from [`Output`], so that the compiler may keep that in registers.
pub(super) struct Notes([MaybeUninit<Note>; MOST + 2]);

impl Notes {
    #[inline(always)]
    pub fn new() -> Self {
        Self([const { MaybeUninit::uninit() }; MOST + 2])
    }
}

/// Takes hits.
pub(super) struct Output<'a, V> {
    pairs: &'a mut [[u32; 2]],
    written: usize,
    noted: usize,
    /// For so many notes there is room.
    most: usize,
    vector: PhantomData<V>,
}

impl<'a, V> Output<'a, V> {
    /// For pairs of the vectors `V`, at least one.
    #[inline(always)]
    pub fn new<T: Copy>(pairs: &'a mut [[u32; 2]]) -> Self
    where
        V: Vector<T>,
    {
        let most = MOST.min(pairs.len() / V::LANES);
        Self { pairs, written: 0, noted: 0, most, vector: PhantomData }
    }

    /// Takes the hits in the vector at a position of a column.
    ///
    /// # Safety
    /// The instructions of `V` are present, and so are its lanes in the column; it is not
    /// [full](Self::is_full).
    #[inline(always)]
    pub unsafe fn take<T: Copy>(
        &mut self,
        hits: V::Mask,
        probe: &Reporter,
        column: &Column<T>,
        at: usize,
        notes: &mut Notes,
    ) where
        V: Vector<T>,
    {
        // SAFETY: the caller's promise.
        unsafe {
            if V::PACKS {
                let (ids, marks) = (column.id.as_ptr().add(at), column.marks.as_ptr().add(at));
                let room = self.pairs.as_mut_ptr().add(self.written);
                self.written += V::pack(hits, probe, ids, marks, room);
            } else {
                let bits = V::bits(hits);
                let marks = probe.marks | if probe.in_first { IN_FIRST } else { 0 };
                let note = Note { at: at as u32, bits, id: probe.id, marks };
                notes.0.get_unchecked_mut(self.noted).write(note);
                self.noted += usize::from(bits != 0);
            }
        }
    }

    /// Whether it takes no more before it has [made room](Self::make_room).
    #[inline(always)]
    pub fn is_full<T: Copy>(&self) -> bool
    where
        V: Vector<T>,
    {
        if V::PACKS { !self.has_room() } else { self.noted >= self.most }
    }

    /// Writes what is noted. False if there is no room for more. The columns are the one or two that
    /// are swept; of one the smaller id comes first in any case.
    ///
    /// # Safety
    /// All was taken from these columns.
    #[inline(always)]
    pub unsafe fn make_room<T: Copy, const N: usize>(
        &mut self,
        columns: [&Column<T>; N],
        ascending: bool,
        notes: &mut Notes,
    ) -> bool
    where
        V: Vector<T>,
    {
        if !V::PACKS {
            // SAFETY: the caller's promise; there is room for `most` vectors full of pairs.
            unsafe {
                let room = self.pairs.as_mut_ptr().add(self.written);
                self.written += write(notes, self.noted, columns, ascending, room);
            }
            self.noted = 0;
            self.most = MOST.min((self.pairs.len() - self.written) / V::LANES);
        }
        self.has_room()
    }

    #[inline(always)]
    fn has_room<T: Copy>(&self) -> bool
    where
        V: Vector<T>,
    {
        self.written + V::LANES <= self.pairs.len()
    }

    /// How many pairs are written.
    pub fn written(&self) -> usize {
        self.written
    }
}

/// Writes the pairs of the first so many notes: of those that share no mark, in their order. Returns
/// how many. One that is no pair may be written behind.
///
/// # Safety
/// So many notes were made, at most [`MOST`]. The lanes of all bits are positions in their columns,
/// and there is room at `out` for as many pairs as there are bits.
#[inline(never)]
unsafe fn write<T, const N: usize>(
    notes: &mut Notes,
    noted: usize,
    columns: [&Column<T>; N],
    ascending: bool,
    out: *mut [u32; 2],
) -> usize {
    let none = Note { at: 0, bits: 0, id: 0, marks: 0 };
    notes.0[noted].write(none);
    notes.0[noted + 1].write(none);
    let mut note = notes.0.as_ptr().cast::<Note>();
    // SAFETY: the caller's promise: notes are read up to those two. `count` is less than the number
    // of bits so far.
    unsafe {
        let end = note.add(noted);
        let mut count = 0;
        let mut bits = (*note).bits;
        // Or else compilers load it where it is used, and make that a branch.
        let mut next = black_box((*note.add(1)).bits);
        while note < end {
            let Note { at, id, marks, .. } = *note;
            let in_first = N == 1 || marks & IN_FIRST != 0;
            let column = columns[usize::from(!in_first)];
            let place = at as usize + bits.trailing_zeros() as usize;
            let other = *column.id.as_ptr().add(place);
            // Written whether it counts or not, and all without a branch: what is smaller, what counts,
            // and when the next note is due cannot be foretold.
            let low = if N == 1 || ascending {
                id.min(other)
            } else if in_first {
                other
            } else {
                id
            };
            *out.add(count) = [low, id ^ other ^ low];
            count += usize::from(*column.marks.as_ptr().add(place) & marks == 0);
            bits &= bits - 1;
            let is_last = bits == 0;
            bits = if is_last { next } else { bits };
            note = note.add(usize::from(is_last));
            next = (*note.add(1)).bits;
        }
        count
    }
}
