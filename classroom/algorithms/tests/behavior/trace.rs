//! A trace plays forward and backward, and what it holds is enough to draw every demo.

use std::collections::BTreeSet;

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Scalar};
use sweep_and_prune_algorithms::{
    Axis, Counts, Edge, Event, Method, Observer, Player, PlayerState, Runner, RunnerOptions,
    Separation, Side, Sort, Trace,
};
use sweep_and_prune_scenes::testing::{valid_box, valid_boxes};
use sweep_and_prune_scenes::{Motion, brute_force, in_all_dimensions};

const METHODS: [Method; 7] = [
    Method::Pairwise,
    Method::SortedPairwise,
    Method::OneToN(0),
    Method::EndpointSweep,
    Method::AxisSweeps,
    Method::SwapSweep,
    Method::AxisSwapSweeps,
];

fn record<const D: usize, T: Scalar>(options: RunnerOptions, frames: &[Vec<Aabb<D, T>>]) -> Trace {
    let mut runner = Runner::new(options);
    let mut trace = Trace::new();
    for boxes in frames {
        runner.step(boxes, &mut trace).unwrap();
    }
    assert!(!trace.is_truncated());
    trace
}

/// The words, read as the layout says and as another language would.
fn walk(words: &[u32]) -> usize {
    let (mut at, mut records) = (0, 0);
    while at < words.len() {
        let (kind, length) = (words[at] & 0xff, (words[at] >> 8) as usize);
        assert!((1..=14).contains(&kind));
        assert_eq!(words[at], words[at + length - 1], "the header stands at both ends");
        at += length;
        records += 1;
    }
    assert_eq!(at, words.len());
    records
}

fn plays_both_ways<const D: usize, T: Scalar>() {
    let frames = prop::collection::vec(valid_boxes::<D, T>(7), 1..4);
    let config = ProptestConfig::with_cases(12);
    proptest!(config, |(frames in frames, persistent in any::<bool>(), axis in 0usize..4)| {
        let axis = [Axis::Fixed(0), Axis::Fixed(D - 1), Axis::LargestVariance, Axis::FewestOverlaps][axis];
        for method in METHODS {
            for sort in Sort::ALL {
                let trace = record(RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent), &frames);
                assert_eq!(walk(trace.words()), trace.len());
                let events: Vec<Event<'_>> = trace.events().collect();
                assert_eq!(events.len(), trace.len());

                let mut player = Player::new(trace.clone());
                assert_eq!(player.current(), None);
                let mut states = vec![player.state().clone()];
                for event in &events {
                    assert_eq!(player.forward().as_ref(), Some(event));
                    assert_eq!(player.current().as_ref(), Some(event));
                    states.push(player.state().clone());
                }
                assert_eq!(player.forward(), None);
                assert_eq!(player.position(), events.len());
                for (position, event) in events.iter().enumerate().rev() {
                    assert_eq!(player.backward().as_ref(), Some(event));
                    assert_eq!(player.position(), position);
                    assert_eq!(player.state(), &states[position], "undoing {event:?}");
                }
                assert_eq!(player.backward(), None);
                // To and fro.
                for position in [events.len() / 2, usize::MAX, events.len() / 3, 1, 0] {
                    player.seek(position);
                    assert_eq!(player.state(), &states[position.min(events.len())]);
                }
            }
        }
    });
}
in_all_dimensions!(a_trace_plays_forward_and_backward, plays_both_ways);

proptest! {
    /// Two observers side by side see the same events, and observing changes nothing.
    #[test]
    fn watching_changes_nothing(
        frames in prop::collection::vec(prop::collection::vec(valid_box::<2, f32>(), 8), 1..4),
    ) {
        for method in METHODS {
            for sort in Sort::ALL {
                let axis = Axis::Fixed(0);
                let options = RunnerOptions::new(method).sort(sort).axis(axis).persistent(true);
                let mut runners = [(); 3].map(|()| Runner::new(options));
                let mut alone = Trace::new();
                let mut together = (Counts::default(), Trace::new());
                for boxes in &frames {
                    let [a, b, c] = &mut runners;
                    let unseen = a.step(boxes, &mut ()).unwrap();
                    let seen = b.step(boxes, &mut alone).unwrap();
                    let twice_seen = c.step(boxes, &mut together).unwrap();
                    prop_assert_eq!(unseen.pairs, seen.pairs);
                    prop_assert_eq!(unseen.pairs, twice_seen.pairs);
                    prop_assert_eq!((unseen.begun, unseen.ended), (seen.begun, seen.ended));
                }
                prop_assert_eq!(&alone, &together.1);
            }
        }
    }
}

/// What is reported to an observer, in order.
#[derive(Default)]
struct Reported(Vec<(u32, u32, Option<Separation>)>);

impl Observer for Reported {
    fn test(&mut self, a: u32, b: u32, separation: Option<Separation>) {
        self.0.push((a, b, separation));
    }

    fn prune(&mut self, separation: Separation) {
        self.0.push((u32::MAX, u32::MAX, Some(separation)));
    }
}

proptest! {
    /// The inequality that decided comes out of the trace as it went in.
    #[test]
    fn a_trace_keeps_the_inequality_that_decided(boxes in valid_boxes::<3, f64>(12)) {
        for method in METHODS {
            let mut both = (Reported::default(), Trace::new());
            let options = on_x(method, Sort::Standard, false);
            Runner::new(options).step(&boxes, &mut both).unwrap();
            let played = both.1.events().filter_map(|event| match event {
                Event::Test { a, b, separation } => Some((a, b, separation)),
                Event::Prune { separation } => Some((u32::MAX, u32::MAX, Some(separation))),
                _ => None,
            });
            prop_assert_eq!(played.collect::<Vec<_>>(), both.0.0);
        }
    }
}

#[test]
fn a_full_trace_stops_and_says_so() {
    let boxes = Motion::Drift.start::<2, f32>(20, 1).unwrap().boxes().to_vec();
    let options = RunnerOptions::new(Method::EndpointSweep)
        .sort(Sort::Insertion)
        .axis(Axis::Fixed(0))
        .persistent(false);
    let full = record(options, std::slice::from_ref(&boxes));
    for limit in (0..full.words().len()).step_by(7) {
        let mut trace = Trace::with_limit(limit);
        Runner::new(options).step(&boxes, &mut trace).unwrap();
        assert!(trace.is_truncated() && trace.words().len() <= limit);
        assert_eq!(walk(trace.words()), trace.len());
        assert!(full.words().starts_with(trace.words()));
        trace.clear();
        assert!(trace.is_empty() && !trace.is_truncated());
    }
    let mut trace = Trace::with_limit(full.words().len());
    Runner::new(options).step(&boxes, &mut trace).unwrap();
    assert_eq!(trace, { trace.clone() });
    assert!(!trace.is_truncated());
}

// The demos, each from its events alone. Which demo needs what, and that it is there.

/// Balls (x, y, radius) of the article.
fn balls(balls: &[(f64, f64, f64)]) -> Vec<Aabb<2, f64>> {
    balls.iter().map(|&(x, y, r)| Aabb::new([x - r, y - r], [x + r, y + r])).collect()
}

fn on_x(method: Method, sort: Sort, persistent: bool) -> RunnerOptions {
    RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(0)).persistent(persistent)
}

fn tested(trace: &Trace) -> Vec<[u32; 2]> {
    let pair = |event| match event {
        Event::Test { a, b, .. } => Some([a.min(b), a.max(b)]),
        _ => None,
    };
    trace.events().filter_map(pair).collect()
}

fn end(trace: &Trace) -> PlayerState {
    let mut player = Player::new(trace.clone());
    player.seek(usize::MAX);
    player.state().clone()
}

/// The state after each event, with the event.
fn moments(trace: &Trace) -> Vec<(Event<'_>, PlayerState)> {
    let mut player = Player::new(trace.clone());
    trace
        .events()
        .map(|event| (player.forward().map(|_| event).unwrap(), player.state().clone()))
        .collect()
}

#[test]
fn d01_d05_d19_balls_and_the_tests_of_sorted_pairwise() {
    let boxes = Motion::Drift.start::<2, f64>(25, 3).unwrap().boxes().to_vec();
    let trace =
        record(on_x(Method::SortedPairwise, Sort::Standard, true), std::slice::from_ref(&boxes));
    // The early break: tested is what overlaps on x, from left to right.
    for [a, b] in tested(&trace) {
        assert!(boxes[a as usize].overlaps_on(0, &boxes[b as usize]));
    }
    let overlaps: Vec<_> = end(&trace).overlaps.into_iter().collect();
    assert_eq!(overlaps, brute_force(&boxes).unwrap());
}

#[test]
fn d02_d03_pairwise_lights_all_pairs_in_turn() {
    let boxes = Motion::Drift.start::<2, f64>(20, 3).unwrap().boxes().to_vec();
    let trace = record(on_x(Method::Pairwise, Sort::Standard, false), std::slice::from_ref(&boxes));
    let expected: Vec<_> = (0..20).flat_map(|a| (a + 1..20).map(move |b| [a, b])).collect();
    assert_eq!(tested(&trace), expected);
    assert_eq!(expected.len(), 190);
}

#[test]
fn d04_three_balls_tell_what_is_skipped_and_by_which_inequality() {
    let boxes = balls(&[(150.0, 250.0, 50.0), (300.0, 150.0, 55.0), (450.0, 275.0, 60.0)]);
    let trace =
        record(on_x(Method::SortedPairwise, Sort::Insertion, false), std::slice::from_ref(&boxes));
    let prunes: Vec<_> = trace
        .events()
        .filter_map(|event| match event {
            Event::Prune { separation } => Some(separation),
            _ => None,
        })
        .collect();
    // A.right < B.left and B.right < C.left; A-C is never looked at.
    let apart = |left, right| Separation { axis: 0, left, right };
    assert_eq!(prunes, [apart(0, 1), apart(1, 2)]);
    assert!(tested(&trace).is_empty());
    // B dragged onto A: now A-B is tested, and what ends the scan from A is C.
    let boxes = balls(&[(150.0, 250.0, 50.0), (200.0, 150.0, 55.0), (450.0, 275.0, 60.0)]);
    let trace =
        record(on_x(Method::SortedPairwise, Sort::Insertion, false), std::slice::from_ref(&boxes));
    assert_eq!(tested(&trace), [[0, 1]]);
    let overlapping = Event::Test { a: 0, b: 1, separation: None };
    assert!(trace.events().any(|event| event == overlapping));
    assert!(trace.events().any(|event| event == Event::Prune { separation: apart(0, 2) }));
}

#[test]
fn d06_d13_tests_a_frame_side_by_side() {
    let boxes = Motion::Drift.start::<2, f64>(10, 3).unwrap().boxes().to_vec();
    let of = |method| {
        let trace = record(on_x(method, Sort::Standard, true), std::slice::from_ref(&boxes));
        end(&trace).counts
    };
    assert_eq!(of(Method::Pairwise).tests, 45);
    assert!(of(Method::SortedPairwise).tests < 45);
    assert_eq!(of(Method::EndpointSweep).tests, of(Method::SortedPairwise).tests);
    // On two axes nothing is left to test but the pairs themselves.
    let two_axes = of(Method::AxisSwapSweeps);
    assert_eq!((two_axes.tests, two_axes.pairs), (0, brute_force(&boxes).unwrap().len() as u64));
}

#[test]
fn d07_the_array_of_edges_is_there_with_its_coordinates() {
    let boxes = balls(&[(300.0, 0.0, 50.0), (100.0, 0.0, 40.0)]);
    let trace =
        record(on_x(Method::EndpointSweep, Sort::Standard, false), std::slice::from_ref(&boxes));
    let array = end(&trace).arrays.remove(0);
    let shown: Vec<_> = array.iter().map(|e| (e.at, e.edge.side, e.edge.id)).collect();
    let (left, right) = (Side::Left, Side::Right);
    assert_eq!(shown, [(60.0, left, 1), (140.0, right, 1), (250.0, left, 0), (350.0, right, 0)]);
}

#[test]
fn d08_the_focused_ball_encloses_the_edges_that_are_visited() {
    let boxes =
        balls(&[(300.0, 0.0, 100.0), (210.0, 0.0, 20.0), (350.0, 0.0, 30.0), (300.0, 0.0, 200.0)]);
    let trace =
        record(on_x(Method::OneToN(0), Sort::Standard, false), std::slice::from_ref(&boxes));
    let moments = moments(&trace);
    let array = end(&trace).arrays.remove(0);
    let place = |side| array.iter().position(|e| e.edge == Edge { side, id: 0 }).unwrap();
    let visited: Vec<usize> = moments
        .iter()
        .filter_map(|(event, _)| match event {
            Event::Visit { position, .. } => Some(*position),
            _ => None,
        })
        .collect();
    assert_eq!(visited, (place(Side::Left)..=place(Side::Right)).collect::<Vec<_>>());
    // Ball 1 by its right edge, ball 2 by both, and ball 3, which encloses, not at all.
    assert_eq!(tested(&trace), [[0, 1], [0, 2]]);
}

#[test]
fn d09_d10_d11_the_line_lights_what_it_touches_and_pairs_as_it_enters() {
    let boxes = Motion::Drift.start::<2, f64>(8, 9).unwrap().boxes().to_vec();
    let trace =
        record(on_x(Method::EndpointSweep, Sort::Standard, false), std::slice::from_ref(&boxes));
    let (mut entered, mut stops) = (None, 0);
    for (event, state) in moments(&trace) {
        match event {
            Event::Visit { .. } => stops += 1,
            Event::Enter { id } => entered = Some(id),
            Event::Test { a, b, .. } => {
                assert_eq!(entered, Some(b), "as the line enters b");
                assert!(state.active.contains(&a));
            }
            _ => {}
        }
        // The highlighted boxes are those that the line touches.
        if let (Event::Enter { .. } | Event::Leave { .. }, Some((position, edge))) =
            (event, state.line)
        {
            let x = state.arrays[0][position].at;
            assert_eq!(state.arrays[0][position].edge, edge);
            let touched: BTreeSet<u32> = (0..8)
                .filter(|&id| {
                    let aabb = &boxes[id as usize];
                    (aabb.min[0] as f32..=aabb.max[0] as f32).contains(&x)
                })
                .filter(|&id| !(event == Event::Leave { id }))
                .collect();
            assert_eq!(state.active, touched);
        }
    }
    assert_eq!(stops, 16);
}

#[test]
fn d12_d18_events_of_the_swap_driven_forms() {
    let mut moving = Motion::Fast.start::<2, f64>(12, 3).unwrap();
    for method in [Method::SwapSweep, Method::AxisSwapSweeps] {
        let frames: Vec<_> = (0..20)
            .map(|_| {
                moving.advance();
                moving.boxes().to_vec()
            })
            .collect();
        let trace = record(on_x(method, Sort::Standard, true), &frames);
        let moments = moments(&trace);
        assert!(moments.iter().any(|(event, _)| matches!(event, Event::Begin { .. })));
        assert!(moments.iter().any(|(event, _)| matches!(event, Event::End { .. })));
        let held: Vec<_> = end(&trace).held.into_iter().collect();
        assert_eq!(held, brute_force(&frames[19]).unwrap());
    }
}

#[test]
fn d14_d15_comparisons_and_swaps_of_the_given_balls() {
    let start = [
        (50.0, 350.0, 50.0),
        (100.0, 300.0, 30.0),
        (150.0, 200.0, 40.0),
        (450.0, 350.0, 35.0),
        (500.0, 300.0, 30.0),
        (550.0, 300.0, 40.0),
    ];
    let mut moved = start;
    moved[2].0 -= 30.0;
    for (sort, at_most) in [(Sort::Quicksort, 60), (Sort::Insertion, 11 + 2 * 3)] {
        let options = on_x(Method::EndpointSweep, sort, true);
        let trace = record(options, &[balls(&start), balls(&moved)]);
        let mut array: Vec<Edge> = Vec::new();
        for (event, state) in moments(&trace) {
            match event {
                Event::Compare { a, b } => {
                    let stands = |edge| state.arrays[0].iter().any(|e| e.edge == edge);
                    assert!(stands(a) && stands(b));
                }
                Event::Swap { positions: [i, j], a, b } => {
                    assert_eq!([array[i], array[j]], [a, b], "where they stood");
                }
                _ => {}
            }
            array = state.arrays.first().iter().flat_map(|a| a.iter().map(|e| e.edge)).collect();
        }
        let counts = end(&trace).counts;
        assert!(counts.comparisons <= at_most && counts.swaps > 0, "{sort:?} {counts:?}");
    }
}

#[test]
fn d16_d17_each_swap_says_which_of_the_four_cases_it_is() {
    // Two intervals, and the second one's next place.
    let cases = [
        ((0.0, 2.0), (3.0, 5.0), (1.0, 5.0), "R-L", Some(true)),
        ((0.0, 2.0), (1.0, 5.0), (3.0, 5.0), "L-R", Some(false)),
        ((0.0, 9.0), (1.0, 5.0), (-1.0, 5.0), "L-L", None),
        ((0.0, 4.0), (1.0, 5.0), (1.0, 3.0), "R-R", None),
    ];
    for (still, before, after, name, begins) in cases {
        let frame = |(l, r): (f64, f64)| vec![Aabb::new([still.0], [still.1]), Aabb::new([l], [r])];
        let options = on_x(Method::SwapSweep, Sort::Standard, true);
        let trace = record(options, &[frame(before), frame(after)]);
        let events: Vec<_> = trace.events().collect();
        let second = events.iter().rposition(|e| matches!(e, Event::Step { .. })).unwrap();
        let at =
            second + events[second..].iter().position(|e| matches!(e, Event::Swap { .. })).unwrap();
        let Event::Swap { positions: [i, j], a, b } = events[at] else { unreachable!() };
        assert_eq!(j, i + 1, "neighbors");
        let letter = |edge: Edge| if edge.side == Side::Left { "L" } else { "R" };
        assert_eq!(format!("{}-{}", letter(a), letter(b)), name);
        let pair = (0, 1);
        match begins {
            Some(true) => {
                assert_eq!(events[at + 1], Event::AxisOverlap { axis: 0, a: pair.0, b: pair.1 });
            }
            Some(false) => {
                assert_eq!(events[at + 1], Event::AxisApart { axis: 0, a: pair.0, b: pair.1 });
            }
            None => assert!(!matches!(
                events[at + 1],
                Event::AxisOverlap { .. } | Event::AxisApart { .. }
            )),
        }
    }
}

#[test]
fn d20_thousands_of_spheres_are_counted_without_a_trace() {
    let boxes = Motion::Drift.start::<3, f32>(3000, 1).unwrap().boxes().to_vec();
    let counts = |method| {
        let mut counts = Counts::default();
        Runner::new(on_x(method, Sort::Standard, true)).step(&boxes, &mut counts).unwrap();
        counts
    };
    let (brute, sweep) = (counts(Method::Pairwise), counts(Method::SortedPairwise));
    assert_eq!(brute.tests, 3000 * 2999 / 2);
    assert_eq!(brute.pairs, sweep.pairs);
    assert!(sweep.tests < brute.tests / 4);
}
