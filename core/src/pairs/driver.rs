//! The algorithm, for one set of boxes (pairs within it) or two (pairs between them):
//!
//! 1. Few boxes are tested by brute force.
//! 2. A plan takes the sweep axis and cuts space into columns on the other axes.
//! 3. Each box is copied to the columns that it touches.
//! 4. The boxes of each column are sorted by left edge, and swept.
//!
//! A column that turns out crowded is planned again by itself. Boxes of very different sizes are split
//! by size first.

use alloc::vec::Vec;
#[cfg(feature = "parallel")]
use core::iter::once;
#[cfg(feature = "parallel")]
use core::mem::{swap, take};
use core::ops::Range;

use super::brute::{brute_force, is_brute_force};
use super::columns::{Columns, Filled, fill};
use super::control::{Stop, Task};
#[cfg(feature = "parallel")]
use super::crowding::{FEW_PROBES, candidates};
use super::crowding::{better_plan, most_records};
use super::grid::Grid;
use super::kernel::{Cursor, Kernel, SortedBoxes};
use super::lookup::{Table, may_pay};
#[cfg(feature = "parallel")]
use super::parallel::{Gather, Schedule, jobs_on_threads, on_threads, sweep_on_threads};
use super::placements::Placements;
use super::plan::{Among, Plan, SizeSplit, plan};
use super::sink::Sink;
use super::sizes::{Groups, wide_boxes};
use super::sort::Sorter;
use super::source::Source;
use super::sweep::Sweep;
use crate::Scalar;

/// Plans are nested at most so deep.
const DEPTH: u32 = 12;
/// A plan that leaves all but one in so many boxes in one column has not divided them: such a column is
/// swept on the axis that seems best, and not cut again by the same means. (Two groups beside each other,
/// of which one reaches into the column of the other: 24 times slower than uniform boxes, now 3.)
const UNDIVIDED: usize = 8;

/// With fewer boxes threads do not pay. (On two busy cores two threads take as long as one at 10,000
/// boxes, and 0.7 of the time at 100,000.)
#[cfg(feature = "parallel")]
const WORTH_THREADS: usize = 4096;
/// With fewer candidates threads do not pay to sweep a single column.
#[cfg(feature = "parallel")]
const MANY_CANDIDATES: u64 = 1 << 20;
/// A thread looks up so many boxes at a time, so that their pairs stay in its cache.
#[cfg(feature = "parallel")]
const AT_A_TIME: usize = 4096;
/// With fewer of them threads do not pay. (On two cores two threads take 1.4 to 2 times as long at 10,000, 1.0 to 1.5
/// times at 100,000, and 0.8 to 0.9 at 200,000.)
#[cfg(feature = "parallel")]
const MANY_LOOKUPS: usize = 1 << 17;

/// The buffers of one thread, kept between calls.
#[derive(Debug)]
pub(super) struct Driver<const D: usize, T: Scalar> {
    pub kernel: Kernel,
    sorter: Sorter<T>,
    sorted: [SortedBoxes<T>; 2],
    table: Table,
    pub placements: Placements,
    /// Spare columns and groups by size: as many as plans were ever nested, if memory allows.
    columns: Vec<[Columns<D, T>; 2]>,
    groups: Vec<Groups<D, T>>,
    /// The drivers of the other threads.
    #[cfg(feature = "parallel")]
    pub helpers: Vec<Self>,
    /// How many boxes this thread has sorted, about how many candidates it has tested, and how many copies of boxes it
    /// has made.
    #[cfg(test)]
    pub work: [u64; 3],
}

impl<const D: usize, T: Scalar> Driver<D, T> {
    pub fn new(kernel: Kernel) -> Self {
        const { assert!(1 <= D && D <= 3, "boxes have one, two or three dimensions") };
        Self {
            kernel,
            sorter: Sorter::default(),
            sorted: Default::default(),
            table: Table::default(),
            placements: Placements::default(),
            columns: Vec::new(),
            groups: Vec::new(),
            #[cfg(feature = "parallel")]
            helpers: Vec::new(),
            #[cfg(test)]
            work: [0; 3],
        }
    }

    /// Sends all pairs within one set, or between two, to the sink. Sets that are searched by
    /// [brute force](is_brute_force) must be valid.
    pub fn run<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.is_empty()) {
            return Ok(());
        }
        if is_brute_force(sets) {
            let sweep = self.sweep(D, task);
            return brute_force(sets, task, &mut self.sorted, sink, |sets, sink| {
                if O::SWEEPS { sweep.run(sets, Cursor::default(), sink) } else { Ok(()) }
            });
        }
        if D == 1 && task.depth == 0 && sets.len() == 2 && self.look_up(sets, task, sink)? {
            return Ok(());
        }
        let may_nest = task.depth < DEPTH;
        let among = if may_nest { Among::All { is_crowded: false } } else { Among::Cuts };
        self.run_plan(plan(sets, among).0, sets, task, sink)
    }

    /// Has the boxes of the larger of two sets on a line look up those of the smaller one. False, with nothing
    /// sent, if it is better to sweep.
    fn look_up<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<bool, Stop> {
        let swap = sets[0].len() <= sets[1].len();
        let [smaller, larger] = if swap { [sets[0], sets[1]] } else { [sets[1], sets[0]] };
        if !O::SWEEPS || !may_pay(smaller, larger) {
            return Ok(false);
        }
        if !sets.iter().all(is_valid) {
            return Err(Stop::Invalid);
        }
        self.sorter.sort(smaller, 0, &mut self.sorted[0])?;
        #[cfg(test)]
        {
            self.work[0] += smaller.len() as u64;
        }
        #[cfg(feature = "parallel")]
        let uses_threads = self.uses_threads::<O>(larger.len()) && larger.len() >= MANY_LOOKUPS;
        let Some(lookup) = self.table.fill(&self.sorted[0], larger)? else { return Ok(false) };
        #[cfg(feature = "parallel")]
        if uses_threads {
            let range = |job| job * AT_A_TIME..larger.len().min((job + 1) * AT_A_TIME);
            let (jobs, threads) = (larger.len().div_ceil(AT_A_TIME), 1 + self.helpers.len());
            jobs_on_threads(jobs, threads, sink, |job, sink| {
                lookup.run(larger, range(job), swap, task, sink)
            })?;
            return Ok(true);
        }
        lookup.run(larger, 0..larger.len(), swap, task, sink).map(|()| true)
    }

    fn run_plan<S: Source<D, T>, O: Sink>(
        &mut self,
        plan: Plan<T>,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        match plan {
            Plan::Cut(grid) if grid.len() == 1 => self.one_column(sets, grid.sweep, task, sink),
            Plan::Cut(grid) => self.cut(sets, &grid, task, sink),
            Plan::SplitBySize(split) => self.split_by_size(sets, split, task, sink),
        }
    }

    /// Sweeps all boxes at once, without copying them to columns.
    fn one_column<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        axis: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        // Nested searches have valid boxes.
        if task.depth == 0 && !sets.iter().all(is_valid) {
            return Err(Stop::Invalid);
        }
        self.sort_and_sweep(sets, axis, usize::MAX, task, sink)?;
        task.done(1.0)
    }

    /// Copies the boxes to the columns of a grid and finds the pairs of each column.
    fn cut<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let boxes = sets.iter().map(|set| set.len()).sum();
        let mut columns = self.columns.pop().unwrap_or_default();
        #[cfg(feature = "parallel")]
        let mut helpers =
            if self.uses_threads::<O>(boxes) { take(&mut self.helpers) } else { Vec::new() };
        let filled = fill(sets, &mut columns, |set, columns, other| {
            #[cfg(feature = "parallel")]
            if !helpers.is_empty() {
                let others = helpers.iter_mut().map(|helper| &mut helper.placements);
                let mut placements: Vec<_> = once(&mut self.placements).chain(others).collect();
                return columns.fill_on_threads(set, grid, other, &mut placements);
            }
            columns.fill(set, grid, other, &mut self.placements)
        });
        #[cfg(test)]
        {
            self.work[2] += columns.iter().map(Columns::len).sum::<usize>() as u64;
        }
        let crowd = most_records(boxes, grid.len());
        let result = filled.and_then(|()| match Filled::new(&columns[..sets.len()], grid, crowd) {
            #[cfg(feature = "parallel")]
            Some(filled) if !helpers.is_empty() => {
                self.columns_on_threads(&mut helpers, &filled, task, sink)
            }
            Some(filled) => self.columns(&filled, 0..grid.len(), task, sink),
            None => task.done(1.0),
        });
        self.columns.try_reserve(1).is_ok().then(|| self.columns.push(columns));
        #[cfg(feature = "parallel")]
        if !helpers.is_empty() {
            self.helpers = helpers;
        }
        if result == Err(Stop::TooMany) {
            return self.without_cut(sets, grid, task, sink);
        }
        result
    }

    /// Follows another plan if a grid would make too many records, of boxes that the sample has
    /// missed: splits the wide ones from the rest, or does not cut.
    fn without_cut<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if task.depth < DEPTH
            && let Some(split) = wide_boxes(sets, grid)
        {
            return self.split_by_size(sets, split, task, sink);
        }
        self.one_column(sets, grid.sweep, task, sink)
    }

    /// The pairs of some columns, one after the other.
    fn columns<O: Sink>(
        &mut self,
        filled: &Filled<'_, D, T>,
        Range { mut start, end }: Range<usize>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        while start < end {
            let shared = filled.next_shared(start..end);
            if let Some(column) = shared {
                let (records, sets) = filled.column(column);
                let records = &records[..sets];
                self.sort_and_sweep(records, filled.grid.sweep, filled.crowd, task, sink)?;
            }
            let next = shared.map_or(end, |column| column + 1);
            if task.progress.is_some() {
                task.done(filled.share(start..next))?;
            }
            start = next;
        }
        Ok(())
    }

    /// Sorts and sweeps boxes, or plans them again if there are more than `crowd`, or more candidates
    /// than a better plan would leave.
    fn sort_and_sweep<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        axis: usize,
        crowd: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.is_empty()) {
            return Ok(());
        }
        let boxes: usize = sets.iter().map(|set| set.len()).sum();
        let is_divided = boxes < task.boxes - task.boxes / UNDIVIDED;
        let among = if is_divided { Among::All { is_crowded: true } } else { Among::Sweeps };
        if boxes > crowd && is_divided && task.depth < DEPTH {
            let (plan, _) = plan(sets, among);
            if plan.divides() {
                return self.run_plan(plan, sets, task.nested(0.0, boxes), sink);
            }
        }
        for (&set, sorted) in sets.iter().zip(&mut self.sorted) {
            self.sorter.sort(set, axis, sorted)?;
        }
        let sorted = &self.sorted[..sets.len()];
        #[cfg(test)]
        {
            self.work[0] += boxes as u64;
        }
        if task.depth < DEPTH
            && let Some(plan) = better_plan(sets, sorted, axis, among)
        {
            return self.run_plan(plan, sets, task.nested(0.0, boxes), sink);
        }
        #[cfg(test)]
        {
            self.work[1] += super::crowding::candidates(sorted, 512);
        }
        if !O::SWEEPS {
            return Ok(());
        }
        let sweep = self.sweep(D - 1, task);
        #[cfg(feature = "parallel")]
        if self.uses_threads::<O>(boxes) && candidates(sorted, FEW_PROBES) >= MANY_CANDIDATES {
            return sweep_on_threads(sweep, sorted, 1 + self.helpers.len(), sink);
        }
        sweep.run(sorted, Cursor::default(), sink)
    }

    /// Splits the boxes of a set by their size on an axis and searches the two groups separately, and
    /// of one set also between them.
    fn split_by_size<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[&[S]],
        split: SizeSplit,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let nested = |share| task.nested(share, sets.iter().map(|set| set.len()).sum());
        let mut groups = self.groups.pop().unwrap_or_default();
        let result = groups.fill(sets, split).and_then(|()| {
            let Groups { small, large, other } = &groups;
            let (small, large, other) = (&small[..], &large[..], &other[..]);
            if sets.len() == 1 {
                self.run(&[small], nested(0.4), sink)?;
                self.run(&[large], nested(0.2), sink)?;
                return self.run(&[large, small], nested(0.4), sink);
            }
            [small, large].into_iter().try_for_each(|group| {
                let sets = if split.set == 0 { [group, other] } else { [other, group] };
                self.run(&sets, nested(0.5), sink)
            })
        });
        self.groups.try_reserve(1).is_ok().then(|| self.groups.push(groups));
        result
    }

    fn sweep<'a>(&self, others: usize, task: Task<'a>) -> Sweep<'a> {
        Sweep { kernel: self.kernel, others, task }
    }
}

/// Whether all boxes of a set are valid. No branch depends on a box.
fn is_valid<const D: usize, T: Scalar, S: Source<D, T>>(set: &&[S]) -> bool {
    set.iter().fold(true, |valid, each| valid & each.aabb().is_valid())
}

#[cfg(feature = "parallel")]
impl<const D: usize, T: Scalar> Driver<D, T> {
    fn uses_threads<O: Sink>(&self, boxes: usize) -> bool {
        O::TAKES_CHUNKS && !self.helpers.is_empty() && boxes >= WORTH_THREADS
    }

    /// The pairs of all columns, found by this thread and the helpers. All of them together search the
    /// huge columns, one after the other.
    fn columns_on_threads<O: Sink>(
        &mut self,
        helpers: &mut Vec<Self>,
        filled: &Filled<'_, D, T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let records = (0..filled.grid.len()).map(|column| filled.records(column));
        let schedule = Schedule::new(records, 1 + helpers.len(), filled.crowd);
        let gather = Gather::new(sink, schedule.len());
        for &group in &schedule.huge {
            gather.job(group, |sink| {
                swap(&mut self.helpers, helpers);
                let result = self.columns(filled, schedule.columns(group), task, sink);
                swap(&mut self.helpers, helpers);
                result
            });
        }
        let sweep_rest = |driver: &mut Self| {
            gather.do_all(&schedule.rest, |group, sink| {
                driver.columns(filled, schedule.columns(group), task, sink)
            });
        };
        on_threads(|| sweep_rest(self), helpers.iter_mut(), sweep_rest);
        let found = gather.end()?;
        sink.join(found)
    }
}
