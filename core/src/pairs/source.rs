//! The boxes that a search reads: the caller's, or those of a column of the grid.

use crate::{Aabb, Scalar};

/// A copy of a box in a column of the grid.
///
/// A pair may meet in several columns. The column that holds the lower corner of the two boxes'
/// intersection reports it: where, on each cut axis, at least one of the two boxes begins. So bit
/// `axis` of `dedup` is set if the box began in an earlier column on that axis, and a pair whose
/// bitmaps share a bit is left to another column.
#[derive(Copy, Debug)]
#[repr(C)]
pub(super) struct Record<const D: usize, T> {
    pub aabb: Aabb<D, T>,
    /// The caller's index of the box.
    pub id: u32,
    /// The dedup bitmap.
    pub dedup: u32,
}

// Not derived, as that of boxes.
impl<const D: usize, T: Copy> Clone for Record<D, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

/// A box as it stands in a set of boxes to search, which is a slice.
pub(super) trait Source<const D: usize, T: Scalar>: Copy + Sync {
    fn aabb(&self) -> &Aabb<D, T>;

    /// The caller's index of the box, given its position in the slice.
    #[inline(always)]
    fn id(&self, at: usize) -> u32 {
        at as u32
    }

    /// The dedup bitmap.
    #[inline(always)]
    fn dedup(&self) -> u32 {
        0
    }

    #[inline(always)]
    fn record(&self, at: usize) -> Record<D, T> {
        Record { aabb: *self.aabb(), id: self.id(at), dedup: self.dedup() }
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for Aabb<D, T> {
    #[inline(always)]
    fn aabb(&self) -> &Aabb<D, T> {
        self
    }
}

impl<const D: usize, T: Scalar> Source<D, T> for Record<D, T> {
    #[inline(always)]
    fn aabb(&self) -> &Aabb<D, T> {
        &self.aabb
    }

    #[inline(always)]
    fn id(&self, _: usize) -> u32 {
        self.id
    }

    #[inline(always)]
    fn dedup(&self) -> u32 {
        self.dedup
    }
}
