//! How a search shares its work with other threads.

use alloc::vec::Vec;
use core::mem::{swap, take};
use core::ops::Range;

use super::fill::fill_on_threads;
use super::gather::{Gather, Job};
use super::receiver::Receiver;
use super::schedule::Schedule;
use super::threads::on_threads;
use crate::Scalar;
use crate::pairs::columns::{Columns, Filled};
use crate::pairs::grid::Grid;
use crate::pairs::placements::Placements;
use crate::pairs::source::Source;
use crate::pairs::task::Stop;

/// With fewer boxes threads do not pay. (On two busy cores two threads take as long as one at 10,000
/// boxes, and 0.7 of the time at 100,000.)
const MIN_BOXES_FOR_THREADS: usize = 4096;

/// What each of the other threads works with.
#[derive(Debug)]
pub struct Helpers<W>(Vec<W>);

/// Several threads.
#[derive(Clone, Copy)]
pub struct Threads(usize);

/// Helpers at work, at least one.
pub struct Team<W>(Vec<W>);

impl<W> Helpers<W> {
    /// No helpers.
    pub fn new() -> Self {
        Self(Vec::new())
    }

    /// Has this many helpers, new ones by `make`.
    pub fn resize(&mut self, count: usize, make: impl FnMut() -> W) {
        self.0.resize_with(count, make);
    }

    /// Changes each helper.
    pub fn for_each(&mut self, change: impl FnMut(&mut W)) {
        self.0.iter_mut().for_each(change);
    }

    /// The helpers, for tests.
    #[cfg(test)]
    pub fn all(&self) -> &[W] {
        &self.0
    }

    /// The threads to search this many boxes on, if several are worthwhile.
    pub fn threads<O: Receiver>(&self, boxes: usize) -> Option<Threads> {
        let pay = O::TAKES_CHUNKS && !self.0.is_empty() && boxes >= MIN_BOXES_FOR_THREADS;
        pay.then_some(Threads(1 + self.0.len()))
    }

    /// All helpers, to search this many boxes with, if that is worthwhile. Until they [`rest`](Self::rest), there
    /// are none here.
    pub fn team<O: Receiver>(&mut self, boxes: usize) -> Option<Team<W>> {
        self.threads::<O>(boxes).map(|_| Team(take(&mut self.0)))
    }

    /// Takes the helpers of a team back.
    pub fn rest(&mut self, team: Option<Team<W>>) {
        if let Some(Team(helpers)) = team {
            self.0 = helpers;
        }
    }
}

impl Threads {
    /// Has each thread take the next `chunk` of the items and find their pairs, until none are left.
    ///
    /// # Errors
    /// Those of `find`, or [`Stop::Memory`].
    pub fn in_chunks<O: Receiver>(
        self,
        items: Range<usize>,
        chunk: usize,
        sink: &mut O,
        find: impl Fn(Range<usize>, &mut Job<'_, '_, O::Chunk>) -> Result<(), Stop> + Sync,
    ) -> Result<(), Stop> {
        let others = (1..self.0).map(|_| ());
        in_chunks(items, chunk, (), others, sink, |(), range, sink| find(range, sink))
    }
}

impl<W: Send> Team<W> {
    /// As [`Threads::in_chunks`], by this thread's `own` worker and the team.
    ///
    /// # Errors
    /// Those of `find`, or [`Stop::Memory`].
    pub fn in_chunks<O: Receiver>(
        &mut self,
        items: Range<usize>,
        chunk: usize,
        own: &mut W,
        sink: &mut O,
        find: impl Fn(&mut W, Range<usize>, &mut Job<'_, '_, O::Chunk>) -> Result<(), Stop> + Sync,
    ) -> Result<(), Stop> {
        in_chunks(items, chunk, own, self.0.iter_mut(), sink, |worker, range, sink| {
            find(worker, range, sink)
        })
    }

    /// Fills columns as [`Columns::fill`] does. Each thread lists a chunk of the boxes in its own placements.
    ///
    /// # Errors
    /// A [`Stop`].
    pub fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
        &mut self,
        columns: &mut Columns<D, T>,
        source: &[S],
        grid: &Grid<T>,
        other: Option<&Columns<D, T>>,
        own: &mut Placements,
        placements: fn(&mut W) -> &mut Placements,
    ) -> Result<(), Stop> {
        let mut all: Vec<_> = [own].into_iter().chain(self.0.iter_mut().map(placements)).collect();
        fill_on_threads(columns, source, grid, other, &mut all)
    }

    /// Finds the pairs of all columns, by this thread's `own` worker and the team. All threads together search the
    /// huge columns, one after the other: for these the worker has its helpers.
    ///
    /// # Errors
    /// Those of `find`, or [`Stop::Memory`].
    pub fn search<const D: usize, T: Scalar, O: Receiver>(
        &mut self,
        own: &mut W,
        helpers: fn(&mut W) -> &mut Helpers<W>,
        filled: &Filled<'_, D, T>,
        sink: &mut O,
        find: impl Fn(&mut W, Range<usize>, &mut Job<'_, '_, O::Chunk>) -> Result<(), Stop> + Sync,
    ) -> Result<(), Stop> {
        let records = |column| filled.column(column).0.iter().map(|records| records.len()).sum();
        let records = (0..filled.grid.len()).map(records);
        let schedule = Schedule::new(records, 1 + self.0.len(), filled.crowd);
        let gather = Gather::new(sink, schedule.len());
        for &group in &schedule.huge {
            gather.job(group, |sink| {
                swap(&mut helpers(own).0, &mut self.0);
                let result = find(own, schedule.columns(group), sink);
                swap(&mut helpers(own).0, &mut self.0);
                result
            });
        }
        let search_rest = |worker: &mut W| {
            gather
                .do_all(&schedule.rest, |group, sink| find(worker, schedule.columns(group), sink));
        };
        on_threads(|| search_rest(own), self.0.iter_mut(), search_rest);
        let found = gather.end()?;
        sink.join(found)
    }
}

/// Has each thread, as one worker, take the next `chunk` of the items and find their pairs, until none are left.
///
/// # Errors
/// Those of `find`, or [`Stop::Memory`].
fn in_chunks<W: Send, O: Receiver>(
    items: Range<usize>,
    chunk: usize,
    own: W,
    others: impl Iterator<Item = W>,
    sink: &mut O,
    find: impl Fn(&mut W, Range<usize>, &mut Job<'_, '_, O::Chunk>) -> Result<(), Stop> + Sync,
) -> Result<(), Stop> {
    let jobs: Vec<_> = (0..items.len().div_ceil(chunk)).collect();
    let gather = Gather::new(sink, jobs.len());
    let do_all = |mut worker: W| {
        gather.do_all(&jobs, |job, sink| {
            let start = items.start + job * chunk;
            find(&mut worker, start..items.end.min(start + chunk), sink)
        });
    };
    on_threads(|| do_all(own), others, do_all);
    let found = gather.end()?;
    sink.join(found)
}
