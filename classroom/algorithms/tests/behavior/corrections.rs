//! What the texts that this project grew from get wrong, each as a test named after what it
//! guards. Where the error is an algorithm's, the wrong version stands here too, and fails.

use std::collections::BTreeSet;

use sweep_and_prune::{Aabb, Error as BoxError};
use sweep_and_prune_algorithms::{
    Axis, Counts, Edge, Endpoint, Error, Method, Observer, Runner, RunnerOptions, Side, Sort,
};
use sweep_and_prune_scenes::{Scene, brute_force};

type Box1 = Aabb<1, f64>;
type Box2 = Aabb<2, f64>;

fn interval(left: f64, right: f64) -> Box1 {
    Aabb::new([left], [right])
}

fn square(x: f64, y: f64, half: f64) -> Box2 {
    Aabb::new([x - half, y - half], [x + half, y + half])
}

fn runner<const D: usize>(method: Method, sort: Sort) -> Runner<D, f64> {
    Runner::new(RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(0)).persistent(true))
}

fn count<const D: usize>(runner: &mut Runner<D, f64>, boxes: &[Aabb<D, f64>]) -> Counts {
    let mut counts = Counts::default();
    runner.step(boxes, &mut counts).unwrap();
    counts
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// The persistent forms that keep overlaps.
const SWAP_DRIVEN: [Method; 2] = [Method::SwapSweep, Method::AxisSwapSweeps];

// 1. A caption says "12 balls = 66 pairs" under ten balls. (The captions themselves are computed
// from the number of balls; that is the site's to test.)
#[test]
fn correction_01_ten_balls_are_45_pairs_and_twelve_are_66() {
    for (n, pairs) in [(5, 10), (10, 45), (12, 66), (15, 105), (20, 190)] {
        let boxes = Scene::Uniform.boxes::<2, f64>(n, 1).unwrap();
        let counts = count(&mut runner(Method::Pairwise, Sort::Standard), &boxes);
        assert_eq!(counts.tests, pairs, "{n} balls");
    }
}

// 2. The table says O(n) at best for sweep and prune with quicksort.
#[test]
fn correction_02_sweep_and_prune_with_quicksort_is_n_log_n_at_best() {
    // The easiest world there is: disjoint, in order, at rest.
    let comparisons_a_box = |log: u32| {
        let boxes: Vec<_> = (0..1 << log).map(|i| interval(f64::from(i), f64::from(i))).collect();
        let mut runner = runner(Method::EndpointSweep, Sort::Quicksort);
        runner.step(&boxes, &mut ()).unwrap();
        count(&mut runner, &boxes).comparisons as f64 / boxes.len() as f64
    };
    // Two endpoints a box, so two comparisons more each time that n doubles.
    for log in [6, 8, 10, 12] {
        let growth = comparisons_a_box(log + 1) - comparisons_a_box(log);
        assert!((1.5..2.5).contains(&growth), "{growth} at n = 2^{log}");
    }
}

// 3. `m` in the running times is called the number of collisions.
#[test]
fn correction_03_tests_grow_with_overlaps_on_the_axis_not_with_collisions() {
    // A stack of flat plates, swept from the side.
    let n = 100;
    let plates: Vec<_> =
        (0..n).map(|i| Aabb::new([0.0, f64::from(2 * i)], [1.0, f64::from(2 * i + 1)])).collect();
    let all = (n * (n - 1) / 2) as u64;
    for method in [Method::SortedPairwise, Method::EndpointSweep, Method::SwapSweep] {
        let counts = count(&mut runner(method, Sort::Standard), &plates);
        assert_eq!((counts.tests, counts.axis_overlaps, counts.pairs), (all, all, 0), "{method:?}");
    }
}

// 4. The published table leaves out insertion sort's worst case.
#[test]
fn correction_04_insertion_sort_swaps_once_an_inversion_from_none_to_a_full_reversal() {
    let n = 50u64;
    let world: Vec<_> = (0..n).map(|i| interval(2.0 * i as f64, 2.0 * i as f64 + 1.0)).collect();
    let mirrored: Vec<_> = world.iter().map(|b| interval(-b.max[0], -b.min[0])).collect();
    for method in [Method::EndpointSweep, Method::SwapSweep] {
        let mut runner = runner(method, Sort::Insertion);
        runner.step(&world, &mut ()).unwrap();
        assert_eq!(count(&mut runner, &world).swaps, 0, "at rest");
        // 2n endpoints in reverse are n(2n - 1) inversions; but each box's own two never change
        // places, so a world can reach n fewer.
        assert_eq!(count(&mut runner, &mirrored).swaps, n * (2 * n - 1) - n);
    }
    let mut runner = runner(Method::SortedPairwise, Sort::Insertion);
    runner.step(&world, &mut ()).unwrap();
    assert_eq!(count(&mut runner, &mirrored).swaps, n * (n - 1) / 2);
}

// 5. The table gives O(1) space to what sorts; and the listing sorts the caller's array.
#[test]
fn correction_05_what_sorts_takes_memory_and_leaves_the_callers_boxes_alone() {
    let boxes = Scene::Reversed.boxes::<2, f64>(1000, 1).unwrap();
    let before = boxes.clone();
    for method in Method::ALL {
        for sort in Sort::ALL {
            let mut runner = runner(method, sort);
            runner.step(&boxes, &mut ()).unwrap();
            let linear = if method == Method::Pairwise { 0 } else { 1000 * 16 };
            assert!(runner.bytes() >= linear, "{method:?}: {} bytes", runner.bytes());
        }
    }
    assert_eq!(boxes, before);
}

// 6. The break negates the second operand of the test, with `>` there and `<` here: with open and
// closed intervals mixed, each variant says something else about boxes that touch.
#[test]
fn correction_06_touching_boxes_overlap_in_every_variant() {
    let boxes = [
        square(0.0, 0.0, 1.0),
        square(2.0, 0.0, 1.0),  // shares a side with 0
        square(2.0, 2.0, 1.0),  // a corner with 0, a side with 1
        square(-1.0, 1.0, 0.0), // a point: the corner of 0
        square(9.0, 0.0, 1.0),
    ];
    let expected = [[0, 1], [0, 2], [0, 3], [1, 2]];
    assert_eq!(brute_force(&boxes).unwrap(), expected);
    for method in Method::ALL {
        for sort in Sort::ALL {
            for axis in [0, 1] {
                let axis = Axis::Fixed(axis);
                for persistent in [false, true] {
                    let options =
                        RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent);
                    let mut runner = Runner::new(options);
                    let pairs = runner.step(&boxes, &mut ()).unwrap().pairs;
                    assert_eq!(sorted(pairs), expected, "{options:?}");
                }
            }
        }
    }
    // As published: open in the test, closed in the break. The neighbors reach the test, which
    // says no; the sweep over endpoints, with ties as they come, may say yes.
    let open = |a: &Box2, b: &Box2| a.min[0] < b.max[0] && a.max[0] > b.min[0];
    assert!(!open(&boxes[0], &boxes[1]) && boxes[0].overlaps(&boxes[1]));
}

// 7. "A.right > B.left" holding for A-B and for B-C says nothing about A-C.
#[test]
fn correction_07_only_the_failures_of_the_test_carry_over() {
    let intervals: Vec<_> =
        (0..4).flat_map(|l| (l..4).map(move |r| interval(f64::from(l), f64::from(r)))).collect();
    let reaches = |a: &Box1, b: &Box1| a.max[0] >= b.min[0];
    let mut successes_that_do_not_carry_over = 0;
    for a in &intervals {
        for b in &intervals {
            for c in &intervals {
                if !reaches(a, b) && !reaches(b, c) {
                    assert!(!reaches(a, c) && !a.overlaps(c));
                }
                // What the break relies on: c is no further left than b.
                if !reaches(a, b) && b.min[0] <= c.min[0] {
                    assert!(!a.overlaps(c));
                }
                if reaches(a, b) && reaches(b, c) && !reaches(a, c) {
                    successes_that_do_not_carry_over += 1;
                }
            }
        }
    }
    assert!(successes_that_do_not_carry_over > 0);
}

/// The final form as published: plain insertion sort of the endpoints as they stand, `<` to break,
/// swaps toggle the pairs. What it has in `overlapping` at the start, it believes.
fn published_final_form(
    edges: &mut [Endpoint<f64>],
    overlapping: &mut BTreeSet<[u32; 2]>,
) -> usize {
    let mut swaps = 0;
    for i in 1..edges.len() {
        for j in (0..i).rev() {
            if edges[j].at < edges[j + 1].at {
                break;
            }
            edges.swap(j, j + 1);
            swaps += 1;
            let (first, second) = (edges[j].edge, edges[j + 1].edge);
            let key = [first.id.min(second.id), first.id.max(second.id)];
            match (first.side, second.side) {
                (Side::Left, Side::Right) => drop(overlapping.insert(key)),
                (Side::Right, Side::Left) => drop(overlapping.remove(&key)),
                _ => {}
            }
        }
    }
    swaps
}

fn endpoints(boxes: &[Box1]) -> Vec<Endpoint<f64>> {
    let both =
        |(b, id): (&Box1, u32)| [Endpoint::left(b.min[0], id), Endpoint::right(b.max[0], id)];
    boxes.iter().zip(0..).flat_map(both).collect()
}

// 8. The listing of the swap-driven form does not say where it starts.
#[test]
fn correction_08_the_swap_driven_form_started_on_overlapping_boxes_loses_none() {
    let boxes = [interval(0.0, 4.0), interval(1.0, 5.0), interval(2.0, 3.0), interval(4.5, 6.0)];
    let expected = [[0, 1], [0, 2], [1, 2], [1, 3]];
    for method in SWAP_DRIVEN {
        let mut runner = runner(method, Sort::Standard);
        let step = runner.step(&boxes, &mut ()).unwrap();
        assert_eq!((step.pairs, step.begun), (&expected[..], &expected[..]));
        // And each can end.
        let apart = [0.0, 10.0, 20.0, 30.0].map(|at| interval(at, at));
        assert_eq!(runner.step(&apart, &mut ()).unwrap().ended, expected);
    }
    // Sorted first, the published form never sees a swap, so never a pair.
    let mut edges = endpoints(&boxes);
    edges.sort_by(Endpoint::order);
    let mut overlapping = BTreeSet::new();
    published_final_form(&mut edges, &mut overlapping);
    assert!(overlapping.is_empty());
}

// 9. With a strict `<`, equal coordinates change places in every frame.
#[test]
fn correction_09_touching_boxes_at_rest_produce_no_events_for_1000_steps() {
    let row: Vec<_> = (0..20).map(|i| interval(f64::from(i), f64::from(i + 1))).collect();
    for method in SWAP_DRIVEN {
        let mut runner = runner(method, Sort::Standard);
        let pairs = runner.step(&row, &mut ()).unwrap().pairs.to_vec();
        assert_eq!(pairs.len(), 19);
        for _ in 0..1000 {
            let mut counts = Counts::default();
            let step = runner.step(&row, &mut counts).unwrap();
            assert_eq!(step.pairs, pairs);
            assert!(step.begun.is_empty() && step.ended.is_empty());
            assert_eq!((counts.swaps, counts.axis_overlaps, counts.axis_ends), (0, 0, 0));
        }
    }
    // As published, two touching boxes flicker.
    let (mut edges, mut overlapping) = (endpoints(&row[..2]), BTreeSet::new());
    let frames: Vec<usize> = (0..4)
        .map(|_| {
            published_final_form(&mut edges, &mut overlapping);
            overlapping.len()
        })
        .collect();
    assert_eq!(frames, [1, 0, 1, 0]);
}

#[test]
fn correction_09_coincident_boxes_cost_no_swaps_when_nothing_moves() {
    let n = 30;
    let same = vec![interval(1.0, 2.0); n];
    for method in Method::ALL {
        for sort in Sort::ALL {
            let mut runner = runner(method, sort);
            runner.step(&same, &mut ()).unwrap();
            assert_eq!(count(&mut runner, &same).swaps, 0, "{method:?} {sort:?}");
        }
    }
    // As published, in every frame each left end passes all the others, and each right end.
    let (mut edges, mut overlapping) = (endpoints(&same), BTreeSet::new());
    published_final_form(&mut edges, &mut overlapping);
    for _ in 0..3 {
        assert_eq!(published_final_form(&mut edges, &mut overlapping), n * (n - 1));
    }
}

#[test]
fn correction_09_a_box_without_width_does_not_pair_with_itself() {
    let point = [interval(1.0, 1.0)];
    for method in Method::ALL {
        let mut runner = runner(method, Sort::Insertion);
        for _ in 0..3 {
            assert!(runner.step(&point, &mut ()).unwrap().pairs.is_empty(), "{method:?}");
        }
    }
    // As published, its right end passes its left one, and later comes back.
    let (mut edges, mut overlapping) = (endpoints(&point), BTreeSet::new());
    published_final_form(&mut edges, &mut overlapping);
    published_final_form(&mut edges, &mut overlapping);
    assert_eq!(overlapping, BTreeSet::from([[0, 0]]));
}

#[test]
fn correction_09_ties_added_in_any_order_give_the_same_pairs() {
    // Three boxes that meet at 1: one ends there, one is a point there, one begins there.
    let boxes = [interval(0.0, 1.0), interval(1.0, 1.0), interval(1.0, 2.0)];
    let somewhere = [interval(5.0, 6.0), interval(7.0, 8.0), interval(9.0, 10.0)];
    for method in Method::ALL {
        for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
            let mut runner = runner(method, Sort::Insertion);
            let mut now = somewhere;
            runner.step(&now, &mut ()).unwrap();
            for id in order {
                now[id] = boxes[id];
                let pairs = sorted(runner.step(&now, &mut ()).unwrap().pairs);
                assert_eq!(pairs, brute_force(&now).unwrap(), "{method:?} {order:?}");
            }
        }
    }
}

// 10. A NaN stops the break and the sort.
#[test]
fn correction_10_nan_is_refused_before_any_work() {
    let nan = f64::NAN;
    let boxes = Scene::Uniform.boxes::<2, f64>(10, 1).unwrap();
    for method in Method::ALL {
        for index in 0..10 {
            for axis in 0..2 {
                let mut bad = boxes.clone();
                bad[index].min[axis] = nan;
                let error = runner(method, Sort::Insertion).step(&bad, &mut ()).unwrap_err();
                let [min, max] = [nan, bad[index].max[axis]].map(Into::into);
                assert_eq!(
                    error,
                    Error::Boxes(BoxError::InvalidBox { set: 0, index, axis, min, max }),
                    "{method:?}"
                );
            }
        }
    }
    // Let in, it passes everything in every frame: a world at rest that never comes to rest.
    let mut edges = [0.0, 1.0, 2.0, nan].map(|at| Endpoint::left(at, 0));
    for _ in 0..5 {
        assert_eq!(published_final_form(&mut edges, &mut BTreeSet::new()), 3);
    }
}

// 11. `key(a, b)` is not said to be symmetric, and the pair changes sides.
#[test]
fn correction_11_a_pair_has_one_key_from_whichever_side_it_is_met() {
    for [still, flying] in [[0, 1], [1, 0]] {
        for method in SWAP_DRIVEN {
            let mut runner = runner(method, Sort::Standard);
            let mut boxes = [interval(0.0, 1.0); 2];
            let mut events = Vec::new();
            // Comes from the left, leaves to the right, and comes back.
            for at in [-5.0, 0.5, 5.0, 0.5, -5.0] {
                boxes[flying] = interval(at, at + 1.0);
                boxes[still] = interval(0.0, 1.0);
                let step = runner.step(&boxes, &mut ()).unwrap();
                events.push((step.begun.to_vec(), step.ended.to_vec(), step.pairs.to_vec()));
            }
            let (pair, none) = (vec![[0, 1]], vec![]);
            let begins = (pair.clone(), none.clone(), pair.clone());
            let ends = (none.clone(), pair, none.clone());
            let nothing = (none.clone(), none.clone(), none);
            assert_eq!(events, [nothing, begins.clone(), ends.clone(), begins, ends]);
        }
    }
}

/// Counts the swaps of endpoints of one box.
struct SwapsOf(u32, u64);

impl Observer for SwapsOf {
    fn swap(&mut self, _: [usize; 2], a: Edge, b: Edge) {
        self.1 += u64::from(a.id == self.0 || b.id == self.0);
    }
}

// 12. One body that jumps past k others costs up to 4k swaps, and no pair comes of it.
#[test]
fn correction_12_a_teleport_past_k_bodies_reports_no_pair_that_did_not_last() {
    let k = 25u32;
    let mut boxes: Vec<_> =
        (1..=k).map(|i| interval(f64::from(4 * i), f64::from(4 * i + 1))).collect();
    boxes.push(interval(0.0, 1.0));
    for method in SWAP_DRIVEN {
        let mut runner = runner(method, Sort::Standard);
        assert!(runner.step(&boxes, &mut ()).unwrap().pairs.is_empty());
        let mut there = boxes.clone();
        // Past all but the last, which it hits.
        there[k as usize] = interval(f64::from(4 * k) - 0.5, f64::from(4 * k) + 0.5);
        let mut watch = (SwapsOf(k, 0), Counts::default());
        let step = runner.step(&there, &mut watch).unwrap();
        assert_eq!((step.begun, step.ended.len()), (&[[k - 1, k]][..], 0));
        let passed = u64::from(k - 1);
        assert_eq!(watch.0.1, 4 * passed + 1);
        assert_eq!(watch.1.axis_overlaps, passed + 1, "each was met");
        assert_eq!(watch.1.axis_ends, passed, "and left");
        let step = runner.step(&boxes, &mut ()).unwrap();
        assert_eq!((step.begun.len(), step.ended), (0, &[[k - 1, k]][..]));
    }
}

// 13. The one-to-n scan misses what encloses its ball; the demo focuses the largest one.
#[test]
fn correction_13_one_to_n_really_misses_the_enclosing_box() {
    let boxes = [square(0.0, 0.0, 1.0), square(0.5, 0.0, 5.0), square(1.5, 0.0, 1.0)];
    let scan = |focus| {
        let mut runner = runner(Method::OneToN(focus), Sort::Standard);
        sorted(runner.step(&boxes, &mut ()).unwrap().pairs)
    };
    assert_eq!(brute_force(&boxes).unwrap(), [[0, 1], [0, 2], [1, 2]]);
    assert_eq!(scan(0), [[0, 2]], "box 1 begins before box 0 and ends after it");
    assert_eq!(scan(1), [[0, 1], [1, 2]], "the largest sees all");
}

// 14. To bounce while sweeping moves what is being swept. Here the boxes are borrowed for as long
// as a step lasts, so that they cannot be moved. An algorithm that moves them while it sweeps does
// lose pairs. (A test of the simulation shows that it resolves contacts after it has collected them.)
#[test]
fn correction_14_pairs_are_collected_before_anything_moves() {
    let boxes = [interval(0.0, 3.0), interval(1.0, 4.0), interval(2.0, 5.0)];
    let pairs =
        sorted(runner(Method::SortedPairwise, Sort::Standard).step(&boxes, &mut ()).unwrap().pairs);
    assert_eq!(pairs, [[0, 1], [0, 2], [1, 2]]);

    let mut moving = boxes;
    let mut found = Vec::new();
    for a in 0..3 {
        for b in a + 1..3 {
            if moving[b].min[0] > moving[a].max[0] {
                break;
            }
            found.push([a, b]);
            // Push the two apart at once.
            moving[a] = interval(moving[a].min[0] - 2.0, moving[a].max[0] - 2.0);
            moving[b] = interval(moving[b].min[0] + 2.0, moving[b].max[0] + 2.0);
        }
    }
    assert_ne!(found, [[0, 1], [0, 2], [1, 2]], "a pair was lost on the way");
}

// 15. Bodies do not bounce "exactly when they collide": fast ones pass through each other between
// two steps. Boxes swept over the step find them.
#[test]
fn correction_15_fast_bodies_tunnel_and_swept_boxes_do_not() {
    let before = [interval(0.0, 1.0), interval(5.0, 6.0)];
    let after = [interval(10.0, 11.0), interval(-5.0, -4.0)];
    for method in Method::ALL {
        let mut runner = runner(method, Sort::Standard);
        for boxes in [&before, &after] {
            assert!(runner.step(boxes, &mut ()).unwrap().pairs.is_empty());
        }
        let swept = [0, 1].map(|i: usize| {
            let (b, a) = (before[i], after[i]);
            interval(b.min[0].min(a.min[0]), b.max[0].max(a.max[0]))
        });
        assert_eq!(runner.step(&swept, &mut ()).unwrap().pairs, [[0, 1]]);
    }
}

// 16. The article's script sorts by center and breaks on edges.
#[test]
fn correction_16_sorting_by_center_really_misses_overlaps() {
    // By center: the small ball, the middle one, the large one that reaches back over both.
    let boxes = [square(0.0, 0.0, 1.0), square(3.0, 0.0, 1.0), square(4.0, 0.0, 4.0)];
    let mut by_center: Vec<u32> = vec![0, 1, 2];
    by_center.sort_by(|&a, &b| {
        let center = |id: u32| boxes[id as usize].min[0] + boxes[id as usize].max[0];
        center(a).total_cmp(&center(b))
    });
    let mut found = Vec::new();
    for (i, &a) in by_center.iter().enumerate() {
        for &b in &by_center[i + 1..] {
            if boxes[b as usize].min[0] > boxes[a as usize].max[0] {
                break;
            }
            if boxes[a as usize].overlaps(&boxes[b as usize]) {
                found.push([a.min(b), a.max(b)]);
            }
        }
    }
    assert_eq!(found, [[1, 2]], "the break at box 1 hides box 2 from box 0");
    let mut runner = runner(Method::SortedPairwise, Sort::Standard);
    assert_eq!(sorted(runner.step(&boxes, &mut ()).unwrap().pairs), [[0, 2], [1, 2]]);
}

// 17. Müller's count for the sweep leaves out the candidates that are rejected on y; the one for
// brute force does not.
#[test]
fn correction_17_the_same_thing_is_counted_for_every_method() {
    // Side by side in a row, and the same above it: half of the candidates fail on y.
    let boxes: Vec<_> =
        (0..20).map(|i| square(f64::from(i / 2), f64::from(i % 2 * 9), 0.4)).collect();
    let mut counts = Method::ALL.map(|method| count(&mut runner(method, Sort::Standard), &boxes));
    let [brute, sorted, endpoint, _, swaps, _] = &mut counts;
    assert_eq!(brute.tests, 190);
    for one_axis in [sorted, endpoint, swaps] {
        assert_eq!((one_axis.tests, one_axis.axis_overlaps, one_axis.pairs), (10, 10, 0));
    }
}

// 18. The "falling spheres" do not fall, and are discs. A test of the simulation
// shows that its spheres fall; here every method works in three dimensions as in two.
#[test]
fn correction_18_spheres_are_in_three_dimensions() {
    // A tetrahedron of touching unit boxes, one axis each, and one that only z keeps apart.
    let at = |x, y, z| Aabb::new([x, y, z], [x + 1.0, y + 1.0, z + 1.0]);
    let boxes = [
        at(0.0, 0.0, 0.0),
        at(1.0, 0.0, 0.0),
        at(0.0, 1.0, 0.0),
        at(0.0, 0.0, 1.0),
        at(0.0, 0.0, 2.5),
    ];
    let expected = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
    for method in Method::ALL {
        for axis in 0..3 {
            let axis = Axis::Fixed(axis);
            let options = RunnerOptions::new(method).sort(Sort::Merge).axis(axis).persistent(true);
            let mut runner = Runner::<3, f64>::new(options);
            assert_eq!(sorted(runner.step(&boxes, &mut ()).unwrap().pairs), expected);
        }
    }
}
