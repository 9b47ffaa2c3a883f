//! Where pairs go: a growing buffer, a counter, or the caller's own function.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::kernel::PAD;
use super::parallel::Kept;
use super::task::Stop;
use crate::memory::grow_to;

/// The most pairs that are stored between two calls of the progress callback.
const MOST_PAIRS_AT_A_TIME: usize = 1 << 16;

/// A buffer for this many pairs is large.
const LARGE: usize = 1 << 20;

/// Pairs in a buffer that is handed on when it is full.
const BUFFER_PAIRS: usize = 4096;

/// Takes pairs a buffer at a time.
pub(super) trait Sink {
    /// Spare capacity for at least [`PAD`] pairs.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop>;

    /// Takes the first `count` pairs of the spare capacity.
    ///
    /// # Errors
    /// [`Stop::Cancelled`], to end the search.
    fn take(&mut self, count: usize) -> Result<(), Stop>;
}

/// Stores pairs. The buffer is longer than what it holds, and only grows.
#[derive(Debug)]
pub(super) struct Store {
    pub buffer: Vec<[u32; 2]>,
    pub len: usize,
    /// With more pairs, the search ends.
    pub most: usize,
    /// Chunks of earlier calls, kept for their buffers.
    pub spare: Kept<Store>,
}

impl Default for Store {
    fn default() -> Self {
        Self { buffer: Vec::new(), len: 0, most: usize::MAX, spare: Kept::default() }
    }
}

impl Store {
    #[inline]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Replaces the pairs by those that `write` writes: at most `most`; it returns how many. Returns false, with nothing
    /// stored, if there is not enough memory.
    #[inline]
    pub fn put(&mut self, most: usize, write: impl FnOnce(&mut [[u32; 2]]) -> usize) -> bool {
        if self.buffer.len() < most && grow_to(&mut self.buffer, most, [0; 2]).is_err() {
            return false;
        }
        self.len = write(&mut self.buffer);
        true
    }

    /// Doubles the capacity, or takes what there is. Of a large one only as much is written as is needed soon: new memory
    /// takes longer than finding the pairs that fill it (300 million pairs of intervals were found in 13.5 s, in kept memory in
    /// 0.3).
    #[cold]
    fn grow(&mut self) -> Result<(), TryReserveError> {
        let len = self.buffer.len();
        let more = if len < LARGE { len + 4 * PAD } else { len / 8 };
        if self.buffer.capacity() - len < more {
            // If that is too much, less may be there.
            _ = self.buffer.try_reserve_exact(len + 4 * PAD);
        }
        grow_to(&mut self.buffer, len + more, [0; 2])
    }

    #[inline]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.buffer[..self.len]
    }

    /// The pairs, to be named otherwise in place.
    pub fn pairs_mut(&mut self) -> &mut [[u32; 2]] {
        &mut self.buffer[..self.len]
    }

    /// How many pairs fit the memory that it has.
    pub fn capacity(&self) -> usize {
        self.buffer.capacity()
    }

    pub fn into_pairs(mut self) -> Vec<[u32; 2]> {
        self.buffer.truncate(self.len);
        self.buffer
    }
}

impl Sink for Store {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.len > self.most {
            return Err(Stop::Cancelled);
        }
        if self.buffer.len() - self.len < PAD {
            self.grow()?;
        }
        let end = self.buffer.len().min(self.len + MOST_PAIRS_AT_A_TIME);
        Ok(&mut self.buffer[self.len..end])
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.len += count;
        Ok(())
    }
}

/// Counts pairs.
#[derive(Debug, Default)]
pub(super) struct Count {
    buffer: Buffer,
    pub count: u64,
}

/// A buffer of a few pairs.
#[derive(Debug, Default)]
pub(super) struct Buffer(Vec<[u32; 2]>);

impl Buffer {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.0.is_empty() {
            grow_to(&mut self.0, BUFFER_PAIRS, [0; 2])?;
        }
        Ok(&mut self.0)
    }
}

impl Sink for Count {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.spare()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.count += count as u64;
        Ok(())
    }
}

/// Hands chunks of pairs to a function, in order, and stores only one buffer. It does not depend on the type of the
/// function, so that a search is not compiled once more for each one, and in a user's debug build.
pub(super) struct Stream<'a> {
    pub buffer: &'a mut Buffer,
    pub each: &'a mut dyn FnMut(&[[u32; 2]]) -> ControlFlow<()>,
}

impl Sink for Stream<'_> {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.spare()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        if count > 0 && (self.each)(&self.buffer.0[..count]).is_break() {
            return Err(Stop::Cancelled);
        }
        Ok(())
    }
}
