//! Where pairs go: a growing buffer, a counter, or the caller's own function.

use alloc::vec::Vec;
#[cfg(feature = "parallel")]
use core::mem::take;
use core::ops::ControlFlow;

use super::control::Stop;
use super::kernel::PAD;
use crate::memory::grow_to;

/// The most pairs that are stored between two calls of the progress callback.
const MOST_AT_A_TIME: usize = 1 << 16;

/// A chunk with a capacity of so many pairs does not grow: it fits a second-level cache.
#[cfg(feature = "parallel")]
const CHUNK: usize = 1 << 14;

/// Pairs in a buffer that is handed on when it is full.
const BUFFER: usize = 4096;

/// Takes pairs a buffer at a time.
pub(super) trait Sink {
    /// Whether it wants pairs at all: otherwise columns are sorted and not swept.
    const SWEEPS: bool = true;

    /// What takes a chunk of the pairs on another thread.
    #[cfg(feature = "parallel")]
    type Chunk: Chunk;

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

    /// How many pairs it wants at most. A few more may be found.
    #[cfg(feature = "parallel")]
    fn most(&self) -> usize {
        usize::MAX
    }

    /// Whether it takes chunks: not if the pairs must come in order, one by one.
    #[cfg(feature = "parallel")]
    const TAKES_CHUNKS: bool = true;

    /// Empty chunks that were kept.
    #[cfg(feature = "parallel")]
    fn spare_chunks(&mut self) -> Vec<Self::Chunk> {
        Vec::new()
    }

    /// All spare capacity behind its pairs.
    #[cfg(feature = "parallel")]
    fn free(&mut self) -> &mut [[u32; 2]] {
        &mut []
    }

    /// Takes the pairs that were written to that capacity, and then those of the chunks that wait.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    #[cfg(feature = "parallel")]
    fn join(&mut self, _found: Gathered<Self::Chunk>) -> Result<(), Stop> {
        Ok(())
    }
}

/// What takes pairs on another thread.
#[cfg(feature = "parallel")]
pub(super) trait Chunk: Sink + Default + Send {
    /// The pairs that it has stored.
    fn pairs(&self) -> &[[u32; 2]] {
        &[]
    }

    /// Drops the stored pairs. (A count goes on.)
    fn clear(&mut self) {}

    /// Whether it has stored so many that they should be copied to their place.
    fn is_full(&self) -> bool {
        false
    }
}

/// Where the pairs of a search on threads are.
#[cfg(feature = "parallel")]
#[derive(Debug)]
pub(super) struct Gathered<C> {
    /// How many were copied to their places.
    pub written: usize,
    /// The chunks with those behind them, for which there was no spare capacity.
    pub waiting: Vec<C>,
    /// Empty chunks, and how many of them, the first ones, were not needed.
    pub spare: Vec<C>,
    pub unused: usize,
}

/// Stores pairs. The buffer is longer than what it holds, and only grows.
#[derive(Debug)]
pub(super) struct Store {
    buffer: Vec<[u32; 2]>,
    len: usize,
    /// With more pairs, the search ends.
    pub most: usize,
    /// Chunks of earlier calls, kept for their buffers.
    #[cfg(feature = "parallel")]
    spare: Vec<Store>,
}

impl Default for Store {
    fn default() -> Self {
        Self {
            buffer: Vec::new(),
            len: 0,
            most: usize::MAX,
            #[cfg(feature = "parallel")]
            spare: Vec::new(),
        }
    }
}

impl Store {
    #[inline]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Replaces the pairs by at most so many, which a function writes; it returns how many. False,
    /// with nothing stored, if there is not enough memory.
    #[inline]
    pub fn put(&mut self, most: usize, write: impl FnOnce(&mut [[u32; 2]]) -> usize) -> bool {
        if self.buffer.len() < most && grow_to(&mut self.buffer, most, [0; 2]).is_err() {
            return false;
        }
        self.len = write(&mut self.buffer);
        true
    }

    #[inline]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.buffer[..self.len]
    }

    pub fn into_pairs(mut self) -> Vec<[u32; 2]> {
        self.buffer.truncate(self.len);
        self.buffer
    }
}

impl Sink for Store {
    #[cfg(feature = "parallel")]
    type Chunk = Store;

    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.len > self.most {
            return Err(Stop::Cancelled);
        }
        if self.buffer.len() - self.len < PAD {
            let size = 2 * self.buffer.len() + 4 * PAD;
            grow_to(&mut self.buffer, size, [0; 2])?;
        }
        let end = self.buffer.len().min(self.len + MOST_AT_A_TIME);
        Ok(&mut self.buffer[self.len..end])
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.len += count;
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn most(&self) -> usize {
        self.most.saturating_sub(self.len)
    }

    #[cfg(feature = "parallel")]
    fn spare_chunks(&mut self) -> Vec<Store> {
        take(&mut self.spare)
    }

    #[cfg(feature = "parallel")]
    fn free(&mut self) -> &mut [[u32; 2]] {
        &mut self.buffer[self.len..]
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, found: Gathered<Store>) -> Result<(), Stop> {
        let Gathered { written, mut waiting, mut spare, unused } = found;
        self.len += written;
        let len = self.len + waiting.iter().map(|chunk| chunk.len).sum::<usize>();
        if self.buffer.len() < len {
            grow_to(&mut self.buffer, len, [0; 2])?;
        }
        let mut rest = &mut self.buffer[self.len..len];
        let mut copies = Vec::new();
        copies.try_reserve_exact(waiting.len())?;
        for chunk in &waiting {
            let (to, behind) = rest.split_at_mut(chunk.len);
            copies.push((to, chunk.pairs()));
            rest = behind;
        }
        super::parallel::copy(copies);
        self.len = len;
        waiting.iter_mut().for_each(Store::clear);
        // The first search, without capacity, stores all pairs in chunks; later ones need few.
        spare.drain(..unused.div_ceil(2));
        spare.append(&mut waiting);
        self.spare = spare;
        Ok(())
    }
}

#[cfg(feature = "parallel")]
impl Chunk for Store {
    fn pairs(&self) -> &[[u32; 2]] {
        self.pairs()
    }

    fn clear(&mut self) {
        self.clear();
    }

    fn is_full(&self) -> bool {
        self.buffer.len() >= CHUNK && self.buffer.len() - self.len < PAD
    }
}

/// Counts pairs.
#[derive(Debug, Default)]
pub(super) struct Count {
    buffer: Buffer,
    pub count: u64,
}

#[cfg(feature = "parallel")]
impl Chunk for Count {}

/// Takes no pairs, to measure the time of a search without its sweep.
#[cfg(feature = "std")]
#[derive(Debug, Default)]
pub(super) struct Unswept;

#[cfg(all(feature = "std", feature = "parallel"))]
impl Chunk for Unswept {}

#[cfg(feature = "std")]
impl Sink for Unswept {
    const SWEEPS: bool = false;

    #[cfg(feature = "parallel")]
    type Chunk = Unswept;

    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        Ok(&mut [])
    }

    fn take(&mut self, _: usize) -> Result<(), Stop> {
        Ok(())
    }
}

/// A buffer of a few pairs.
#[derive(Debug, Default)]
pub(super) struct Buffer(Vec<[u32; 2]>);

impl Buffer {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.0.is_empty() {
            grow_to(&mut self.0, BUFFER, [0; 2])?;
        }
        Ok(&mut self.0)
    }
}

impl Sink for Count {
    #[cfg(feature = "parallel")]
    type Chunk = Count;

    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.spare()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.count += count as u64;
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, found: Gathered<Count>) -> Result<(), Stop> {
        self.count +=
            found.waiting.iter().chain(&found.spare).map(|chunk| chunk.count).sum::<u64>();
        Ok(())
    }
}

/// Hands chunks of pairs to a function, in order, and stores only one buffer.
#[derive(Debug)]
pub(super) struct Stream<'a, F> {
    pub buffer: &'a mut Buffer,
    pub each: F,
}

impl<F: FnMut(&[[u32; 2]]) -> ControlFlow<()>> Sink for Stream<'_, F> {
    #[cfg(feature = "parallel")]
    type Chunk = Count;

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

    #[cfg(feature = "parallel")]
    const TAKES_CHUNKS: bool = false;
}
