//! Every algorithm, over steps in which boxes move, come and go: its pairs are the oracle's, what
//! begins and ends is the difference of two oracle runs, what it tells is true, and its counts are
//! the known ones.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Error as BoxError, Scalar};
use sweep_and_prune_algorithms::{
    Axis, Counts, Endpoint, Error, Method, Player, Runner, RunnerOptions, Sort, Trace,
};
use sweep_and_prune_scenes::testing::{valid_box, valid_boxes};
use sweep_and_prune_scenes::{Motion, Scene, brute_force, in_all_dimensions};

/// Boxes with holes: slot by slot a box, or none.
type Slots<const D: usize, T> = Vec<Option<Aabb<D, T>>>;

fn all_axes<const D: usize>() -> Vec<Axis> {
    (0..D).map(Axis::Fixed).chain(Axis::ALL[1..].iter().copied()).collect()
}

/// Every algorithm with every sort, on this axis.
fn all_options(axis: Axis, persistent: bool) -> impl Iterator<Item = RunnerOptions> {
    Method::ALL.into_iter().flat_map(move |method| {
        Sort::ALL.into_iter().filter(move |&sort| method.sorts() || sort == Sort::Standard).map(
            move |sort| RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent),
        )
    })
}

/// The boxes that are there and their slots.
fn dense<const D: usize, T: Scalar>(slots: &Slots<D, T>) -> (Vec<Aabb<D, T>>, Vec<u32>) {
    slots.iter().zip(0..).filter_map(|(slot, id)| slot.map(|aabb| (aabb, id))).unzip()
}

fn oracle<const D: usize, T: Scalar>(slots: &Slots<D, T>) -> BTreeSet<[u32; 2]> {
    let (boxes, ids) = dense(slots);
    brute_force(&boxes).unwrap().iter().map(|pair| pair.map(|i| ids[i as usize])).collect()
}

/// The pairs that overlap on one axis.
fn axis_oracle<const D: usize, T: Scalar>(slots: &Slots<D, T>, axis: usize) -> BTreeSet<[u32; 2]> {
    let flat = |aabb: &Aabb<D, T>| Aabb::new([aabb.min[axis]], [aabb.max[axis]]);
    oracle(&slots.iter().map(|slot| slot.as_ref().map(flat)).collect())
}

/// The endpoints on one axis in their one order; only the left ones if `lefts`.
fn sorted_endpoints<const D: usize, T: Scalar>(
    slots: &Slots<D, T>,
    axis: usize,
    lefts: bool,
) -> Vec<Endpoint<f32>> {
    let (boxes, ids) = dense(slots);
    let mut endpoints: Vec<Endpoint<T>> = Vec::new();
    for (aabb, id) in boxes.iter().zip(ids) {
        endpoints.push(Endpoint::left(aabb.min[axis], id));
        if !lefts {
            endpoints.push(Endpoint::right(aabb.max[axis], id));
        }
    }
    endpoints.sort_by(Endpoint::order);
    let rounded = |e: Endpoint<T>| Endpoint { at: e.at.to_f64() as f32, edge: e.edge };
    endpoints.into_iter().map(rounded).collect()
}

fn set(pairs: &[[u32; 2]]) -> BTreeSet<[u32; 2]> {
    let set: BTreeSet<_> = pairs.iter().copied().collect();
    assert_eq!(set.len(), pairs.len(), "each pair is reported once");
    assert!(set.iter().all(|[a, b]| a < b));
    set
}

/// Steps one runner through the frames and checks everything that it answers and tells.
fn check<const D: usize, T: Scalar>(options: RunnerOptions, frames: &[Slots<D, T>]) {
    let RunnerOptions { method, persistent, .. } = options;
    let mut runner = Runner::<D, T>::new(options);
    let mut both = (Counts::default(), Trace::new());
    // Where in the trace each step ends, along which axis it went, and what was counted.
    let mut steps = Vec::new();
    let mut last = BTreeSet::new();
    for (number, slots) in frames.iter().enumerate() {
        // Whatever stands in a hole is not looked at: no box at all, or one that is far off.
        let [low, high] = [[f64::NAN, f64::NAN], [-1e6, 1e30]][number % 2].map(T::from_f64);
        let mut hole = Aabb::new([low; D], [low; D]);
        hole.max[D - 1] = high;
        let boxes: Vec<_> = slots.iter().map(|slot| slot.unwrap_or(hole)).collect();
        let present = |id: u32| slots[id as usize].is_some();
        both.0 = Counts::default();
        let step = runner.step_where(&boxes, present, &mut both).unwrap();
        let context = || format!("{options:?}, step {number} of {frames:?}");

        assert_eq!(Ok(step.axis), options.axis.choose(&dense(slots).0), "{}", context());
        let pairs = oracle(slots);
        assert_eq!(set(step.pairs), pairs, "{}", context());
        assert!(step.pairs.is_sorted() || method != Method::Pairwise);
        let (begun, ended) = if persistent {
            (&pairs - &last, &last - &pairs)
        } else {
            (BTreeSet::new(), BTreeSet::new())
        };
        assert_eq!(set(step.begun), begun, "{}", context());
        assert_eq!(set(step.ended), ended, "{}", context());
        assert!(step.begun.is_sorted() && step.ended.is_sorted(), "{}", context());
        steps.push((both.1.len(), step.axis, both.0));
        last = pairs;
    }

    // The player knows only what was reported, and that leads to the same state.
    let mut player = Player::new(both.1);
    for (slots, (end, axis, counts)) in frames.iter().zip(steps) {
        player.seek(end);
        let state = player.state();
        let context = || format!("{options:?}, event {end}, {frames:?}");
        assert_eq!((state.axis, state.counts), (axis, counts), "{}", context());
        let pairs = oracle(slots);
        let held = if persistent { pairs.clone() } else { BTreeSet::new() };
        assert_eq!((&state.overlaps, &state.held), (&pairs, &held), "{}", context());
        assert!(state.active.is_empty(), "{}", context());
        let swept = match method {
            Method::AxisSweeps | Method::AxisSwapSweeps => 0..D,
            _ => axis..axis + 1,
        };
        let mut on_axes = BTreeSet::new();
        for axis in swept {
            on_axes.extend(axis_oracle(slots, axis).into_iter().map(|pair| (axis, pair)));
            if method != Method::Pairwise {
                let expected = sorted_endpoints(slots, axis, method == Method::SortedPairwise);
                assert_eq!(state.arrays[axis], expected, "{}", context());
            }
        }
        assert_eq!(state.axis_overlaps, on_axes, "{}", context());
    }
}

/// Frames on few coordinates in which slots are kept, changed, emptied and filled, one at a time
/// and all at once.
fn frames<const D: usize, T: Scalar>() -> impl Strategy<Value = Vec<Slots<D, T>>> {
    #[derive(Clone, Debug)]
    enum Change<A> {
        Keep,
        Place(A),
        Remove,
    }
    let slots = 9;
    let some = prop_oneof![
        6 => Just(Change::Keep),
        3 => valid_box::<D, T>().prop_map(Change::Place),
        1 => Just(Change::Remove),
    ];
    let place = valid_box::<D, T>().prop_map(Change::Place);
    let frame = prop_oneof![
        6 => prop::collection::vec(some, slots),
        2 => prop::collection::vec(place, slots),
        1 => prop::collection::vec(Just(Change::Remove), slots),
        1 => prop::collection::vec(Just(Change::Keep), slots),
    ];
    prop::collection::vec(frame, 1..8).prop_map(move |changes| {
        let mut now: Slots<D, T> = vec![None; slots];
        let next = |changes: Vec<Change<Aabb<D, T>>>| {
            for (slot, change) in now.iter_mut().zip(changes) {
                match change {
                    Change::Keep => {}
                    Change::Place(aabb) => *slot = Some(aabb),
                    Change::Remove => *slot = None,
                }
            }
            now.clone()
        };
        changes.into_iter().map(next).collect()
    })
}

fn holds_on_random_frames<const D: usize, T: Scalar>() {
    proptest!(ProptestConfig::with_cases(12), |(frames in frames::<D, T>())| {
        for axis in all_axes::<D>() {
            for persistent in [true, false] {
                for options in all_options(axis, persistent) {
                    check(options, &frames);
                }
            }
        }
    });
}
in_all_dimensions!(everything_holds_while_boxes_move_come_and_go, holds_on_random_frames);

/// The same over the motions, with boxes that blink in and out.
fn holds_in_motion<const D: usize, T: Scalar>() {
    for motion in Motion::ALL {
        let mut moving = motion.start::<D, T>(30, 5).unwrap();
        let frames: Vec<Slots<D, T>> = (0..6)
            .map(|frame| {
                moving.advance();
                let blink = |(i, &aabb)| ((i + frame) % 7 != 0).then_some(aabb);
                moving.boxes().iter().enumerate().map(blink).collect()
            })
            .collect();
        for axis in [Axis::Fixed(D - 1), Axis::LargestVariance] {
            for options in all_options(axis, true) {
                check(options, &frames);
            }
        }
    }
}
in_all_dimensions!(everything_holds_in_motion, holds_in_motion);

/// The same on every scene, one after the other: all boxes go and others come.
fn holds_on_scenes<const D: usize, T: Scalar>() {
    let scenes = Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&D));
    let frames: Vec<Slots<D, T>> = scenes
        .map(|scene| scene.boxes::<D, T>(14, 3).unwrap().into_iter().map(Some).collect())
        .collect();
    for axis in [Axis::Fixed(0), Axis::FewestOverlaps] {
        for persistent in [true, false] {
            for options in all_options(axis, persistent) {
                check(options, &frames);
            }
        }
    }
}
in_all_dimensions!(everything_holds_from_scene_to_scene, holds_on_scenes);

#[test]
fn boxes_beyond_the_end_of_a_shorter_slice_are_gone() {
    for options in all_options(Axis::Fixed(0), true) {
        let boxes = Scene::Coincident.boxes::<2, f32>(6, 1).unwrap();
        let mut runner = Runner::new(options);
        assert_eq!(runner.step(&boxes, &mut ()).unwrap().begun.len(), 15);
        let step = runner.step(&boxes[..4], &mut ()).unwrap();
        assert_eq!((step.pairs.len(), step.begun.len(), step.ended.len()), (6, 0, 9));
        let step = runner.step(&boxes[..5], &mut ()).unwrap();
        assert_eq!(set(step.begun), BTreeSet::from([[0, 4], [1, 4], [2, 4], [3, 4]]));
    }
}

/// One-to-n finds what overlaps its focus, but for what encloses it on the axis.
fn one_to_n_finds_all_but_enclosing<const D: usize, T: Scalar>() {
    proptest!(|(boxes in valid_boxes::<D, T>(12), focus in 0u32..13, axis in 0..D, later in any::<bool>())| {
        let mut runner = Runner::new(RunnerOptions::new(Method::OneToN(focus)).sort(Sort::Standard).axis(Axis::Fixed(axis)).persistent(later));
        if later {
            let reversed: Vec<_> = boxes.iter().rev().copied().collect();
            runner.step(&reversed, &mut ()).unwrap();
        }
        let found = set(runner.step(&boxes, &mut ()).unwrap().pairs);
        let ends = |id: u32| {
            let aabb = &boxes[id as usize];
            (Endpoint::left(aabb.min[axis], id), Endpoint::right(aabb.max[axis], id))
        };
        let encloses_focus = |id: u32| {
            let ((left, right), (focus_left, focus_right)) = (ends(id), ends(focus));
            left.precedes(&focus_left) && focus_right.precedes(&right)
        };
        let expected: BTreeSet<_> = brute_force(&boxes).unwrap().into_iter()
            .filter(|pair| pair.contains(&focus))
            .filter(|[a, b]| !encloses_focus(a + b - focus))
            .collect();
        prop_assert_eq!(found, expected);
    });
}
in_all_dimensions!(one_to_n_misses_exactly_what_encloses, one_to_n_finds_all_but_enclosing);

fn endpoint_options(method: Method, sort: Sort) -> RunnerOptions {
    RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(0)).persistent(true)
}

fn inversions(before: &[Endpoint<f32>], after: &[Aabb<2, f32>]) -> u64 {
    let moved: Vec<Endpoint<f32>> = before
        .iter()
        .map(|e| {
            let aabb = &after[e.edge.id as usize];
            let at = [aabb.min[0], aabb.max[0]][e.edge.side as usize];
            Endpoint { at, edge: e.edge }
        })
        .collect();
    let inverted = |i: usize| moved[i + 1..].iter().filter(|e| e.precedes(&moved[i])).count();
    (0..moved.len()).map(|i| inverted(i) as u64).sum()
}

proptest! {
    /// In the swap-driven forms and in insertion sort a swap is an inversion, and comparisons are
    /// the swaps and at most one more for each endpoint.
    #[test]
    fn swaps_are_the_inversions_of_the_endpoints(
        before in prop::collection::vec(valid_box::<2, f32>(), 10),
        after in prop::collection::vec(valid_box::<2, f32>(), 10),
    ) {
        let order = sorted_endpoints(&before.iter().copied().map(Some).collect(), 0, false);
        let expected = inversions(&order, &after);
        for method in [Method::SwapSweep, Method::EndpointSweep] {
            let mut runner = Runner::new(endpoint_options(method, Sort::Insertion));
            runner.step(&before, &mut ()).unwrap();
            let mut counts = Counts::default();
            runner.step(&after, &mut counts).unwrap();
            prop_assert_eq!(counts.swaps, expected);
            prop_assert!((expected..expected + 20).contains(&counts.comparisons));
        }
    }

    /// All one-axis forms hand the same pairs to the box test; the others hand over none.
    #[test]
    fn tests_are_the_overlaps_on_the_axis(boxes in valid_boxes::<3, f32>(20), axis in 0usize..3) {
        let n = boxes.len() as u64;
        let slots: Slots<3, f32> = boxes.iter().copied().map(Some).collect();
        let on_axis = |axis| axis_oracle(&slots, axis).len() as u64;
        for method in Method::ALL {
            let axis = Axis::Fixed(axis);
            let mut runner = Runner::new(endpoint_options(method, Sort::Merge).axis(axis));
            let mut counts = Counts::default();
            let step = runner.step(&boxes, &mut counts).unwrap();
            let (tests, overlaps) = match method {
                Method::Pairwise => (n * n.saturating_sub(1) / 2, on_axis(step.axis)),
                Method::AxisSweeps | Method::AxisSwapSweeps => (0, (0..3).map(on_axis).sum()),
                _ => (on_axis(step.axis), on_axis(step.axis)),
            };
            prop_assert_eq!((counts.tests, counts.axis_overlaps), (tests, overlaps), "{:?}", method);
            prop_assert_eq!(counts.pairs, step.pairs.len() as u64);
        }
    }

    /// The sweep line touches at once what overlaps at one coordinate.
    #[test]
    fn the_active_set_is_as_large_as_the_deepest_stack(boxes in valid_boxes::<2, f32>(20)) {
        let deepest = boxes.iter().map(|at| {
            boxes.iter().filter(|aabb| aabb.min[0] <= at.min[0] && at.min[0] <= aabb.max[0]).count()
        }).max().unwrap_or(0);
        let mut counts = Counts::default();
        let mut runner = Runner::new(endpoint_options(Method::EndpointSweep, Sort::Timsort));
        runner.step(&boxes, &mut counts).unwrap();
        prop_assert_eq!((counts.max_active, counts.active), (deepest as u64, 0));
    }

    /// To bring one box into a world, or take it out, looks at no pair of the others.
    #[test]
    fn coming_and_going_costs_the_own_overlaps(
        boxes in prop::collection::vec(valid_box::<2, f32>(), 1..15),
        one in any::<prop::sample::Index>(),
    ) {
        let one = one.index(boxes.len()) as u32;
        let slots: Slots<2, f32> = boxes.iter().copied().map(Some).collect();
        let own = |axis| axis_oracle(&slots, axis).iter().filter(|pair| pair.contains(&one)).count();
        let own = (own(0) + own(1)) as u64;
        let mut runner = Runner::new(endpoint_options(Method::AxisSwapSweeps, Sort::Standard));
        runner.step_where(&boxes, |id| id != one, &mut ()).unwrap();
        let mut counts = Counts::default();
        runner.step(&boxes, &mut counts).unwrap();
        prop_assert_eq!((counts.axis_overlaps, counts.axis_ends), (own, 0));
        let mut counts = Counts::default();
        runner.step_where(&boxes, |id| id != one, &mut counts).unwrap();
        prop_assert_eq!((counts.axis_overlaps, counts.axis_ends), (0, own));
    }
}

/// With a first sort, insertion sort never starts from scratch: not in the first step, and not where the axis changes.
#[test]
fn a_first_sort_spares_insertion_sort_the_start() {
    let boxes = Scene::Uniform.boxes::<2, f32>(500, 3).unwrap();
    // As wide along y as the first are along x.
    let turned: Vec<Aabb<2>> = boxes
        .iter()
        .map(|aabb| Aabb::new([0.1 * aabb.min[1], aabb.min[0]], [0.1 * aabb.max[1], aabb.max[0]]))
        .collect();
    let sorting = Method::ALL.into_iter().filter(|method| method.sorts());
    for method in sorting {
        let options = RunnerOptions::new(method).sort(Sort::Insertion).persistent(true);
        let axis = Axis::LongestExtent;
        let mut runner = Runner::new(options.axis(axis).first_sort(Sort::Standard));
        let mut counted = |boxes: &[Aabb<2>]| {
            let mut counts = Counts::default();
            let pairs = set(runner.step(boxes, &mut counts).unwrap().pairs);
            assert_eq!(pairs, set(&brute_force(boxes).unwrap()), "{method:?}");
            counts.comparisons
        };
        let on_every_axis = matches!(method, Method::AxisSweeps | Method::AxisSwapSweeps);
        let wide: Vec<_> = boxes
            .iter()
            .map(|aabb| {
                Aabb::new([aabb.min[0], 0.1 * aabb.min[1]], [aabb.max[0], 0.1 * aabb.max[1]])
            })
            .collect();
        assert!(counted(&wide) < 60_000, "{method:?}: a first step");
        assert!(counted(&wide) < 2_000, "{method:?}: at rest, by insertion sort");
        if !on_every_axis {
            assert!(counted(&turned) < 60_000, "{method:?}: along another axis");
        }
    }
}

#[test]
fn a_world_at_rest_costs_one_comparison_an_endpoint_and_nothing_else() {
    for scene in [Scene::Grid, Scene::Coincident, Scene::Infinite, Scene::Points, Scene::Uniform] {
        let boxes = scene.boxes::<2, f64>(100, 1).unwrap();
        let mut runner = Runner::new(endpoint_options(Method::AxisSwapSweeps, Sort::Quicksort));
        let pairs = runner.step(&boxes, &mut ()).unwrap().pairs.len() as u64;
        for _ in 0..10 {
            let mut counts = Counts::default();
            runner.step(&boxes, &mut counts).unwrap();
            let expected = Counts { comparisons: 2 * 199, pairs, ..Counts::default() };
            assert_eq!(counts, expected, "{}", scene.name());
        }
    }
}

/// Memory stays within what the head comments promise, and does not creep.
#[test]
fn memory_is_linear_in_boxes_and_kept_overlaps() {
    let n = 1000;
    let mut moving = Motion::Drift.start::<2, f32>(n, 3).unwrap();
    for options in all_options(Axis::Fixed(0), true) {
        let mut runner = Runner::new(options);
        let mut most_overlaps = 0;
        for _ in 0..5 {
            moving.advance();
            let mut counts = Counts::default();
            runner.step(moving.boxes(), &mut counts).unwrap();
            most_overlaps = most_overlaps.max(counts.axis_overlaps as usize);
        }
        // Endpoints of 12 bytes and their set, twice for growth.
        let endpoints = |axes: usize| 2 * axes * (2 * n * 12 + 4 * n * 4);
        // A pair with its value, and two to four slots for it; again twice for growth.
        let kept = |overlaps: usize| 2 * overlaps * (16 + 4 * 8);
        let limit = match options.method {
            Method::Pairwise => 0,
            Method::SortedPairwise => endpoints(1) / 2,
            Method::EndpointSweep => endpoints(1),
            Method::AxisSweeps => endpoints(2) + kept(most_overlaps),
            _ => endpoints(2) + 2 * kept(most_overlaps),
        };
        let bytes = runner.bytes();
        assert!(bytes <= limit, "{options:?}: {bytes} bytes > {limit}");
        assert!(bytes > 0 || options.method == Method::Pairwise);
    }
}

#[test]
fn a_refused_step_changes_nothing() {
    let good = Scene::Uniform.boxes::<2, f32>(20, 1).unwrap();
    let mut bad = good.clone();
    bad[7].max[1] = f32::NAN;
    for options in all_options(Axis::LargestVariance, true) {
        let mut runner = Runner::new(options);
        runner.step(&good, &mut ()).unwrap();
        let mut trace = Trace::new();
        let error = runner.step(&bad, &mut trace).unwrap_err();
        assert!(matches!(error, Error::Boxes(BoxError::InvalidBox { index: 7, axis: 1, .. })));
        assert!(trace.is_empty());
        // A hole is not looked at, and ends its pairs.
        let step = runner.step_where(&bad, |id| id != 7, &mut ()).unwrap();
        let gone = brute_force(&good).unwrap().into_iter().filter(|pair| pair.contains(&7));
        assert_eq!(set(step.ended), gone.collect());
        assert!(step.begun.is_empty());
    }
}

#[test]
fn boxes_without_dimensions_are_refused() {
    for axis in Axis::ALL {
        for options in all_options(axis, true) {
            let error = Runner::<0, f32>::new(options).step(&[], &mut ()).unwrap_err();
            assert_eq!(error, Error::InvalidAxis { axis: 0, dimensions: 0 });
        }
    }
}

#[test]
fn every_name_is_unique_and_can_be_parsed() {
    assert!(Method::ALL.into_iter().all(|method| Method::from_name(method.name()) == Some(method)));
    assert!(Sort::ALL.into_iter().all(|sort| Sort::from_name(sort.name()) == Some(sort)));
    assert!(Axis::ALL.into_iter().all(|axis| Axis::from_name(axis.name()) == Some(axis)));
    assert_eq!(Method::from_name(Method::OneToN(7).name()), Some(Method::OneToN(0)));
    assert_eq!(Method::from_name("bogosort"), None);
}

/// Which axis each way to choose takes.
#[test]
fn axes_are_chosen_by_their_measure() {
    // One far outlier in x; spread in y; and needles along y, so that only z has few overlaps.
    let mut boxes: Vec<Aabb<3, f64>> = (0..2000)
        .map(|i| {
            let (y, z) = (f64::from(i % 50) * 10.0, f64::from(i / 50));
            Aabb::new([0.0, y, z], [1.0, y + 300.0, z + 0.5])
        })
        .collect();
    boxes.push(Aabb::new([2000.0, 0.0, 0.0], [2000.5, 300.0, 0.5]));
    assert_eq!(Axis::LongestExtent.choose(&boxes), Ok(0));
    assert_eq!(Axis::LargestVariance.choose(&boxes), Ok(1));
    assert_eq!(Axis::FewestOverlaps.choose(&boxes), Ok(2));
    assert_eq!(Axis::Fixed(1).choose(&boxes), Ok(1));
    let missing = Error::InvalidAxis { axis: 3, dimensions: 3 };
    assert_eq!(Axis::Fixed(3).choose(&boxes), Err(missing));
}

proptest! {
    /// Of few boxes all are counted, so the axis has the fewest overlaps there are.
    #[test]
    fn fewest_overlaps_is_exact_for_few_boxes(boxes in valid_boxes::<3, f32>(30)) {
        let slots: Slots<3, f32> = boxes.iter().copied().map(Some).collect();
        let overlaps = [0, 1, 2].map(|axis| axis_oracle(&slots, axis).len());
        let chosen = Axis::FewestOverlaps.choose(&boxes).unwrap();
        let first_fewest = (0..3).min_by_key(|&axis| overlaps[axis]).unwrap();
        prop_assert_eq!(chosen, first_fewest);
    }
}

/// A grid in row order, whose every 32nd box is in one column: a sample that took every k-th box
/// would see only that.
#[test]
fn fewest_overlaps_is_not_misled_by_periodic_input() {
    let boxes: Vec<Aabb<2, f32>> = (0..1 << 15)
        .map(|i| {
            let (x, y) = ((i % 32) as f32 * 100.0, (i / 32) as f32);
            Aabb::new([x, y], [x + 0.5, y + 100.0])
        })
        .collect();
    // On x 1/32 of all pairs overlap, on y nearly 1/5.
    assert_eq!(Axis::FewestOverlaps.choose(&boxes), Ok(0));
}
