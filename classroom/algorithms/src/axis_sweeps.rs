//! A sweep on every axis: a pair must be flagged on each (Baraff 1992; I-COLLIDE, Cohen, Lin,
//! Manocha and Ponamgi 1995).
//!
//! ```text
//! for each axis
//!     sort its endpoints
//!     sweep: for each overlap on the axis: flag the pair
//! the pairs flagged on every axis overlap
//! ```
//!
//! Time: D sorts, plus O(n + m) where m is the sum of the overlaps on *all* the axes. No box
//! is ever tested against another: the flags replace the test. That is no gain by itself. Each
//! axis costs as much as a one-axis sweep with its tests, so this form only pays where the flags
//! are kept and seldom change: see `swap_sweep.rs`.
//!
//! Memory: O(n) an axis, plus the flags. A pair that was not flagged on the axes before can be
//! dropped at once, so only the overlaps of the first axis are ever stored; the sweep begins with
//! the axis that was chosen, which should be the one with the fewest.
//!
//! Unlike the article, which only describes this form, the flags are a count in a hash table: a
//! pair overlaps once it has been counted on all D axes.

use alloc::vec::Vec;

use crate::endpoint_array::EndpointArray;
use crate::endpoint_sweep::sweep;
use crate::observer::{Observer, pair};
use crate::pair_map::PairMap;
use crate::sorts::Sort;
use crate::touching::Touching;
use sweep_and_prune::{Aabb, Scalar};

/// The endpoints of every axis and the flags of every pair.
#[derive(Clone, Debug)]
pub(crate) struct AxisSweeps<const D: usize, T> {
    /// One array an axis.
    pub arrays: [EndpointArray<T>; D],
    touching: Touching,
    /// On how many axes, in the order in which they are swept, a pair overlaps.
    flags: PairMap<usize>,
}

impl<const D: usize, T: Scalar> AxisSweeps<D, T> {
    /// No boxes yet.
    pub fn new() -> Self {
        Self {
            arrays: core::array::from_fn(|_| EndpointArray::default()),
            touching: Touching::default(),
            flags: PairMap::default(),
        }
    }

    /// Appends all overlapping pairs of the boxes in the arrays, in the order in which the last
    /// sweep flags them. The axes are swept from `first_axis` upward, then from 0.
    pub fn find<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        first_axis: usize,
        sort: Sort,
        observer: &mut O,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let flags = &mut self.flags;
        flags.clear();
        for (already, axis) in (first_axis..D).chain(0..first_axis).enumerate() {
            let array = &mut self.arrays[axis];
            array.sort(boxes, axis, sort, observer);
            sweep(&array.endpoints, &mut self.touching, observer, |observer, a, b| {
                let pair = pair(a, b);
                observer.axis_overlap(axis, pair[0], pair[1]);
                if already == 0 {
                    flags.insert(pair, 1);
                } else if let Some(count) = flags.get_mut(pair).filter(|count| **count == already) {
                    *count += 1;
                } else {
                    return;
                }
                if already + 1 == D {
                    observer.overlap(pair[0], pair[1]);
                    pairs.push(pair);
                }
            });
        }
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        let arrays: usize = self.arrays.iter().map(EndpointArray::bytes).sum();
        arrays + self.touching.bytes() + self.flags.bytes()
    }
}
