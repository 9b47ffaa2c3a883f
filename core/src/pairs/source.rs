//! The boxes that a search reads: the caller's, or those of a column of the grid.

use core::ops::Range;

use crate::{Aabb, Scalar};

/// A copy of a box in a column of the grid.
///
/// A pair may meet in several columns. The column that holds the lower corner of the two boxes'
/// intersection reports it: where, on each cut axis, at least one of the two boxes begins. So bit
/// `axis` of `dedup` is set if the box began in an earlier column on that axis, and a pair whose
/// bitmaps share a bit is left to another column.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Record<const D: usize, T> {
    pub aabb: Aabb<D, T>,
    /// The caller's index of the box.
    pub id: u32,
    /// The dedup bitmap.
    pub dedup: u32,
}

/// A set of boxes to search.
pub(super) trait Source<const D: usize, T>: Copy + Sync {
    fn len(&self) -> usize;
    fn aabb(&self, i: usize) -> &Aabb<D, T>;
    fn id(&self, i: usize) -> u32;
    fn dedup(&self, i: usize) -> u32;

    /// The boxes of a range, in order.
    fn aabbs(&self, range: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone
    where
        T: 'static;

    #[inline(always)]
    fn record(&self, i: usize) -> Record<D, T>
    where
        T: Copy,
    {
        Record { aabb: *self.aabb(i), id: self.id(i), dedup: self.dedup(i) }
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
    fn dedup(&self, _: usize) -> u32 {
        0
    }

    #[inline(always)]
    fn aabbs(&self, range: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[range].iter()
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
    fn dedup(&self, i: usize) -> u32 {
        self[i].dedup
    }

    #[inline(always)]
    fn aabbs(&self, range: Range<usize>) -> impl Iterator<Item = &Aabb<D, T>> + Clone {
        self[range].iter().map(|record| &record.aabb)
    }
}
