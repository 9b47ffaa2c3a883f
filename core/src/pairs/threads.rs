//! Threads: each lists a stretch of the boxes and copies it to the bins. Then each takes the next
//! group of bins until none is left; or, where there are no bins, the next stretch of the sweep. Their
//! pairs are [gathered](super::gather) in the order of one thread.

use alloc::vec::Vec;
use core::hint::spin_loop;
use core::iter::once;
use core::mem::{swap, take};
use core::ops::Range;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::thread::yield_now;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

use super::bins::{Bins, Refusal, Source, copied};
use super::gather::{Gather, Piece};
use super::grid::Grid;
use super::kernel::{Column, Cursor};
use super::list::List;
use super::search::{Filled, Search, Stop, Task, fill, limit};
use super::sink::Sink;
use super::sweep::{Sweep, candidates};
use crate::Scalar;

/// With fewer boxes threads do not pay.
const WORTH: usize = 4096;
/// With fewer pairs threads do not pay to copy them.
const MANY_PAIRS: usize = 1 << 18;
/// How often the calling thread looks whether the others are done, and then how often more between
/// which it lets others run, before it goes to sleep: some hundred microseconds.
const SPINS: u32 = 10_000;
const YIELDS: u32 = 200;
/// Groups of bins for each thread: some are harder than others.
const GROUPS: usize = 16;
/// With fewer candidates threads do not pay to sweep what is in no bins,
const MANY_TESTS: u64 = 1 << 20;
/// and then each takes so many boxes at a time, so that their pairs stay in its cache.
const STRETCH: usize = 256;

/// The other threads' buffers.
#[derive(Debug)]
pub(super) struct Team<const D: usize, T: Scalar> {
    /// How many threads, with the calling one.
    pub threads: usize,
    others: Vec<Search<D, T>>,
}

impl<const D: usize, T: Scalar> Default for Team<D, T> {
    fn default() -> Self {
        Self { threads: 1, others: Vec::new() }
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
    if !O::TAKES_PARTS || !search.team.pays(sets.iter().map(|set| set.len()).sum()) {
        return None;
    }
    let mut others = take(&mut search.team.others);
    others.resize_with(search.team.threads - 1, || Search::new(search.kernel));
    let mut bins = search.bins.pop().unwrap_or([Bins::new(), Bins::new()]);
    let result = fill(sets, &mut bins, |set, bins, other| {
        let others = others.iter_mut().map(|search| &mut search.list);
        put(set, &mut once(&mut search.list).chain(others).collect::<Vec<_>>(), grid, bins, other)
    });
    let result = result.map(|()| match Filled::new(&bins, sets, grid) {
        Some(bins) => sweep_bins(search, &mut others, &bins, task, sink),
        None => task.done(1.0),
    });
    search.bins.push(bins);
    search.team.others = others;
    Some(result)
}

/// Does its own work on the calling thread, and each of the others' on another.
///
/// The calling thread waits awake for the others, who are seldom far behind: to sleep and be woken
/// would take as long as they do. But not for ever; they may not even have begun, where the pool
/// has other things to do.
fn on_threads<W: Send>(
    own: impl FnOnce(),
    others: impl Iterator<Item = W>,
    work: impl Fn(W) + Sync,
) {
    let busy = AtomicUsize::new(0);
    rayon::in_place_scope(|scope| {
        let work = &work;
        for other in others {
            busy.fetch_add(1, Ordering::Relaxed);
            let busy = Busy(&busy);
            scope.spawn(move |_| {
                let _busy = busy;
                work(other);
            });
        }
        own();
        // A thread of the pool itself waits by doing what there is to do.
        let patience = if rayon::current_thread_index().is_some() { 0 } else { SPINS + YIELDS };
        for turn in 0..patience {
            if busy.load(Ordering::Acquire) == 0 {
                break;
            }
            if turn < SPINS { spin_loop() } else { yield_now() }
        }
        // The scope learns of it a moment later.
        (0..50).for_each(|_| spin_loop());
    });
}

/// Works on each of some things on a thread of its own; the calling one takes the first.
fn each_on_a_thread<W: Send>(mut things: impl Iterator<Item = W>, work: impl Fn(W) + Sync) {
    let first = things.next();
    on_threads(|| first.into_iter().for_each(&work), things, &work);
}

/// One that is at work until it is dropped.
struct Busy<'a>(&'a AtomicUsize);

impl Drop for Busy<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Release);
    }
}

/// Puts the boxes of a set into bins, one stretch a thread: only into those that the other set, if
/// there is one, has boxes in.
fn put<const D: usize, T: Scalar, S: Source<D, T>>(
    set: S,
    lists: &mut [&mut List],
    grid: &Grid<T>,
    bins: &mut Bins<D, T>,
    other: Option<&Bins<D, T>>,
) -> Result<(), Refusal> {
    let (threads, boxes, limit) = (lists.len(), set.len(), limit(set.len()));
    bins.stretches.resize_with(threads - 1, Vec::new);
    let all_ends = bins.stretches.iter_mut().chain(once(&mut bins.ends));
    let mut counted: Vec<_> = lists.iter().map(|_| None).collect();
    let steps = lists.iter_mut().zip(all_ends).zip(&mut counted).enumerate();
    each_on_a_thread(steps, |(thread, ((list, ends), counted))| {
        let stretch = boxes * thread / threads..boxes * (thread + 1) / threads;
        *counted = Some(list.fill(set, stretch, grid, limit).and_then(|len| {
            if let Some(other) = other {
                list.keep_shared(other);
            }
            Ok((len, list.count(ends)?))
        }));
    });
    // The gravest: an invalid box before all else.
    let refusals = counted.iter().flatten().filter_map(|counted| counted.as_ref().err());
    if let Some(&refusal) = refusals.min() {
        return Err(refusal);
    }
    let (lens, mut counted): (Vec<u64>, Vec<_>) = counted.into_iter().flatten().flatten().unzip();
    if lens.into_iter().sum::<u64>() > limit {
        return Err(Refusal::TooMany);
    }
    let shares = bins.records.shares(&mut counted)?;
    each_on_a_thread(shares, |share| share.put(|copy| copied(set, copy)));
    Ok(())
}

/// Has each thread find the pairs of groups of bins. A bin that holds more than half of a thread's
/// share, and will be planned anew, is found by all threads together.
fn sweep_bins<const D: usize, T: Scalar, O: Sink>(
    search: &mut Search<D, T>,
    others: &mut Vec<Search<D, T>>,
    filled: &Filled<'_, D, T>,
    task: Task<'_>,
    sink: &mut O,
) -> Result<(), Stop> {
    let threads = 1 + others.len();
    let groups = group(filled, threads * GROUPS);
    let records = groups.iter().map(|group| group.records).sum::<usize>();
    let huge = filled.crowd.max(records / (2 * threads));
    let is_huge = |&group: &usize| groups[group].bins.len() == 1 && groups[group].records > huge;
    let (huge, mut rest): (Vec<_>, Vec<_>) = (0..groups.len()).partition(is_huge);
    // The large ones first, so that none is left for the end.
    rest.sort_by_key(|&group| groups[group].records < 2 * (records / groups.len()));

    let gather = Gather::new(sink, groups.len());
    let find = |search: &mut Search<D, T>, group: usize, pairs: &mut Piece<'_, '_, O::Part>| {
        groups[group].bins.clone().try_for_each(|bin| search.bin(filled, bin, task, pairs))
    };
    swap(&mut search.team.others, others);
    huge.into_iter().for_each(|group| gather.find(group, |pairs| find(search, group, pairs)));
    swap(&mut search.team.others, others);

    let kernel = search.kernel;
    let find_all = |search: &mut Search<D, T>| {
        gather.find_all(&rest, |group, pairs| find(search, group, pairs));
    };
    // What is planned anew now is nobody else's.
    search.team.threads = 1;
    on_threads(
        || find_all(search),
        others.iter_mut(),
        |other| {
            other.kernel = kernel;
            find_all(other);
        },
    );
    search.team.threads = threads;
    let found = gather.end()?;
    sink.join(found)
}

/// As [`Sweep::run`], on so many threads, at least two; none if that does not pay.
pub(super) fn sweep<T: Scalar, O: Sink>(
    sweep: Sweep<'_>,
    columns: &[Column<T>],
    threads: usize,
    sink: &mut O,
) -> Option<Result<(), Stop>> {
    if !O::TAKES_PARTS || !O::SWEEPS || candidates(columns, 32) < MANY_TESTS {
        return None;
    }
    let stretches = Cursor::stretches(columns, STRETCH);
    let pieces: Vec<_> = (0..stretches.len()).collect();
    let gather = Gather::new(sink, stretches.len());
    let find_all = || {
        gather
            .find_all(&pieces, |stretch, pairs| sweep.stretch(columns, stretches[stretch], pairs));
    };
    on_threads(find_all, 1..threads, |_| find_all());
    Some(gather.end().and_then(|found| sink.join(found)))
}

/// A stretch of bins, and how many records they have.
struct Group {
    bins: Range<usize>,
    records: usize,
}

/// Stretches of bins with about as many records each; a bin that has so many is by itself.
fn group<const D: usize, T: Scalar>(filled: &Filled<'_, D, T>, groups: usize) -> Vec<Group> {
    let sets = &filled.bins[..filled.sets];
    let share = sets.iter().map(Bins::len).sum::<usize>() / groups + 1;
    let mut stretches: Vec<Group> = Vec::with_capacity(groups + 1);
    for bin in 0..filled.grid.len() {
        let records = sets.iter().map(|set| set.bin(bin).len()).sum::<usize>();
        match stretches.last_mut() {
            Some(group) if group.records.max(records) < share => {
                group.bins.end = bin + 1;
                group.records += records;
            }
            _ => stretches.push(Group { bins: bin..bin + 1, records }),
        }
    }
    stretches
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
