//! Few boxes against many: of the many most lie near none of the few, and are left out before anything is planned or copied.
//!
//! ```text
//! cut space into cells: most of the many boxes reach no further than one or two cells on
//! for each of the few boxes
//!     mark the cells that it touches, and on each axis the one or two before them
//! for each of the many boxes
//!     keep it if the cell of its lower corner is marked, or if it reaches further
//! ```
//!
//! So no box that overlaps one of the few is left out.

use alloc::vec::Vec;

use super::grid::{BLOCK, CellCoordinates};
use super::plan::{MOST_NEAR_CELLS, near_cells};
use super::source::{Record, Source};
use super::task::Stop;
use crate::sampling::positions;
use crate::{Aabb, Scalar};

/// There must be at least this many boxes for each of the few.
const MIN_SET_RATIO: usize = 8;
/// And this many in all: among fewer, to plan takes too long in WebAssembly (100 boxes against 1,000 in space, 1.2 times).
const LEAST_MANY: usize = 2048;
/// Leaving out takes as long as testing all of the many boxes against ten,
const TESTED_AGAINST: usize = 10;
/// and as 20,000 tests more.
const TESTS: usize = 20_000;
/// There is memory for at least this part of the many boxes, as some of the few, and as those near them.
const SPARE_ONE_IN: [usize; 2] = [64, 4];
/// Of this many blocks of the many boxes at most half of the boxes may be near.
const SAMPLED_BLOCKS: usize = 8;

/// Which cells are near one of the few boxes.
struct Bitmap {
    /// From a cell to the next on each axis of the grid, and how many cells on most of the many boxes reach there.
    steps: [u32; 3],
    reach: [u32; 3],
    bits: [u32; MOST_NEAR_CELLS / 32],
}

impl Bitmap {
    /// Sets the bits of the cells from which boxes reach a box: of those that it touches, and on each axis of those before them.
    /// `column` is its first cell, and `more` how many more it touches on each axis.
    #[inline(never)]
    fn add(&mut self, column: u32, more: [u32; 3]) {
        let Self { steps, reach, bits } = self;
        let lens: [u32; 3] = core::array::from_fn(|axis| more[axis] + reach[axis] + 1);
        // Before the first cell of an axis is another one, or none: marked in vain.
        let before: u32 = steps.iter().zip(&*reach).map(|(step, reach)| step * reach).sum();
        let first = column as i32 - before as i32;
        for i in 0..lens[0] {
            for j in 0..lens[1] {
                let start = first + (i * steps[0] + j * steps[1]) as i32;
                let end = (start + lens[2] as i32).clamp(0, MOST_NEAR_CELLS as i32) as usize;
                let mut at = start.max(0) as usize;
                while at < end {
                    let len = (end - at).min(32 - at % 32);
                    bits[at / 32] |= u32::MAX >> (32 - len) << (at % 32);
                    at += len;
                }
            }
        }
    }

    /// Which of the first `len` boxes of a block may lie near one of the few, a bit each.
    #[inline(never)]
    fn near(&self, len: usize, CellCoordinates { column, more }: &CellCoordinates) -> u64 {
        // Loops of one kind of step each, so that the compiler can do several boxes at once.
        let mut is_far = [0; BLOCK];
        for (more, &reach) in more.iter().zip(&self.reach) {
            let each = is_far.iter_mut().zip(more);
            each.for_each(|(is_far, &more)| *is_far |= u32::from(more > reach));
        }
        let mut near = 0;
        for at in (0..len).rev() {
            let cell = column[at] as usize % MOST_NEAR_CELLS;
            let is_marked = self.bits[cell / 32] >> (cell % 32) & 1;
            near = near << 1 | u64::from(is_marked | is_far[at]);
        }
        near
    }

    /// Sets the bits of the few boxes, and lists these and the many that may lie near one of them. `fill` computes the cells of
    /// the block of the few or of the many that begins there, and returns whether its boxes are valid. Returns false, with none
    /// of the many listed, if that does not seem to leave out most of them.
    ///
    /// # Errors
    /// [`Stop::Invalid`] or [`Stop::Memory`].
    #[inline(never)]
    fn find(
        &mut self,
        [few, many]: [usize; 2],
        fill: &mut dyn FnMut(usize, usize, &mut CellCoordinates) -> bool,
        [all_few, near]: &mut [Vec<u32>; 2],
    ) -> Result<bool, Stop> {
        let cells = &mut CellCoordinates::new();
        all_few.clear();
        // Spare capacity, so that updates of a world seldom allocate.
        all_few.try_reserve(few.max(many / SPARE_ONE_IN[0]))?;
        for start in (0..few).step_by(BLOCK) {
            if !fill(0, start, cells) {
                return Err(Stop::Invalid);
            }
            for at in 0..BLOCK.min(few - start) {
                self.add(cells.column[at], cells.more.map(|more| more[at]));
                all_few.push((start + at) as u32);
            }
        }
        // An invalid box is found below.
        let kept = positions(many / BLOCK, SAMPLED_BLOCKS).map(|block| {
            fill(1, block * BLOCK, cells);
            self.near(BLOCK, cells).count_ones() as usize
        });
        if kept.sum::<usize>() > BLOCK * SAMPLED_BLOCKS / 2 {
            return Ok(false);
        }
        near.clear();
        near.try_reserve(many / SPARE_ONE_IN[1])?;
        for start in (0..many).step_by(BLOCK) {
            if !fill(1, start, cells) {
                return Err(Stop::Invalid);
            }
            near.try_reserve(BLOCK)?;
            let mut bits = self.near(BLOCK.min(many - start), cells);
            while bits != 0 {
                near.push(start as u32 + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
        Ok(true)
    }
}

/// The boxes of one set that are few, and those of another that may lie near one of them.
#[derive(Debug, Default)]
pub(super) struct Near<const D: usize, T> {
    few: Vec<Record<D, T>>,
    near: Vec<Record<D, T>>,
    /// Their indices.
    listed: [Vec<u32>; 2],
}

impl<const D: usize, T: Scalar> Near<D, T> {
    /// Copies the boxes of the smaller of two sets, and those of the larger that may lie near one of these, and returns these sets in
    /// the order in which they came; `None` if there is one set, or if that does not seem to leave out most of the larger.
    ///
    /// # Errors
    /// [`Stop::Invalid`] or [`Stop::Memory`].
    #[inline(never)]
    pub fn fill(&mut self, sets: &[&[Aabb<D, T>]]) -> Result<Option<[&[Record<D, T>]; 2]>, Stop> {
        let &[first, second] = sets else { return Ok(None) };
        let swap = first.len() > second.len();
        let (few, many) = if swap { (second, first) } else { (first, second) };
        let [few_count, many_count] = [few.len(), many.len()];
        let are_few = many_count >= LEAST_MANY
            && few_count > TESTED_AGAINST
            && few_count * MIN_SET_RATIO <= many_count
            && few_count - TESTED_AGAINST > TESTS / many_count;
        if D == 1 || !are_few {
            return Ok(None);
        }
        let Some((grid, reach)) = near_cells(few, many) else { return Ok(None) };
        let mut bitmap = Bitmap { steps: grid.steps(), reach, bits: [0; MOST_NEAR_CELLS / 32] };
        let mut fill = |set: usize, start: usize, cells: &mut CellCoordinates| {
            let boxes = &[few, many][set][start..];
            cells.fill(&boxes[..BLOCK.min(boxes.len())], &grid)
        };
        if !bitmap.find([few_count, many_count], &mut fill, &mut self.listed)? {
            return Ok(None);
        }
        let Self { few: kept_few, near, listed: [all_few, listed] } = self;
        copy(kept_few, few, all_few, all_few.capacity())?;
        copy(near, many, listed, listed.capacity())?;
        Ok(Some(if swap { [near, kept_few] } else { [kept_few, near] }))
    }
}

/// Replaces records by those of the boxes with these indices. There is memory for `spare` of them.
#[inline(never)]
fn copy<const D: usize, T: Scalar>(
    to: &mut Vec<Record<D, T>>,
    boxes: &[Aabb<D, T>],
    indices: &[u32],
    spare: usize,
) -> Result<(), Stop> {
    to.clear();
    to.try_reserve(spare)?;
    to.extend(indices.iter().map(|&at| boxes[at as usize].record(at as usize)));
    Ok(())
}

#[cfg(test)]
mod tests {
    use sweep_and_prune_scenes::Random;

    use super::*;

    /// Boxes with corners on a coarse grid, so that many touch edges of cells and of each other.
    fn boxes<const D: usize>(random: &mut Random, count: usize, side: usize) -> Vec<Aabb<D, f32>> {
        let mut boxes: Vec<_> = (0..count)
            .map(|_| {
                let min = core::array::from_fn(|_| random.below(side) as f32);
                Aabb::new(min, min.map(|at: f32| at + random.below(4) as f32))
            })
            .collect();
        // Some are large, flat, far away or without end.
        for _ in 0..1 + count / 300 {
            let at = random.below(count);
            let aabb = &mut boxes[at];
            let axis = random.below(D);
            match random.below(4) {
                0 => aabb.max = aabb.max.map(|at| at + 10.0),
                1 => (aabb.min[axis], aabb.max[axis]) = (f32::NEG_INFINITY, f32::INFINITY),
                2 => (aabb.min[axis], aabb.max[axis]) = (-1e9, -1e9),
                _ => (aabb.min[axis], aabb.max[axis]) = (1e30, f32::MAX),
            }
        }
        boxes
    }

    fn keeps_what_overlaps<const D: usize>(seed: u64) -> usize {
        let mut random = Random::new(seed);
        let side = [20, 40, 200, 2000][random.below(4)];
        let count = 40 + random.below(60);
        let few = boxes::<D>(&mut random, count, side);
        let many = boxes::<D>(&mut random, 3000, side);
        let mut near = Near::default();
        let swap = random.below(2) == 0;
        let sets: [&[_]; 2] = if swap { [&many, &few] } else { [&few, &many] };
        let Some(kept) = near.fill(&sets).unwrap() else { return 0 };
        let [kept_few, kept] = if swap { [kept[1], kept[0]] } else { kept };
        let same = |(at, (record, aabb)): (usize, (&Record<D, f32>, &Aabb<D, f32>))| {
            record.id == at as u32 && record.aabb == *aabb
        };
        assert!(kept_few.len() == few.len() && kept_few.iter().zip(&few).enumerate().all(same));
        let ids: Vec<_> = kept.iter().map(|record| record.id as usize).collect();
        assert!(
            ids.is_sorted() && kept.iter().all(|record| record.aabb == many[record.id as usize])
        );
        for (at, aabb) in many.iter().enumerate() {
            let overlaps = few.iter().any(|few| few.overlaps(aabb));
            assert!(
                !overlaps || ids.binary_search(&at).is_ok(),
                "seed {seed}: box {at} is left out"
            );
        }
        many.len() - kept.len()
    }

    #[test]
    fn what_overlaps_one_of_the_few_is_kept_and_most_others_are_not() {
        let left_out =
            |each: fn(u64) -> usize| (0..100).map(each).filter(|&left| left > 1500).count();
        assert!(left_out(keeps_what_overlaps::<2>) > 30);
        assert!(left_out(keeps_what_overlaps::<3>) > 30);
    }

    #[test]
    fn one_set_few_boxes_and_a_line_are_left_as_they_are() {
        let mut random = Random::new(1);
        let many = boxes::<2>(&mut random, 3000, 100);
        let mut near = Near::default();
        assert!(near.fill(&[&many]).unwrap().is_none());
        assert!(near.fill(&[&many, &many[..1000]]).unwrap().is_none());
        assert!(near.fill(&[&many, &many[..5]]).unwrap().is_none());
        assert!(near.fill(&[&many, &many[..100]]).unwrap().is_some());
        let line = boxes::<1>(&mut random, 3000, 100);
        assert!(Near::default().fill(&[&line, &line[..100]]).unwrap().is_none());
    }

    #[test]
    fn an_invalid_box_is_found_in_either_set() {
        let mut random = Random::new(2);
        let few = boxes::<3>(&mut random, 100, 1000);
        let many = boxes::<3>(&mut random, 4000, 1000);
        let invalid = Aabb::new([1.0, f32::NAN, 1.0], [2.0; 3]);
        for at in [0, 77, 3999] {
            let mut wrong = many.clone();
            wrong[at] = invalid;
            assert_eq!(Near::default().fill(&[&few, &wrong]).err(), Some(Stop::Invalid));
        }
        let mut wrong = few;
        wrong[99] = invalid;
        assert_eq!(Near::default().fill(&[&many, &wrong]).err(), Some(Stop::Invalid));
    }
}
