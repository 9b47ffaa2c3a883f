//! The sorts, over endpoints in their total order, observable.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use crate::endpoint::Endpoint;
use crate::observer::Observer;
use sweep_and_prune::Scalar;

/// How to sort endpoints. All sorts give the same array, because the order is total.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
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

    /// Sorts `endpoints[from..]` in place. Reports positions in `endpoints`, not in that part of it.
    pub(crate) fn sort_tail<T: Scalar, O: Observer>(
        self,
        endpoints: &mut [Endpoint<T>],
        from: usize,
        observer: &mut O,
    ) {
        let tail = from..endpoints.len();
        let mut array = Array { endpoints, observer };
        match self {
            Sort::Standard => array.standard(tail),
            Sort::Quicksort => array.quicksort(tail),
            Sort::Insertion => array.insertion(tail, 1),
            Sort::Merge => array.merge_sort(tail),
            Sort::Timsort => array.timsort(tail),
        }
    }

    /// Sorts endpoints in place.
    pub(crate) fn sort<T: Scalar, O: Observer>(
        self,
        endpoints: &mut [Endpoint<T>],
        observer: &mut O,
    ) {
        self.sort_tail(endpoints, 0, observer);
    }
}

/// Quicksort leaves parts of at most this many endpoints to insertion sort. Timsort's runs are at
/// least this long.
const SMALL: usize = 8;

/// An array of endpoints whose sort is observed.
pub(crate) struct Array<'a, T, O> {
    pub endpoints: &'a mut [Endpoint<T>],
    pub observer: &'a mut O,
}

impl<T: Scalar, O: Observer> Array<'_, T, O> {
    /// One observed comparison: whether `a` stands before `b`.
    #[inline]
    fn precedes(&mut self, a: Endpoint<T>, b: Endpoint<T>) -> bool {
        self.observer.compare(a.edge, b.edge);
        a.precedes(&b)
    }

    /// One observed swap.
    #[inline]
    fn swap(&mut self, i: usize, j: usize) {
        self.observer.swap([i, j], self.endpoints[i].edge, self.endpoints[j].edge);
        self.endpoints.swap(i, j);
    }

    /// The article's loop: carries each endpoint left, swap by swap, to its place. The first
    /// `sorted >= 1` endpoints of the range are already in order.
    fn insertion(&mut self, Range { start, end }: Range<usize>, sorted: usize) {
        for i in start + sorted..end {
            for j in (start..i).rev() {
                if !self.precedes(self.endpoints[j + 1], self.endpoints[j]) {
                    break;
                }
                self.swap(j, j + 1);
            }
        }
    }

    /// Partitions around the median of the first, the middle and the last. It recurses into the smaller
    /// part and loops over the larger, so that the stack stays O(log n) deep.
    fn quicksort(&mut self, mut range: Range<usize>) {
        while range.len() > SMALL {
            let middle = self.partition(range.clone());
            let (left, right) = (range.start..middle, middle..range.end);
            let (smaller, larger) =
                if left.len() < right.len() { (left, right) } else { (right, left) };
            self.quicksort(smaller);
            range = larger;
        }
        self.insertion(range, 1);
    }

    /// Hoare's partition. Returns `middle` with `start < middle < end`: everything before `middle`
    /// precedes everything from it on.
    fn partition(&mut self, Range { start, end }: Range<usize>) -> usize {
        let last = end - 1;
        let middle = start + (last - start) / 2;
        // Sort the three, so that the median is in the middle and the ends are sentinels.
        for (i, j) in [(start, middle), (middle, last), (start, middle)] {
            if self.precedes(self.endpoints[j], self.endpoints[i]) {
                self.swap(i, j);
            }
        }
        let pivot = self.endpoints[middle];
        let (mut i, mut j) = (start, last);
        loop {
            i += 1;
            while self.precedes(self.endpoints[i], pivot) {
                i += 1;
            }
            j -= 1;
            while self.precedes(pivot, self.endpoints[j]) {
                j -= 1;
            }
            if i >= j {
                return i;
            }
            self.swap(i, j);
        }
    }

    /// Sorts each half, then merges them.
    fn merge_sort(&mut self, Range { start, end }: Range<usize>) {
        let middle = start + (end - start) / 2;
        if middle > start {
            self.merge_sort(start..middle);
            self.merge_sort(middle..end);
            self.merge(start..end, middle);
        }
    }

    /// Merges the endpoints of a range before `middle` and those from it on, each in order, into one.
    pub fn merge(&mut self, Range { start, end }: Range<usize>, middle: usize) {
        let left = self.endpoints[start..middle].to_vec();
        let before: Vec<_> =
            if O::ACTIVE { self.endpoints[start..end].to_vec() } else { Vec::new() };
        let mut target = vec![0; before.len()];
        let (mut i, mut j) = (0, middle);
        for place in start..end {
            let from_right =
                i == left.len() || j < end && self.precedes(self.endpoints[j], left[i]);
            let source = if from_right { j } else { start + i };
            self.endpoints[place] = if from_right { self.endpoints[j] } else { left[i] };
            if O::ACTIVE {
                target[source - start] = place - start;
            }
            if from_right { j += 1 } else { i += 1 }
        }
        self.report_swaps(before, target, start);
    }

    /// Splits the range into the sorted runs that it has, and merges neighbors so that their lengths
    /// stay balanced.
    fn timsort(&mut self, Range { start, end }: Range<usize>) {
        // The lengths of the sorted runs from `start` on.
        let mut runs: Vec<usize> = Vec::new();
        let mut sorted = start;
        while sorted < end {
            let natural = self.natural_run(sorted..end);
            let run = natural.max(SMALL).min(end - sorted);
            self.insertion(sorted..sorted + run, natural);
            runs.push(run);
            sorted += run;
            while let Some(k) = unbalanced(&runs) {
                self.merge_runs(&mut runs, k, sorted);
            }
        }
        while runs.len() > 1 {
            let k = runs.len() - 2;
            self.merge_runs(&mut runs, k, sorted);
        }
    }

    /// The length of the run at the start of the range. A descending run is reversed.
    fn natural_run(&mut self, Range { start, end }: Range<usize>) -> usize {
        if end - start < 2 {
            return end - start;
        }
        let down = self.precedes(self.endpoints[start + 1], self.endpoints[start]);
        let mut run = start + 2;
        while run < end && self.precedes(self.endpoints[run], self.endpoints[run - 1]) == down {
            run += 1;
        }
        let run = run - start;
        if down {
            for i in 0..run / 2 {
                self.swap(start + i, start + run - 1 - i);
            }
        }
        run
    }

    /// Merges run `k` with the one after it; the last run ends at `end`.
    fn merge_runs(&mut self, runs: &mut Vec<usize>, k: usize, end: usize) {
        let start = end - runs[k..].iter().sum::<usize>();
        self.merge(start..start + runs[k] + runs[k + 1], start + runs[k]);
        runs[k] += runs.remove(k + 1);
    }

    fn standard(&mut self, range: Range<usize>) {
        let start = range.start;
        let endpoints = &mut self.endpoints[range];
        let before: Vec<_> = if O::ACTIVE { endpoints.to_vec() } else { Vec::new() };
        endpoints.sort_unstable_by(|a, b| {
            self.observer.compare(a.edge, b.edge);
            a.order(b)
        });
        // Where each endpoint belongs, found by its place in the order.
        let mut by_order: Vec<usize> = (0..before.len()).collect();
        by_order.sort_unstable_by(|&i, &j| before[i].order(&before[j]));
        let mut target = vec![0; before.len()];
        for (place, &i) in by_order.iter().enumerate() {
            target[i] = place;
        }
        self.report_swaps(before, target, start);
    }

    /// Reports the fewest swaps that bring each `before[i]`, which stood at `start + i`, to
    /// `start + target[i]`: one cycle of the permutation after another.
    fn report_swaps(&mut self, mut before: Vec<Endpoint<T>>, mut target: Vec<usize>, start: usize) {
        for i in 0..before.len() {
            while target[i] != i {
                let j = target[i];
                self.observer.swap([start + i, start + j], before[i].edge, before[j].edge);
                before.swap(i, j);
                target.swap(i, j);
            }
        }
    }
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
