//! The finder against brute force, with every kernel and number of threads, for one set and two,
//! stored, counted and streamed; on scenes that each defeat some simple design.

use std::ops::ControlFlow;

use proptest::prelude::*;
use sweep_and_prune::{
    Aabb, Error, Kernel, PairFinder, Scalar, Search, Value, count_pairs, find_pairs,
    find_pairs_between, validate,
};
use sweep_and_prune_scenes::testing::{coordinate, valid_boxes};
use sweep_and_prune_scenes::{Motion, Random, brute_force, in_all_dimensions};

type Boxes<const D: usize, T> = Vec<Aabb<D, T>>;

/// A box around a center; the edges are rounded to the type.
fn around<const D: usize, T: Scalar>(center: [f64; D], half: [f64; D]) -> Aabb<D, T> {
    Aabb::new(
        core::array::from_fn(|k| T::from_f64(center[k] - half[k])),
        core::array::from_fn(|k| T::from_f64(center[k] + half[k])),
    )
}

/// Boxes in the unit cube, each with about this half size.
fn some<const D: usize, T: Scalar>(n: usize, half: f64) -> Boxes<D, T> {
    let mut random = Random::new(n as u64);
    (0..n).map(|_| around(random.point(), [half * (0.5 + random.unit()); D])).collect()
}

/// The half size at which boxes in the unit cube overlap one other box on average.
fn half_size<const D: usize>(n: usize) -> f64 {
    0.25 * (2.0 / n as f64).powf(1.0 / D as f64)
}

/// Scenes, each against some shortcut.
fn adversaries<const D: usize, T: Scalar>(n: usize) -> Vec<(&'static str, Boxes<D, T>)> {
    let half = half_size::<D>(n);
    let uniform: Boxes<D, T> = some(n, half);
    let with = |every: usize, change: &dyn Fn(usize, &mut Aabb<D, T>)| {
        let mut boxes = uniform.clone();
        boxes.iter_mut().enumerate().step_by(every).for_each(|(i, aabb)| change(i, aabb));
        boxes
    };
    let scaled = |factor: f64, offset: f64| {
        let scale = |at: T| T::from_f64(at.to_f64() * factor + offset);
        uniform.iter().map(|b| Aabb::new(b.min.map(scale), b.max.map(scale))).collect::<Vec<_>>()
    };
    let by_left = |reverse: bool| {
        let mut boxes = uniform.clone();
        boxes.sort_by(|a, b| a.min[0].partial_cmp(&b.min[0]).unwrap());
        if reverse {
            boxes.reverse();
        }
        boxes
    };
    let (least, most, low) = (T::NEG_INFINITY, T::INFINITY, T::from_f64(0.3));
    let far = |i: usize, aabb: &mut Aabb<D, T>, axes: std::ops::Range<usize>| {
        for axis in axes {
            let offset = T::from_f64(if i.is_multiple_of(4) { 1e4 } else { 3e4 });
            aabb.min[axis] = aabb.min[axis] + offset;
            aabb.max[axis] = aabb.max[axis] + offset;
        }
    };
    vec![
        ("uniform", uniform.clone()),
        ("dense", some(n, 3.0 * half)),
        ("points", some(n, 0.0)),
        ("sorted", by_left(false)),
        ("reversed", by_left(true)),
        ("at 1e30", scaled(1e30, 0.0)),
        ("at 1e-30", scaled(1e-30, 0.0)),
        ("beyond the plan's limit", scaled(1e38, -2e38)),
        ("far from the origin", scaled(1.0, 1e5)),
        ("one spans all", with(n, &|_, b| (b.min, b.max) = ([low; D].map(|_| least), [most; D]))),
        ("one in ten spans all", with(10, &|_, b| (b.min, b.max) = ([least; D], [most; D]))),
        ("half spaces", with(50, &|i, b| (b.min, b.max[i % D]) = ([least; D], low))),
        (
            "needles",
            with(1, &|i, b| (b.min[i % D], b.max[i % D]) = (T::from_f64(-1.0), T::from_f64(2.0))),
        ),
        ("long on an axis", with(3, &|_, b| b.max[0] = T::from_f64(2.0))),
        ("all reach to infinity", with(1, &|_, b| b.max[D - 1] = most)),
        ("all at infinity", with(1, &|_, b| (b.min[0], b.max[0]) = (most, most))),
        ("two far clusters", with(2, &|i, b| far(i, b, 0..D))),
        ("two clusters far on an axis", with(2, &|i, b| far(i, b, 0..1))),
        ("one outlier", with(n, &|_, b| *b = around([1e20; D], [1.0; D]))),
        ("in one plane", with(1, &|_, b| (b.min[D - 1], b.max[D - 1]) = (low, low))),
        ("on a line", with(1, &|_, b| (b.min, b.max) = ([b.min[0]; D], [b.max[0]; D]))),
        ("scales", {
            let mut boxes = uniform.clone();
            for (i, aabb) in boxes.iter_mut().enumerate() {
                let scale = |at: T| T::from_f64(at.to_f64() * 0.01f64.powi(i as i32 % 4));
                *aabb = Aabb::new(aabb.min.map(scale), aabb.max.map(scale));
            }
            boxes
        }),
        ("nested", {
            let half = |i: usize| 0.99f64.powi(i as i32);
            (0..n.min(600)).map(|i| around([0.5; D], [half(i); D])).collect()
        }),
        ("coincident", vec![around([0.5; D], [0.5; D]); n.min(600)]),
        ("lattice of touching boxes", {
            let side = (n as f64).powf(1.0 / D as f64).ceil() as usize;
            let at = |i: usize| core::array::from_fn(|k| (i / side.pow(k as u32) % side) as f64);
            (0..n).map(|i| around(at(i), [0.5; D])).collect()
        }),
        ("power-law sizes", {
            let mut random = Random::new(5);
            let size = |r: f64| (0.3 * half * (1.0 - r).powf(-0.7)).min(1.0);
            (0..n).map(|_| around(random.point(), [size(random.unit()); D])).collect()
        }),
    ]
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// Every finder that this build offers: the scalar one first, which is the definition.
fn finders<const D: usize, T: Scalar>() -> Vec<(String, PairFinder<D, T>)> {
    let mut all = Vec::new();
    for kernel in Kernel::available() {
        let finder = PairFinder::new().kernel(kernel);
        #[cfg(feature = "parallel")]
        for threads in [2, 3] {
            let name = format!("{} on {threads} threads", kernel.name());
            all.push((name, PairFinder::new().kernel(kernel).threads(threads)));
        }
        all.push((kernel.name().into(), finder));
    }
    all
}

/// Pairs between two sets by brute force.
fn brute_force_between<const D: usize, T: Scalar>(
    a: &[Aabb<D, T>],
    b: &[Aabb<D, T>],
) -> Vec<[u32; 2]> {
    let mut pairs = Vec::new();
    for (i, first) in a.iter().enumerate() {
        let partners = (0..b.len()).filter(|&j| first.overlaps(&b[j]));
        pairs.extend(partners.map(|j| [i as u32, j as u32]));
    }
    pairs
}

/// Every finder gives the right pairs, in the same order.
fn check<const D: usize, T: Scalar>(name: &str, boxes: &[Aabb<D, T>]) {
    // The oracle is slow, and a second million of pairs would show nothing new.
    let mut boxes = boxes;
    while count_pairs(boxes).unwrap() > 1_000_000 {
        boxes = &boxes[..boxes.len() / 2];
    }
    let found = find_pairs(boxes).unwrap();
    assert!(sorted(&found) == brute_force(boxes).unwrap(), "{name}, {D}D, {} boxes", boxes.len());
    for (with, mut finder) in finders() {
        assert!(finder.find(boxes).unwrap() == found, "{name}, {D}D, {with}");
        assert_eq!(finder.search(boxes).count(), Ok(found.len() as u64), "{name}, {D}D, {with}");
    }
    let mut streamed = Vec::new();
    let flow = PairFinder::new().search(boxes).for_each(|pair| {
        streamed.push(pair);
        ControlFlow::<()>::Continue(())
    });
    assert!(flow == Ok(ControlFlow::Continue(())) && streamed == found, "{name}, {D}D, streamed");
    let mut counts = vec![0; boxes.len()];
    found.iter().flatten().for_each(|&index| counts[index as usize] += 1);
    assert!(PairFinder::new().search(boxes).counts() == Ok(counts), "{name}, {D}D, counts");
}

fn check_between<const D: usize, T: Scalar>(name: &str, a: &[Aabb<D, T>], b: &[Aabb<D, T>]) {
    let (mut a, mut b) = (a, b);
    while PairFinder::new().search(a).against(b).count().unwrap() > 1_000_000 {
        (a, b) = (&a[..a.len().div_ceil(2)], &b[..b.len().div_ceil(2)]);
    }
    let found = find_pairs_between(a, b).unwrap();
    assert!(sorted(&found) == brute_force_between(a, b), "{name}, {D}D, {} {}", a.len(), b.len());
    for (with, mut finder) in finders() {
        assert!(finder.find_between(a, b).unwrap() == found, "{name}, {D}D, {with}");
        assert_eq!(finder.search(a).against(b).count(), Ok(found.len() as u64), "{name}, {with}");
    }
    let mut counts = vec![0; a.len()];
    found.iter().for_each(|&[first, _]| counts[first as usize] += 1);
    assert!(PairFinder::new().search(a).against(b).counts() == Ok(counts), "{name}, {D}D, counts");
    let mut streamed = Vec::new();
    let flow = PairFinder::new().search(a).against(b).for_each(|pair| {
        streamed.push(pair);
        ControlFlow::<()>::Continue(())
    });
    assert!(flow == Ok(ControlFlow::Continue(())) && streamed == found, "{name}, {D}D, streamed");
}

/// In an optimized build, enough boxes for many columns and for threads.
const MANY: usize = if cfg!(debug_assertions) { 700 } else { 5000 };

fn adversaries_in_one_set<const D: usize, T: Scalar>() {
    for n in [66, 300, MANY] {
        for (name, boxes) in adversaries::<D, T>(n) {
            check(name, &boxes);
        }
    }
}
in_all_dimensions!(every_finder_finds_the_pairs_of_every_adversary, adversaries_in_one_set);

fn adversaries_in_two_sets<const D: usize, T: Scalar>() {
    let few: Boxes<D, T> = some(7, 0.3);
    let uniform: Boxes<D, T> = some(MANY, half_size::<D>(MANY));
    for (name, boxes) in adversaries::<D, T>(MANY / 2) {
        check_between(name, &boxes, &uniform);
        check_between(name, &few, &boxes);
        check_between(name, &boxes, &few);
        check_between(name, &boxes[..1], &boxes);
        check_between(name, &boxes, &[]);
    }
}
in_all_dimensions!(every_finder_finds_the_pairs_between_sets, adversaries_in_two_sets);

fn random_boxes<const D: usize, T: Scalar>() {
    proptest!(ProptestConfig::with_cases(96), |(boxes in valid_boxes::<D, T>(150))| {
        check("random", &boxes);
    });
    proptest!(ProptestConfig::with_cases(48), |(a in valid_boxes::<D, T>(90), b in valid_boxes::<D, T>(150))| {
        check_between("random", &a, &b);
    });
    // Enough boxes that space is cut, on so few coordinates that edges of boxes and columns meet.
    let whole = |k: usize| move |random: &mut Random| random.below(k) as f64;
    let mut random = Random::new(17);
    for k in [3, 10, 40] {
        let coordinate = whole(k);
        let mut next = || T::from_f64(coordinate(&mut random));
        let boxes: Boxes<D, T> = (0..MANY / 4)
            .map(|_| {
                let min: [T; D] = core::array::from_fn(|_| next());
                let one = T::from_f64(1.0);
                Aabb::new(
                    min,
                    core::array::from_fn(|k| if next() > one { min[k] } else { min[k] + one }),
                )
            })
            .collect();
        check("whole numbers", &boxes);
    }
}
in_all_dimensions!(every_finder_finds_the_pairs_of_random_boxes, random_boxes);

/// Frames of boxes that move little, teleport, grow and shrink in number.
fn earlier_calls_do_not_matter<const D: usize, T: Scalar>() {
    let mut finders = finders::<D, T>();
    let mut random = Random::new(3);
    for n in [MANY, MANY, 3, 600, MANY, 20, MANY / 3, 0, MANY] {
        let mut boxes: Boxes<D, T> = some(n, half_size::<D>(n.max(1)));
        for _ in 0..2 {
            let fresh = find_pairs(&boxes).unwrap();
            for (name, finder) in &mut finders {
                assert!(finder.find(&boxes).unwrap() == fresh, "{name}, {D}D, {n} boxes");
            }
            for aabb in &mut boxes {
                let by = T::from_f64(if random.below(9) == 0 { random.unit() } else { 0.001 });
                *aabb = Aabb::new(aabb.min.map(|at| at + by), aabb.max.map(|at| at + by));
            }
        }
    }
}
in_all_dimensions!(a_used_finder_finds_what_a_new_one_finds, earlier_calls_do_not_matter);

/// Another box in the place of one.
type Change<'a, const D: usize, T> = &'a dyn Fn(usize, Aabb<D, T>) -> Aabb<D, T>;

/// Frames of boxes that move little and now and then teleport, change in number, or are another
/// scene: a finder that was used before finds what a new one finds, in the same order.
fn earlier_frames_do_not_matter<const D: usize, T: Scalar>() {
    let frames = if cfg!(debug_assertions) { 20 } else { 40 };
    let each = |it: Aabb<D, T>, change: &dyn Fn(f64) -> f64| {
        let changed = |at: T| T::from_f64(change(at.to_f64()));
        Aabb::new(it.min.map(changed), it.max.map(changed))
    };
    // With many equal edges; with half of the boxes in a corner, too many for the column there; with a
    // bundle of needles along each axis, for which another sweep axis is better than for the rest.
    let coarse = |_: usize, it| each(it, &|at| (at * 64.0).round() / 64.0);
    let corner = |i: usize, it| if i.is_multiple_of(2) { it } else { each(it, &|at| at * 0.01) };
    let bundles = |i: usize, it: Aabb<D, T>| {
        let at = it.min.map(|at| 0.3 + 0.1 * (i % D) as f64 + 5e-4 * at.to_f64());
        let half = (it.max[0].to_f64() - it.min[0].to_f64()) / 2.0;
        let halves = core::array::from_fn(|axis| if i % D == axis { half } else { 1e-7 });
        if i < 1200 * D { around(at, halves) } else { it }
    };
    let as_it_is = |_: usize, it| it;
    let change: [(Motion, usize, Change<'_, D, T>); 6] = [
        (Motion::Drift, 900, &as_it_is),
        (Motion::MostlyStill, 3000, &as_it_is),
        (Motion::Teleport, 2000, &as_it_is),
        (Motion::MostlyStill, 2000, &coarse),
        (Motion::MostlyStill, 8000, &corner),
        (Motion::MostlyStill, 16_000, &bundles),
    ];
    for (motion, n, change) in change {
        let mut moving = motion.start::<D, T>(n, 1).unwrap();
        let mut used = finders::<D, T>();
        for frame in 0..frames.min(160_000 / n) {
            let all = moving.boxes().iter().enumerate();
            let mut boxes: Boxes<D, T> = all.map(|(i, it)| change(i, *it)).collect();
            moving.advance();
            match frame % 17 {
                7 => boxes.push(boxes[0]),
                11 => boxes.reverse(),
                13 => boxes[n / 2].min[0] = T::INFINITY,
                14 => boxes.iter_mut().step_by(9).for_each(|it| *it = around([0.5; D], [0.01; D])),
                _ => {}
            }
            let fresh = find_pairs(&boxes);
            for (name, finder) in &mut used {
                let found = finder.find(&boxes);
                assert!(
                    found == fresh.as_deref().map_err(|&e| e),
                    "{motion:?} {D}D {frame} {name}"
                );
            }
        }
    }
}
in_all_dimensions!(
    a_finder_used_for_moving_boxes_finds_what_a_new_one_finds,
    earlier_frames_do_not_matter
);

/// The same pairs in the same order, never an empty chunk, and none after a break.
#[test]
fn pairs_come_in_chunks() {
    for n in [0, 1, 2, 30, 200, 3000] {
        let (a, b) = (some::<2, f32>(n, 0.1), some::<2, f32>(n / 2, 0.1));
        let mut finder = PairFinder::new();
        let mut taken = Vec::new();
        let mut take = |pairs: &[[u32; 2]]| {
            assert!((1..=4096).contains(&pairs.len()));
            taken.extend_from_slice(pairs);
            ControlFlow::<()>::Continue(())
        };
        assert!(finder.search(&a).for_each_chunk(&mut take).unwrap().is_continue());
        assert!(finder.search(&a).against(&b).for_each_chunk(&mut take).unwrap().is_continue());
        let expected = [find_pairs(&a).unwrap(), find_pairs_between(&a, &b).unwrap()].concat();
        assert_eq!(taken, expected, "{n}");

        let mut calls = 0;
        let end = finder.search(&a).for_each_chunk(|pairs| {
            calls += 1;
            ControlFlow::Break(pairs[0])
        });
        let first = find_pairs(&a).unwrap().first().copied();
        assert_eq!((end.unwrap().break_value(), calls), (first, usize::from(first.is_some())));
    }
}

/// What threads share in different ways: columns that hold most of the boxes, sweeps of one column,
/// pairs that fill many chunks. Repeated by the same finders, whose buffers then exist, and for two
/// sets.
#[cfg(feature = "parallel")]
fn threads_share<const D: usize, T: Scalar>() {
    let crossing = |n: usize| -> Boxes<D, T> {
        let mut random = Random::new(9);
        let long = |i: usize| core::array::from_fn(|k| if i % D == k { 1.0 } else { 1e-3 });
        (0..n).map(|i| around(random.point(), long(i))).collect()
    };
    // All but a few in a corner, and of these all but a few in a corner of it.
    let corners = |n: usize| -> Boxes<D, T> {
        let scale = |i: usize| match i % 9 {
            0 => 1.0,
            1 => 1e-3,
            _ => 1e-6,
        };
        let all = some::<D, T>(n, half_size::<D>(n)).into_iter().enumerate();
        all.map(|(i, it)| {
            let scaled = |at: T| T::from_f64(at.to_f64() * scale(i));
            Aabb::new(it.min.map(scaled), it.max.map(scaled))
        })
        .collect()
    };
    let scenes = [
        ("crossing", crossing(5000)),
        ("corners", corners(30_000)),
        ("coincident", vec![around([0.5; D], [0.5; D]); 4200]),
        ("large", some(5000, 0.1)),
    ];
    let mut used = [2, 3].map(|threads| PairFinder::<D, T>::new().threads(threads));
    for frame in 0..3 {
        for (name, boxes) in &scenes {
            let boxes = &boxes[frame..];
            let few = &scenes[0].1[..2000 + frame];
            let fresh = find_pairs(boxes).unwrap();
            let between = find_pairs_between(boxes, few).unwrap();
            for finder in &mut used {
                assert!(finder.find(boxes).unwrap() == fresh, "{name} {D}D {frame}");
                assert_eq!(
                    finder.search(boxes).count(),
                    Ok(fresh.len() as u64),
                    "{name} {D}D {frame}"
                );
                let found = finder.find_between(boxes, few).unwrap();
                assert!(found == between, "{name} {D}D {frame}, between");
            }
        }
    }
}

#[cfg(feature = "parallel")]
#[test]
fn several_threads_find_what_one_finds() {
    threads_share::<2, f32>();
    threads_share::<3, f64>();
}

/// Random boxes, most of them invalid.
fn refuses_bad_boxes<const D: usize, T: Scalar>() {
    let bad = |a: T, b: T| Aabb::new([a; D], [b; D]);
    let nan = T::from_f64(f64::NAN);
    let corner = || prop_oneof![4 => coordinate::<T>(), 1 => Just(nan)];
    let boxes = prop::collection::vec((corner(), corner()), 0..200);
    proptest!(ProptestConfig::with_cases(64), |(corners in boxes, n in 0..3000usize)| {
        let corners: Boxes<D, T> = corners.into_iter().map(|(a, b)| bad(a, b)).collect();
        let mut boxes: Boxes<D, T> = some(n, 0.01);
        if let Err(error) = validate(&corners) {
            let Error::InvalidBox { index, axis, min, max, .. } = error else { unreachable!() };
            let second = Error::InvalidBox { set: 1, index, axis, min, max };
            prop_assert_eq!(find_pairs_between(&boxes, &corners), Err(second));
            prop_assert_eq!(find_pairs_between(&corners, &boxes), Err(error));
            let error = Error::InvalidBox { set: 0, index: n + index, axis, min, max };
            boxes.extend(corners);
            prop_assert_eq!(find_pairs(&boxes), Err(error));
            prop_assert_eq!(count_pairs(&boxes), Err(error));
            for (_, mut finder) in finders::<D, T>() {
                prop_assert_eq!(finder.find(&boxes), Err(error));
                prop_assert_eq!(finder.search(&boxes).for_each(|_| -> ControlFlow<()> { panic!("a pair") }), Err(error));
            }
        }
    });
}
in_all_dimensions!(invalid_boxes_are_refused_by_index, refuses_bad_boxes);

/// Among boxes that are cut into columns, one that is invalid on the sweep axis alone, or on an axis that is cut.
fn refuses_one_bad_axis<const D: usize, T: Scalar>() {
    let mut boxes: Boxes<D, T> = some(3000, 0.01);
    let good = boxes[1234];
    for axis in 0..D {
        let [min, max] = [good.max[axis], good.min[axis]];
        for [min, max] in [[min, max], [T::from_f64(f64::NAN), max], [min, T::from_f64(f64::NAN)]] {
            (boxes[1234].min[axis], boxes[1234].max[axis]) = (min, max);
            let error = validate(&boxes).unwrap_err();
            for (_, mut finder) in finders::<D, T>() {
                assert_eq!(finder.find(&boxes), Err(error));
                assert_eq!(finder.search(&boxes).count(), Err(error));
                assert_eq!(finder.search(&boxes).counts(), Err(error));
                assert_eq!(finder.find_between(&boxes, &boxes[..900]), Err(error));
            }
        }
        boxes[1234] = good;
    }
}
in_all_dimensions!(a_box_that_is_invalid_on_one_axis_alone_is_refused, refuses_one_bad_axis);

#[test]
fn an_invalid_box_of_two_sets_is_named_by_its_set_and_its_index_there() {
    let (good, bad) = (Aabb::new([0.0f32], [1.0]), Aabb::new([1.0f32], [0.0]));
    let [min, max] = [1.0, 0.0].map(Value::from);
    let error = |set, index| Error::InvalidBox { set, index, axis: 0, min, max };
    assert_eq!(find_pairs_between(&[good, good], &[good, bad]), Err(error(1, 1)));
    assert_eq!(find_pairs_between(&[], &[good, good, good, bad]), Err(error(1, 3)));
    assert_eq!(find_pairs_between(&[good; 3], &[bad; 3000]), Err(error(1, 0)));
}

#[test]
fn a_stream_ends_when_its_receiver_breaks() {
    let boxes: Boxes<2, f32> = some(3000, 0.05);
    let all = find_pairs(&boxes).unwrap();
    for end in [0, 1, 5000, all.len() - 1] {
        let mut seen = Vec::new();
        let flow = PairFinder::new().search(&boxes).for_each(|pair| {
            seen.push(pair);
            if seen.len() > end { ControlFlow::Break(pair) } else { ControlFlow::Continue(()) }
        });
        assert_eq!(flow, Ok(ControlFlow::Break(all[end])));
        assert_eq!(seen, all[..=end]);
    }
}

/// What a search reports to a progress callback that lets it go on. It returns the same as without a
/// callback, and is cancelled by one that breaks.
fn reported<'b, R: PartialEq + std::fmt::Debug>(
    finder: &mut PairFinder<3, f64>,
    (a, b): (&'b [Aabb<3, f64>], Option<&'b [Aabb<3, f64>]>),
    end: impl Fn(Search<'_, '_, 3, f64>) -> Result<R, Error>,
) -> Vec<f64> {
    fn search<'f, 'b>(
        finder: &'f mut PairFinder<3, f64>,
        (a, b): (&'b [Aabb<3, f64>], Option<&'b [Aabb<3, f64>]>),
    ) -> Search<'f, 'b, 3, f64> {
        let search = finder.search(a);
        if let Some(b) = b { search.against(b) } else { search }
    }
    let half = |share| if share > 0.5 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    assert!(end(search(finder, (a, b)).progress(&half)) == Err(Error::Cancelled));
    let shares = std::sync::Mutex::new(Vec::new());
    let report = |share| {
        shares.lock().unwrap().push(share);
        ControlFlow::Continue(())
    };
    let found = end(search(finder, (a, b)).progress(&report));
    assert!(found.is_ok() && found == end(search(finder, (a, b))));
    let mut shares = shares.into_inner().unwrap();
    shares.sort_by(f64::total_cmp);
    assert!(shares.iter().all(|share| (0.0..=1.0).contains(share)), "{shares:?}");
    shares
}

#[test]
fn a_progress_callback_hears_of_progress_and_cancels_the_search() {
    use std::sync::Mutex;
    let boxes: Boxes<3, f64> = some(60_000, half_size::<3>(60_000));
    let (a, b) = boxes.split_at(20_000);
    for (name, finder) in &mut finders() {
        let pairs = |search: Search<'_, '_, 3, f64>| search.pairs().map(<[_]>::to_vec);
        let count = |search: Search<'_, '_, 3, f64>| search.count();
        let each_chunk = |search: Search<'_, '_, 3, f64>| {
            let mut all = Vec::new();
            let end = search.for_each_chunk(|chunk| {
                all.extend_from_slice(chunk);
                ControlFlow::<()>::Continue(())
            });
            end.map(|_| all)
        };
        let all_reported = [
            reported(finder, (&boxes, None), pairs),
            reported(finder, (a, Some(b)), pairs),
            reported(finder, (&boxes, None), count),
            reported(finder, (b, Some(a)), count),
            reported(finder, (a, Some(b)), each_chunk),
        ];
        for shares in all_reported {
            assert!(shares.len() > 10, "{name}: {shares:?}");
            assert!(*shares.last().unwrap() > 0.95, "{name}: {shares:?}");
        }
        // They share no column, and that is all there is to report.
        let apart = boxes
            .iter()
            .map(|aabb| Aabb::new(aabb.min.map(|x| x + 9.0), aabb.max.map(|x| x + 9.0)));
        let apart: Boxes<3, f64> = apart.collect();
        let shares = Mutex::new(Vec::new());
        let report = |share| {
            shares.lock().unwrap().push(share);
            ControlFlow::Continue(())
        };
        let count = finder.search(&boxes).against(&apart).progress(&report).count();
        assert_eq!(count, Ok(0), "{name}");
        assert_eq!(shares.into_inner().unwrap(), [1.0], "{name}");
    }
    // Most lie in one column of the first plan, which is planned again: its parts are reported.
    let shrunk =
        |aabb: &Aabb<3, f64>| Aabb::new(aabb.min.map(|x| x * 1e-5), aabb.max.map(|x| x * 1e-5));
    let cluster: Boxes<3, f64> = boxes.iter().take(54_000).map(shrunk).collect();
    let clustered: Boxes<3, f64> = cluster.into_iter().chain(b[..6_000].to_vec()).collect();
    let shares = reported(&mut PairFinder::new(), (&clustered, None), |search| search.count());
    assert!(shares.len() > 10 && *shares.last().unwrap() > 0.95, "{shares:?}");
    // One column full of pairs: the callback is called while they are found.
    let heap = vec![Aabb::new([0.0f32], [1.0]); 20_000];
    let asked = Mutex::new(0);
    let mut finder = PairFinder::new();
    let third = |_| {
        *asked.lock().unwrap() += 1;
        if *asked.lock().unwrap() == 3 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    assert_eq!(finder.search(&heap).progress(&third).pairs(), Err(Error::Cancelled));
    assert!(finder.take_pairs().is_empty(), "after an error there are none");
}

#[test]
fn a_billion_pairs_are_counted_in_bounded_memory() {
    let n = if cfg!(debug_assertions) { 2000u64 } else { 50_000 };
    let boxes = vec![Aabb::new([1.0f32, 2.0, 3.0], [2.0, 3.0, 4.0]); n as usize];
    assert_eq!(count_pairs(&boxes), Ok(n * (n - 1) / 2));
    let mut streamed = 0;
    let flow = PairFinder::new().search(&boxes).for_each(|_| {
        streamed += 1;
        ControlFlow::<()>::Continue(())
    });
    assert_eq!((flow, streamed), (Ok(ControlFlow::Continue(())), n * (n - 1) / 2));
}
