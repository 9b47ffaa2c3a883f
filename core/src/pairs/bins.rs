//! Stage 1: bins. Space is cut into columns (and long ones into slabs), and each box is copied to
//! every bin that it touches: list, count, prefix sum, scatter. Several threads list and count
//! stretches of the boxes, and then scatter them into one array.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::kernel::{Copied, Counted, Share, place};
use super::list::List;
use crate::memory::grow_to;
use crate::{Aabb, Scalar};

/// A box on its way: where it came from, and how its pairs are reported once.
///
/// A pair may meet in several bins. It is reported by the one that holds the lower corner of
/// the two boxes' intersection, that is, where on each cut axis at least one of the two begins.
/// So bit `axis` of `marks` says that the box began in an earlier cell on that axis, and a pair
/// whose marks share a bit is left to that bin.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Record<const D: usize, T> {
    pub aabb: Aabb<D, T>,
    pub id: u32,
    pub marks: u32,
}

/// Boxes to find pairs of: the caller's, or those of a bin that is cut again.
pub(super) trait Source<const D: usize, T>: Copy + Sync {
    fn len(&self) -> usize;
    fn aabb(&self, i: usize) -> &Aabb<D, T>;
    fn id(&self, i: usize) -> u32;
    fn marks(&self, i: usize) -> u32;

    /// Some of the boxes, one after the other.
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone
    where
        T: 'static;

    #[inline(always)]
    fn record(&self, i: usize) -> Record<D, T>
    where
        T: Copy,
    {
        Record { aabb: *self.aabb(i), id: self.id(i), marks: self.marks(i) }
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Aabb<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn aabb(&self, i: usize) -> &Aabb<D, T> {
        &self[i]
    }

    #[inline(always)]
    fn id(&self, i: usize) -> u32 {
        i as u32
    }

    #[inline(always)]
    fn marks(&self, _: usize) -> u32 {
        0
    }

    #[inline(always)]
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[boxes].iter()
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for &[Record<D, T>] {
    #[inline(always)]
    fn len(&self) -> usize {
        (**self).len()
    }

    #[inline(always)]
    fn aabb(&self, i: usize) -> &Aabb<D, T> {
        &self[i].aabb
    }

    #[inline(always)]
    fn id(&self, i: usize) -> u32 {
        self[i].id
    }

    #[inline(always)]
    fn marks(&self, i: usize) -> u32 {
        self[i].marks
    }

    #[inline(always)]
    fn aabbs(&self, boxes: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[boxes].iter().map(|record| &record.aabb)
    }
}

/// Records by bin. Within a bin they stand in the order of the source.
#[derive(Debug)]
pub(super) struct Bins<const D: usize, T> {
    pub records: Records<D, T>,
    /// Where each bin ends.
    pub ends: Vec<u32>,
    /// Where in each bin the boxes of a stretch end: of each stretch but the last.
    #[cfg(feature = "parallel")]
    pub stretches: Vec<Vec<u32>>,
}

/// The records of all bins; behind `len` the array is scratch.
#[derive(Debug)]
pub(super) struct Records<const D: usize, T> {
    array: Vec<Record<D, T>>,
    len: usize,
}

impl<const D: usize, T: Scalar> Records<D, T> {
    /// Makes room for what was listed, and gives each list its share of it. There must be less than
    /// 2^32 copies.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn shares<'a>(
        &'a mut self,
        lists: &mut [Counted<'a>],
    ) -> Result<impl Iterator<Item = Share<'a, Record<D, T>>>, TryReserveError> {
        self.len = lists.iter().map(Counted::len).sum();
        if self.array.len() < self.len {
            let aabb = Aabb::new([T::ZERO; D], [T::ZERO; D]);
            // Plans for boxes that move differ by that much.
            let room = self.len + self.len / 4;
            grow_to(&mut self.array, room, Record { aabb, id: 0, marks: 0 })?;
        }
        Ok(place(lists, &mut self.array[..self.len]))
    }
}

impl<const D: usize, T: Scalar> Bins<D, T> {
    pub const fn new() -> Self {
        Self {
            records: Records { array: Vec::new(), len: 0 },
            ends: Vec::new(),
            #[cfg(feature = "parallel")]
            stretches: Vec::new(),
        }
    }

    /// Copies the boxes of a source to their bins as listed.
    ///
    /// # Errors
    /// If there is not enough memory.
    pub fn fill<S: Source<D, T>>(&mut self, source: S, list: &List) -> Result<(), TryReserveError> {
        let mut lists = [list.count(&mut self.ends)?];
        for share in self.records.shares(&mut lists)? {
            share.put(|copy| copied(source, copy));
        }
        Ok(())
    }

    /// How many records there are.
    pub fn len(&self) -> usize {
        self.records.len
    }

    /// The records of a bin.
    pub fn bin(&self, bin: usize) -> &[Record<D, T>] {
        let start = if bin == 0 { 0 } else { self.ends[bin - 1] };
        &self.records.array[start as usize..self.ends[bin] as usize]
    }
}

/// What becomes of a box in a bin.
#[inline(always)]
pub(super) fn copied<const D: usize, T: Scalar, S: Source<D, T>>(
    source: S,
    copy: Copied,
) -> Record<D, T> {
    let record = source.record(copy.of as usize);
    Record { marks: record.marks | copy.marks(), ..record }
}

/// Why bins were not filled, the gravest reason first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Refusal {
    /// A box is inverted or NaN.
    Invalid,
    /// There is not enough memory.
    Memory,
    /// There would be more copies than allowed.
    TooMany,
}

impl From<TryReserveError> for Refusal {
    fn from(_: TryReserveError) -> Self {
        Refusal::Memory
    }
}
