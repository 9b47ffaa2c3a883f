//! Counts the pairs of boxes on a line without finding them, in linear time however many there are.
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

use super::grid::BLOCK;
use super::parallel::Helpers;
use super::sink::{Count, Sink};
use super::sort::intervals;
use super::task::{Stop, Task};
use crate::geometry::{Arithmetic, Quantizer};
use crate::memory::grow;
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

/// With fewer boxes to look up, threads do not pay.
const MIN_BOXES_FOR_THREADS: usize = 1 << 17;
/// A thread looks up this many boxes at a time.
const BOXES_AT_A_TIME: usize = 1 << 14;

/// The edges of a set on one side, by cell.
#[derive(Debug, Default)]
pub(super) struct Ranks<T> {
    edges: Vec<T>,
    /// Where each cell begins, and where the last one ends.
    begins: Vec<u32>,
}

/// Which edges are ranked, and what is looked up among them.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    /// Left edges, among which right edges are looked up: how many are not greater.
    Begins,
    /// Right edges, among which left edges are looked up: how many are less.
    Ends,
}

/// The ranked edges of one set.
struct Ranked<'a, T> {
    edges: &'a [T],
    begins: &'a [u32],
    quantizer: Quantizer<T>,
    side: Side,
}

impl<T: Scalar> Ranks<T> {
    /// How many pairs there are within a set of valid boxes, or between two.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    pub fn pairs<const D: usize, W>(
        &mut self,
        sets: &[&[Aabb<D, T>]],
        task: Task<'_>,
        helpers: &Helpers<W>,
    ) -> Result<u64, Stop> {
        let [larger, smaller] = match *sets {
            [first, second] if first.len() < second.len() => [second, first],
            [first, .., second] => [first, second],
            _ => [sets[0]; 2],
        };
        let task = Task { share: task.share / sets.len() as f64, ..task };
        let begin = self.rank(smaller, Side::Begins)?.sum_all(larger, task, helpers)?;
        let not_pairs = if sets.len() == 2 {
            self.rank(smaller, Side::Ends)?.sum_all(larger, task, helpers)?
        } else {
            let count = larger.len() as u64;
            count * (count + 1) / 2
        };
        Ok(begin - not_pairs)
    }

    /// Ranks edges of valid boxes, at least one. O(n) time where edges are spread, O(n log n) at most.
    ///
    /// # Errors
    /// If there is not enough memory.
    fn rank<const D: usize>(
        &mut self,
        boxes: &[Aabb<D, T>],
        side: Side,
    ) -> Result<Ranked<'_, T>, TryReserveError> {
        let edge = |aabb: &Aabb<D, T>| if side == Side::Begins { aabb.min[0] } else { aabb.max[0] };
        let count = boxes.len().next_power_of_two().min(MOST_CELLS);
        let quantizer = intervals(reach(boxes.len(), |at| edge(&boxes[at])), count);
        let cell = |at: T| T::Arithmetic::cell(at, &quantizer) as usize;
        grow(&mut self.begins, count + 1, 0)?;
        grow(&mut self.edges, boxes.len() + COMPARED_EDGES, T::default())?;
        let begins = &mut self.begins[..=count];
        begins.fill(0);
        boxes.iter().for_each(|aabb| begins[cell(edge(aabb))] += 1);
        let (mut total, mut most) = (0, 0);
        for begin in &mut *begins {
            most = most.max(*begin);
            total += *begin;
            *begin = total;
        }
        // From the end of each cell to where it begins.
        for edge in boxes.iter().map(edge) {
            let begin = &mut begins[cell(edge)];
            *begin -= 1;
            self.edges[*begin as usize] = edge;
        }
        if most as usize > COMPARED_EDGES {
            for cell in begins.windows(2).filter(|cell| is_crowded(cell[0], cell[1])) {
                let edges = &mut self.edges[cell[0] as usize..cell[1] as usize];
                edges.sort_unstable_by(|a, b| a.order(*b));
            }
        }
        let edges = &mut self.edges[..boxes.len() + COMPARED_EDGES];
        // Not less than anything, nor equal.
        edges[boxes.len()..].fill(T::from_f64(f64::NAN));
        Ok(Ranked { edges, begins, quantizer, side })
    }
}

impl<T: Scalar> Ranked<'_, T> {
    /// The sum of the ranks of all boxes.
    ///
    /// # Errors
    /// [`Stop::Memory`], [`Stop::Cancelled`].
    fn sum_all<const D: usize, W>(
        &self,
        boxes: &[Aabb<D, T>],
        task: Task<'_>,
        helpers: &Helpers<W>,
    ) -> Result<u64, Stop> {
        let all = 0..boxes.len();
        match helpers.threads::<Count>(boxes.len()) {
            // Elsewhere the sum of a chunk may not fit.
            Some(threads) if boxes.len() >= MIN_BOXES_FOR_THREADS && usize::BITS == 64 => {
                let mut count = Count::default();
                threads.in_chunks(all, BOXES_AT_A_TIME, &mut count, |range, sink| {
                    sink.take(self.sum(boxes, range, task)? as usize)
                })?;
                Ok(count.count)
            }
            _ => self.sum(boxes, all, task),
        }
    }

    /// The sum of the ranks of a range of boxes.
    ///
    /// # Errors
    /// [`Stop::Cancelled`].
    fn sum<const D: usize>(
        &self,
        boxes: &[Aabb<D, T>],
        range: Range<usize>,
        task: Task<'_>,
    ) -> Result<u64, Stop> {
        let mut sum = 0;
        let mut looked_up = [T::default(); BLOCK];
        let mut cells = [0; BLOCK];
        for block in boxes[range].chunks(BLOCK) {
            let begins = self.side == Side::Begins;
            for (at, aabb) in looked_up.iter_mut().zip(block) {
                *at = if begins { aabb.max[0] } else { aabb.min[0] };
            }
            for (cell, at) in cells.iter_mut().zip(&looked_up) {
                *cell = T::Arithmetic::cell(*at, &self.quantizer);
            }
            let looked_up = cells.iter().zip(&looked_up).take(block.len());
            sum += if begins {
                looked_up.map(|(&cell, &at)| self.count(cell, |edge| edge <= at)).sum::<u64>()
            } else {
                looked_up.map(|(&cell, &at)| self.count(cell, |edge| edge < at)).sum::<u64>()
            };
            if task.progress.is_some() {
                task.done(block.len() as f64 / boxes.len() as f64)?;
            }
        }
        Ok(sum)
    }

    /// How many edges are less than a coordinate of a cell.
    #[inline(always)]
    fn count(&self, cell: u32, is_less: impl Fn(T) -> bool) -> u64 {
        let [begin, end] = [self.begins[cell as usize], self.begins[cell as usize + 1]];
        let edges = &self.edges[begin as usize..];
        let less = if is_crowded(begin, end) {
            edges[..(end - begin) as usize].partition_point(|&edge| is_less(edge))
        } else {
            edges[..COMPARED_EDGES].iter().map(|&edge| usize::from(is_less(edge))).sum()
        };
        u64::from(begin) + less as u64
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
            let mut ranks = Ranks::default();
            let ranked = ranks.rank(&boxes, Side::Ends).expect("memory");
            let counts = ranked.begins.windows(2).map(|cell| cell[1] - cell[0]);
            assert!(counts.max() < Some(16), "{far}");
        }
    }
}
