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
use core::mem::take;
use core::ops::Range;

use super::brute::{brute_force, is_brute_force};
use super::buckets::{Buckets, chunk_of};
use super::columns::{Columns, Filled, fill};
use super::crowding::{are_sparse, better_plan, most_records, tests};
use super::grid::Grid;
use super::in_order::{Spans, is_sorted};
use super::kernel::{Cursor, Kernel, SortedBoxes};
use super::lookup::{Lookup, SAMPLED_BOXES, Table, may_pay, move_long, sampled};
use super::one_by_one::one_by_one;
use super::parallel::{Helpers, Receiver, Team};
use super::placements::Placements;
use super::plan::{Among, Plan, SizeSplit, plan};
use super::probe::Probe;
use super::sizes::{Groups, wide_boxes};
use super::sort::Sorter;
use super::source::Source;
use super::sweep::Sweep;
use super::task::{Stop, Task};
use crate::Scalar;
use crate::memory::only_item;

/// The deepest that plans nest.
const MOST_NESTED_PLANS: u32 = 12;
/// If one column still holds more than 7/8 of the boxes, the plan has not divided them: the column is swept on its
/// cheapest axis and not cut again. (Two groups beside each other, of which one reaches into the column of the
/// other, took 24 times as long as uniform boxes. Now they take 3 times as long.)
const UNDIVIDED_ONE_IN: usize = 8;

/// How many boxes come at a time if they look up others in any order.
const BOXES_IN_ANY_ORDER: usize = 1 << 20;
/// With fewer tests, threads do not pay for the sweep of a single column.
const MIN_TESTS_FOR_THREADS: u64 = 1 << 20;
/// A thread takes this many probes of a sweep at a time, so that their pairs stay in its cache.
const PROBES_AT_A_TIME: usize = 256;

/// What only searches of boxes on a line need.
#[derive(Debug, Default)]
struct OnLine<T> {
    /// For lookups among boxes, or first among the short ones and then among the long ones.
    tables: [Table<T>; 2],
    buckets: Buckets<T>,
    spans: Spans,
}

/// The buffers of one thread, kept between calls.
#[derive(Debug)]
pub(super) struct Driver<const D: usize, T: Scalar, P = ()> {
    pub kernel: Kernel,
    pub sorter: Sorter<T>,
    pub sorted: [SortedBoxes<T>; 2],
    /// None or one, so that drivers of other boxes are small.
    on_line: Vec<OnLine<T>>,
    pub placements: Placements,
    /// Spare columns and groups by size, one for each level at which plans were ever nested, if memory allows.
    pub columns: Vec<[Columns<D, T>; 2]>,
    groups: Vec<Groups<D, T>>,
    /// The drivers of the other threads.
    pub helpers: Helpers<Self>,
    pub probe: P,
}

impl<const D: usize, T: Scalar, P: Probe> Driver<D, T, P> {
    pub fn new(kernel: Kernel) -> Self {
        const { assert!(1 <= D && D <= 3, "boxes have one, two or three dimensions") };
        Self {
            kernel,
            sorter: Sorter::default(),
            sorted: Default::default(),
            on_line: Vec::new(),
            placements: Placements::default(),
            columns: Vec::new(),
            groups: Vec::new(),
            helpers: Helpers::new(),
            probe: P::default(),
        }
    }

    /// The same buffers with another probe, and without helpers.
    #[cfg(feature = "std")]
    pub fn with_probe<Q: Probe>(self) -> Driver<D, T, Q> {
        let Self { kernel, sorter, sorted, on_line, placements, columns, groups, .. } = self;
        let (helpers, probe) = (Helpers::new(), Q::default());
        Driver { kernel, sorter, sorted, on_line, placements, columns, groups, helpers, probe }
    }

    /// Sends all pairs within one set, or between two, to the sink. Sets that are searched by
    /// [brute force](is_brute_force) must be valid.
    pub fn run<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.is_empty()) {
            return Ok(());
        }
        if is_brute_force(sets) {
            let sweep = self.sweep(true, task);
            return brute_force(sets, task, &mut self.sorted, sink, |sets, sink| {
                if P::SWEEPS { sweep.run::<D, T, _>(sets, Cursor::default(), sink) } else { Ok(()) }
            });
        }
        let mut task = task;
        if D == 1 && task.depth == 0 && P::SWEEPS {
            if sets.iter().all(|set| is_sorted(set)) {
                check(sets, task)?;
                task.is_checked = true;
                if self.search_in_order(sets, task, sink)? {
                    return Ok(());
                }
            }
            if sets.len() == 2 && self.look_up(sets, task, sink)? {
                return Ok(());
            }
        }
        let may_nest = task.depth < MOST_NESTED_PLANS;
        let among = if may_nest { Among::All { is_crowded: false } } else { Among::Cuts };
        self.run_plan(plan(sets, among).0, sets, task, sink)
    }

    /// Finds the pairs of valid boxes on a line that come sorted. False, with nothing sent, if it is better to sweep.
    fn search_in_order<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<bool, Stop> {
        let Some(in_order) = only_item(&mut self.on_line)?.spans.fill(sets)? else {
            return Ok(false);
        };
        one_by_one(&in_order, &self.helpers, task, sink)?;
        Ok(true)
    }

    /// Has the boxes of the larger of two sets on a line look up those of the smaller one. False, with nothing
    /// sent, if it is better to sweep.
    fn look_up<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<bool, Stop> {
        let swap = sets[0].len() <= sets[1].len();
        let [smaller, larger] = if swap { [sets[0], sets[1]] } else { [sets[1], sets[0]] };
        if !may_pay(smaller, larger.len()) {
            return Ok(false);
        }
        check(sets, task)?;
        let begins = sampled(larger.len()).map(|at| larger[at].aabb().min[0]);
        if !self.prepare_lookups(smaller, begins)? {
            return Ok(false);
        }
        self.look_up_prepared(larger, 0, swap, task, sink)?;
        Ok(true)
    }

    /// Sorts the smaller of two valid sets on a line, and fills the tables that boxes of the larger one look up; `begins` are
    /// the left edges of a sample of these. False if it is better to sweep.
    pub fn prepare_lookups<S: Source<D, T>>(
        &mut self,
        smaller: &[S],
        begins: impl ExactSizeIterator<Item = T>,
    ) -> Result<bool, Stop> {
        let mut sample = [T::default(); SAMPLED_BOXES];
        let len = begins.len().min(SAMPLED_BOXES);
        sample.iter_mut().zip(begins).for_each(|(to, begin)| *to = begin);
        let begins = &sample[..len];
        let Self { sorter, sorted: [short, long], on_line, .. } = self;
        let [of_short, of_long] = &mut only_item(on_line)?.tables;
        sorter.sort(smaller, 0, short)?;
        self.probe.sorted(smaller.len());
        of_long.clear();
        Ok(of_short.fill(short, begins)?
            || move_long(short, long)?
                && of_short.fill(short, begins)?
                && of_long.fill(long, begins)?)
    }

    /// Has valid boxes look up those for which tables are filled. The index of the first box is `first`; `swap`: pairs begin
    /// with the box that is looked up.
    pub fn look_up_prepared<S: Source<D, T>, O: Receiver>(
        &mut self,
        boxes: &[S],
        first: usize,
        swap: bool,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let filled = take(&mut only_item(&mut self.on_line)?.tables);
        let tables = || filled.iter().filter_map(|table| table.indexed(swap));
        let task = Task { share: task.share / tables().count() as f64, ..task };
        let found = tables().try_for_each(|indexed| {
            let lookup = Lookup { indexed: &indexed, boxes, first };
            if indexed.takes_any_order() {
                one_by_one(&lookup, &self.helpers, task, sink)
            } else {
                self.look_up_in_buckets(lookup, task, sink)
            }
        });
        only_item(&mut self.on_line)?.tables = filled;
        found
    }

    /// Has boxes look up others a chunk at a time, on several threads if there are helpers.
    fn look_up_in_buckets<S: Source<D, T>, O: Receiver>(
        &mut self,
        Lookup { indexed, boxes, first }: Lookup<'_, S, T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let (all, chunk) = (0..boxes.len(), chunk_of(indexed));
        let part = |range: Range<usize>| {
            let share = task.share * range.len() as f64 / boxes.len() as f64;
            let (first, boxes) = (first + range.start, &boxes[range]);
            (Lookup { indexed, boxes, first }, Task { share, ..task })
        };
        let mut team = self.helpers.team::<O>(boxes.len());
        let found = match &mut team {
            Some(team) => team.in_chunks(all, chunk, self, sink, |driver, range, sink| {
                let (lookup, task) = part(range);
                only_item(&mut driver.on_line)?.buckets.look_up(lookup, task, sink)
            }),
            None => all.step_by(chunk).try_for_each(|start| {
                let (lookup, task) = part(start..boxes.len().min(start + chunk));
                only_item(&mut self.on_line)?.buckets.look_up(lookup, task, sink)
            }),
        };
        self.helpers.rest(team);
        found
    }

    /// How many boxes have to come at a time to look up those for which tables are filled, so that their pairs come in the same
    /// order as if all came at once. None if only that keeps the order.
    pub fn boxes_at_a_time(&self) -> Option<usize> {
        let [of_all, of_long] = &self.on_line.first()?.tables;
        let indexed = of_all.indexed(false).filter(|_| of_long.indexed(false).is_none())?;
        Some(if indexed.takes_any_order() { BOXES_IN_ANY_ORDER } else { chunk_of(&indexed) })
    }

    pub fn run_plan<S: Source<D, T>, O: Receiver>(
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
    fn one_column<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        axis: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        check(sets, task)?;
        self.sort_and_sweep(sets, axis, usize::MAX, task, sink)
    }

    /// Copies the boxes to the columns of a grid and finds the pairs of each column.
    fn cut<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let boxes = sets.iter().map(|set| set.len()).sum();
        let mut columns = self.columns.pop().unwrap_or_default();
        let mut team = self.helpers.team::<O>(boxes);
        let filled = fill(sets, &mut columns, |set, columns, other| {
            let placements = &mut self.placements;
            match &mut team {
                Some(team) => team
                    .fill(columns, set, grid, other, placements, |helper| &mut helper.placements),
                None => columns.fill(set, grid, other, placements),
            }
        });
        self.probe.copied(columns.iter().map(Columns::len).sum());
        let result = filled.and_then(|()| {
            let columns = &columns[..sets.len()];
            self.search_columns(columns, grid, boxes, &mut team, task, sink)
        });
        self.columns.try_reserve(1).is_ok().then(|| self.columns.push(columns));
        self.helpers.rest(team);
        if result == Err(Stop::TooMany) {
            return self.without_cut(sets, grid, task, sink);
        }
        result
    }

    /// Finds the pairs of each column.
    #[inline(never)]
    fn search_columns<O: Receiver>(
        &mut self,
        columns: &[Columns<D, T>],
        grid: &Grid<T>,
        boxes: usize,
        team: &mut Option<Team<Self>>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let crowd = most_records(boxes, grid.len());
        let Some(filled) = Filled::new(columns, grid, crowd) else {
            return task.done(1.0);
        };
        match team {
            Some(team) => team.search(
                self,
                |driver| &mut driver.helpers,
                &filled,
                sink,
                |driver, columns, sink| driver.columns(&filled, columns, task, sink),
            ),
            None => self.columns(&filled, 0..grid.len(), task, sink),
        }
    }

    /// Follows another plan if a grid would make too many records, of boxes that the sample has
    /// missed: splits the wide ones from the rest, or does not cut.
    fn without_cut<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if task.depth < MOST_NESTED_PLANS
            && let Some(split) = wide_boxes(sets, grid)
        {
            return self.split_by_size(sets, split, task, sink);
        }
        self.one_column(sets, grid.sweep, task, sink)
    }

    /// The pairs of some columns, one after the other.
    fn columns<O: Receiver>(
        &mut self,
        filled: &Filled<'_, D, T>,
        Range { mut start, end }: Range<usize>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        while start < end {
            let shared = filled.next_shared(start..end);
            let next = shared.map_or(end, |column| column + 1);
            let share = if task.progress.is_some() { filled.share(start..next) } else { 0.0 };
            let task = Task { share: task.share * share, ..task };
            match shared {
                Some(column) => {
                    let (records, sets) = filled.column(column);
                    let records = &records[..sets];
                    self.sort_and_sweep(records, filled.grid.sweep, filled.crowd, task, sink)?;
                }
                None => task.done(1.0)?,
            }
            start = next;
        }
        Ok(())
    }

    /// Sorts and sweeps boxes, or plans them again if there are more than `crowd`, or if another plan
    /// would leave fewer tests. Reports the whole task as done, where boxes are planned again part by part.
    fn sort_and_sweep<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        axis: usize,
        crowd: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.is_empty()) {
            return task.done(1.0);
        }
        let boxes: usize = sets.iter().map(|set| set.len()).sum();
        let is_divided = boxes < task.boxes - task.boxes / UNDIVIDED_ONE_IN;
        let among = if is_divided { Among::All { is_crowded: true } } else { Among::Sweeps };
        if boxes > crowd && is_divided && task.depth < MOST_NESTED_PLANS {
            let (plan, _) = plan(sets, among);
            if plan.divides() {
                return self.run_plan(plan, sets, task.nested(1.0, boxes), sink);
            }
        }
        for (&set, sorted) in sets.iter().zip(&mut self.sorted) {
            self.sorter.sort(set, axis, sorted)?;
        }
        let sorted = &self.sorted[..sets.len()];
        self.probe.sorted(boxes);
        let tests = tests(sorted, boxes);
        if let Some(tests) = tests
            && task.depth < MOST_NESTED_PLANS
            && let Some(plan) = better_plan(sets, sorted, tests, axis, among)
        {
            return self.run_plan(plan, sets, task.nested(1.0, boxes), sink);
        }
        self.probe.swept(sorted);
        if !P::SWEEPS {
            return Ok(());
        }
        let mut sweep = self.sweep(false, task);
        if tests.is_some_and(|tests| are_sparse::<T>(tests, boxes)) {
            sweep.kernel = sweep.kernel.with_fewer_lanes();
        }
        match self.helpers.threads::<O>(boxes) {
            Some(threads) if tests >= Some(MIN_TESTS_FOR_THREADS) => {
                threads.in_chunks(0..boxes, PROBES_AT_A_TIME, sink, |probes, sink| {
                    sweep.run::<D, T, _>(sorted, Cursor::of(sorted, probes), sink)
                })?;
            }
            _ => sweep.run::<D, T, _>(sorted, Cursor::default(), sink)?,
        }
        task.done(1.0)
    }

    /// Splits the boxes of a set by their size on an axis and searches the two groups separately, and
    /// of one set also between them.
    fn split_by_size<S: Source<D, T>, O: Receiver>(
        &mut self,
        sets: &[&[S]],
        split: SizeSplit,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let mut groups = self.groups.pop().unwrap_or_default();
        let boxes = sets.iter().map(|set| set.len()).sum();
        let result = groups.fill(sets, split).and_then(|()| {
            let split = (sets.len() == 2).then_some(split.set);
            self.search_groups(&groups, split, task.nested(1.0, boxes), sink)
        });
        self.groups.try_reserve(1).is_ok().then(|| self.groups.push(groups));
        result
    }

    /// Searches the small and the large boxes of one set, and between them; or of two sets, of which one was split, both with
    /// those of the other.
    #[inline(never)]
    fn search_groups<O: Receiver>(
        &mut self,
        Groups { small, large, other }: &Groups<D, T>,
        split: Option<usize>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let (small, large, other) = (&small[..], &large[..], &other[..]);
        let part = |share| Task { share: task.share * share, ..task };
        let Some(split) = split else {
            self.run(&[small], part(0.4), sink)?;
            self.run(&[large], part(0.2), sink)?;
            return self.run(&[large, small], part(0.4), sink);
        };
        [small, large].into_iter().try_for_each(|group| {
            let sets = if split == 0 { [group, other] } else { [other, group] };
            self.run(&sets, part(0.5), sink)
        })
    }

    fn sweep<'a>(&self, all_axes: bool, task: Task<'a>) -> Sweep<'a> {
        Sweep { kernel: self.kernel, all_axes, task }
    }
}

/// # Errors
/// [`Stop::Invalid`] if a box is invalid, and this was not known to be otherwise.
fn check<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[&[S]],
    task: Task<'_>,
) -> Result<(), Stop> {
    if task.is_checked || sets.iter().all(is_valid) { Ok(()) } else { Err(Stop::Invalid) }
}

/// Whether all boxes of a set are valid. No branch depends on a box.
pub(super) fn is_valid<const D: usize, T: Scalar, S: Source<D, T>>(set: &&[S]) -> bool {
    set.iter().fold(true, |valid, each| valid & each.aabb().is_valid())
}
