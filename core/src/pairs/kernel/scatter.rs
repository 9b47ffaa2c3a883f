//! The last step of a counting sort, by one thread or by several at once: each has a list of what
//! goes where, and all write into one array.
//!
//! That no two write to one place follows from the counts, which are made here, of lists that
//! nobody can change until they are written.

use core::marker::PhantomData;
use core::mem::{replace, take};

use crate::memory::prefetch;

/// Bytes of the array that the second cache may hold,
const LARGE: usize = 1 << 20;
/// and how far ahead its lines are asked for, if it is larger.
const LINES: usize = 128;

/// Bits of [`Copied::bin`] that are the bin.
const BIN_BITS: u32 = 29;

/// One copy of a box to a bin.
#[derive(Clone, Copy, Debug, Default)]
pub struct Copied {
    /// The bin, and above it the marks that the copy adds.
    bin: u32,
    /// The box's position in the source.
    pub of: u32,
}

impl Copied {
    /// A copy of box `of` to a bin, to which its [marks](Self::mark) have been added.
    #[inline(always)]
    pub fn new(bin: u32, of: u32) -> Self {
        Self { bin, of }
    }

    /// What to add to a bin, so that its copies are marked for an axis.
    pub fn mark(axis: usize) -> u32 {
        1 << BIN_BITS << axis
    }

    #[inline(always)]
    pub fn bin(self) -> usize {
        (self.bin & ((1 << BIN_BITS) - 1)) as usize
    }

    #[inline(always)]
    pub fn marks(self) -> u32 {
        self.bin >> BIN_BITS
    }
}

/// A list of copies, and how many of them go to each bin.
#[derive(Debug)]
pub struct Counted<'a> {
    copies: &'a [Copied],
    /// For each bin at first how many, in the end where they end.
    ends: &'a mut [u32],
}

impl<'a> Counted<'a> {
    /// Counts. There is an end for each bin.
    pub fn new(copies: &'a [Copied], ends: &'a mut [u32]) -> Self {
        ends.fill(0);
        for copy in copies {
            ends[copy.bin()] += 1;
        }
        Self { copies, ends }
    }

    /// How many copies there are.
    pub fn len(&self) -> usize {
        self.copies.len()
    }
}

/// Gives each list its share of an array, which has just room for all: bin by bin, and within a
/// bin list by list.
pub fn place<'a, V: Copy>(
    lists: &mut [Counted<'a>],
    room: &'a mut [V],
) -> impl Iterator<Item = Share<'a, V>> {
    let bins = lists.first().map_or(0, |list| list.ends.len());
    let len = lists.iter().map(Counted::len).sum::<usize>();
    assert!(len == room.len() && u32::try_from(len).is_ok());
    assert!(lists.iter().all(|list| list.ends.len() == bins));
    let mut total = 0;
    let mut start = |end: &mut u32| total += replace(end, total);
    if let [list] = lists {
        list.ends.iter_mut().for_each(&mut start);
    } else {
        (0..bins).for_each(|bin| lists.iter_mut().for_each(|list| start(&mut list.ends[bin])));
    }
    let start = room.as_mut_ptr();
    // Taken, so that no list is placed twice.
    lists.iter_mut().map(move |list| Share {
        copies: take(&mut list.copies),
        ends: take(&mut list.ends),
        start,
        is_large: size_of::<V>() * len > LARGE,
        room: PhantomData,
    })
}

/// The places in an array that one list fills. See [`place`].
#[derive(Debug)]
pub struct Share<'a, V> {
    copies: &'a [Copied],
    ends: &'a mut [u32],
    start: *mut V,
    is_large: bool,
    room: PhantomData<&'a mut [V]>,
}

// SAFETY: a share writes values to places that no other share of the array has.
unsafe impl<V: Send> Send for Share<'_, V> {}

impl<V: Copy> Share<'_, V> {
    /// Puts the value of each copy to its place.
    #[inline(always)]
    pub fn put(self, value: impl Fn(Copied) -> V) {
        for &copy in self.copies {
            let value = value(copy);
            let end = &mut self.ends[copy.bin()];
            // In bounds, as is the place itself.
            let place = self.start.wrapping_add(*end as usize);
            // Places that the caches do not hold take their time to come, but are known early.
            if self.is_large {
                prefetch(place.wrapping_add(LINES / size_of::<V>()));
            }
            // SAFETY: `place` gave each bin of each list as many places of the array, which this
            // share has borrowed, as the list has copies for the bin, and no two share one. The
            // list is the one that was counted: it has been borrowed since. So there is one for
            // this copy.
            unsafe { place.write(value) };
            *end += 1;
        }
    }
}
