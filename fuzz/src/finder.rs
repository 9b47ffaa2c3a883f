//! Searches of one set of boxes and of two, by every kernel and number of threads, stored, counted, streamed and
//! cancelled: the pairs of brute force, always in the same order.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};

use sweep_and_prune::{Aabb, Error, Kernel, PairFinder, Scalar, find_pairs, find_pairs_between};

use super::{Input, Space, in_any_dimension};

/// With more pairs, boxes are left out: brute force takes long, and more pairs would show nothing new.
const MOST_PAIRS: usize = 300_000;

pub(super) fn target(input: &mut Input) -> u64 {
    in_any_dimension!(input, search)
}

fn search<const D: usize, T: Scalar>(input: &mut Input) -> u64 {
    let crowd = input.pick(&[300, 10, 100, 5000]);
    let space = Space::draw::<D, T>(input, crowd);
    let has_two_sets = input.below(3) == 1;
    let odds = input.pick(&[2, 2, 5, 40, 250]);
    // Drawn now; only some of the searches below use them.
    let (stop, at, kind) = (input.below(256), input.below(256), input.below(12));
    let clusters = input.pick(&[1, 1, 2, 9]);
    let mut sets = [Vec::new(), Vec::new()];
    while input.next_operation() {
        let set = usize::from(has_two_sets && input.below(odds) == 0);
        let mut aabb = space.aabb::<D, T>(input);
        if clusters > 1 {
            // Groups far from each other, so that no plan suits all.
            let shift: T = space.length((input.below(clusters) * 1000) as f64);
            let shift = if shift < T::INFINITY { shift } else { T::default() };
            aabb.min = aabb.min.map(|at| at + shift);
            aabb.max = aabb.max.map(|at| at + shift);
        }
        sets[set].push(aabb);
    }
    if kind > 7 {
        // On a line such boxes are searched in another way.
        for set in &mut sets {
            set.sort_by(|a, b| a.min[0].order(b.min[0]));
        }
    }
    let [mut first, mut second] = sets;
    let mut expected = pairs(&first, &second, has_two_sets);
    while expected.len() > MOST_PAIRS {
        first.truncate(first.len() / 2);
        second.truncate(second.len() / 2);
        expected = pairs(&first, &second, has_two_sets);
    }
    input.say(|| format!("{D}D, {} bytes: {first:?} {second:?}", T::BYTES));
    let against = has_two_sets.then_some(&second[..]);
    let found = match against {
        None => find_pairs(&first).unwrap(),
        Some(second) => find_pairs_between(&first, second).unwrap(),
    };
    let mut sorted = found.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, expected, "the pairs of find_pairs or find_pairs_between");
    let calls = Cell::new(1);
    let all = Case { boxes: &first, against, found: &found, calls: &calls };
    // Smaller sets are searched by one thread in any case.
    #[cfg(feature = "parallel")]
    let uses_threads = first.len() + second.len() > 4000 || found.len() > 20_000;
    #[cfg_attr(not(feature = "parallel"), expect(unused_variables))]
    for (which, kernel) in Kernel::available().enumerate() {
        let mut finder = PairFinder::new().kernel(kernel);
        all.store(&mut finder);
        all.count(&mut finder);
        match kind {
            0 => all.stream(&mut finder, stop),
            1 => all.cancel(&mut finder, stop % 8),
            2 => all.refuse(&mut finder, at),
            3 => Case { boxes: &first[..first.len() / 2], ..all }.use_old_buffers(&mut finder),
            _ => {}
        }
        all.store(&mut finder);
        #[cfg(feature = "parallel")]
        if uses_threads && which == at % Kernel::available().count() {
            let mut finder = PairFinder::new().kernel(kernel).threads(2 + at % 2);
            all.store(&mut finder);
            all.count(&mut finder);
            all.cancel(&mut finder, stop % 8);
            all.refuse(&mut finder, at);
            all.store(&mut finder);
        }
    }
    calls.get()
}

/// The pairs by brute force, sorted.
fn pairs<const D: usize, T: Scalar>(
    first: &[Aabb<D, T>],
    second: &[Aabb<D, T>],
    has_two_sets: bool,
) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, a) in (0..).zip(first) {
        let (start, others) =
            if has_two_sets { (0, second) } else { (i + 1, &first[i as usize + 1..]) };
        pairs.extend((start..).zip(others).filter(|(_, b)| a.overlaps(b)).map(|(j, _)| [i, j]));
    }
    pairs
}

/// A search whose pairs are known.
#[derive(Clone, Copy)]
struct Case<'a, const D: usize, T: Scalar> {
    boxes: &'a [Aabb<D, T>],
    against: Option<&'a [Aabb<D, T>]>,
    found: &'a [[u32; 2]],
    calls: &'a Cell<u64>,
}

impl<const D: usize, T: Scalar> Case<'_, D, T> {
    fn search<'f, 'b>(
        &'b self,
        finder: &'f mut PairFinder<D, T>,
    ) -> sweep_and_prune::Search<'f, 'b, D, T> {
        self.calls.set(self.calls.get() + 1);
        let search = finder.search(self.boxes);
        match self.against {
            None => search,
            Some(others) => search.against(others),
        }
    }

    fn store(&self, finder: &mut PairFinder<D, T>) {
        assert!(self.search(finder).pairs().unwrap() == self.found, "pairs or their order");
    }

    fn count(&self, finder: &mut PairFinder<D, T>) {
        assert_eq!(self.search(finder).count().unwrap(), self.found.len() as u64);
        let mut counts = vec![0; self.boxes.len()];
        for &[first, second] in self.found {
            counts[first as usize] += 1;
            if self.against.is_none() {
                counts[second as usize] += 1;
            }
        }
        assert_eq!(self.search(finder).counts().unwrap(), counts);
    }

    /// Streams the pairs in chunks, and one by one until one in this many.
    fn stream(&self, finder: &mut PairFinder<D, T>, stop: usize) {
        let mut streamed = Vec::new();
        let each = |pairs: &[[u32; 2]]| {
            streamed.extend_from_slice(pairs);
            ControlFlow::<()>::Continue(())
        };
        assert_eq!(self.search(finder).for_each_chunk(each), Ok(ControlFlow::Continue(())));
        assert!(streamed == self.found, "streamed pairs or their order");
        streamed.clear();
        let end = self.search(finder).for_each(|pair| {
            streamed.push(pair);
            if streamed.len() > stop { ControlFlow::Break(pair) } else { ControlFlow::Continue(()) }
        });
        let end = match end.unwrap() {
            ControlFlow::Break(pair) => Some(pair),
            ControlFlow::Continue(()) => None,
        };
        assert_eq!(end, self.found.get(stop).copied());
        assert_eq!(streamed, self.found[..self.found.len().min(stop + 1)]);
    }

    /// Cancels a search after this many calls of its progress callback.
    fn cancel(&self, finder: &mut PairFinder<D, T>, most: usize) {
        let reports = AtomicUsize::new(0);
        let progress = |done: f64| {
            assert!((0.0..=1.0).contains(&done));
            let before = reports.fetch_add(1, Ordering::Relaxed);
            if before >= most { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let result = self.search(finder).progress(&progress).pairs();
        if reports.load(Ordering::Relaxed) > most {
            assert_eq!(result, Err(Error::Cancelled));
        } else {
            assert!(result == Ok(self.found), "pairs or their order, with a progress callback");
        }
    }

    /// A box that is not valid is named, whichever set it is in, and also beside an empty set.
    fn refuse(&self, finder: &mut PairFinder<D, T>, at: usize) {
        let mut sets = [self.boxes.to_vec(), self.against.unwrap_or_default().to_vec()];
        let (set, axis) = (usize::from(self.against.is_some() && at.is_multiple_of(2)), at % D);
        if sets[set].is_empty() {
            return;
        }
        let index = at % sets[set].len();
        let bad = if at.is_multiple_of(3) { T::INFINITY } else { T::from_f64(f64::NAN) };
        sets[set][index].min[axis] = bad;
        sets[set][index].max[axis] = T::NEG_INFINITY;
        let (min, max) = (bad.to_f64().into(), f64::NEG_INFINITY.into());
        let error = Error::InvalidBox { set, index, axis, min, max };
        let Self { found, calls, .. } = *self;
        let case =
            Case { boxes: &sets[0], against: self.against.map(|_| &sets[1][..]), found, calls };
        assert_eq!(case.search(finder).pairs(), Err(error));
        assert_eq!(case.search(finder).count(), Err(error));
        assert_eq!(case.search(finder).counts(), Err(error));
    }

    /// Searches a part of the boxes: a search of all boxes afterwards finds other buffers.
    fn use_old_buffers(&self, finder: &mut PairFinder<D, T>) {
        let most = self.boxes.len() as u32;
        let mut found = self.search(finder).pairs().unwrap().to_vec();
        found.sort_unstable();
        let mut expected = self.found.to_vec();
        expected.retain(|pair| pair[0] < most && (self.against.is_some() || pair[1] < most));
        expected.sort_unstable();
        assert_eq!(found, expected, "the pairs of fewer boxes");
    }
}
