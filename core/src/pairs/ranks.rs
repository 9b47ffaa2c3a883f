//! Counts the pairs of boxes on a line, of all boxes or of each, without finding them: in linear time however many there are.
//!
//! Two boxes are apart if one ends before the other begins. So it is enough to look up ranks among edges:
//!
//! ```text
//! between two sets:
//!     pairs = sum over the larger set of (boxes of the smaller one that begin before its box ends, or there)
//!           - sum over the larger set of (boxes of the smaller one that end before its box begins)
//! within a set of n boxes:
//!     pairs = sum over the set of (boxes that begin before its box ends, or there) - n (n + 1) / 2
//! ```
//!
//! The sum within a set counts each box for itself, two boxes that overlap twice, and two that are apart once: n (n + 1) / 2
//! more than the pairs.
//!
//! The edges are spread over equal cells. The rank of a coordinate is where its cell begins, and how many edges from there
//! on are less. All edges in later cells are greater, so a few edges are compared without asking where the cell ends.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::driver::is_valid;
use super::grid::BLOCK;
use super::parallel::Helpers;
use super::sink::{Count, Sink};
use super::sort::intervals;
use super::task::{Stop, Task};
use crate::geometry::{Arithmetic, Quantizer};
use crate::memory::{grow, prefetch_ahead, prefetch_item, prefetch_pays};
use crate::sampling::positions;
use crate::{Aabb, Scalar};

/// The most cells.
const MOST_CELLS: usize = 1 << 21;
/// How many edges are compared without a branch. A cell with more is sorted.
const COMPARED_EDGES: usize = 4;
/// The size of the sample that shows whether a few edges are far from the others.
const SAMPLED_EDGES: usize = 64;
/// How many edges of the sample may be far away, on each side.
const FAR_EDGES: usize = 2;
/// Edges are far away if without them the sample reaches over less than one part in this many.
const FAR: f64 = 8.0;

/// Among more boxes, the two edges are looked up one after the other: the tables of both do not fit a cache. (9.9 million among
/// 1.2 million took 0.72 s instead of 0.36; 1 million among 100,000 take 0.7 of the time on both sides at once.)
const MOST_LOOKED_UP_ON_BOTH_SIDES: usize = 1 << 18;
/// With fewer boxes to look up, threads do not pay.
const MIN_BOXES_FOR_THREADS: usize = 1 << 17;
/// A thread looks up this many boxes at a time.
const BOXES_AT_A_TIME: usize = 1 << 14;

/// The edges of a set, ready to be looked up.
#[derive(Debug, Default)]
pub(super) struct Ranks<T> {
    begins: Edges<T>,
    ends: Edges<T>,
}

/// The left edges of a set, or the right ones, by cell.
#[derive(Debug, Default)]
struct Edges<T> {
    all: Vec<T>,
    /// Where each cell begins, and where the last one ends.
    cells: Vec<u32>,
}

/// What gives the rank of a coordinate among edges.
struct Ranked<'a, T> {
    edges: &'a [T],
    cells: &'a [u32],
    quantizer: Quantizer<T>,
}

/// A set of boxes to look up, and the edges of another set, or the same.
struct Line<'a, const D: usize, T> {
    boxes: &'a [Aabb<D, T>],
    sides: Sides<Ranked<'a, T>>,
}

/// What is counted for a box.
enum Sides<R> {
    /// The others that begin before its end, or there.
    Begins(R),
    /// Those that end before it begins.
    Ends(R),
    /// The first without the second.
    Both(R, R),
}

/// Which of them.
#[derive(Clone, Copy)]
enum Side {
    Begins,
    Ends,
    Both,
}

impl<T: Scalar> Ranks<T> {
    /// How many pairs there are within a set of boxes, or between two. No set is empty.
    ///
    /// # Errors
    /// A [`Stop`].
    pub fn pairs<const D: usize, W>(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        task: Task<'_>,
        helpers: &Helpers<W>,
    ) -> Result<u64, Stop> {
        match *sets {
            [first, second] => {
                let swap = first.len() < second.len();
                let [larger, smaller] = if swap { [second, first] } else { [first, second] };
                if smaller.len() <= MOST_LOOKED_UP_ON_BOTH_SIDES {
                    return self.line(larger, smaller, Side::Both)?.sum_all(task, helpers);
                }
                let task = Task { share: task.share / 2.0, ..task };
                let begun = self.line(larger, smaller, Side::Begins)?.sum_all(task, helpers)?;
                Ok(begun - self.line(larger, smaller, Side::Ends)?.sum_all(task, helpers)?)
            }
            _ => {
                let begun = self.line(sets[0], sets[0], Side::Begins)?.sum_all(task, helpers)?;
                let count = sets[0].len() as u64;
                Ok(begun - count * (count + 1) / 2)
            }
        }
    }

    /// Counts for each box of the first set those of the second that overlap it; within one set, the other boxes. No
    /// set is empty.
    ///
    /// # Errors
    /// A [`Stop`].
    pub fn counts<const D: usize>(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        task: Task<'_>,
    ) -> Result<Vec<u32>, Stop> {
        let (boxes, others) = (sets[0], sets[sets.len() - 1]);
        let mut counts = Vec::new();
        counts.try_reserve_exact(boxes.len())?;
        let itself = u32::from(sets.len() == 1);
        let all = 0..boxes.len();
        if others.len() <= MOST_LOOKED_UP_ON_BOTH_SIDES {
            let line = self.line(boxes, others, Side::Both)?;
            line.each(all, task, |found| counts.extend(found.iter().map(|count| count - itself)))?;
            return Ok(counts);
        }
        let task = Task { share: task.share / 2.0, ..task };
        let begun = self.line(boxes, others, Side::Begins)?;
        begun.each(all.clone(), task, |found| {
            counts.extend(found.iter().map(|begun| begun - itself))
        })?;
        let mut rest = counts.iter_mut();
        self.line(boxes, others, Side::Ends)?.each(all, task, |found| {
            found.iter().zip(&mut rest).for_each(|(ended, count)| *count -= ended);
        })?;
        Ok(counts)
    }

    /// Ranks the edges of `others`, which `boxes` will look up.
    ///
    /// # Errors
    /// [`Stop::Memory`], and [`Stop::Invalid`] if one of `others` is.
    fn line<'a, const D: usize>(
        &'a mut self,
        boxes: &'a [Aabb<D, T>],
        others: &[Aabb<D, T>],
        side: Side,
    ) -> Result<Line<'a, D, T>, Stop> {
        if !is_valid(&others) {
            return Err(Stop::Invalid);
        }
        let [left, right] = [|aabb: &Aabb<D, T>| aabb.min[0], |aabb: &Aabb<D, T>| aabb.max[0]];
        let sides = match side {
            Side::Begins => Sides::Begins(self.begins.rank(others, left)?),
            Side::Ends => Sides::Ends(self.ends.rank(others, right)?),
            Side::Both => {
                Sides::Both(self.begins.rank(others, left)?, self.ends.rank(others, right)?)
            }
        };
        Ok(Line { boxes, sides })
    }
}

impl<T: Scalar> Edges<T> {
    /// Ranks an edge of each box, at least one. O(n) time where edges are spread, O(n log n) at most.
    ///
    /// # Errors
    /// If there is not enough memory.
    fn rank<const D: usize>(
        &mut self,
        boxes: &[Aabb<D, T>],
        edge: impl Fn(&Aabb<D, T>) -> T,
    ) -> Result<Ranked<'_, T>, TryReserveError> {
        let count = boxes.len().next_power_of_two().min(MOST_CELLS);
        let quantizer = intervals(reach(boxes.len(), |at| edge(&boxes[at])), count);
        let cell = |at: T| T::Arithmetic::cell(at, &quantizer) as usize;
        grow(&mut self.cells, count + 1, 0)?;
        grow(&mut self.all, boxes.len() + COMPARED_EDGES, T::default())?;
        let cells = &mut self.cells[..=count];
        cells.fill(0);
        boxes.iter().for_each(|aabb| cells[cell(edge(aabb))] += 1);
        let (mut total, mut most) = (0, 0);
        for begin in &mut *cells {
            most = most.max(*begin);
            total += *begin;
            *begin = total;
        }
        // From the end of each cell to where it begins.
        for edge in boxes.iter().map(&edge) {
            let begin = &mut cells[cell(edge)];
            *begin -= 1;
            self.all[*begin as usize] = edge;
        }
        if most as usize > COMPARED_EDGES {
            for cell in cells.windows(2).filter(|cell| is_crowded(cell[0], cell[1])) {
                let edges = &mut self.all[cell[0] as usize..cell[1] as usize];
                edges.sort_unstable_by(|a, b| a.order(*b));
            }
        }
        let edges = &mut self.all[..boxes.len() + COMPARED_EDGES];
        // Not less than anything, nor equal.
        edges[boxes.len()..].fill(T::from_f64(f64::NAN));
        Ok(Ranked { edges, cells, quantizer })
    }
}

impl<const D: usize, T: Scalar> Line<'_, D, T> {
    /// The sum of the counts of all boxes.
    ///
    /// # Errors
    /// A [`Stop`].
    fn sum_all<W>(&self, task: Task<'_>, helpers: &Helpers<W>) -> Result<u64, Stop> {
        let all = 0..self.boxes.len();
        match helpers.threads::<Count>(all.len()) {
            // Elsewhere the sum of a chunk may not fit.
            Some(threads) if all.len() >= MIN_BOXES_FOR_THREADS && usize::BITS == 64 => {
                let mut count = Count::default();
                threads.in_chunks(all, BOXES_AT_A_TIME, &mut count, |range, sink| {
                    sink.take(self.sum(range, task)? as usize)
                })?;
                Ok(count.count)
            }
            _ => self.sum(all, task),
        }
    }

    /// The sum of the counts of a range of boxes.
    ///
    /// # Errors
    /// [`Stop::Invalid`], [`Stop::Cancelled`].
    fn sum(&self, range: Range<usize>, task: Task<'_>) -> Result<u64, Stop> {
        let mut sum = 0;
        self.each(range, task, |found| {
            sum += found.iter().map(|&count| u64::from(count)).sum::<u64>()
        })?;
        Ok(sum)
    }

    /// Passes on what is counted for each box of a range, block by block.
    ///
    /// # Errors
    /// [`Stop::Invalid`], [`Stop::Cancelled`].
    #[inline(always)]
    fn each(
        &self,
        range: Range<usize>,
        task: Task<'_>,
        mut take: impl FnMut(&[u32]),
    ) -> Result<(), Stop> {
        let (mut counts, mut unreported) = ([0; BLOCK], 0);
        let starts = range.clone().step_by(BLOCK);
        for (start, block) in starts.zip(self.boxes[range].chunks(BLOCK)) {
            prefetch_ahead(self.boxes, start..start + block.len());
            if !is_valid(&block) {
                return Err(Stop::Invalid);
            }
            let [begins, ends] = [0, 1].map(|end| {
                block.iter().map(move |aabb| if end == 1 { aabb.max[0] } else { aabb.min[0] })
            });
            if let Sides::Begins(ranked) | Sides::Both(ranked, _) = &self.sides {
                ranked.look_up(ends, |edge, end| edge <= end, |at, rank| counts[at] = rank);
            }
            match &self.sides {
                Sides::Begins(_) => {}
                Sides::Ends(ranked) => {
                    ranked.look_up(begins, |edge, at| edge < at, |at, rank| counts[at] = rank);
                }
                Sides::Both(_, ranked) => {
                    ranked.look_up(begins, |edge, at| edge < at, |at, rank| counts[at] -= rank);
                }
            }
            take(&counts[..block.len()]);
            // Not for each block: of very many boxes, its share is too small to be added.
            unreported += block.len();
            if task.progress.is_some() && unreported >= BOXES_AT_A_TIME {
                task.done(unreported as f64 / self.boxes.len() as f64)?;
                unreported = 0;
            }
        }
        if task.progress.is_some() {
            task.done(unreported as f64 / self.boxes.len() as f64)?;
        }
        Ok(())
    }
}

impl<T: Scalar> Ranked<'_, T> {
    /// Passes on for each of a block of coordinates how many edges are less than it.
    #[inline(always)]
    fn look_up(
        &self,
        coordinates: impl Iterator<Item = T> + Clone,
        is_less: impl Fn(T, T) -> bool,
        mut take: impl FnMut(usize, u32),
    ) {
        let mut cells = [0; BLOCK];
        for (cell, at) in cells.iter_mut().zip(coordinates.clone()) {
            *cell = T::Arithmetic::cell(at, &self.quantizer);
        }
        // In steps of their own, so that more of a large table is waited for at the same time. (A million among 100,000 take 0.8
        // of the time.)
        let mut parts = [[0; 2]; BLOCK];
        for (part, &cell) in parts.iter_mut().zip(&cells) {
            *part = [self.cells[cell as usize], self.cells[cell as usize + 1]];
        }
        if prefetch_pays(self.edges) {
            parts.iter().for_each(|part| prefetch_item(self.edges, part[0] as usize));
        }
        for (place, (&[begin, end], at)) in parts.iter().zip(coordinates).enumerate() {
            let edges = &self.edges[begin as usize..];
            let less = if is_crowded(begin, end) {
                edges[..(end - begin) as usize].partition_point(|&edge| is_less(edge, at)) as u32
            } else {
                edges[..COMPARED_EDGES].iter().map(|&edge| u32::from(is_less(edge, at))).sum()
            };
            take(place, begin + less);
        }
    }
}

/// Whether a cell has more edges than are compared.
fn is_crowded(begin: u32, end: u32) -> bool {
    (end - begin) as usize > COMPARED_EDGES
}

/// From where to where cells are needed: from the least to the greatest edge, but for a few that are far from the others.
fn reach<T: Scalar>(len: usize, edge: impl Fn(usize) -> T) -> [T; 2] {
    let mut sample = [T::default(); SAMPLED_EDGES];
    let sampled = positions(len, SAMPLED_EDGES);
    let sample = &mut sample[..sampled.len()];
    sample.iter_mut().zip(sampled).for_each(|(to, at)| *to = edge(at));
    sample.sort_unstable_by(|a, b| a.order(*b));
    let far = FAR_EDGES.min(sample.len() / 4);
    let [low, high] = [sample[far], sample[sample.len() - 1 - far]];
    let span = high.to_f64() - low.to_f64();
    let least_or_greatest = |[least, greatest]: [T; 2], at| {
        let edge = edge(at);
        [if edge < least { edge } else { least }, if greatest < edge { edge } else { greatest }]
    };
    let all = (0..len).fold([edge(0); 2], least_or_greatest);
    if all[1].to_f64() - all[0].to_f64() > FAR * span {
        [low.to_f64() - span / FAR, high.to_f64() + span / FAR].map(T::from_f64)
    } else {
        all
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;

    /// Compared one by one with those of its cell, each edge would be compared with all others.
    #[test]
    fn edges_are_spread_over_cells_also_beside_some_that_are_far_away() {
        let place = |at: u64| (at.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64;
        for far in [1.0, 1e20, 1e300, f64::INFINITY] {
            let edges = (0..10_000).map(place).chain([far, -far]);
            let boxes: Vec<_> = edges.map(|at| Aabb::new([at], [at])).collect();
            let mut edges = Edges::default();
            let ranked = edges.rank(&boxes, |aabb| aabb.max[0]).expect("memory");
            let counts = ranked.cells.windows(2).map(|cell| cell[1] - cell[0]);
            assert!(counts.max() < Some(16), "{far}");
        }
    }
}
