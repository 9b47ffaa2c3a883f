//! Sinks whose pairs several threads find: each thread stores or counts chunks of them, which are joined in order.

use alloc::vec::Vec;
use core::mem::take;

use super::threads::copy;
use crate::memory::grow_to;
use crate::pairs::kernel::PAD;
use crate::pairs::sink::{Count, Sink, Store, Stream};
use crate::pairs::task::Stop;

/// A chunk with a capacity of this many pairs does not grow: it fits a second-level cache.
const CHUNK_PAIRS: usize = 1 << 14;

/// A sink of a search that may use threads.
pub trait Receiver: Sink {
    /// What takes a chunk of the pairs on another thread.
    type Chunk: Chunk;

    /// Whether it takes chunks: not if the pairs must come in order, one by one.
    const TAKES_CHUNKS: bool = true;

    /// How many pairs it wants at most. A few more may be found.
    fn most(&self) -> usize {
        usize::MAX
    }

    /// Empty chunks that were kept.
    fn spare_chunks(&mut self) -> Vec<Self::Chunk> {
        Vec::new()
    }

    /// All spare capacity behind its pairs.
    fn free(&mut self) -> &mut [[u32; 2]] {
        &mut []
    }

    /// Takes the pairs that were written to that capacity, and then those of the chunks that wait.
    ///
    /// # Errors
    /// [`Stop::Memory`].
    fn join(&mut self, _found: Gathered<Self::Chunk>) -> Result<(), Stop> {
        Ok(())
    }
}

/// What takes pairs on another thread.
pub trait Chunk: Receiver + Default + Send {
    /// The pairs that it has stored.
    fn pairs(&self) -> &[[u32; 2]] {
        &[]
    }

    /// Drops the stored pairs. (A count goes on.)
    fn clear(&mut self) {}

    /// Whether it is full, so that its pairs should be copied to their place.
    fn is_full(&self) -> bool {
        false
    }
}

/// Where the pairs of a search on threads are.
#[derive(Debug)]
pub struct Gathered<C> {
    /// How many were copied to their places.
    pub written: usize,
    /// The chunks with those behind them, for which there was no spare capacity.
    pub waiting: Vec<C>,
    /// Empty chunks, and how many of them, the first ones, were not needed.
    pub spare: Vec<C>,
    pub unused: usize,
}

impl Receiver for Store {
    type Chunk = Store;

    fn most(&self) -> usize {
        self.most.saturating_sub(self.len)
    }

    fn spare_chunks(&mut self) -> Vec<Store> {
        take(&mut self.spare)
    }

    fn free(&mut self) -> &mut [[u32; 2]] {
        &mut self.buffer[self.len..]
    }

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
        copy(copies);
        self.len = len;
        waiting.iter_mut().for_each(Store::clear);
        // The first search, without capacity, stores all pairs in chunks; later ones need few.
        spare.drain(..unused.div_ceil(2));
        spare.append(&mut waiting);
        self.spare = spare;
        Ok(())
    }
}

impl Chunk for Store {
    fn pairs(&self) -> &[[u32; 2]] {
        self.pairs()
    }

    fn clear(&mut self) {
        self.clear();
    }

    fn is_full(&self) -> bool {
        self.buffer.len() >= CHUNK_PAIRS && self.buffer.len() - self.len < PAD
    }
}

impl Receiver for Count {
    type Chunk = Count;

    fn join(&mut self, found: Gathered<Count>) -> Result<(), Stop> {
        self.count +=
            found.waiting.iter().chain(&found.spare).map(|chunk| chunk.count).sum::<u64>();
        Ok(())
    }
}

impl Chunk for Count {}

impl Receiver for Stream<'_> {
    type Chunk = Count;
    const TAKES_CHUNKS: bool = false;
}
