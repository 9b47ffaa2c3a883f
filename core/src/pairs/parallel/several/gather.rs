//! Puts the pairs of the jobs of a search, which threads do in any order, into the order of the jobs.
//! Pairs are stored in chunks. Each chunk is copied to its place as soon as all chunks before it have their places: most
//! of them while they are in the cache of the thread that found them.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::iter::{once, repeat_with};
use core::mem::take;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use super::receiver::{Chunk, Gathered, Receiver};
use crate::pairs::sink::Sink;
use crate::pairs::task::Stop;

/// The pairs found so far, and where they go.
#[derive(Debug)]
pub struct Gather<'a, C> {
    state: Mutex<GatherState<'a, C>>,
    /// How many jobs have been begun.
    begun: AtomicUsize,
    failed: OnceLock<Stop>,
}

#[derive(Debug)]
struct GatherState<'a, C> {
    jobs: Vec<Found<C>>,
    /// The first job whose pairs do not all have their places.
    next: usize,
    /// Spare capacity for them and for those behind.
    free: &'a mut [[u32; 2]],
    written: usize,
    /// How many more pairs are wanted.
    wanted: usize,
    /// Empty chunks: the last was used last, and may be in a cache.
    spare: Vec<C>,
    /// How many of them were never needed.
    unused: usize,
}

/// The pairs of a job that wait for those before it.
#[derive(Debug)]
struct Found<C> {
    chunks: VecDeque<C>,
    is_complete: bool,
}

impl<'a, C: Chunk> Gather<'a, C> {
    /// For the pairs of this many jobs.
    pub fn new<O: Receiver<Chunk = C>>(sink: &'a mut O, jobs: usize) -> Self {
        let found = || Found { chunks: VecDeque::new(), is_complete: false };
        let (spare, jobs) = (sink.spare_chunks(), repeat_with(found).take(jobs).collect());
        let (unused, wanted) = (spare.len(), sink.most());
        let state =
            GatherState { jobs, next: 0, free: sink.free(), written: 0, wanted, spare, unused };
        Self { state: Mutex::new(state), begun: AtomicUsize::new(0), failed: OnceLock::new() }
    }

    /// Does the jobs that no other thread has begun, one by one.
    pub fn do_all(
        &self,
        jobs: &[usize],
        mut find: impl FnMut(usize, &mut Job<'_, 'a, C>) -> Result<(), Stop>,
    ) {
        while let Some(&job) = jobs.get(self.begun.fetch_add(1, Ordering::Relaxed)) {
            self.job(job, |pairs| find(job, pairs));
        }
    }

    /// Does a job, unless another has failed.
    pub fn job(&self, job: usize, find: impl FnOnce(&mut Job<'_, 'a, C>) -> Result<(), Stop>) {
        if self.failed.get().is_some() {
            return;
        }
        let mut pairs = Job { gather: self, job, chunk: self.chunk() };
        let found = find(&mut pairs);
        if let Err(stop) = found.and_then(|()| self.put(job, [pairs.chunk], true)) {
            _ = self.failed.set(stop);
        }
    }

    /// An empty chunk.
    fn chunk(&self) -> C {
        let Ok(mut state) = self.state.lock() else { return C::default() };
        let chunk = state.spare.pop();
        state.unused = state.unused.min(state.spare.len());
        chunk.unwrap_or_default()
    }

    /// Takes finished chunks of a job (`is_complete`: its last) and copies every chunk whose place is known.
    fn put(
        &self,
        job: usize,
        chunks: impl IntoIterator<Item = C>,
        is_complete: bool,
    ) -> Result<(), Stop> {
        let mut chunks = Some(chunks.into_iter());
        let mut copied: Option<C> = None;
        while let Ok(mut state) = self.state.lock() {
            if let Some(chunks) = chunks.take() {
                state.jobs[job].chunks.try_reserve(chunks.size_hint().0)?;
                for chunk in chunks {
                    let wanted = state.wanted.checked_sub(chunk.pairs().len());
                    state.wanted = wanted.ok_or(Stop::Cancelled)?;
                    state.jobs[job].chunks.push_back(chunk);
                }
                state.jobs[job].is_complete = is_complete;
            }
            state.spare.extend(copied.take());
            let Some((place, mut chunk)) = state.next() else { break };
            drop(state);
            place.copy_from_slice(chunk.pairs());
            chunk.clear();
            copied = Some(chunk);
        }
        Ok(())
    }

    /// Where all pairs are.
    ///
    /// # Errors
    /// Those of a job that failed.
    pub fn end(self) -> Result<Gathered<C>, Stop> {
        if let Some(stop) = self.failed.into_inner() {
            return Err(stop);
        }
        // No thread panics while it has the lock.
        let GatherState { jobs, written, spare, unused, .. } =
            self.state.into_inner().map_err(|_| Stop::Memory)?;
        let mut waiting = Vec::new();
        waiting.try_reserve_exact(jobs.iter().map(|found| found.chunks.len()).sum())?;
        waiting.extend(jobs.into_iter().flat_map(|found| found.chunks));
        Ok(Gathered { written, waiting, spare, unused })
    }
}

impl<'a, C: Chunk> GatherState<'a, C> {
    /// The next chunk and where its pairs go, if it is there and there is spare capacity.
    fn next(&mut self) -> Option<(&'a mut [[u32; 2]], C)> {
        loop {
            let found = self.jobs.get_mut(self.next)?;
            if let Some(chunk) = found.chunks.front() {
                let pairs = chunk.pairs().len();
                if pairs > self.free.len() {
                    return None;
                }
                let (place, free) = take(&mut self.free).split_at_mut(pairs);
                self.free = free;
                self.written += pairs;
                return Some((place, found.chunks.pop_front()?));
            }
            if !found.is_complete {
                return None;
            }
            self.next += 1;
        }
    }
}

/// Takes the pairs of a job.
#[derive(Debug)]
pub struct Job<'g, 'a, C> {
    gather: &'g Gather<'a, C>,
    job: usize,
    chunk: C,
}

impl<C: Chunk> Sink for Job<'_, '_, C> {
    #[inline]
    fn spare(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.chunk.is_full() {
            self.gather.put(self.job, [take(&mut self.chunk)], false)?;
            self.chunk = self.gather.chunk();
        }
        self.chunk.spare()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.chunk.take(count)
    }
}

impl<C: Chunk> Receiver for Job<'_, '_, C> {
    type Chunk = C;

    fn most(&self) -> usize {
        self.gather.state.lock().map_or(usize::MAX, |state| state.wanted)
    }

    fn spare_chunks(&mut self) -> Vec<C> {
        let all = |state: &mut GatherState<'_, C>| {
            state.unused = 0;
            take(&mut state.spare)
        };
        self.gather.state.lock().map(|mut state| all(&mut state)).unwrap_or_default()
    }

    fn join(&mut self, Gathered { waiting, spare, .. }: Gathered<C>) -> Result<(), Stop> {
        let chunks = once(take(&mut self.chunk)).chain(waiting).chain(spare);
        self.gather.put(self.job, chunks, false)
    }
}
