//! Threads: each puts a stretch of the boxes into bins, then each takes the next group of bins
//! until none is left. The pairs of the groups are strung together in the order of the bins, which
//! is the order of one thread.

use alloc::vec::Vec;
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock};

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::bins::{Bins, Grid, Refusal, Source};
use super::search::{Search, Stop, Task, limit};
use super::sink::Sink;
use crate::Scalar;

/// With fewer boxes threads do not pay.
const WORTH: usize = 4096;
/// With fewer pairs threads do not pay to copy them.
const MANY_PAIRS: usize = 1 << 18;
/// Groups of bins for each thread: some are harder than others.
const GROUPS: usize = 16;

/// The other threads' buffers.
#[derive(Debug)]
pub(super) struct Team<const D: usize, T: Scalar> {
    /// How many threads.
    pub threads: usize,
    workers: Vec<Search<D, T>>,
    pieces: Vec<[Bins<D, T>; 2]>,
}

impl<const D: usize, T: Scalar> Default for Team<D, T> {
    fn default() -> Self {
        Self { threads: 1, workers: Vec::new(), pieces: Vec::new() }
    }
}

impl<const D: usize, T: Scalar> Team<D, T> {
    /// Whether several threads pay for so many boxes.
    pub fn pays(&self, boxes: usize) -> bool {
        self.threads > 1 && boxes >= WORTH
    }
}

/// As the serial search, on threads; none if that does not pay.
pub(super) fn cut<const D: usize, T: Scalar, S: Source<D, T>, O: Sink>(
    search: &mut Search<D, T>,
    sets: &[S],
    grid: &Grid<T>,
    task: Task<'_>,
    sink: &mut O,
) -> Option<Result<Result<(), Stop>, Refusal>> {
    let threads = search.team.threads;
    if !search.team.pays(sets.iter().map(|set| set.len()).sum()) {
        return None;
    }
    let first = sink.fork()?;
    let mut workers = core::mem::take(&mut search.team.workers);
    let mut pieces = core::mem::take(&mut search.team.pieces);
    workers.resize_with(threads, || Search::new(search.kernel));
    pieces.resize_with(threads, || [Bins::new(), Bins::new()]);

    let result = fill(sets, grid, &mut pieces).map(|()| {
        let groups = group(&pieces, sets.len(), grid.len(), threads * GROUPS);
        let mut forks = alloc::vec![Mutex::new(first)];
        forks.extend(groups[1..].iter().filter_map(|_| sink.fork()).map(Mutex::new));
        let (next, failed) = (AtomicUsize::new(0), OnceLock::new());
        let borrowed: Vec<&[Bins<D, T>; 2]> = pieces.iter().collect();
        let work = |worker: &mut Search<D, T>| {
            worker.kernel = search.kernel;
            loop {
                let at = next.fetch_add(1, Ordering::Relaxed);
                let (Some(group), Some(fork)) = (groups.get(at), forks.get(at)) else { return };
                let Ok(mut fork) = fork.lock() else { return };
                for bin in group.clone() {
                    if let Err(stop) =
                        worker.bin(&borrowed, sets.len(), bin, grid, task, &mut *fork)
                    {
                        failed.get_or_init(|| stop);
                    }
                    if failed.get().is_some() {
                        return;
                    }
                }
            }
        };
        on_threads(&mut workers, |_, worker| work(worker));
        if let Some(stop) = failed.into_inner() {
            return Err(stop);
        }
        sink.join(forks.into_iter().filter_map(|fork| fork.into_inner().ok()).collect())
    });
    search.team.workers = workers;
    search.team.pieces = pieces;
    Some(result)
}

/// Has each of some threads work on its own; the calling one is the first.
fn on_threads<W: Send>(own: &mut [W], work: impl Fn(usize, &mut W) + Sync) {
    rayon::in_place_scope(|scope| {
        let work = &work;
        let mut own = own.iter_mut().enumerate();
        let first = own.next();
        for (thread, own) in own {
            scope.spawn(move |_| work(thread, own));
        }
        if let Some((thread, own)) = first {
            work(thread, own);
        }
    });
}

/// Where pairs go, and those pairs.
pub(super) type Stretch<'a> = (&'a mut [[u32; 2]], &'a [[u32; 2]]);

/// Copies pairs to their places, on threads if they are many.
pub(super) fn copy(stretches: Vec<Stretch<'_>>) {
    let pairs: usize = stretches.iter().map(|(_, from)| from.len()).sum();
    if pairs < MANY_PAIRS {
        stretches.into_iter().for_each(|(to, from)| to.copy_from_slice(from));
    } else {
        stretches.into_par_iter().for_each(|(to, from)| to.copy_from_slice(from));
    }
}

/// Each thread puts its stretch of the boxes into bins of its own.
fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[S],
    grid: &Grid<T>,
    pieces: &mut [[Bins<D, T>; 2]],
) -> Result<(), Refusal> {
    let threads = pieces.len();
    let mut own: Vec<_> = pieces.iter_mut().map(|bins| (bins, Ok([0; 2]))).collect();
    on_threads(&mut own, |thread, (bins, listed)| {
        let list = |set: usize, bins: &mut Bins<D, T>| {
            let of = sets[set].len();
            let stretch = of * thread / threads..of * (thread + 1) / threads;
            let count = bins.list(sets[set], stretch, grid, limit(of))?;
            bins.scatter(sets[set])?;
            Ok(count)
        };
        let [first, second] = &mut **bins;
        *listed = list(0, first)
            .and_then(|count| Ok([count, if sets.len() == 2 { list(1, second)? } else { 0 }]));
    });
    let mut totals = [0; 2];
    let mut refusal = None;
    for (_, listed) in own {
        match listed {
            Ok(counts) => (0..2).for_each(|set| totals[set] += counts[set]),
            // The least: an invalid box before all else.
            Err(of) => refusal = Some(refusal.map_or(of, |other: Refusal| other.min(of))),
        }
    }
    let many = sets.iter().zip(totals).any(|(set, total)| total > limit(set.len()));
    refusal.or(many.then_some(Refusal::TooMany)).map_or(Ok(()), Err)
}

/// Stretches of bins with about as many records each.
fn group<const D: usize, T: Scalar>(
    pieces: &[[Bins<D, T>; 2]],
    sets: usize,
    bins: usize,
    groups: usize,
) -> Vec<Range<usize>> {
    let filled = || pieces.iter().flat_map(|piece| &piece[..sets]);
    let share = filled().map(Bins::len).sum::<usize>() / groups + 1;
    let mut stretches = Vec::with_capacity(groups + 1);
    let (mut start, mut records) = (0, 0);
    for bin in 0..bins {
        records += filled().map(|piece| piece.bin(bin).len()).sum::<usize>();
        if records >= share || bin + 1 == bins {
            stretches.push(start..bin + 1);
            (start, records) = (bin + 1, 0);
        }
    }
    stretches
}
