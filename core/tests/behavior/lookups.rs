//! Boxes on a line: of two sets, boxes of the larger one look up the smaller one; sorted boxes are read in order; counts are
//! differences of ranks. The pairs of brute force.

use std::ops::ControlFlow;
use std::sync::Mutex;

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Error, InParts, PairFinder, Scalar};
use sweep_and_prune_scenes::testing::valid_box;

fn pairwise<T: Scalar>(a: &[Aabb<1, T>], b: &[Aabb<1, T>]) -> Vec<[u32; 2]> {
    let partners = |i: usize| {
        let all = (0..b.len()).filter(move |&j| a[i].overlaps(&b[j]));
        all.map(move |j| [i as u32, j as u32])
    };
    (0..a.len()).flat_map(partners).collect()
}

/// The boxes by left edge.
fn in_order<T: Scalar>(boxes: &[Aabb<1, T>]) -> Vec<Aabb<1, T>> {
    let mut boxes = boxes.to_vec();
    boxes.sort_by(|a, b| a.min[0].order(b.min[0]));
    boxes
}

/// The pairs within each set and between both, as they come and in order.
fn check<T: Scalar>(a: &[Aabb<1, T>], b: &[Aabb<1, T>]) {
    let sorted = [in_order(a), in_order(b)];
    for set in [a, b, &sorted[0], &sorted[1]] {
        let within = pairwise(set, set).into_iter().filter(|[a, b]| a < b);
        let within: Vec<_> = within.collect();
        let mut finder = PairFinder::new();
        assert_eq!(finder.search(set).count(), Ok(within.len() as u64));
        let both = within.iter().flatten();
        assert_eq!(finder.search(set).counts(), Ok(counted(both, set.len())));
        let mut found = finder.find(set).unwrap().to_vec();
        found.sort_unstable();
        assert!(found == within);
    }
    check_between(a, b);
    check_between(&sorted[0], &sorted[1]);
    check_between(&sorted[0], b);
}

/// How often each index comes.
fn counted<'a>(indices: impl Iterator<Item = &'a u32>, len: usize) -> Vec<u32> {
    let mut counts = vec![0; len];
    indices.for_each(|&index| counts[index as usize] += 1);
    counts
}

/// The pairs between two sets, received in chunks.
fn streamed<T: Scalar>(
    finder: &mut PairFinder<1, T>,
    a: &[Aabb<1, T>],
    b: &[Aabb<1, T>],
) -> Vec<[u32; 2]> {
    let mut streamed = Vec::new();
    let take = |pairs: &[[u32; 2]]| {
        streamed.extend_from_slice(pairs);
        ControlFlow::<()>::Continue(())
    };
    assert!(finder.search(a).against(b).for_each_chunk(take).unwrap().is_continue());
    streamed
}

/// All ways to receive the pairs between two sets, with either one first.
fn check_between<T: Scalar>(a: &[Aabb<1, T>], b: &[Aabb<1, T>]) {
    for (a, b) in [(a, b), (b, a)] {
        let mut finder = PairFinder::new();
        let found = finder.find_between(a, b).unwrap().to_vec();
        let mut sorted = found.clone();
        sorted.sort_unstable();
        assert!(sorted == pairwise(a, b), "{} {}", a.len(), b.len());
        assert_eq!(finder.search(a).against(b).count(), Ok(found.len() as u64));
        let firsts = found.iter().map(|[first, _]| first);
        assert_eq!(finder.search(a).against(b).counts(), Ok(counted(firsts, a.len())));
        assert!(streamed(&mut finder, a, b) == found);
        #[cfg(feature = "parallel")]
        assert!(PairFinder::new().threads(3).find_between(a, b).unwrap() == found);
        check_in_parts(a, b);
    }
}

/// The pairs between two sets of which the larger one comes in parts; none if they cannot be found so. They must be those of
/// one search, in its order.
fn check_in_parts<T: Scalar>(a: &[Aabb<1, T>], b: &[Aabb<1, T>]) -> Option<Vec<[u32; 2]>> {
    let is_first = a.len() > b.len();
    let (smaller, larger) = if is_first { (b, a) } else { (a, b) };
    let parts = InParts { boxes: larger.len(), is_first };
    let sample: Vec<_> = parts.sample().map(|at| larger[at]).collect();
    let mut finder = PairFinder::new();
    let at_a_time = finder.prepare_parts(smaller, parts, &sample).unwrap()?;
    let mut found = Vec::new();
    for (number, part) in larger.chunks(at_a_time).enumerate() {
        let go_on = |_| ControlFlow::Continue(());
        let mut take = |pairs: &[[u32; 2]]| {
            found.extend_from_slice(pairs);
            ControlFlow::Continue(())
        };
        let first = number * at_a_time;
        let end = finder.for_each_chunk_of_part(parts, part, first, &go_on, &mut take);
        assert_eq!(end, Ok(Some(ControlFlow::Continue(()))));
    }
    assert!(found == PairFinder::new().find_between(a, b).unwrap());
    Some(found)
}

/// Numbers from 0 to 1, always the same.
fn random() -> impl FnMut() -> f64 {
    let mut state = 1u64;
    move || {
        state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Intervals of about this length, anywhere from 0 to 1.
fn intervals(count: usize, length: f64, mut random: impl FnMut() -> f64) -> Vec<Aabb<1, f64>> {
    let interval = |_| {
        let start = random();
        Aabb::new([start], [start + length * random()])
    };
    (0..count).map(interval).collect()
}

/// Short intervals between whole numbers: many touch, begin together or have no length, and few of each set overlap.
fn whole_intervals() -> impl Strategy<Value = Vec<Aabb<1, f32>>> {
    let interval = (-500i16..500, 0i16..4);
    let aabb = |(start, length)| Aabb::new([f32::from(start)], [f32::from(start + length)]);
    prop::collection::vec(interval.prop_map(aabb), 129..400)
}

proptest! {
    #[test]
    fn ties_and_infinities_are_found(
        a in prop::collection::vec(valid_box::<1, f64>(), 33..200),
        b in prop::collection::vec(valid_box::<1, f64>(), 129..400),
    ) {
        check(&a, &b);
    }

    #[test]
    fn touching_intervals_are_found(a in whole_intervals(), b in whole_intervals()) {
        check(&a, &b);
    }
}

/// From none for most to all for one, and enough that buffers are handed on while one looks them up.
#[test]
fn intervals_of_all_lengths_are_found() {
    let mut random = random();
    for length in [0.0, 0.001, 0.01, 0.1, 1.0] {
        let few = intervals(500, 0.002, &mut random);
        let many = intervals(1500, length, &mut random);
        check(&few, &many);
        check(&intervals(500, length, &mut random), &many);
    }
    let mut many = intervals(129, 0.001, &mut random);
    many.push(Aabb::new([f64::NEG_INFINITY], [f64::INFINITY]));
    check(&intervals(10_000, 0.0001, &mut random), &many);
    many.extend(intervals(12_000, 0.0001, &mut random));
    check(&intervals(10_000, 0.0001, &mut random), &many);
}

/// Far edges, edges that are equal, and clusters: some cells have nearly all edges.
#[test]
fn edges_anywhere_are_counted() {
    let mut random = random();
    let far = [1e3, 1e30, f64::MAX, f64::INFINITY];
    for count in [0, 1, 2, 3, 40] {
        for far in far {
            let mut many = intervals(2000, 0.001, &mut random);
            many.extend((0..count).map(|at| Aabb::new([far - f64::from(at)], [far])));
            many.extend((0..count).map(|_| Aabb::new([-far], [-far / 2.0])));
            check(&many, &intervals(700, 0.001, &mut random));
        }
    }
    let clusters = (0..900).map(|at| Aabb::new([f64::from(at % 3)], [f64::from(at % 5)]));
    let clusters: Vec<_> = clusters.filter(Aabb::is_valid).collect();
    check(&clusters, &intervals(500, 0.1, &mut random));
    check(&[Aabb::new([1.0], [1.0]); 300], &[Aabb::new([-0.0], [1.0]); 200]);
    check(&[Aabb::new([-0.0], [0.0]); 300], &[Aabb::new([0.0], [-0.0]); 200]);
}

/// From 0.0 to -0.0 there is no way, but its length has a sign.
#[test]
fn zeros_of_both_signs_are_found() {
    let mut random = random();
    let point = |at: f64| Aabb::new([at], [at]);
    let mut end = || (4.0 * random() - 2.0).round();
    let around = (0..900).map(|_| [end(), end()]).map(|[a, b]| Aabb::new([a.min(b)], [a.max(b)]));
    let around: Vec<_> = around.collect();
    check(&[Aabb::new([0.0], [-0.0]); 300], &around);
    for far in [-1.0, -1e9, f64::NEG_INFINITY] {
        let zeros = (0..12).map(|at| point(if at < 6 { 0.0 } else { -0.0 }));
        let zeros: Vec<_> = [point(far), point(1.0)].into_iter().chain(zeros).collect();
        check(&zeros, &around);
        check(&zeros, &[point(far)]);
    }
}

/// More than fit a cache: boxes of the larger set are put in order a chunk at a time, and there are two chunks.
#[test]
fn millions_are_found() {
    let mut random = random();
    let apart = [intervals(270_000, 3e-6, &mut random), intervals(1_200_000, 1e-6, &mut random)];
    // Many coincide, and half of the larger set is at one place.
    let point = |at: f64| Aabb::new([at], [at]);
    let mut somewhere = || (1e5 * random()).floor() * random().round();
    let ties = [
        (0..270_000).map(|at| point(f64::from(at))).collect(),
        (0..1_200_000).map(|_| point(somewhere())).collect(),
    ];
    for [few, many] in [&apart, &ties] {
        for (a, b) in [(few, many), (many, few)] {
            let mut finder = PairFinder::new();
            let shares = Mutex::new(Vec::new());
            let report = |share: f64| {
                shares.lock().unwrap().push(share);
                ControlFlow::Continue(())
            };
            let found = finder.search(a).against(b).progress(&report).pairs().unwrap().to_vec();
            let shares = shares.into_inner().unwrap();
            assert!(shares.is_sorted() && shares.len() > 100 && shares.last() >= Some(&0.99));
            assert!(found.len() > 300_000);
            assert!(found.iter().all(|&[i, j]| a[i as usize].overlaps(&b[j as usize])));
            let mut sorted = found.clone();
            sorted.sort_unstable();
            assert!(sorted.windows(2).all(|pairs| pairs[0] != pairs[1]));
            // Counts come from ranks.
            let firsts = found.iter().map(|[first, _]| first);
            assert!(finder.search(a).against(b).counts() == Ok(counted(firsts, a.len())));
            assert!(streamed(&mut finder, a, b) == found);
            #[cfg(feature = "parallel")]
            assert!(PairFinder::new().threads(3).find_between(a, b).unwrap() == found);
            assert!(check_in_parts(a, b).is_some());
        }
    }
}

/// Two parts, of which one is short; sets that are searched in another way; a part that is invalid.
#[test]
fn a_larger_set_may_come_in_parts() {
    let mut random = random();
    let (few, many) = (intervals(5000, 1e-4, &mut random), intervals(40_000, 1e-4, &mut random));
    assert!(check_in_parts(&few, &many).is_some() && check_in_parts(&many, &few).is_some());
    let sorted = [in_order(&few), in_order(&many)];
    assert!(check_in_parts(&sorted[0], &many).is_some());
    assert!(check_in_parts(&few, &sorted[1]).is_some());
    assert!(check_in_parts(&sorted[0], &sorted[1]).is_none());
    assert!(check_in_parts(&few[..20], &many).is_none());
    assert!(check_in_parts(&few, &few).is_none());
    let crowded = intervals(5000, 1.0, &mut random);
    assert!(check_in_parts(&crowded, &many).is_none());
    let mut long = few.clone();
    long[7] = Aabb::new([0.0], [2.0]);
    // The long one has a table of its own, which all of the larger set looks up after the other.
    assert!(check_in_parts(&long, &many).is_none());

    let parts = InParts { boxes: many.len(), is_first: true };
    let sample: Vec<_> = parts.sample().map(|at| many[at]).collect();
    let mut finder = PairFinder::new();
    let go_on = |_| ControlFlow::Continue(());
    let invalid = Aabb::new([1.0], [0.0]);
    assert_eq!(finder.prepare_parts(&few, parts, &[invalid]), Ok(None));
    let few_and_invalid = [&few[..], &[invalid]].concat();
    assert_eq!(finder.prepare_parts(&few_and_invalid, parts, &sample), Ok(None));
    assert!(finder.prepare_parts(&few, parts, &sample).unwrap().is_some());
    let mut nothing = |_: &[[u32; 2]]| panic!("a pair was sent");
    let part = [many[0], invalid];
    assert_eq!(finder.for_each_chunk_of_part(parts, &part, 0, &go_on, &mut nothing), Ok(None));
    let mut stop = |_: &[[u32; 2]]| ControlFlow::Break(());
    let end = finder.for_each_chunk_of_part(parts, &many, 0, &go_on, &mut stop);
    assert_eq!(end, Ok(Some(ControlFlow::Break(()))));
    let cancel = |_| ControlFlow::Break(());
    let mut take = |_: &[[u32; 2]]| ControlFlow::Continue(());
    let end = finder.for_each_chunk_of_part(parts, &many, 0, &cancel, &mut take);
    assert_eq!(end, Err(Error::Cancelled));
}

/// More than are looked up on both sides at once.
#[test]
fn hundreds_of_thousands_are_counted() {
    let mut random = random();
    let (a, b) = (intervals(270_000, 1e-5, &mut random), intervals(280_000, 1e-5, &mut random));
    let mut finder = PairFinder::new();
    for (a, b) in [(&a, &b), (&b, &a)] {
        let pairs = finder.find_between(a, b).unwrap().to_vec();
        assert_eq!(finder.search(a).against(b).count(), Ok(pairs.len() as u64));
        let counts = counted(pairs.iter().map(|[first, _]| first), a.len());
        assert!(finder.search(a).against(b).counts() == Ok(counts));
    }
}

#[test]
fn few_boxes_and_none_are_counted() {
    let boxes = [Aabb::new([0.0], [2.0]), Aabb::new([2.0], [3.0]), Aabb::new([5.0], [5.0])];
    for end in 0..=3 {
        check(&boxes[..end], &boxes);
        check(&boxes, &boxes[end..]);
    }
    let invalid = Aabb::new([1.0], [0.0]);
    let counts = PairFinder::new().search(&[boxes[0], invalid]).counts();
    assert!(matches!(counts, Err(Error::InvalidBox { set: 0, index: 1, .. })), "{counts:?}");
}

/// Enough to look up on threads.
#[test]
#[cfg(feature = "parallel")]
fn threads_find_the_same_in_the_same_order() {
    let mut random = random();
    let (a, b) = (intervals(3000, 0.0005, &mut random), intervals(140_001, 0.00005, &mut random));
    let sorted = [in_order(&b), in_order(&intervals(150_000, 0.00001, &mut random))];
    for (a, b) in [(&a, &b), (&b, &a), (&sorted[0], &sorted[1])] {
        let one = PairFinder::new().find_between(a, b).unwrap().to_vec();
        assert!(one.len() > 50_000);
        for threads in [2, 5] {
            let mut finder = PairFinder::new().threads(threads);
            assert!(finder.find_between(a, b).unwrap() == one);
            assert_eq!(finder.search(a).against(b).count(), Ok(one.len() as u64));
        }
    }
}

#[test]
fn an_invalid_interval_is_named_before_any_pair() {
    let mut random = random();
    let (few, many) = (intervals(200, 0.01, &mut random), intervals(900, 0.01, &mut random));
    for set in 0..2 {
        for (min, max) in [(2.0, 1.0), (f64::NAN, 1.0), (1.0, f64::NAN)] {
            let mut sets = [few.clone(), many.clone()];
            sets[set][177] = Aabb::new([min], [max]);
            let each = |_: [u32; 2]| -> ControlFlow<()> { panic!("a pair was sent") };
            let result = PairFinder::new().search(&sets[0]).against(&sets[1]).for_each(each);
            let is_named =
                matches!(result, Err(Error::InvalidBox { set: s, index: 177, .. }) if s == set);
            assert!(is_named, "{result:?}");
            let count = PairFinder::new().search(&sets[0]).against(&sets[1]).count();
            assert_eq!(count, result.map(|_| 0));
            let counts = PairFinder::new().search(&sets[0]).against(&sets[1]).counts();
            assert_eq!(counts, result.map(|_| Vec::new()));
        }
    }
}

#[test]
fn lookups_can_be_cancelled() {
    let mut random = random();
    let (few, many) = (intervals(2000, 0.001, &mut random), intervals(9000, 0.001, &mut random));
    let mut finder = PairFinder::new();
    let report =
        |done: f64| if done > 0.4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let result = finder.search(&few).against(&many).progress(&report).count();
    assert_eq!(result, Err(Error::Cancelled));
    let go_on = |_| ControlFlow::<()>::Continue(());
    let result = finder.search(&few).against(&many).progress(&report).for_each(go_on);
    assert_eq!(result.unwrap_err(), Error::Cancelled);
    let found = finder.find_between(&few, &many).unwrap().len();
    assert_eq!(found, pairwise(&few, &many).len());
}

#[test]
fn progress_is_heard_of_on_the_way() {
    let mut random = random();
    let shuffled = intervals(60_000, 0.00001, &mut random);
    let sorted = in_order(&shuffled);
    let (few, few_sorted) = (&shuffled[..6000], in_order(&shuffled[..6000]));
    let searches = [(&sorted[..], None), (&sorted, Some(&few_sorted[..])), (&shuffled, Some(few))];
    for (first, second) in searches {
        let shares = Mutex::new(Vec::new());
        let report = |share: f64| {
            shares.lock().unwrap().push(share);
            ControlFlow::Continue(())
        };
        let mut finder = PairFinder::new();
        let search = finder.search(first).progress(&report);
        let go_on = |_: &[[u32; 2]]| ControlFlow::<()>::Continue(());
        let found = match second {
            Some(second) => search.against(second).for_each_chunk(go_on),
            None => search.for_each_chunk(go_on),
        };
        assert!(found.is_ok());
        let mut shares = shares.into_inner().unwrap();
        shares.dedup();
        assert!(shares.is_sorted() && shares.last() >= Some(&0.99), "{shares:?}");
        assert!(shares.iter().filter(|&&share| share < 0.9).count() > 1, "{shares:?}");
    }
}
