//! The sorts, over endpoints in their total order, observable.

use alloc::vec;
use alloc::vec::Vec;
use core::cmp::Ordering;

use super::endpoint::Endpoint;
use super::observer::Observer;
use crate::Scalar;

/// How to sort endpoints. All give the same array: the order is total.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sort {
    /// The standard library's unstable sort, O(n log n). It does not show its moves: the observer
    /// sees its comparisons, and afterwards the fewest swaps that have the same effect.
    #[default]
    Standard,
    /// Quicksort (Hoare 1961) on the middle one of three: O(n log n) expected, O(n²) at worst,
    /// O(log n) memory.
    Quicksort,
    /// Insertion sort: O(n + s) for s inversions, so O(n) when hardly anything has moved and
    /// n(n-1)/2 swaps on a full reversal. Its swaps are exactly the inversions.
    Insertion,
}

impl Sort {
    /// Every sort.
    pub const ALL: [Sort; 3] = [Sort::Standard, Sort::Quicksort, Sort::Insertion];

    /// The name that a person reads.
    pub const fn name(self) -> &'static str {
        match self {
            Sort::Standard => "standard library",
            Sort::Quicksort => "quicksort",
            Sort::Insertion => "insertion sort",
        }
    }

    /// Sorts endpoints in place.
    pub fn sort<T: Scalar, O: Observer>(self, endpoints: &mut [Endpoint<T>], observer: &mut O) {
        match self {
            Sort::Standard => standard(endpoints, observer),
            Sort::Quicksort => quicksort(endpoints, 0, observer),
            Sort::Insertion => insertion(endpoints, 0, observer),
        }
    }
}

/// One observed comparison: whether `a` stands before `b`.
#[inline]
fn precedes<T: Scalar, O: Observer>(a: &Endpoint<T>, b: &Endpoint<T>, observer: &mut O) -> bool {
    observer.compare(a.edge, b.edge);
    a.precedes(b)
}

/// One observed swap of two positions of a slice that begins at `offset` of the whole array.
#[inline]
fn swap<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    i: usize,
    j: usize,
    observer: &mut O,
) {
    observer.swap([offset + i, offset + j], endpoints[i].edge, endpoints[j].edge);
    endpoints.swap(i, j);
}

/// The article's loop: carry each endpoint left, swap by swap, to where it belongs.
fn insertion<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    observer: &mut O,
) {
    for i in 1..endpoints.len() {
        for j in (0..i).rev() {
            if !precedes(&endpoints[j + 1], &endpoints[j], observer) {
                break;
            }
            swap(endpoints, offset, j, j + 1, observer);
        }
    }
}

/// Below this many endpoints quicksort leaves the rest to insertion sort.
const SMALL: usize = 8;

/// Partition about the median of first, middle and last; recurse into the smaller part and go on
/// with the larger, so that the stack stays O(log n) deep.
fn quicksort<T: Scalar, O: Observer>(
    mut endpoints: &mut [Endpoint<T>],
    mut offset: usize,
    observer: &mut O,
) {
    while endpoints.len() > SMALL {
        let middle = partition(endpoints, offset, observer);
        let (left, right) = endpoints.split_at_mut(middle);
        if left.len() < right.len() {
            quicksort(left, offset, observer);
            (endpoints, offset) = (right, offset + middle);
        } else {
            quicksort(right, offset + middle, observer);
            endpoints = left;
        }
    }
    insertion(endpoints, offset, observer);
}

/// Hoare's partition. Returns `middle` with `0 < middle < len`: nothing in `..middle` stands
/// after anything in `middle..`.
fn partition<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    observer: &mut O,
) -> usize {
    let last = endpoints.len() - 1;
    // Sort the three, so that the median is in the middle and the ends are sentinels.
    for (i, j) in [(0, last / 2), (last / 2, last), (0, last / 2)] {
        if precedes(&endpoints[j], &endpoints[i], observer) {
            swap(endpoints, offset, i, j, observer);
        }
    }
    let pivot = endpoints[last / 2];
    let (mut i, mut j) = (0, last);
    loop {
        i += 1;
        while precedes(&endpoints[i], &pivot, observer) {
            i += 1;
        }
        j -= 1;
        while precedes(&pivot, &endpoints[j], observer) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        swap(endpoints, offset, i, j, observer);
    }
}

fn standard<T: Scalar, O: Observer>(endpoints: &mut [Endpoint<T>], observer: &mut O) {
    let before: Vec<_> = if O::ACTIVE { endpoints.to_vec() } else { Vec::new() };
    endpoints.sort_unstable_by(|a, b| {
        observer.compare(a.edge, b.edge);
        a.order(b)
    });
    if O::ACTIVE {
        tell_swaps(before, endpoints, observer);
    }
}

/// Tells the observer the fewest swaps that turn `array` into `sorted`: one cycle of the
/// permutation after another.
fn tell_swaps<T: Scalar, O: Observer>(
    mut array: Vec<Endpoint<T>>,
    sorted: &[Endpoint<T>],
    observer: &mut O,
) {
    // Where each endpoint belongs, found by its place in the order.
    let mut by_order: Vec<usize> = (0..array.len()).collect();
    by_order.sort_unstable_by(|&i, &j| array[i].order(&array[j]));
    let mut target = vec![0; array.len()];
    for (place, &i) in by_order.iter().enumerate() {
        target[i] = place;
    }
    debug_assert!(by_order.iter().zip(sorted).all(|(&i, s)| array[i].order(s) == Ordering::Equal));
    for i in 0..array.len() {
        while target[i] != i {
            let j = target[i];
            swap(&mut array, 0, i, j, observer);
            target.swap(i, j);
        }
    }
}
