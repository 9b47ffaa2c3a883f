//! The swap-driven sweep, the article's final form: each swap of insertion sort shows that an overlap
//! begins or ends. On one axis, or on every axis at once.
//!
//! ```text
//! for i in 1..len                                    insertion sort of last step's endpoints
//!     for j in i-1 down to 0
//!         if not endpoints[j+1] < endpoints[j]: break
//!         swap endpoints[j], endpoints[j+1]
//!         )( becomes ()  :  the two boxes begin to overlap on this axis
//!         () becomes )(  :  the two boxes cease to overlap on this axis
//!         (( and ))      :  nothing
//! ```
//!
//! When a right endpoint moves left, its box ceases to overlap each box whose left endpoint it
//! passes. When a left endpoint moves left, its box begins to overlap each box whose right endpoint
//! it passes.
//!
//! Time of an update: O(n + s + m) on each axis. All 2n endpoints are refreshed and compared, even if
//! their boxes rest: O(n). There are s swaps, exactly one for each inversion: none in a world
//! at rest, a few if it moves a little, and at worst 2n(n-1). (A full reversal of 2n endpoints has
//! n(2n-1) inversions, and the n pairs of endpoints of one box never swap.) At the end all m stored
//! overlaps are listed. On one axis each of them is tested on the other axes. On every axis a pair
//! must be flagged on each, and no box is tested. The pairs are kept in a hash table, so that a change
//! takes expected O(1). Memory: O(n + m), where m is the number of overlaps on *all* swept axes.
//!
//! What differs from the article, and why:
//! - It must start from what overlaps. The article's listing, run on endpoints that were sorted
//!   first, never sees the overlaps that exist at the start. Here boxes are added in bulk: their
//!   endpoints are sorted and merged in, and one sweep finds what they overlap. The first step adds
//!   boxes to an empty array. Removing boxes works the same way.
//! - The order is total. With the article's strict `<`, equal coordinates swap in every step:
//!   touching boxes flicker, and a flat box begins to overlap itself.
//! - A pair has one key, smaller id first, whichever box reached the other.
//! - `begun` and `ended` are net. A box that teleports past k others makes up to 4k swaps and, on this
//!   axis, k overlaps that begin and end: 2k events within one update. They cancel, so it reports no
//!   pair.

use alloc::vec;
use alloc::vec::Vec;

use crate::endpoint::{Edge, Side};
use crate::endpoint_array::EndpointArray;
use crate::observer::{Observer, Separation, pair};
use crate::pair_map::PairMap;
use crate::sorts::{Array, Sort};
use crate::touching::Touching;
use sweep_and_prune::{Aabb, Scalar};

/// Endpoints and overlaps that persist from step to step. A step consists of
/// [`remove`](Self::remove), [`move_all`](Self::move_all), [`insert`](Self::insert) and
/// [`report`](Self::report), in this order.
#[derive(Clone, Debug, Default)]
pub(crate) struct SwapSweep<T> {
    /// The axes that are swept, each with its sorted endpoints.
    sweeps: Vec<(usize, EndpointArray<T>)>,
    /// Whether every axis is swept: then nothing is left to test.
    every_axis: bool,
    overlaps: Overlaps,
    /// The boxes that the sweep line touches and that were there in the last step.
    staying: Touching,
    /// The boxes that the sweep line touches and that are added or removed.
    marked: Touching,
}

impl<T: Scalar> SwapSweep<T> {
    /// No boxes yet, and this one axis to sweep.
    pub fn on_axis(axis: usize) -> Self {
        Self { sweeps: vec![(axis, EndpointArray::default())], ..Self::default() }
    }

    /// No boxes yet, and all `dimensions` axes to sweep.
    pub fn on_every_axis(dimensions: usize) -> Self {
        let sweeps = (0..dimensions).map(|axis| (axis, EndpointArray::default())).collect();
        let overlaps = Overlaps { axes: dimensions, ..Overlaps::default() };
        Self { sweeps, every_axis: true, overlaps, ..Self::default() }
    }

    /// Changes the axis of the form that sweeps one: removes all boxes, which ends every overlap. A
    /// pair that overlaps again once its boxes are inserted is not a change.
    pub fn turn_to<O: Observer>(&mut self, axis: usize, ids: &[u32], observer: &mut O) {
        self.remove(ids, observer);
        self.sweeps[0].0 = axis;
    }

    /// The axis it sweeps, if it is only one of several.
    pub fn axis(&self) -> Option<usize> {
        if self.every_axis { None } else { self.sweeps.first().map(|(axis, _)| *axis) }
    }

    /// Ends every overlap of these boxes and drops them, `ids` ascending. O(n log k + their
    /// overlaps) an axis.
    pub fn remove<O: Observer>(&mut self, ids: &[u32], observer: &mut O) {
        if ids.is_empty() {
            return;
        }
        for k in 0..self.sweeps.len() {
            let (axis, array) = &self.sweeps[k];
            observer.array(*axis, &array.endpoints);
            self.sweep_marked(k, ids, observer, |overlaps, observer, axis, [a, b]| {
                observer.axis_apart(axis, a, b);
                overlaps.cease([a, b]);
            });
            self.sweeps[k].1.remove(ids);
        }
    }

    /// Refreshes all endpoints and sorts them; the swaps show which overlaps begin and end.
    /// O(n + swaps).
    pub fn move_all<const D: usize, O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        observer: &mut O,
    ) {
        for (axis, array) in &mut self.sweeps {
            array.refresh(0, boxes, *axis);
            observer.array(*axis, &array.endpoints);
            let mut swaps = SwapObserver { axis: *axis, overlaps: &mut self.overlaps, observer };
            Sort::Insertion.sort(&mut array.endpoints, &mut swaps);
        }
    }

    /// Merges these boxes in and begins every overlap of theirs, `ids` ascending and none in it.
    /// O(n + k log k + their overlaps) an axis.
    pub fn insert<const D: usize, O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        ids: &[u32],
        sort: Sort,
        observer: &mut O,
    ) {
        if ids.is_empty() {
            return;
        }
        for k in 0..self.sweeps.len() {
            let (axis, array) = &mut self.sweeps[k];
            let old = array.endpoints.len();
            array.append(ids, &[Side::Left, Side::Right]);
            array.refresh(old, boxes, *axis);
            observer.array(*axis, &array.endpoints);
            sort.sort_tail(&mut array.endpoints, old, observer);
            let len = array.endpoints.len();
            Array { endpoints: &mut array.endpoints, observer }.merge(0..len, old);
            self.sweep_marked(k, ids, observer, |overlaps, observer, axis, [a, b]| {
                observer.axis_overlap(axis, a, b);
                overlaps.begin([a, b]);
            });
        }
    }

    /// Appends all overlapping pairs, in an order that depends only on the steps so far.
    pub fn report<const D: usize, O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        observer: &mut O,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let one_axis = self.axis();
        let Overlaps { flagged, changed, .. } = &mut self.overlaps;
        for &mut ([a, b], ref mut reported) in flagged.iter_mut() {
            let separation = one_axis.and_then(|axis| {
                let separation = Separation::find_beside(boxes, a, b, axis);
                observer.test(a, b, separation);
                separation
            });
            let overlaps = separation.is_none();
            if overlaps {
                observer.overlap(a, b);
                pairs.push([a, b]);
            }
            if *reported != overlaps {
                *reported = overlaps;
                changed.push([a, b]);
            }
        }
    }

    /// Appends the pairs that only the last report has, and the pairs that only the one before has, each sorted.
    /// O(c log c) for c changes.
    pub fn changes(&mut self, begun: &mut Vec<[u32; 2]>, ended: &mut Vec<[u32; 2]>) {
        let Overlaps { flagged, changed, .. } = &mut self.overlaps;
        // Each entry switches a pair between reported and not reported, so an even number of them cancels.
        changed.sort_unstable();
        for turns in changed.chunk_by(|a, b| a == b).filter(|turns| turns.len() % 2 == 1) {
            let pair = turns[0];
            let reported = flagged.get_mut(pair).is_some_and(|reported| *reported);
            if reported { begun.push(pair) } else { ended.push(pair) }
        }
        changed.clear();
    }

    /// Sweeps the sorted endpoints of axis number `k` and calls `meet` for each pair that overlaps
    /// there and has a box among the `ids`. Other pairs cost nothing.
    fn sweep_marked<O: Observer>(
        &mut self,
        k: usize,
        ids: &[u32],
        observer: &mut O,
        meet: impl Fn(&mut Overlaps, &mut O, usize, [u32; 2]),
    ) {
        let Self { sweeps, overlaps, staying, marked, .. } = self;
        let (axis, array) = &sweeps[k];
        let are_all_marked = ids.len() * 2 == array.endpoints.len();
        for (position, endpoint) in array.endpoints.iter().enumerate() {
            let Edge { side, id } = endpoint.edge;
            let is_marked = are_all_marked || ids.binary_search(&id).is_ok();
            observer.visit(position, endpoint.edge);
            if side == Side::Right {
                if is_marked {
                    marked.remove(id)
                } else {
                    staying.remove(id)
                }
                observer.leave(id);
                continue;
            }
            observer.enter(id);
            for &other in marked.ids() {
                meet(overlaps, observer, *axis, pair(other, id));
            }
            if is_marked {
                for &other in staying.ids() {
                    meet(overlaps, observer, *axis, pair(other, id));
                }
                marked.add(id);
            } else {
                staying.add(id);
            }
        }
    }

    /// How many overlaps on the swept axes there are.
    pub fn axis_overlaps(&self) -> u64 {
        self.overlaps.standing
    }

    /// The memory it holds.
    pub fn bytes(&self) -> usize {
        let arrays: usize = self.sweeps.iter().map(|(_, array)| array.bytes()).sum();
        arrays + self.staying.bytes() + self.marked.bytes() + self.overlaps.bytes()
    }
}

/// Turns the swaps of insertion sort into overlaps that begin and end, and passes everything on to
/// the observer.
struct SwapObserver<'a, O> {
    axis: usize,
    overlaps: &'a mut Overlaps,
    observer: &'a mut O,
}

impl<O: Observer> Observer for SwapObserver<'_, O> {
    #[inline]
    fn compare(&mut self, a: Edge, b: Edge) {
        self.observer.compare(a, b);
    }

    /// `a` stood before `b` and now stands behind it.
    #[inline]
    fn swap(&mut self, positions: [usize; 2], a: Edge, b: Edge) {
        self.observer.swap(positions, a, b);
        let [least, other] = pair(a.id, b.id);
        match (a.side, b.side) {
            (Side::Right, Side::Left) => {
                self.observer.axis_overlap(self.axis, least, other);
                self.overlaps.begin([least, other]);
            }
            (Side::Left, Side::Right) => {
                self.observer.axis_apart(self.axis, least, other);
                self.overlaps.cease([least, other]);
            }
            (Side::Left, Side::Left) | (Side::Right, Side::Right) => {}
        }
    }
}

/// Which pairs overlap on which swept axes.
#[derive(Clone, Debug, Default)]
struct Overlaps {
    /// How many axes are swept.
    axes: usize,
    /// The pairs that overlap on every swept axis, and whether the last report had them.
    flagged: PairMap<bool>,
    /// On how many swept axes a pair overlaps, if on any. Not needed for a single one.
    counts: PairMap<usize>,
    /// How many overlaps there are, summed over the swept axes.
    standing: u64,
    /// The pairs that turned from reported to not reported or back, since the last report.
    changed: Vec<[u32; 2]>,
}

impl Overlaps {
    /// A pair begins to overlap on an axis.
    fn begin(&mut self, pair: [u32; 2]) {
        self.standing += 1;
        if self.axes > 1 {
            let Some(count) = self.counts.get_mut(pair) else {
                return self.counts.insert(pair, 1);
            };
            *count += 1;
            if *count < self.axes {
                return;
            }
        }
        self.flagged.insert(pair, false);
    }

    /// A pair ceases to overlap on an axis.
    fn cease(&mut self, pair: [u32; 2]) {
        self.standing -= 1;
        if self.axes > 1
            && let Some(count) = self.counts.get_mut(pair)
        {
            *count -= 1;
            if *count == 0 {
                self.counts.remove(pair);
            }
        }
        if self.flagged.remove(pair) == Some(true) {
            self.changed.push(pair);
        }
    }

    fn bytes(&self) -> usize {
        let changed = self.changed.capacity() * size_of::<[u32; 2]>();
        self.flagged.bytes() + self.counts.bytes() + changed
    }
}
