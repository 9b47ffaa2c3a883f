//! The pairs of pieces of a search, which threads find in any order, strung together in the order of
//! the pieces. They are stored in parts, each of which is copied to its place as soon as all before it
//! have theirs: most of them while they are in the cache of the thread that found them.

use alloc::collections::VecDeque;
use alloc::vec::Vec;
use core::iter::{once, repeat_with};
use core::mem::take;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use super::search::Stop;
use super::sink::{Part, Sink};

/// What is found, and where it goes.
#[derive(Debug)]
pub(super) struct Gather<'a, P> {
    state: Mutex<State<'a, P>>,
    /// How many pieces have been begun.
    begun: AtomicUsize,
    failed: OnceLock<Stop>,
}

#[derive(Debug)]
struct State<'a, P> {
    pieces: Vec<Found<P>>,
    /// The first piece whose pairs do not all have their places.
    next: usize,
    /// Room for them and for those behind.
    free: &'a mut [[u32; 2]],
    written: usize,
    /// Empty parts: the last was used last, and may be in a cache.
    spare: Vec<P>,
    /// So many of them were never needed.
    unused: usize,
}

/// What was found of a piece and waits for what is before it.
#[derive(Debug)]
struct Found<P> {
    parts: VecDeque<P>,
    is_whole: bool,
}

impl<'a, P: Part> Gather<'a, P> {
    /// For the pairs of so many pieces.
    pub fn new<O: Sink<Part = P>>(sink: &'a mut O, pieces: usize) -> Self {
        let found = || Found { parts: VecDeque::new(), is_whole: false };
        let (spare, pieces) = (sink.parts(), repeat_with(found).take(pieces).collect());
        let unused = spare.len();
        let state = State { pieces, next: 0, free: sink.free(), written: 0, spare, unused };
        Self { state: Mutex::new(state), begun: AtomicUsize::new(0), failed: OnceLock::new() }
    }

    /// Has the pairs of pieces found that no other thread has begun, one by one.
    pub fn find_all(
        &self,
        pieces: &[usize],
        mut find: impl FnMut(usize, &mut Piece<'_, 'a, P>) -> Result<(), Stop>,
    ) {
        while let Some(&piece) = pieces.get(self.begun.fetch_add(1, Ordering::Relaxed)) {
            self.find(piece, |pairs| find(piece, pairs));
        }
    }

    /// Has the pairs of a piece found, unless another has failed.
    pub fn find(&self, piece: usize, find: impl FnOnce(&mut Piece<'_, 'a, P>) -> Result<(), Stop>) {
        if self.failed.get().is_some() {
            return;
        }
        let mut pairs = Piece { gather: self, piece, part: self.part() };
        let found = find(&mut pairs);
        if let Err(stop) = found.and_then(|()| self.put(piece, [pairs.part], true)) {
            _ = self.failed.set(stop);
        }
    }

    /// An empty part.
    fn part(&self) -> P {
        self.state.lock().ok().and_then(|mut state| state.part()).unwrap_or_default()
    }

    /// Takes parts of a piece, the last of them if it is whole then, and copies all pairs to their
    /// places that can be.
    fn put(
        &self,
        piece: usize,
        parts: impl IntoIterator<Item = P>,
        is_whole: bool,
    ) -> Result<(), Stop> {
        let mut parts = Some(parts.into_iter());
        let mut copied: Option<P> = None;
        while let Ok(mut state) = self.state.lock() {
            if let Some(parts) = parts.take() {
                state.pieces[piece].parts.try_reserve(parts.size_hint().0)?;
                state.pieces[piece].parts.extend(parts);
                state.pieces[piece].is_whole = is_whole;
            }
            state.spare.extend(copied.take());
            let Some((place, mut part)) = state.next() else { break };
            drop(state);
            place.copy_from_slice(part.held());
            part.forget();
            copied = Some(part);
        }
        Ok(())
    }

    /// What became of all pairs.
    ///
    /// # Errors
    /// Of a search that failed.
    pub fn end(self) -> Result<Gathered<P>, Stop> {
        if let Some(stop) = self.failed.into_inner() {
            return Err(stop);
        }
        // No thread panics while it has the lock.
        let State { pieces, written, spare, unused, .. } =
            self.state.into_inner().map_err(|_| Stop::Memory)?;
        let mut waiting = Vec::new();
        waiting.try_reserve_exact(pieces.iter().map(|found| found.parts.len()).sum())?;
        waiting.extend(pieces.into_iter().flat_map(|found| found.parts));
        Ok(Gathered { written, waiting, spare, unused })
    }
}

/// What became of pairs.
#[derive(Debug)]
pub(super) struct Gathered<P> {
    /// So many were copied to their places.
    pub written: usize,
    /// Parts with those behind them, for which there was no room.
    pub waiting: Vec<P>,
    /// Empty parts, of which the first so many were not needed.
    pub spare: Vec<P>,
    pub unused: usize,
}

impl<'a, P: Part> State<'a, P> {
    fn part(&mut self) -> Option<P> {
        let part = self.spare.pop();
        self.unused = self.unused.min(self.spare.len());
        part
    }

    /// The part that is next and where its pairs go, if it is there and there is room.
    fn next(&mut self) -> Option<(&'a mut [[u32; 2]], P)> {
        loop {
            let found = self.pieces.get_mut(self.next)?;
            if let Some(part) = found.parts.front() {
                let pairs = part.held().len();
                if pairs > self.free.len() {
                    return None;
                }
                let (place, free) = take(&mut self.free).split_at_mut(pairs);
                self.free = free;
                self.written += pairs;
                return Some((place, found.parts.pop_front()?));
            }
            if !found.is_whole {
                return None;
            }
            self.next += 1;
        }
    }
}

/// Takes the pairs of a piece.
#[derive(Debug)]
pub(super) struct Piece<'g, 'a, P> {
    gather: &'g Gather<'a, P>,
    piece: usize,
    part: P,
}

impl<P: Part> Sink for Piece<'_, '_, P> {
    const SWEEPS: bool = P::SWEEPS;

    type Part = P;

    #[inline]
    fn room(&mut self) -> Result<&mut [[u32; 2]], Stop> {
        if self.part.is_full() {
            self.gather.put(self.piece, [take(&mut self.part)], false)?;
            self.part = self.gather.part();
        }
        self.part.room()
    }

    #[inline]
    fn take(&mut self, count: usize) -> Result<(), Stop> {
        self.part.take(count)
    }

    fn parts(&mut self) -> Vec<P> {
        let all = |state: &mut State<'_, P>| {
            state.unused = 0;
            take(&mut state.spare)
        };
        self.gather.state.lock().map(|mut state| all(&mut state)).unwrap_or_default()
    }

    fn join(&mut self, Gathered { waiting, spare, .. }: Gathered<P>) -> Result<(), Stop> {
        let parts = once(take(&mut self.part)).chain(waiting).chain(spare);
        self.gather.put(self.piece, parts, false)
    }
}
