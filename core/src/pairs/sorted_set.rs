//! A set of boxes that is copied to columns and sorted once, for many searches with other boxes.
//!
//! ```text
//! copy the other boxes to the columns of the set
//! for each column with boxes of both
//!     sort the others, and sweep both
//! ```

use super::columns::Columns;
use super::crowding::{are_crowded, tests};
use super::driver::Driver;
use super::finder::PairFinder;
use super::grid::Grid;
use super::kernel::{Cursor, PairOrder};
use super::plan::{Among, Plan, plan};
use super::search::{Buffers, error};
use super::sink::Store;
use super::sort::Sorter;
use super::sweep::Sweep;
use super::task::{Stop, Task};
use crate::memory::only_item;
use crate::{Aabb, Error, Scalar};

/// The boxes of a set in columns, by left edge in each.
#[derive(Debug)]
pub struct SortedSet<const D: usize, T> {
    grid: Grid<T>,
    columns: Columns<D, T>,
}

impl<const D: usize, T: Scalar> SortedSet<D, T> {
    /// Sorts valid boxes, with the buffers of a finder. None if one grid does not divide them well, since their sizes differ much,
    /// or if there is not enough memory.
    #[inline(never)]
    pub fn new(boxes: &[Aabb<D, T>], finder: &mut PairFinder<D, T>) -> Option<Self> {
        if boxes.is_empty() {
            return None;
        }
        let among = Among::All { is_crowded: false };
        let Plan::Cut(grid) = plan(&[boxes], among).0 else { return None };
        let Driver { sorter, placements, .. } = &mut finder.0.driver;
        let mut columns = Columns::default();
        columns.fill(boxes, &grid, None, placements).ok()?;
        columns.sort(&grid, sorter).ok()?;
        Some(Self { grid, columns })
    }

    /// The pairs of one of these valid boxes and one of the set, as `[index of the box, index in the set]`. None, with no pair
    /// of use, if there are many more than `most`, or if another grid is better for them: they touch very many columns of this
    /// one, or are crowded in one.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    #[inline(never)]
    pub fn pairs_with<'f>(
        &self,
        boxes: &[Aabb<D, T>],
        most: usize,
        finder: &'f mut PairFinder<D, T>,
    ) -> Result<Option<&'f mut [[u32; 2]]>, Error> {
        let Buffers { driver, store, .. } = &mut finder.0;
        store.most = most;
        let result = self.search(boxes, driver, store);
        store.most = usize::MAX;
        match result {
            Err(Stop::TooMany | Stop::Cancelled) => Ok(None),
            Err(stop) => Err(error(stop)),
            Ok(()) => Ok(Some(store.pairs_mut())),
        }
    }

    fn search(
        &self,
        boxes: &[Aabb<D, T>],
        Driver { kernel, sorter, sorted, placements, columns, .. }: &mut Driver<D, T>,
        store: &mut Store,
    ) -> Result<(), Stop> {
        let axis = self.grid.sweep;
        let task = Task::new(PairOrder::BySet, None);
        let sweep = Sweep { kernel: *kernel, all_axes: false, task };
        let others = &mut only_item(columns)?[0];
        others.fill(boxes, &self.grid, None, placements)?;
        store.clear();
        for column in 0..self.grid.len() {
            let [others, own] = [others.column(column), self.columns.column(column)];
            if others.is_empty() || own.is_empty() {
                continue;
            }
            sorter.sort(others, axis, &mut sorted[0])?;
            Sorter::in_order(own, axis, &mut sorted[1])?;
            let boxes = others.len() + own.len();
            if tests(sorted, boxes).is_some_and(|tests| are_crowded(tests, boxes)) {
                return Err(Stop::TooMany);
            }
            sweep.run::<D, T, _>(sorted, Cursor::default(), store)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use sweep_and_prune_scenes::Random;

    use super::*;
    use crate::pairs::find_pairs_between;

    /// Boxes with few distinct coordinates, so that many touch.
    fn boxes<const D: usize, T: Scalar>(
        count: usize,
        size: f64,
        random: &mut Random,
    ) -> Vec<Aabb<D, T>> {
        let mut aabb = || {
            let min: [f64; D] = core::array::from_fn(|_| (random.unit() * 64.0).floor());
            let max = min.map(|at| at + (random.unit() * size).floor());
            Aabb::new(min.map(T::from_f64), max.map(T::from_f64))
        };
        (0..count).map(|_| aabb()).collect()
    }

    fn pairs_are_those_of_the_finder<const D: usize, T: Scalar>() {
        let (random, mut finder) = (&mut Random::new(7), PairFinder::new());
        let set = boxes::<D, T>(6000, 2.0, random);
        let sorted = SortedSet::new(&set, &mut finder).expect("a grid divides them");
        for (count, size) in [(0, 2.0), (1, 2.0), (500, 3.0), (6000, 2.0), (50, 12.0)] {
            let with = boxes(count, size, random);
            let found = sorted.pairs_with(&with, usize::MAX, &mut finder).unwrap();
            let found = found.expect("the boxes touch few columns");
            found.sort_unstable();
            let mut expected = find_pairs_between(&with, &set).unwrap();
            expected.sort_unstable();
            assert!(*found == expected, "{D}D, {count} boxes: {} {}", found.len(), expected.len());
        }
    }

    #[test]
    fn pairs_with_a_sorted_set_are_those_of_the_finder() {
        pairs_are_those_of_the_finder::<2, f32>();
        pairs_are_those_of_the_finder::<3, f32>();
        pairs_are_those_of_the_finder::<2, f64>();
        pairs_are_those_of_the_finder::<3, f64>();
    }

    /// A set along a line, which is swept along it, and boxes that are as long; a crowd.
    #[test]
    fn boxes_that_are_crowded_in_a_column_are_left_to_another_plan() {
        let (at, finder) = (|x: u16, y: f32| [f32::from(x), y], &mut PairFinder::new());
        let set: Vec<Aabb<2>> = (0..4000).map(|x| Aabb::new(at(x, 0.0), at(x, 1.0))).collect();
        let sorted = SortedSet::new(&set, finder).expect("one column is enough");
        let long = |y: u16| Aabb::new([0.0, f32::from(y)], [4000.0, f32::from(y) + 0.5]);
        let with: Vec<_> = (1..1000).map(long).collect();
        assert!(matches!(sorted.pairs_with(&with, usize::MAX, finder), Ok(None)));
        let few = sorted
            .pairs_with(&with[..5], usize::MAX, finder)
            .unwrap()
            .expect("they are not crowded");
        assert_eq!(few.len(), 4000);

        let crowd = [Aabb::new([0.0; 2], [1.0; 2]); 20_000];
        let sorted = SortedSet::new(&crowd, finder).expect("one column is enough");
        assert!(matches!(sorted.pairs_with(&crowd, usize::MAX, finder), Ok(None)));
        let far = [Aabb::new([2.0; 2], [3.0; 2])];
        assert!(matches!(sorted.pairs_with(&far, usize::MAX, finder), Ok(Some([]))));
    }

    #[test]
    fn boxes_that_touch_very_many_columns_are_left_to_another_plan() {
        let (set, finder) =
            (boxes::<3, f32>(20_000, 2.0, &mut Random::new(7)), &mut PairFinder::new());
        let sorted = SortedSet::new(&set, finder).expect("a grid divides them");
        let all = [Aabb::new([-1.0; 3], [70.0; 3]); 50];
        assert!(matches!(sorted.pairs_with(&all, usize::MAX, finder), Ok(None)));
    }

    #[test]
    fn boxes_of_very_different_sizes_are_not_sorted() {
        let mut sizes = boxes::<3, f32>(20_000, 2.0, &mut Random::new(7));
        sizes.iter_mut().step_by(10).for_each(|each| *each = Aabb::new([0.0; 3], [64.0; 3]));
        assert!(SortedSet::new(&sizes, &mut PairFinder::new()).is_none());
        assert!(SortedSet::<2, f32>::new(&[], &mut PairFinder::new()).is_none());
    }
}
