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

use super::brute::{brute_force, is_brute_force};
use super::columns::Columns;
use super::control::{Stop, Task};
use super::grid::Grid;
use super::kernel::{Cursor, Kernel, SortedBoxes};
#[cfg(feature = "parallel")]
use super::parallel::{Gather, Schedule, on_threads};
use super::placements::{Placements, Refusal};
use super::plan::{CANDIDATE, Plan, plan};
use super::sink::Sink;
use super::sort::Sorter;
use super::source::{Record, Source};
use super::sweep::{Sweep, candidates};
use crate::{Aabb, Scalar};

/// Plans are nested at most so deep.
const DEPTH: u32 = 12;

/// A column with fewer boxes is never planned again,
const WORTH_PROBING: usize = 512;
/// nor is one with fewer candidates per box.
const CROWDED: u64 = 96;
/// How many probes show that a column is not crowded, and how many decide that it is planned again.
const FEW_PROBES: u64 = 32;
const MANY_PROBES: u64 = 512;
/// A column is planned again if that costs less than this share of its sweep.
const PLAN_PAYS: f64 = 0.6;

/// A column with more boxes, or with so many times its share of them, is planned again before it is
/// sorted: that many were not expected.
const LARGE: usize = 16384;
const UNEXPECTED: usize = 10;
/// Fewer boxes take less time to sort than to plan.
const WORTH_A_PLAN: usize = 2048;

/// If there would be too many records, boxes wider than so many columns are split from the rest.
const WIDE: f64 = 8.0;

/// With fewer boxes threads do not pay.
#[cfg(feature = "parallel")]
const WORTH_THREADS: usize = 4096;
/// With fewer candidates threads do not pay to sweep a single column,
#[cfg(feature = "parallel")]
const MANY_CANDIDATES: u64 = 1 << 20;
/// and then each takes so many probes at a time, so that their pairs stay in its cache.
#[cfg(feature = "parallel")]
const PROBES: usize = 256;

/// The buffers of one thread, kept between calls.
#[derive(Debug)]
pub(super) struct Driver<const D: usize, T: Scalar> {
    pub kernel: Kernel,
    sorter: Sorter<T>,
    sorted: [SortedBoxes<T>; 2],
    placements: Placements,
    /// Spare columns and groups by size: as many as plans were ever nested.
    columns: Vec<[Columns<D, T>; 2]>,
    groups: Vec<[Vec<Record<D, T>>; 3]>,
    /// The drivers of the other threads.
    #[cfg(feature = "parallel")]
    pub helpers: Vec<Self>,
}

impl<const D: usize, T: Scalar> Driver<D, T> {
    pub fn new(kernel: Kernel) -> Self {
        const { assert!(1 <= D && D <= 3, "boxes have one, two or three dimensions") };
        Self {
            kernel,
            sorter: Sorter::new(),
            sorted: [SortedBoxes::new(), SortedBoxes::new()],
            placements: Placements::new(),
            columns: Vec::new(),
            groups: Vec::new(),
            #[cfg(feature = "parallel")]
            helpers: Vec::new(),
        }
    }

    /// Sends all pairs within one set, or between two, to the sink. Sets that are searched by
    /// [brute force](is_brute_force) must be valid.
    pub fn run<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.len() == 0) {
            return Ok(());
        }
        if is_brute_force(sets) {
            let sweep = self.sweep(D, task);
            return brute_force(sets, task, &mut self.sorted, sink, |sets, sink| {
                if O::SWEEPS { sweep.run(sets, Cursor::default(), sink) } else { Ok(()) }
            });
        }
        let planned = plan(sets, task.depth < DEPTH);
        self.follow(planned.plan, sets, task, sink)
    }

    fn follow<S: Source<D, T>, O: Sink>(
        &mut self,
        plan: Plan<T>,
        sets: &[S],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        match plan {
            Plan::Cut(grid) if grid.len() == 1 => self.one_column(sets, grid.sweep, task, sink),
            Plan::Cut(grid) => self.cut(sets, &grid, task, sink),
            Plan::SplitBySize { set, axis, size } => {
                self.split_by_size(sets, set, axis, size, task, sink)
            }
        }
    }

    /// Sweeps all boxes at once, without copying them to columns.
    fn one_column<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        axis: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let valid = |set: &S| (0..set.len()).fold(true, |valid, i| valid & set.aabb(i).is_valid());
        // Nested searches have valid boxes.
        if task.depth == 0 && !sets.iter().all(valid) {
            return Err(Stop::Invalid);
        }
        self.sort_and_sweep(sets, axis, usize::MAX, task, sink)?;
        task.done(1.0)
    }

    /// Copies the boxes to the columns of a grid and finds the pairs of each column.
    fn cut<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let mut columns = self.columns.pop().unwrap_or([Columns::new(), Columns::new()]);
        #[cfg(feature = "parallel")]
        let mut helpers = self.take_helpers::<O>(sets.iter().map(|set| set.len()).sum());
        let filled = fill(sets, &mut columns, |set, columns, other| {
            #[cfg(feature = "parallel")]
            if !helpers.is_empty() {
                let others = helpers.iter_mut().map(|helper| &mut helper.placements);
                let mut placements: Vec<_> = once(&mut self.placements).chain(others).collect();
                return columns.fill_on_threads(set, grid, other, &mut placements);
            }
            columns.fill(set, grid, other, &mut self.placements)
        });
        let result = filled.map(|()| match Filled::new(&columns, sets, grid) {
            #[cfg(feature = "parallel")]
            Some(filled) if !helpers.is_empty() => {
                self.columns_on_threads(&mut helpers, &filled, task, sink)
            }
            Some(filled) => {
                (0..grid.len()).try_for_each(|column| self.column(&filled, column, task, sink))
            }
            None => task.done(1.0),
        });
        self.columns.push(columns);
        #[cfg(feature = "parallel")]
        if !helpers.is_empty() {
            self.helpers = helpers;
        }
        result.unwrap_or_else(|refusal| self.refused(refusal, sets, grid, task, sink))
    }

    /// Follows another plan if a grid would make too many records, of boxes that the sample has
    /// missed: splits the wide ones from the rest, or does not cut.
    fn refused<S: Source<D, T>, O: Sink>(
        &mut self,
        refusal: Refusal,
        sets: &[S],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        match refusal {
            Refusal::Invalid => return Err(Stop::Invalid),
            Refusal::Memory => return Err(Stop::Memory),
            Refusal::TooMany => (),
        }
        for (axis, width) in grid.widths().filter(|_| task.depth < DEPTH) {
            for (set, source) in sets.iter().enumerate() {
                let size = WIDE * width;
                let wide = |i| extent(source.aabb(i), axis) > size;
                if (0..source.len()).any(wide) && !(0..source.len()).all(wide) {
                    return self.split_by_size(sets, set, axis, size, task, sink);
                }
            }
        }
        self.one_column(sets, grid.sweep, task, sink)
    }

    /// The pairs of one column.
    fn column<O: Sink>(
        &mut self,
        filled: &Filled<'_, D, T>,
        column: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let [first, last] = filled.columns;
        let records =
            [first.column(column), if filled.sets == 2 { last.column(column) } else { &[] }];
        self.sort_and_sweep(&records[..filled.sets], filled.grid.sweep, filled.crowd, task, sink)?;
        if task.progress.is_some() {
            task.done(records[0].len() as f64 / first.len() as f64)?;
        }
        Ok(())
    }

    /// Sorts and sweeps boxes, or plans them again if there are more than `crowd`, or more candidates
    /// than a better plan would leave.
    fn sort_and_sweep<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        axis: usize,
        crowd: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.len() == 0) {
            return Ok(());
        }
        let boxes: usize = sets.iter().map(|set| set.len()).sum();
        if boxes > crowd && task.depth < DEPTH {
            let planned = plan(sets, true);
            if planned.plan.divides() {
                return self.follow(planned.plan, sets, task.nested(0.0), sink);
            }
        }
        for (&set, sorted) in sets.iter().zip(&mut self.sorted) {
            self.sorter.sort(set, axis, sorted)?;
        }
        let sorted = &self.sorted[..sets.len()];
        let is_crowded = |probes| candidates(sorted, probes) > CROWDED * boxes as u64;
        if task.depth < DEPTH && boxes >= WORTH_PROBING && is_crowded(FEW_PROBES) {
            let candidates = candidates(sorted, MANY_PROBES);
            if candidates > CROWDED * boxes as u64 {
                let planned = plan(sets, true);
                if planned.cost < PLAN_PAYS * CANDIDATE * candidates as f64 {
                    return self.follow(planned.plan, sets, task.nested(0.0), sink);
                }
            }
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
        sets: &[S],
        set: usize,
        axis: usize,
        size: f64,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let mut groups = self.groups.pop().unwrap_or([Vec::new(), Vec::new(), Vec::new()]);
        groups.iter_mut().for_each(Vec::clear);
        let mut valid = true;
        for i in 0..sets[set].len() {
            let record = sets[set].record(i);
            valid &= record.aabb.is_valid();
            let group = &mut groups[usize::from(extent(&record.aabb, axis) > size)];
            group.try_reserve(1)?;
            group.push(record);
        }
        let [small, large, other] = &mut groups;
        if sets.len() == 2 {
            // The other set is copied as it is: all groups are then of one type.
            other.try_reserve(sets[1 - set].len())?;
            for i in 0..sets[1 - set].len() {
                let record = sets[1 - set].record(i);
                valid &= record.aabb.is_valid();
                other.push(record);
            }
        }
        let (small, large, other) = (&small[..], &large[..], &other[..]);
        let result = if !valid {
            Err(Stop::Invalid)
        } else if sets.len() == 1 {
            self.run(&[small], task.nested(0.4), sink)
                .and_then(|()| self.run(&[large], task.nested(0.2), sink))
                .and_then(|()| self.run(&[large, small], task.nested(0.4), sink))
        } else {
            [small, large].into_iter().try_for_each(|group| {
                let sets = if set == 0 { [group, other] } else { [other, group] };
                self.run(&sets, task.nested(0.5), sink)
            })
        };
        self.groups.push(groups);
        result
    }

    fn sweep<'a>(&self, others: usize, task: Task<'a>) -> Sweep<'a> {
        let Task { pair_order, progress, .. } = task;
        Sweep { kernel: self.kernel, others, pair_order, progress }
    }
}

#[cfg(feature = "parallel")]
impl<const D: usize, T: Scalar> Driver<D, T> {
    fn uses_threads<O: Sink>(&self, boxes: usize) -> bool {
        O::TAKES_CHUNKS && !self.helpers.is_empty() && boxes >= WORTH_THREADS
    }

    /// The drivers of the other threads, if these are to help with so many boxes.
    fn take_helpers<O: Sink>(&mut self, boxes: usize) -> Vec<Self> {
        if self.uses_threads::<O>(boxes) { take(&mut self.helpers) } else { Vec::new() }
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
                let mut columns = schedule.columns(group);
                let result = columns.try_for_each(|column| self.column(filled, column, task, sink));
                swap(&mut self.helpers, helpers);
                result
            });
        }
        let sweep_rest = |driver: &mut Self| {
            gather.do_all(&schedule.rest, |group, sink| {
                let mut columns = schedule.columns(group);
                columns.try_for_each(|column| driver.column(filled, column, task, sink))
            });
        };
        let helpers = helpers.iter_mut();
        on_threads(|| sweep_rest(self), helpers, sweep_rest);
        let found = gather.end()?;
        sink.join(found)
    }
}

/// Runs a sweep on so many threads, at least two.
#[cfg(feature = "parallel")]
fn sweep_on_threads<T: Scalar, O: Sink>(
    sweep: Sweep<'_>,
    sorted: &[SortedBoxes<T>],
    threads: usize,
    sink: &mut O,
) -> Result<(), Stop> {
    let chunks = Cursor::chunks(sorted, PROBES);
    let jobs: Vec<_> = (0..chunks.len()).collect();
    let gather = Gather::new(sink, chunks.len());
    let do_all = || gather.do_all(&jobs, |job, sink| sweep.run(sorted, chunks[job], sink));
    on_threads(do_all, 1..threads, |_| do_all());
    let found = gather.end()?;
    sink.join(found)
}

/// The columns of a grid, filled with the boxes of one set or two.
struct Filled<'a, const D: usize, T> {
    columns: &'a [Columns<D, T>; 2],
    sets: usize,
    grid: &'a Grid<T>,
    /// A column with more records is planned again.
    crowd: usize,
}

impl<'a, const D: usize, T: Scalar> Filled<'a, D, T> {
    /// None if a set has no records, as when the two share no column: then there are no pairs.
    fn new<S: Source<D, T>>(
        columns: &'a [Columns<D, T>; 2],
        sets: &[S],
        grid: &'a Grid<T>,
    ) -> Option<Self> {
        let boxes = sets.iter().map(|set| set.len()).sum::<usize>();
        let crowd = (UNEXPECTED * (boxes / grid.len())).clamp(WORTH_A_PLAN, LARGE);
        let all_have = columns[..sets.len()].iter().all(|columns| columns.len() > 0);
        all_have.then_some(Self { columns, sets: sets.len(), grid, crowd })
    }

    /// How many records a column has.
    #[cfg(feature = "parallel")]
    fn records(&self, column: usize) -> usize {
        self.columns[..self.sets].iter().map(|set| set.column(column).len()).sum()
    }
}

/// Fills the columns with the boxes of one set or two: with those of the larger set only where the
/// smaller set has boxes.
fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[S],
    columns: &mut [Columns<D, T>; 2],
    mut fill: impl FnMut(S, &mut Columns<D, T>, Option<&Columns<D, T>>) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let [first_columns, last_columns] = columns;
    let &[first, last] = sets else {
        return fill(sets[0], first_columns, None);
    };
    if first.len() <= last.len() {
        fill(first, first_columns, None)?;
        fill(last, last_columns, Some(first_columns))
    } else {
        fill(last, last_columns, None)?;
        fill(first, first_columns, Some(last_columns))
    }
}

/// The size of a box on an axis; NaN if it lies at infinity.
fn extent<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, axis: usize) -> f64 {
    aabb.max[axis].to_f64() - aabb.min[axis].to_f64()
}
