//! The sorts, over endpoints in their total order, observable.

use alloc::vec;
use alloc::vec::Vec;

use super::endpoint::Endpoint;
use super::observer::Observer;
use crate::Scalar;

/// How to sort endpoints. All sorts give the same array, because the order is total.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Sort {
    /// The standard library's unstable sort, O(n log n). It hides its moves: the observer
    /// sees its comparisons, and afterwards the fewest swaps that have the same effect.
    #[default]
    Standard,
    /// Quicksort (Hoare 1961) with the median of three as the pivot. O(n log n) on most inputs, but
    /// O(n²) at worst: some orders defeat the pivot. O(log n) memory.
    Quicksort,
    /// Insertion sort: O(n + s) for s inversions. That is O(n) if hardly anything has moved, and
    /// n(n-1)/2 swaps if the order is reversed. It makes exactly one swap for each inversion.
    Insertion,
    /// Merge sort, top down: O(n log n) always, and O(n) memory. The observer sees the comparisons of
    /// each merge, and afterwards the fewest swaps that have the same effect.
    Merge,
    /// Timsort (Peters 2002) without galloping: a merge sort that starts from the sorted runs that
    /// the array already has. Insertion sort extends short runs. O(n + n log r) for r runs: O(n) if
    /// the array is sorted or reversed, O(n log n) at worst. O(n) memory.
    Timsort,
}

impl Sort {
    /// Every sort.
    pub const ALL: [Sort; 5] =
        [Sort::Standard, Sort::Quicksort, Sort::Insertion, Sort::Merge, Sort::Timsort];

    /// The name that a person reads.
    pub const fn name(self) -> &'static str {
        match self {
            Sort::Standard => "standard library",
            Sort::Quicksort => "quicksort",
            Sort::Insertion => "insertion sort",
            Sort::Merge => "merge sort",
            Sort::Timsort => "Timsort",
        }
    }

    /// The sort of this [`name`](Self::name).
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|sort| sort.name() == name)
    }

    /// Sorts `endpoints[from..]` in place. Reported positions are those of the whole array.
    pub(super) fn sort_tail<T: Scalar, O: Observer>(
        self,
        endpoints: &mut [Endpoint<T>],
        from: usize,
        observer: &mut O,
    ) {
        let tail = &mut endpoints[from..];
        match self {
            Sort::Standard => standard(tail, from, observer),
            Sort::Quicksort => quicksort(tail, from, observer),
            Sort::Insertion => insertion(tail, 1, from, observer),
            Sort::Merge => merge_sort(tail, from, observer),
            Sort::Timsort => timsort(tail, from, observer),
        }
    }

    /// Sorts endpoints in place.
    pub(super) fn sort<T: Scalar, O: Observer>(
        self,
        endpoints: &mut [Endpoint<T>],
        observer: &mut O,
    ) {
        self.sort_tail(endpoints, 0, observer);
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

/// The article's loop: carries each endpoint left, swap by swap, to its place. The first
/// `sorted >= 1` endpoints are already in order.
fn insertion<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    sorted: usize,
    offset: usize,
    observer: &mut O,
) {
    for i in sorted..endpoints.len() {
        for j in (0..i).rev() {
            if !precedes(&endpoints[j + 1], &endpoints[j], observer) {
                break;
            }
            swap(endpoints, offset, j, j + 1, observer);
        }
    }
}

/// Quicksort leaves parts of at most this many endpoints to insertion sort. Timsort's runs are at
/// least this long.
const SMALL: usize = 8;

/// Partitions around the median of the first, the middle and the last. It recurses into the smaller
/// part and loops over the larger, so that the stack stays O(log n) deep.
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
    insertion(endpoints, 1, offset, observer);
}

/// Hoare's partition. Returns `middle` with `0 < middle < len`: everything in `..middle` precedes
/// everything in `middle..`.
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

/// Sorts each half, then merges them.
fn merge_sort<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    observer: &mut O,
) {
    let middle = endpoints.len() / 2;
    if middle == 0 {
        return;
    }
    merge_sort(&mut endpoints[..middle], offset, observer);
    merge_sort(&mut endpoints[middle..], offset + middle, observer);
    merge(endpoints, middle, offset, observer);
}

/// Merges `endpoints[..middle]` and `endpoints[middle..]`, each in order, into one.
pub(super) fn merge<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    middle: usize,
    offset: usize,
    observer: &mut O,
) {
    let before: Vec<_> = if O::ACTIVE { endpoints.to_vec() } else { Vec::new() };
    let mut target = vec![0; before.len()];
    let left = endpoints[..middle].to_vec();
    let (mut i, mut j) = (0, middle);
    for place in 0..endpoints.len() {
        let from_right =
            i == left.len() || j < endpoints.len() && precedes(&endpoints[j], &left[i], observer);
        let source = if from_right { &mut j } else { &mut i };
        endpoints[place] = if from_right { endpoints[*source] } else { left[*source] };
        if O::ACTIVE {
            target[*source] = place;
        }
        *source += 1;
    }
    report_swaps(before, target, offset, observer);
}

/// Splits the array into the sorted runs that it has, and merges neighbors so that their lengths stay
/// balanced.
fn timsort<T: Scalar, O: Observer>(endpoints: &mut [Endpoint<T>], offset: usize, observer: &mut O) {
    // The lengths of the sorted runs that `endpoints[..end]` consists of.
    let mut runs: Vec<usize> = Vec::new();
    let mut end = 0;
    while end < endpoints.len() {
        let rest = &mut endpoints[end..];
        let natural = natural_run(rest, offset + end, observer);
        let run = natural.max(SMALL).min(rest.len());
        insertion(&mut rest[..run], natural, offset + end, observer);
        runs.push(run);
        end += run;
        while let Some(k) = unbalanced(&runs) {
            merge_runs(endpoints, &mut runs, k, end, offset, observer);
        }
    }
    while runs.len() > 1 {
        let k = runs.len() - 2;
        merge_runs(endpoints, &mut runs, k, end, offset, observer);
    }
}

/// The length of the run at the start of the slice. A descending run is reversed.
fn natural_run<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    observer: &mut O,
) -> usize {
    let n = endpoints.len();
    if n < 2 {
        return n;
    }
    let down = precedes(&endpoints[1], &endpoints[0], observer);
    let mut run = 2;
    while run < n && precedes(&endpoints[run], &endpoints[run - 1], observer) == down {
        run += 1;
    }
    if down {
        for i in 0..run / 2 {
            swap(endpoints, offset, i, run - 1 - i, observer);
        }
    }
    run
}

/// The run to merge with the next one, until each run is longer than the next two together.
fn unbalanced(runs: &[usize]) -> Option<usize> {
    let short = |k: usize| runs[k] <= runs[k + 1] + runs.get(k + 2).copied().unwrap_or(0);
    let last = runs.len().checked_sub(2)?;
    if last >= 1 && short(last - 1) || last >= 2 && short(last - 2) {
        Some(if runs[last - 1] < runs[last + 1] { last - 1 } else { last })
    } else {
        (runs[last] <= runs[last + 1]).then_some(last)
    }
}

/// Merges run `k` with the one after it; the last run ends at `end`.
fn merge_runs<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    runs: &mut Vec<usize>,
    k: usize,
    end: usize,
    offset: usize,
    observer: &mut O,
) {
    let start = end - runs[k..].iter().sum::<usize>();
    let both = start..start + runs[k] + runs[k + 1];
    merge(&mut endpoints[both], runs[k], offset + start, observer);
    runs[k] += runs.remove(k + 1);
}

fn standard<T: Scalar, O: Observer>(
    endpoints: &mut [Endpoint<T>],
    offset: usize,
    observer: &mut O,
) {
    let before: Vec<_> = if O::ACTIVE { endpoints.to_vec() } else { Vec::new() };
    endpoints.sort_unstable_by(|a, b| {
        observer.compare(a.edge, b.edge);
        a.order(b)
    });
    // Where each endpoint belongs, found by its place in the order.
    let mut by_order: Vec<usize> = (0..before.len()).collect();
    by_order.sort_unstable_by(|&i, &j| before[i].order(&before[j]));
    let mut target = vec![0; before.len()];
    for (place, &i) in by_order.iter().enumerate() {
        target[i] = place;
    }
    report_swaps(before, target, offset, observer);
}

/// Reports the fewest swaps that bring each `array[i]` to `target[i]`: one cycle of the permutation
/// after another.
fn report_swaps<T: Scalar, O: Observer>(
    mut array: Vec<Endpoint<T>>,
    mut target: Vec<usize>,
    offset: usize,
    observer: &mut O,
) {
    for i in 0..array.len() {
        while target[i] != i {
            let j = target[i];
            swap(&mut array, offset, i, j, observer);
            target.swap(i, j);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algorithms::{Counts, Edge};
    use proptest::prelude::*;

    /// Repeats the reported swaps on a copy of the array.
    struct Mirror(Vec<Edge>);

    impl Observer for Mirror {
        fn swap(&mut self, [i, j]: [usize; 2], a: Edge, b: Edge) {
            assert_eq!(
                [self.0[i], self.0[j]],
                [a, b],
                "the reported endpoints are at the reported positions"
            );
            self.0.swap(i, j);
        }
    }

    fn endpoints(coordinates: &[i8]) -> Vec<Endpoint<f32>> {
        coordinates
            .iter()
            .enumerate()
            .map(|(i, &at)| match i % 3 {
                0 => Endpoint::right(f32::from(at), i as u32),
                _ => Endpoint::left(f32::from(at), i as u32),
            })
            .collect()
    }

    fn inversions(endpoints: &[Endpoint<f32>]) -> u64 {
        let n = endpoints.len();
        (0..n)
            .map(|i| (i..n).filter(|&j| endpoints[j].precedes(&endpoints[i])).count() as u64)
            .sum()
    }

    proptest! {
        #[test]
        fn every_sort_gives_the_same_order_and_reports_its_swaps(
            coordinates in proptest::collection::vec(-3i8..4, 0..200),
            from in 0usize..20,
        ) {
            let array = endpoints(&coordinates);
            let from = from.min(array.len());
            let mut expected = array.clone();
            expected[from..].sort_by(|a, b| a.order(b));
            for sort in Sort::ALL {
                let mut sorted = array.clone();
                let mut mirror = Mirror(array.iter().map(|e| e.edge).collect());
                sort.sort_tail(&mut sorted, from, &mut mirror);
                prop_assert_eq!(&sorted, &expected, "{}", sort.name());
                let reported: Vec<Edge> = expected.iter().map(|e| e.edge).collect();
                prop_assert_eq!(mirror.0, reported, "{}", sort.name());
                let mut unobserved = array.clone();
                sort.sort_tail(&mut unobserved, from, &mut ());
                prop_assert_eq!(&unobserved, &expected, "{}", sort.name());
            }
        }

        #[test]
        fn insertion_sort_swaps_once_for_each_inversion(
            coordinates in proptest::collection::vec(-3i8..4, 0..60),
        ) {
            let mut array = endpoints(&coordinates);
            let expected = inversions(&array);
            let mut counts = Counts::default();
            Sort::Insertion.sort(&mut array, &mut counts);
            prop_assert_eq!(counts.swaps, expected);
        }
    }

    #[test]
    fn timsort_takes_a_sorted_and_a_reversed_array_in_one_pass() {
        let up: Vec<_> = (0..1000).map(|i| Endpoint::left(i as f32, i)).collect();
        let down: Vec<_> = up.iter().rev().copied().collect();
        for mut array in [up, down] {
            let mut counts = Counts::default();
            Sort::Timsort.sort(&mut array, &mut counts);
            assert_eq!(counts.comparisons, 999);
        }
    }
}
