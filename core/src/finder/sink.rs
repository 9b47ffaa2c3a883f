//! Where pairs go: a growing buffer, a counter, or the caller's own function.

use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::kernel::PAD;
use super::memory::grow_to;
use super::search::Stop;

/// Pairs that are stored between two looks at the watch, at most.
const STRETCH: usize = 1 << 16;

/// Pairs in a buffer that is handed on when it is full.
const BUFFER: usize = 4096;

/// Takes pairs a buffer at a time.
pub(super) trait Sink {
    /// Whether it is for pairs at all: else columns are ordered and not swept.
    const SWEEPS: bool = true;

    /// What takes a stretch of the pairs on another thread.
    #[cfg(feature = "parallel")]
    type Fork: Sink + Send;

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

    /// An empty sink for another thread; none if the pairs must come in order, one by one.
    #[cfg(feature = "parallel")]
    fn fork(&mut self) -> Option<Self::Fork>;

    /// Takes the pairs of forks, in this order, after its own.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    #[cfg(feature = "parallel")]
    fn join(&mut self, forks: Vec<Self::Fork>) -> Result<(), Stop>;
}

/// Stores pairs. The buffer is longer than what it holds, and only grows.
#[derive(Debug, Default)]
pub(super) struct Store {
    buffer: Vec<[u32; 2]>,
    len: usize,
    /// Forks of earlier calls, kept for their buffers.
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
    type Fork = Store;

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
    fn fork(&mut self) -> Option<Store> {
        Some(self.spare.pop().unwrap_or_default())
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, forks: Vec<Store>) -> Result<(), Stop> {
        let len = self.len + forks.iter().map(|fork| fork.len).sum::<usize>();
        if self.buffer.len() < len {
            grow_to(&mut self.buffer, len, [0; 2])?;
        }
        let mut rest = &mut self.buffer[self.len..len];
        let mut copies = Vec::with_capacity(forks.len());
        for fork in &forks {
            let (to, behind) = rest.split_at_mut(fork.len);
            copies.push((to, fork.pairs()));
            rest = behind;
        }
        super::threads::copy(copies);
        self.len = len;
        self.spare.extend(forks.into_iter().map(|fork| Store { len: 0, ..fork }));
        Ok(())
    }
}

/// Counts pairs.
#[derive(Debug, Default)]
pub(super) struct Count {
    buffer: Buffer,
    pub count: u64,
}

/// Takes no pairs, so that the time of a search without its sweep can be told.
#[cfg(feature = "std")]
#[derive(Debug)]
pub(super) struct Unswept;

#[cfg(feature = "std")]
impl Sink for Unswept {
    const SWEEPS: bool = false;

    #[cfg(feature = "parallel")]
    type Fork = Unswept;

    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        Ok(&mut [])
    }

    fn take(&mut self, _: usize) -> Result<(), Stop> {
        Ok(())
    }

    #[cfg(feature = "parallel")]
    fn fork(&mut self) -> Option<Unswept> {
        Some(Unswept)
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, _: Vec<Unswept>) -> Result<(), Stop> {
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
    type Fork = Count;

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
    fn fork(&mut self) -> Option<Count> {
        Some(Count::default())
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, forks: Vec<Count>) -> Result<(), Stop> {
        self.count += forks.iter().map(|fork| fork.count).sum::<u64>();
        Ok(())
    }
}

/// Hands pairs to a function, in order, and stores only a buffer of them.
#[derive(Debug)]
pub(super) struct Stream<'a, F> {
    pub buffer: &'a mut Buffer,
    pub each: F,
}

impl<F: FnMut([u32; 2]) -> ControlFlow<()>> Sink for Stream<'_, F> {
    #[cfg(feature = "parallel")]
    type Fork = Count;

    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        self.buffer.room()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        match self.buffer.0[..count].iter().try_for_each(|&pair| (self.each)(pair)) {
            ControlFlow::Continue(()) => Ok(()),
            ControlFlow::Break(()) => Err(Stop::Enough),
        }
    }

    #[cfg(feature = "parallel")]
    fn fork(&mut self) -> Option<Count> {
        None
    }

    #[cfg(feature = "parallel")]
    fn join(&mut self, _: Vec<Count>) -> Result<(), Stop> {
        Ok(())
    }
}
