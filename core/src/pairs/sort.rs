//! Sorts the boxes of a column by left edge, and lays them out as a structure of arrays.
//!
//! ```text
//! spread the keys over about as many equal intervals as there are keys: count, prefix sum, scatter
//! sort each crowded interval (clusters, equal edges) by the standard sort
//! exchange neighbors that are out of order, in one pass without a branch
//! finish by insertion sort: now nearly every key is in its place
//! ```
//!
//! So it takes linear time where edges are spread, and O(n log n) for any input.
//!
//! The limits below were chosen on uniform boxes of 1,000 to 100,000, one core of an AMD EPYC (Zen 5). They
//! were not measured one by one, apart from the exchange: 0.97 of the time, in clusters 0.9.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::Range;

use super::kernel::SortedBoxes;
use super::source::Source;
use crate::float::greater;
use crate::geometry::{Arithmetic, Key, Quantizer};
use crate::memory::grow;
use crate::{Aabb, Scalar};

/// Up to this many keys are sorted by insertion alone.
const INSERTION_ONLY: usize = 24;
/// An interval with more keys than this is sorted by the standard sort.
const CROWDED_INTERVAL: u32 = 16;
/// How many coordinates stay in the first-level cache.
const BLOCK: usize = 1024;
/// The most intervals: their counters fit the second-level cache.
const MOST_INTERVALS: usize = 1 << 16;

/// The buffers of the sort.
#[derive(Debug, Default)]
pub(super) struct Sorter<T: Scalar> {
    keys: Vec<Key<T>>,
    sorted: Vec<Key<T>>,
    lefts: Vec<T>,
    intervals: Vec<u32>,
    ends: Vec<u32>,
}

impl<T: Scalar> Sorter<T> {
    /// Fills `boxes` with those of `source`, by left edge on `axis`, then by position in the source.
    #[inline(never)] // It is the same for all sinks.
    pub fn sort<const D: usize, S: Source<D, T>>(
        &mut self,
        source: &[S],
        axis: usize,
        boxes: &mut SortedBoxes<T>,
    ) -> Result<(), TryReserveError> {
        self.sort_keys(source, axis)?;
        boxes.reset(source.len(), D - 1)?;
        for (at, &key) in self.sorted[..source.len()].iter().enumerate() {
            put(source, T::Arithmetic::position(key) as usize, axis, boxes, at);
        }
        Ok(())
    }

    /// The positions of the boxes in the source by left edge on `axis`, then by position.
    pub fn order<const D: usize, S: Source<D, T>>(
        &mut self,
        source: &[S],
        axis: usize,
    ) -> Result<impl Iterator<Item = usize>, TryReserveError> {
        self.sort_keys(source, axis)?;
        let keys = self.sorted[..source.len()].iter();
        Ok(keys.map(|&key| T::Arithmetic::position(key) as usize))
    }

    /// Fills `boxes` with those of `source`, which come by left edge on `axis`.
    pub fn in_order<const D: usize, S: Source<D, T>>(
        source: &[S],
        axis: usize,
        boxes: &mut SortedBoxes<T>,
    ) -> Result<(), TryReserveError> {
        boxes.reset(source.len(), D - 1)?;
        // A call for each box takes hardly more time, and 1.9 KB less of WebAssembly.
        (0..source.len()).for_each(|at| put_same(source, at, axis, boxes));
        Ok(())
    }

    /// Fills `boxes` with a range of those of `source`, unsorted, for brute force: with all axes beside
    /// a sweep axis on which all overlap.
    pub fn unsorted<const D: usize, S: Source<D, T>>(
        source: &[S],
        range: Range<usize>,
        boxes: &mut SortedBoxes<T>,
    ) -> Result<(), TryReserveError> {
        boxes.reset(range.len(), D)?;
        boxes.left[..range.len()].fill(T::default());
        boxes.right[..range.len()].fill(T::default());
        for (at, i) in range.enumerate() {
            let Aabb { min, max } = source[i].aabb();
            for axis in 0..D {
                boxes.min[axis][at] = min[axis];
                boxes.max[axis][at] = max[axis];
            }
            boxes.id[at] = source[i].id(i);
            boxes.dedup[at] = source[i].dedup();
        }
        Ok(())
    }

    /// Leaves the sorted keys of the boxes in `sorted`.
    #[inline(never)]
    fn sort_keys<const D: usize, S: Source<D, T>>(
        &mut self,
        source: &[S],
        axis: usize,
    ) -> Result<(), TryReserveError> {
        let len = source.len();
        let edge = |i: usize| source[i].aabb().min[axis];
        grow(&mut self.sorted, len, Key::<T>::default())?;
        if len <= INSERTION_ONLY {
            for (i, key) in self.sorted[..len].iter_mut().enumerate() {
                *key = T::Arithmetic::key(edge(i), i as u32);
            }
            insertion(&mut self.sorted[..len]);
            return Ok(());
        }
        grow(&mut self.keys, len, Key::<T>::default())?;
        grow(&mut self.lefts, len, T::default())?;
        for (i, (key, left)) in self.keys.iter_mut().zip(&mut self.lefts[..len]).enumerate() {
            *left = edge(i);
            *key = T::Arithmetic::key(*left, i as u32);
        }
        self.spread(len)?;
        exchange(&mut self.sorted[..len]);
        insertion(&mut self.sorted[..len]);
        Ok(())
    }

    /// Leaves `keys`, of `lefts`, in `sorted`, each near its place.
    fn spread(&mut self, len: usize) -> Result<(), TryReserveError> {
        let count = len.next_power_of_two().min(MOST_INTERVALS);
        let quantizer = intervals(extremes(&self.lefts[..len]), count);
        grow(&mut self.intervals, len, 0)?;
        for (interval, left) in self.intervals.iter_mut().zip(&self.lefts[..len]) {
            *interval = T::Arithmetic::cell(*left, &quantizer);
        }
        grow(&mut self.ends, count, 0)?;
        let ends = &mut self.ends[..count];
        ends.fill(0);
        for &interval in &self.intervals[..len] {
            ends[interval as usize] += 1;
        }
        let (mut total, mut most) = (0, 0);
        for end in &mut *ends {
            most = most.max(*end);
            total += core::mem::replace(end, total);
        }
        let sorted = &mut self.sorted[..len];
        for (&key, &interval) in self.keys[..len].iter().zip(&self.intervals[..len]) {
            let end = &mut ends[interval as usize];
            let at = *end as usize;
            *end += 1;
            sorted[at] = key;
        }
        if most > CROWDED_INTERVAL {
            let mut begin = 0;
            for &end in &*ends {
                if end - begin > CROWDED_INTERVAL {
                    sorted[begin as usize..end as usize].sort_unstable();
                }
                begin = end;
            }
        }
        Ok(())
    }
}

/// Puts box `i` of the source, to be swept on an axis, at a position of `boxes`.
#[inline(always)]
fn put<const D: usize, T: Scalar, S: Source<D, T>>(
    source: &[S],
    i: usize,
    axis: usize,
    boxes: &mut SortedBoxes<T>,
    at: usize,
) {
    let Aabb { min, max } = source[i].aabb();
    boxes.left[at] = min[axis];
    boxes.right[at] = max[axis];
    let mut other = axis;
    for k in 0..D - 1 {
        other = if other + 1 == D { 0 } else { other + 1 };
        boxes.min[k][at] = min[other];
        boxes.max[k][at] = max[other];
    }
    boxes.id[at] = source[i].id(i);
    boxes.dedup[at] = source[i].dedup();
}

/// Puts box `at` of the source at its own position.
#[inline(never)]
fn put_same<const D: usize, T: Scalar, S: Source<D, T>>(
    source: &[S],
    at: usize,
    axis: usize,
    boxes: &mut SortedBoxes<T>,
) {
    put(source, at, axis, boxes, at);
}

/// The least and the greatest of some coordinates.
fn extremes<T: Scalar>(coordinates: &[T]) -> [T; 2] {
    coordinates.chunks(BLOCK).fold([coordinates[0]; 2], |[least, greatest], block| {
        [
            reduce(least, block, |a, b| if a < b { a } else { b }),
            reduce(greatest, block, |a, b| if a > b { a } else { b }),
        ]
    })
}

/// Reduces coordinates to one, a vector at a time. (Both extremes in one loop, or more lanes, take twice as long: the
/// compiler then finds no instructions for the lesser and the greater.)
fn reduce<T: Scalar>(first: T, coordinates: &[T], chosen: impl Fn(T, T) -> T) -> T {
    const LANES: usize = 4;
    let (vectors, rest) = coordinates.as_chunks::<LANES>();
    let lanes = vectors.iter().fold([first; LANES], |lanes, vector| {
        core::array::from_fn(|lane| chosen(vector[lane], lanes[lane]))
    });
    rest.iter().chain(&lanes).fold(first, |all, &each| chosen(each, all))
}

/// Cuts the line between two coordinates into `count` equal intervals.
pub(super) fn intervals<T: Scalar>(ends: [T; 2], count: usize) -> Quantizer<T> {
    let ends = ends.map(T::to_f64);
    let unit = T::Arithmetic::unit(greater(ends[0].abs(), ends[1].abs()));
    let [low, high] =
        ends.map(|end| (end * unit.to_f64()).clamp(-T::Arithmetic::LIMIT, T::Arithmetic::LIMIT));
    let last = (count - 1) as f64;
    // From 0.0 to -0.0 it is -0.0, by which cells would fall.
    let extent = (high - low).abs();
    let [origin, scale, last] = [low, last / extent, last].map(T::from_f64);
    Quantizer { unit, origin, scale, last }
}

/// One pass of exchanges between neighbors, without a branch, which would be unpredictable: most keys
/// that are not in their place are one beside it.
fn exchange<K: Copy + Ord>(keys: &mut [K]) {
    if let [first, ..] = *keys {
        let mut most = first;
        for i in 1..keys.len() {
            let key = keys[i];
            keys[i - 1] = most.min(key);
            most = most.max(key);
        }
        keys[keys.len() - 1] = most;
    }
}

/// Insertion sort: linear where each key is near its place.
#[inline(never)]
fn insertion<K: Copy + Ord>(keys: &mut [K]) {
    for i in 1..keys.len() {
        let key = keys[i];
        let mut at = i;
        while at > 0 && key < keys[at - 1] {
            keys[at] = keys[at - 1];
            at -= 1;
        }
        keys[at] = key;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key<T: Scalar>(left: T, position: u32) -> Key<T> {
        T::Arithmetic::key(left, position)
    }

    /// One far key puts all others into one interval: inserted one by one each would move past a quarter of them.
    #[test]
    fn keys_are_spread_to_near_their_places_also_beside_one_far_away() {
        for far in [1.0, 1e6, 1e30, f64::MAX, f64::INFINITY] {
            let place = |index: u64| (index.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11) as f64;
            let lefts = (0..10_000).map(place).chain([far]).collect::<Vec<_>>();
            let keys = (0..).zip(&lefts);
            let keys: Vec<_> = keys.map(|(i, &left)| key(left, i)).collect();
            let len = keys.len();
            let mut sorted = keys.clone();
            sorted.sort_unstable();
            let nothing = std::vec![Key::<f64>::default(); len];
            let mut sorter = Sorter { keys, lefts, sorted: nothing, ..Sorter::default() };
            sorter.spread(len).expect("memory");
            let distance = |(at, key)| sorted.binary_search(key).expect("it is there").abs_diff(at);
            let farthest = sorter.sorted.iter().enumerate().map(distance).max();
            assert!(farthest < Some(CROWDED_INTERVAL as usize), "{far}: {farthest:?}");
        }
    }
}
