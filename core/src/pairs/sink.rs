//! Where pairs go: a growing buffer, a counter, or the caller's own function.

use alloc::vec::Vec;
#[cfg(feature = "parallel")]
use core::mem::take;
use core::ops::ControlFlow;

#[cfg(feature = "parallel")]
use super::gather::Gathered;
use super::kernel::PAD;
use super::search::Stop;
use crate::memory::grow_to;

/// Pairs that are stored between two looks at the watch, at most.
const STRETCH: usize = 1 << 16;

/// A part that has room for so many pairs does not grow: what it has fits a cache.
#[cfg(feature = "parallel")]
const PART: usize = 1 << 14;

/// Pairs in a buffer that is handed on when it is full.
const BUFFER: usize = 4096;

/// Takes pairs a buffer at a time.
pub(super) trait Sink {
    /// Whether it is for pairs at all: else columns are ordered and not swept.
    const SWEEPS: bool = true;

    /// What takes a part of the pairs on another thread.
    #[cfg(feature = "parallel")]
    type Part: Part;

    /// Room for at least [`PAD`] pairs.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop>;

    /// Takes the first `count` pairs of the room.
    ///
    /// # Errors
    /// [`Stop::Enough`], to end the search.
    fn take(&mut self, count: usize) -> Result<(), Stop>;

    /// Whether it takes parts: not if the pairs must come in order, one by one.
    #[cfg(feature = "parallel")]
    const TAKES_PARTS: bool = true;

    /// Empty parts that were kept.
    #[cfg(feature = "parallel")]
    fn parts(&mut self) -> Vec<Self::Part> {
        Vec::new()
    }

    /// Room that there is behind its pairs.
    #[cfg(feature = "parallel")]
    fn free(&mut self) -> &mut [[u32; 2]] {
        &mut []
    }

    /// Takes the pairs that were written to that room, and then those of the parts that wait.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    #[cfg(feature = "parallel")]
    fn join(&mut self, found: Gathered<Self::Part>) -> Result<(), Stop>;
}

/// What takes pairs on another thread.
#[cfg(feature = "parallel")]
pub(super) trait Part: Sink + Default + Send {
    /// The pairs that it has stored.
    fn held(&self) -> &[[u32; 2]] {
        &[]
    }

    /// Stores them no more. (What counts them goes on.)
    fn forget(&mut self) {}

    /// Whether it has stored so many that it had better be copied to its place.
    fn is_full(&self) -> bool {
        false
    }
}

/// Stores pairs. The buffer is longer than what it holds, and only grows.
#[derive(Debug, Default)]
pub(super) struct Store {
    buffer: Vec<[u32; 2]>,
    len: usize,
    /// Parts of earlier calls, kept for their buffers.
    #[cfg(feature = "parallel")]
    spare: Vec<Store>,
}

impl Store {
    #[inline]
    pub fn clear(&mut self) {
        self.len = 0;
    }

    /// Has at most so many pairs written, by a function that tells how many they are. False, with
    /// nothing stored, if there is not enough memory.
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
    type Part = Store;

    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.buffer.len() - self.len < PAD {
            let room = 2 * self.buffer.len() + 4 * PAD;
            grow_to(&mut self.buffer, room, [0; 2])?;
        }
        let end = self.buffer.len().min(self.len + STRETCH);
        Ok(&mut self.buffer[self.len..end])
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.len += count;
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn parts(&mut self) -> Vec<Store> {
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
        let len = self.len + waiting.iter().map(|part| part.len).sum::<usize>();
        if self.buffer.len() < len {
            grow_to(&mut self.buffer, len, [0; 2])?;
        }
        let mut rest = &mut self.buffer[self.len..len];
        let mut copies = Vec::new();
        copies.try_reserve_exact(waiting.len())?;
        for part in &waiting {
            let (to, behind) = rest.split_at_mut(part.len);
            copies.push((to, part.pairs()));
            rest = behind;
        }
        super::threads::copy(copies);
        self.len = len;
        waiting.iter_mut().for_each(Store::clear);
        // The first search, which has no room, needs a part for every pair; later ones need few.
        spare.drain(..unused.div_ceil(2));
        spare.append(&mut waiting);
        self.spare = spare;
        Ok(())
    }
}

#[cfg(feature = "parallel")]
impl Part for Store {
    fn held(&self) -> &[[u32; 2]] {
        self.pairs()
    }

    fn forget(&mut self) {
        self.clear();
    }

    fn is_full(&self) -> bool {
        self.buffer.len() >= PART && self.buffer.len() - self.len < PAD
    }
}

/// Counts pairs.
#[derive(Debug, Default)]
pub(super) struct Count {
    buffer: Buffer,
    pub count: u64,
}

#[cfg(feature = "parallel")]
impl Part for Count {}

/// Takes no pairs, so that the time of a search without its sweep can be told.
#[cfg(feature = "std")]
#[derive(Debug, Default)]
pub(super) struct Unswept;

#[cfg(all(feature = "std", feature = "parallel"))]
impl Part for Unswept {}

#[cfg(feature = "std")]
impl Sink for Unswept {
    const SWEEPS: bool = false;

    #[cfg(feature = "parallel")]
    type Part = Unswept;

    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        Ok(&mut [])
    }

    fn take(&mut self, _: usize) -> Result<(), Stop> {
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, _: Gathered<Unswept>) -> Result<(), Stop> {
        Ok(())
    }
}

/// Room for a few pairs at a time.
#[derive(Debug, Default)]
pub(super) struct Buffer(Vec<[u32; 2]>);

impl Buffer {
    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.0.is_empty() {
            grow_to(&mut self.0, BUFFER, [0; 2])?;
        }
        Ok(&mut self.0)
    }
}

impl Sink for Count {
    #[cfg(feature = "parallel")]
    type Part = Count;

    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.room()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.count += count as u64;
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, found: Gathered<Count>) -> Result<(), Stop> {
        self.count += found.waiting.iter().chain(&found.spare).map(|part| part.count).sum::<u64>();
        Ok(())
    }
}

/// Hands pairs to a function, some at a time and in order, and stores only a buffer of them.
#[derive(Debug)]
pub(super) struct Stream<'a, F> {
    pub buffer: &'a mut Buffer,
    pub each: F,
}

impl<F: FnMut(&[[u32; 2]]) -> ControlFlow<()>> Sink for Stream<'_, F> {
    #[cfg(feature = "parallel")]
    type Part = Count;

    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.room()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        if count > 0 && (self.each)(&self.buffer.0[..count]).is_break() {
            return Err(Stop::Enough);
        }
        Ok(())
    }

    #[cfg(feature = "parallel")]
    const TAKES_PARTS: bool = false;

    #[cfg(feature = "parallel")]
    fn join(&mut self, _: Gathered<Count>) -> Result<(), Stop> {
        Ok(())
    }
}
