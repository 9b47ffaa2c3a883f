//! The stages put together, for one set (pairs within it) or two (pairs between them): plan, put
//! into bins, order each, sweep it. A bin that turns out crowded is planned anew.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use super::bins::{Bins, Record, Refusal, Source};
use super::grid::Grid;
use super::kernel::{Arrange, Column, Kernel};
use super::list::List;
use super::order::Sorter;
use super::plan::{CANDIDATE, Plan, plan};
use super::sink::{Sink, Store};
use super::sweep::{Sweep, candidates};
use super::watch::Watch;
use crate::{Aabb, Scalar};

/// Up to this many boxes in a set each is tested against each,
const FEW: usize = 128;
/// and with two sets also if one of them has no more than this.
const FEW_AGAINST_MANY: usize = 32;
/// Up to this many it is not even worth while to lay them out for the vectors,
const VERY_FEW: usize = 40;
/// and with two sets up to so many tests.
const FEW_TESTS: usize = 400;
/// Boxes laid out at a time where many are tested against a few.
const CHUNK: usize = 4096;

/// Plans within plans: cuts of crowded bins, and parts by size.
const DEPTH: u32 = 12;

/// A bin with fewer boxes is never planned anew,
const SMALL: usize = 512;
/// nor is one with fewer candidates a box.
const CROWDED: u64 = 96;

/// One with more, or with so many times its share of the boxes, is planned anew before it is
/// ordered: that many were not expected.
const LARGE: usize = 16384;
const UNEXPECTED: usize = 10;
/// Fewer take less time to order than to plan.
const WORTH_A_PLAN: usize = 2048;

/// Copies are held to this many records a box.
const COPIES: u64 = 4;
/// Where they are more, boxes wider than this many columns are parted from the rest.
const WIDE: f64 = 8.0;

/// Buffers of one thread, kept between calls.
#[derive(Debug)]
pub(super) struct Search<const D: usize, T: Scalar> {
    pub kernel: Kernel,
    pub sorter: Sorter<T>,
    pub columns: [Column<T>; 2],
    /// Which boxes go to which bins.
    pub list: List,
    /// Spare bins and parts: as many as plans were ever nested.
    pub bins: Vec<[Bins<D, T>; 2]>,
    parts: Vec<[Vec<Record<D, T>>; 3]>,
    #[cfg(feature = "parallel")]
    pub team: super::threads::Team<D, T>,
}

/// What holds for a search and all within it.
#[derive(Clone, Copy)]
pub(super) struct Task<'a> {
    pub arrange: Arrange,
    pub watch: Option<&'a Watch<'a>>,
    /// How much of the whole this is.
    pub share: f64,
    pub depth: u32,
}

impl<'a> Task<'a> {
    pub fn new(arrange: Arrange, watch: Option<&'a Watch<'a>>) -> Self {
        Self { arrange, watch, share: 1.0, depth: 0 }
    }

    /// A part of the task.
    fn part(self, share: f64) -> Self {
        Self { depth: self.depth + 1, share: self.share * share, ..self }
    }

    pub fn done(self, share: f64) -> Result<(), Stop> {
        match self.watch.map(|watch| watch.add(self.share * share)) {
            Some(ControlFlow::Break(())) => Err(Stop::Enough),
            _ => Ok(()),
        }
    }
}

/// How a search ends before its end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stop {
    /// A box is inverted or NaN; no pair has been found.
    Invalid,
    /// The sink or the watch had enough.
    Enough,
    /// There is not enough memory.
    Memory,
}

impl From<TryReserveError> for Stop {
    fn from(_: TryReserveError) -> Self {
        Stop::Memory
    }
}

impl<const D: usize, T: Scalar> Search<D, T> {
    pub fn new(kernel: Kernel) -> Self {
        const { assert!(1 <= D && D <= 3, "boxes have one, two or three dimensions") };
        Self {
            kernel,
            sorter: Sorter::new(),
            columns: [Column::new(), Column::new()],
            list: List::new(),
            bins: Vec::new(),
            parts: Vec::new(),
            #[cfg(feature = "parallel")]
            team: super::threads::Team::default(),
        }
    }

    /// Sends all pairs within one set, or between two, to the sink. Sets that are
    /// [searched directly](is_direct) must be valid.
    pub fn run<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if sets.iter().any(|set| set.len() == 0) {
            return Ok(());
        }
        if is_direct(sets) {
            return self.direct(sets, task, sink);
        }
        let planned = plan(sets, task.depth < DEPTH);
        self.follow(planned.plan, sets, task, sink)
    }

    /// Tests each box against each, with nothing ordered.
    fn direct<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let [first, last] = [sets[0], sets[sets.len() - 1]];
        if is_tiny(sets) {
            return very_few(sets, task.arrange, sink);
        }
        for start in (0..first.len()).step_by(CHUNK) {
            Sorter::unordered(first, start..first.len().min(start + CHUNK), &mut self.columns[0])?;
            if sets.len() == 1 {
                return self.sweep(1, D, task, sink);
            }
            for start in (0..last.len()).step_by(CHUNK) {
                let boxes = start..last.len().min(start + CHUNK);
                Sorter::unordered(last, boxes, &mut self.columns[1])?;
                self.sweep(2, D, task, sink)?;
            }
        }
        Ok(())
    }

    fn follow<S: Source<D, T>, O: Sink>(
        &mut self,
        plan: Plan<T>,
        sets: &[S],
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        match plan {
            Plan::Cut(grid) => self.cut(sets, &grid, task, sink),
            Plan::Part { set, axis, size } => self.part(sets, set, axis, size, task, sink),
        }
    }

    /// Puts the boxes into the bins of a grid and finds the pairs of each bin. One bin is not even
    /// filled.
    fn cut<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        grid: &Grid<T>,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if grid.len() == 1 {
            let valid =
                |set: &S| (0..set.len()).fold(true, |valid, i| valid & set.aabb(i).is_valid());
            // Deeper down all are.
            if task.depth == 0 && !sets.iter().all(valid) {
                return Err(Stop::Invalid);
            }
            self.ordered(sets, grid.sweep, usize::MAX, task, sink)?;
            return task.done(1.0);
        }
        #[cfg(feature = "parallel")]
        if let Some(result) = super::threads::cut(self, sets, grid, task, sink) {
            return result.unwrap_or_else(|refusal| self.refused(refusal, sets, grid, task, sink));
        }
        let mut bins = self.bins.pop().unwrap_or([Bins::new(), Bins::new()]);
        let filled = fill(sets, &mut bins, |set, bins, other| {
            self.list.fill(set, 0..set.len(), grid, limit(set.len()))?;
            if let Some(other) = other {
                self.list.keep_shared(other);
            }
            Ok(bins.fill(set, &self.list)?)
        });
        let result = match filled {
            Ok(()) => match Filled::new(&bins, sets, grid) {
                Some(bins) => (0..grid.len()).try_for_each(|bin| self.bin(&bins, bin, task, sink)),
                None => task.done(1.0),
            },
            Err(refusal) => self.refused(refusal, sets, grid, task, sink),
        };
        self.bins.push(bins);
        result
    }

    /// Another plan where a grid would make too many copies, of boxes that the sample has missed:
    /// part the wide ones from the rest, or do not cut.
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
                    return self.part(sets, set, axis, size, task, sink);
                }
            }
        }
        self.cut(sets, &Grid::uncut::<D>(grid.sweep), task, sink)
    }

    /// The pairs of one bin: orders and sweeps it, or plans it anew if it is crowded.
    pub fn bin<O: Sink>(
        &mut self,
        filled: &Filled<'_, D, T>,
        bin: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let [first, last] = filled.bins;
        let records = [first.bin(bin), if filled.sets == 2 { last.bin(bin) } else { &[] }];
        self.ordered(&records[..filled.sets], filled.grid.sweep, filled.crowd, task, sink)?;
        if task.watch.is_some() {
            task.done(records[0].len() as f64 / first.len() as f64)?;
        }
        Ok(())
    }

    /// The pairs of boxes that are taken together: orders and sweeps them, or plans them anew if
    /// there are more than `crowd`, or more candidates than a better plan would leave.
    pub fn ordered<S: Source<D, T>, O: Sink>(
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
        let again = Task { depth: task.depth + 1, share: 0.0, ..task };
        if boxes > crowd && task.depth < DEPTH {
            let planned = plan(sets, true);
            if planned.plan.divides() {
                return self.follow(planned.plan, sets, again, sink);
            }
        }
        for (&set, column) in sets.iter().zip(&mut self.columns) {
            self.sorter.order(set, axis, column)?;
        }
        if task.depth < DEPTH && self.is_crowded(sets.len()) {
            let candidates = candidates(&self.columns[..sets.len()], 512);
            if candidates > CROWDED * boxes as u64 {
                let planned = plan(sets, true);
                if planned.cost < 0.6 * CANDIDATE * candidates as f64 {
                    return self.follow(planned.plan, sets, again, sink);
                }
            }
        }
        #[cfg(feature = "parallel")]
        if self.team.pays(boxes) {
            let (sweep, columns) = (self.sweeper(D - 1, task), &self.columns[..sets.len()]);
            if let Some(result) = super::threads::sweep(sweep, columns, self.team.threads, sink) {
                return result;
            }
        }
        self.sweep(sets.len(), D - 1, task, sink)
    }

    /// Whether the columns that stand ordered may have too many candidates: a few probes tell that
    /// all is well; more are due before anything is done about it.
    pub fn is_crowded(&self, sets: usize) -> bool {
        let columns = &self.columns[..sets];
        let boxes = columns.iter().map(Column::len).sum::<usize>();
        boxes >= SMALL && candidates(columns, 32) > CROWDED * boxes as u64
    }

    /// Parts the boxes of a set by their size on an axis and takes the parts by themselves.
    fn part<S: Source<D, T>, O: Sink>(
        &mut self,
        sets: &[S],
        set: usize,
        axis: usize,
        size: f64,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        let mut parts = self.parts.pop().unwrap_or([Vec::new(), Vec::new(), Vec::new()]);
        parts.iter_mut().for_each(Vec::clear);
        let mut valid = true;
        for i in 0..sets[set].len() {
            let record = sets[set].record(i);
            valid &= record.aabb.is_valid();
            let part = &mut parts[usize::from(extent(&record.aabb, axis) > size)];
            part.try_reserve(1)?;
            part.push(record);
        }
        let [small, large, other] = &mut parts;
        if sets.len() == 2 {
            // The other set is copied as it is: all parts are then of one type.
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
            self.run(&[small], task.part(0.4), sink)
                .and_then(|()| self.run(&[large], task.part(0.2), sink))
                .and_then(|()| self.run(&[large, small], task.part(0.4), sink))
        } else {
            [small, large].into_iter().try_for_each(|part| {
                let sets = if set == 0 { [part, other] } else { [other, part] };
                self.run(&sets, task.part(0.5), sink)
            })
        };
        self.parts.push(parts);
        result
    }

    /// Sweeps the columns that stand ordered.
    pub fn sweep<O: Sink>(
        &self,
        sets: usize,
        others: usize,
        task: Task<'_>,
        sink: &mut O,
    ) -> Result<(), Stop> {
        if !O::SWEEPS {
            return Ok(());
        }
        self.sweeper(others, task).run(&self.columns[..sets], sink)
    }

    fn sweeper<'a>(&self, others: usize, task: Task<'a>) -> Sweep<'a> {
        let Task { arrange, watch, .. } = task;
        // Known to the compiler where there is no choice, so that the others are left out.
        let kernel = if cfg!(feature = "std") { self.kernel } else { Kernel::best() };
        Sweep { kernel, others, arrange, watch }
    }
}

/// The bins of a grid, filled with the boxes of one set or two.
pub(super) struct Filled<'a, const D: usize, T> {
    pub bins: &'a [Bins<D, T>; 2],
    pub sets: usize,
    pub grid: &'a Grid<T>,
    /// With how many records a bin is planned anew.
    pub crowd: usize,
}

impl<'a, const D: usize, T: Scalar> Filled<'a, D, T> {
    /// None if a set has no records, as when the two share no bin: then there are no pairs.
    pub fn new<S: Source<D, T>>(
        bins: &'a [Bins<D, T>; 2],
        sets: &[S],
        grid: &'a Grid<T>,
    ) -> Option<Self> {
        let crowd = crowd(sets.iter().map(|set| set.len()).sum(), grid);
        let all_have = bins[..sets.len()].iter().all(|bins| bins.len() > 0);
        all_have.then_some(Self { bins, sets: sets.len(), grid, crowd })
    }
}

/// Has the boxes of one set or two put into bins: of the larger of two only those that meet the
/// smaller in a bin.
pub(super) fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[S],
    bins: &mut [Bins<D, T>; 2],
    mut put: impl FnMut(S, &mut Bins<D, T>, Option<&Bins<D, T>>) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let [first_bins, last_bins] = bins;
    let &[first, last] = sets else {
        return put(sets[0], first_bins, None);
    };
    if first.len() <= last.len() {
        put(first, first_bins, None)?;
        put(last, last_bins, Some(first_bins))
    } else {
        put(last, last_bins, None)?;
        put(first, first_bins, Some(last_bins))
    }
}

/// Whether each box is simply tested against each.
pub(super) fn is_direct<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[S]) -> bool {
    let [first, last] = [sets[0].len(), sets[sets.len() - 1].len()];
    first.max(last) <= FEW || (sets.len() == 2 && first.min(last) <= FEW_AGAINST_MANY)
}

/// Whether boxes are so few that nothing else is worth while.
#[inline]
pub(super) fn is_tiny<const D: usize, T: Scalar, S: Source<D, T>>(sets: &[S]) -> bool {
    // Of 65,536 boxes and itself the product is 0 where `usize` has 32 bits.
    sets[0].len().saturating_mul(sets[sets.len() - 1].len()) <= FEW_TESTS
}

/// Stores the pairs of very few boxes. False, with nothing stored, if they are more, or invalid,
/// or there is not enough memory.
#[inline]
pub(super) fn few<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], store: &mut Store) -> bool {
    if boxes.len() > VERY_FEW || !boxes.iter().all(Aabb::is_valid) {
        return false;
    }
    store.clear();
    boxes.len() < 2 || store_few(boxes, store)
}

/// See [`few`]. Not inline, so that there is little to save and restore for none or one.
#[inline(never)]
fn store_few<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], store: &mut Store) -> bool {
    store.put(boxes.len() * (boxes.len() - 1) / 2, |pairs| {
        let (mut count, mut i, mut boxes) = (0, 0, boxes);
        while let [a, behind @ ..] = boxes {
            for (j, b) in (i + 1..).zip(behind) {
                if a.overlaps(b)
                    && let Some(pair) = pairs.get_mut(count)
                {
                    *pair = [i, j];
                    count += 1;
                }
            }
            (i, boxes) = (i + 1, behind);
        }
        count
    })
}

/// The pairs of very few boxes, box by box.
#[inline]
pub(super) fn very_few<const D: usize, T: Scalar, S: Source<D, T>, O: Sink>(
    sets: &[S],
    arrange: Arrange,
    sink: &mut O,
) -> Result<(), Stop> {
    let [first, last] = [sets[0], sets[sets.len() - 1]];
    let mut room = sink.room()?;
    let mut count = 0;
    for i in 0..first.len() {
        for j in if sets.len() == 1 { i + 1 } else { 0 }..last.len() {
            if first.aabb(i).overlaps(last.aabb(j)) && first.marks(i) & last.marks(j) == 0 {
                if count == room.len() {
                    sink.take(count)?;
                    (room, count) = (sink.room()?, 0);
                }
                let (a, b) = (first.id(i), last.id(j));
                let swap = arrange == Arrange::Ascending && b < a;
                room[count] = if swap { [b, a] } else { [a, b] };
                count += 1;
            }
        }
    }
    sink.take(count)
}

/// A bin that holds more than this of so many boxes is planned anew. Where there is but one, it
/// was planned.
pub(super) fn crowd<T: Scalar>(boxes: usize, grid: &Grid<T>) -> usize {
    match grid.len() {
        1 => usize::MAX,
        bins => (UNEXPECTED * (boxes / bins)).clamp(WORTH_A_PLAN, LARGE),
    }
}

/// The most records that so many boxes may become.
pub(super) fn limit(boxes: usize) -> u64 {
    (COPIES * boxes as u64 + SMALL as u64).min(u32::MAX.into())
}

/// The size of a box on an axis; a NaN if it lies at infinity.
fn extent<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, axis: usize) -> f64 {
    aabb.max[axis].to_f64() - aabb.min[axis].to_f64()
}
