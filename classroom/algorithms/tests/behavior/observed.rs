//! What an observer is told is true, and its counts are the known ones.

use proptest::prelude::*;
use sweep_and_prune::{Aabb, Scalar};
use sweep_and_prune_algorithms::{
    Axis, Counts, Edge, Endpoint, Method, Observer, Runner, RunnerOptions, Separation, Sort,
};
use sweep_and_prune_scenes::testing::valid_boxes;
use sweep_and_prune_scenes::{Scene, brute_force, in_all_dimensions};

/// Checks each thing it is told against the boxes, and counts.
struct Witness<'a, const D: usize, T> {
    boxes: &'a [Aabb<D, T>],
    /// The sort's array before its first swap, then after each.
    edges: Vec<Edge>,
    entered: Vec<u32>,
    left: Vec<u32>,
    pairs: Vec<[u32; 2]>,
    counts: Counts,
}

impl<'a, const D: usize, T: Scalar> Witness<'a, D, T> {
    fn new(boxes: &'a [Aabb<D, T>], edges: Vec<Edge>) -> Self {
        let (entered, left, pairs) = (Vec::new(), Vec::new(), Vec::new());
        Self { boxes, edges, entered, left, pairs, counts: Counts::default() }
    }

    fn boxes_of(&self, a: u32, b: u32) -> (&Aabb<D, T>, &Aabb<D, T>) {
        assert_ne!(a, b);
        (&self.boxes[a as usize], &self.boxes[b as usize])
    }

    fn check_separation(&self, Separation { axis, left, right }: Separation) {
        let (left, right) = self.boxes_of(left, right);
        assert!(left.max[axis] < right.min[axis]);
    }
}

impl<const D: usize, T: Scalar> Observer for Witness<'_, D, T> {
    fn compare(&mut self, a: Edge, b: Edge) {
        self.counts.compare(a, b);
    }

    fn swap(&mut self, positions: [usize; 2], a: Edge, b: Edge) {
        assert_eq!(positions.map(|position| self.edges[position]), [a, b]);
        self.edges.swap(positions[0], positions[1]);
        self.counts.swap(positions, a, b);
    }

    fn enter(&mut self, id: u32) {
        self.entered.push(id);
    }

    fn leave(&mut self, id: u32) {
        self.left.push(id);
    }

    fn prune(&mut self, separation: Separation) {
        self.check_separation(separation);
    }

    fn test(&mut self, a: u32, b: u32, separation: Option<Separation>) {
        let (box_a, box_b) = self.boxes_of(a, b);
        assert_eq!(separation.is_none(), box_a.overlaps(box_b));
        if let Some(found) = separation {
            assert!([[a, b], [b, a]].contains(&[found.left, found.right]));
            self.check_separation(found);
        }
        self.counts.test(a, b, separation);
    }

    fn axis_overlap(&mut self, axis: usize, a: u32, b: u32) {
        let (box_a, box_b) = self.boxes_of(a, b);
        assert!(box_a.overlaps_on(axis, box_b));
        self.counts.axis_overlap(axis, a, b);
    }

    fn overlap(&mut self, a: u32, b: u32) {
        assert!(a < b);
        let (box_a, box_b) = self.boxes_of(a, b);
        assert!(box_a.overlaps(box_b));
        self.pairs.push([a, b]);
        self.counts.overlap(a, b);
    }
}

/// The left endpoints in the order of the indices.
fn lefts<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], axis: usize) -> Vec<Endpoint<T>> {
    boxes.iter().zip(0..).map(|(aabb, id)| Endpoint::left(aabb.min[axis], id)).collect()
}

fn edges<T>(endpoints: &[Endpoint<T>]) -> Vec<Edge> {
    endpoints.iter().map(|endpoint| endpoint.edge).collect()
}

/// The number of pairs of items of which `holds` is true, by trying all.
fn count_pairs<I>(items: &[I], holds: impl Fn(&I, &I) -> bool) -> u64 {
    let pairs =
        items.iter().enumerate().flat_map(|(i, a)| items[i + 1..].iter().map(move |b| (a, b)));
    pairs.filter(|(a, b)| holds(a, b)).count() as u64
}

/// The fewest swaps that sort: the number of items less the number of cycles of the permutation
/// that takes them to their places.
fn fewest_swaps<T: Scalar>(endpoints: &[Endpoint<T>]) -> u64 {
    let place = |e: &Endpoint<T>| endpoints.iter().filter(|other| other.precedes(e)).count();
    let places: Vec<usize> = endpoints.iter().map(place).collect();
    let mut seen = vec![false; places.len()];
    let mut swaps = 0;
    for start in 0..places.len() {
        let mut at = places[start];
        while !seen[start] && at != start {
            seen[at] = true;
            at = places[at];
            swaps += 1;
        }
    }
    swaps
}

fn runner<const D: usize, T: Scalar>(method: Method, sort: Sort, axis: usize) -> Runner<D, T> {
    Runner::new(RunnerOptions::new(method).sort(sort).axis(Axis::Fixed(axis)).persistent(true))
}

fn check_pairwise<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], axis: usize) {
    let mut witness = Witness::new(boxes, Vec::new());
    let mut runner = runner(Method::Pairwise, Sort::Standard, axis);
    let pairs = runner.step(boxes, &mut witness).unwrap().pairs;
    assert_eq!(pairs, brute_force(boxes).unwrap());
    assert_eq!(witness.pairs, pairs);
    let n = boxes.len() as u64;
    let Counts { comparisons, swaps, tests, axis_overlaps, pairs: count, .. } = witness.counts;
    assert_eq!((comparisons, swaps), (0, 0));
    assert_eq!(tests, n * n.saturating_sub(1) / 2);
    assert_eq!(axis_overlaps, count_pairs(boxes, |a, b| a.overlaps_on(axis, b)));
    assert_eq!(count, pairs.len() as u64);
}

/// Sorted pairwise from the order of the indices, and then again from its own order.
fn check_sorted_pairwise<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>], axis: usize) {
    let before = lefts(boxes, axis);
    let mut in_order = before.clone();
    in_order.sort_by(Endpoint::order);
    let n = boxes.len() as u64;
    let mut same_for_all_sorts = None;
    for sort in Sort::ALL {
        let mut runner = runner(Method::SortedPairwise, sort, axis);
        let mut witness = Witness::new(boxes, edges(&before));
        let pairs = runner.step(boxes, &mut witness).unwrap().pairs.to_vec();

        // The sort: the swaps told lead to the order, which is the only one there is.
        assert_eq!(witness.edges, edges(&in_order), "{sort:?}");
        let Counts { comparisons, swaps, .. } = witness.counts;
        if sort == Sort::Insertion {
            assert_eq!(swaps, count_pairs(&before, |a, b| b.precedes(a)));
            assert!((swaps..swaps + n.max(1)).contains(&comparisons));
        } else if sort == Sort::Standard {
            assert_eq!(swaps, fewest_swaps(&before));
        }

        // The sweep: boxes in order, one test for each overlap on the axis, the same for all sorts.
        let ids: Vec<u32> = in_order.iter().map(|left| left.edge.id).collect();
        assert_eq!((&witness.entered, &witness.left), (&ids, &ids), "{sort:?}");
        let axis_overlaps = count_pairs(boxes, |a, b| a.overlaps_on(axis, b));
        assert_eq!(witness.counts.axis_overlaps, axis_overlaps);
        assert_eq!(witness.counts.tests, axis_overlaps);
        assert_eq!(witness.counts.pairs, pairs.len() as u64);
        assert_eq!(witness.pairs, pairs);
        assert_eq!(same_for_all_sorts.get_or_insert_with(|| pairs.clone()), &pairs, "{sort:?}");

        // A world at rest: nothing to swap, however many coordinates coincide.
        let mut counts = Counts::default();
        assert_eq!(runner.step(boxes, &mut counts).unwrap().pairs, pairs, "{sort:?}");
        assert_eq!(counts.swaps, 0, "{sort:?}");
        if sort == Sort::Insertion {
            assert_eq!(counts.comparisons, n.saturating_sub(1));
        }
    }
}

fn true_on_scenes<const D: usize, T: Scalar>() {
    for &scene in Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&D)) {
        for n in [0, 1, 2, 9, 80] {
            let boxes = scene.boxes::<D, T>(n, 3).unwrap();
            for axis in 0..D {
                check_pairwise(&boxes, axis);
                check_sorted_pairwise(&boxes, axis);
            }
        }
    }
}
in_all_dimensions!(what_is_told_is_true_on_every_scene, true_on_scenes);

fn true_on_random_boxes<const D: usize, T: Scalar>() {
    proptest!(|(boxes in valid_boxes::<D, T>(30), axis in 0..D)| {
        check_pairwise(&boxes, axis);
        check_sorted_pairwise(&boxes, axis);
    });
}
in_all_dimensions!(what_is_told_is_true_on_random_boxes, true_on_random_boxes);

/// Repeats the reported swaps on a copy of the array, which is then that of the sweep.
#[derive(Default)]
struct Mirror(Vec<Edge>);

impl Observer for Mirror {
    fn array<T: Scalar>(&mut self, _: usize, endpoints: &[Endpoint<T>]) {
        self.0 = edges(endpoints);
    }

    fn swap(&mut self, positions: [usize; 2], a: Edge, b: Edge) {
        assert_eq!(positions.map(|position| self.0[position]), [a, b]);
        self.0.swap(positions[0], positions[1]);
    }

    fn visit(&mut self, position: usize, edge: Edge) {
        assert_eq!(self.0[position], edge);
    }
}

/// The sweep over endpoints sorts all of them; that by swaps sorts those of new boxes behind the old ones,
/// and merges them in.
#[test]
fn every_sort_gives_the_same_order_and_reports_its_swaps() {
    let intervals = proptest::collection::vec((-3i8..4, 0i8..3), 0..100);
    proptest!(|(intervals in intervals, old in 0usize..20)| {
        let aabb = |&(min, size): &(i8, i8)| Aabb::new([f32::from(min)], [f32::from(min + size)]);
        let boxes: Vec<_> = intervals.iter().map(aabb).collect();
        let rights = boxes.iter().zip(0..).map(|(aabb, id)| Endpoint::right(aabb.max[0], id));
        let mut in_order: Vec<_> = lefts(&boxes, 0).into_iter().chain(rights).collect();
        in_order.sort_by(Endpoint::order);
        for (method, old) in [(Method::EndpointSweep, 0), (Method::SwapSweep, old.min(boxes.len()))] {
            for sort in Sort::ALL {
                let mut runner = runner(method, sort, 0);
                runner.step(&boxes[..old], &mut ()).unwrap();
                let (mut unobserved, mut mirror) = (runner.clone(), Mirror::default());
                let pairs = runner.step(&boxes, &mut mirror).unwrap().pairs;
                assert_eq!(mirror.0, edges(&in_order), "{method:?} {sort:?}");
                assert_eq!(unobserved.step(&boxes, &mut ()).unwrap().pairs, pairs, "{method:?} {sort:?}");
            }
        }
    });
}

#[test]
fn timsort_takes_a_sorted_and_a_reversed_array_in_one_pass() {
    let up: Vec<_> = (0..1000).map(|i| Aabb::new([i as f32], [i as f32])).collect();
    let down: Vec<_> = up.iter().rev().copied().collect();
    for boxes in [up, down] {
        let mut counts = Counts::default();
        runner(Method::SortedPairwise, Sort::Timsort, 0).step(&boxes, &mut counts).unwrap();
        assert_eq!(counts.comparisons, 999);
    }
}

fn counts_of(scene: Scene, n: usize, sort: Sort) -> Counts {
    let boxes = scene.boxes::<2, f64>(n, 1).unwrap();
    let mut counts = Counts::default();
    runner(Method::SortedPairwise, sort, 0).step(&boxes, &mut counts).unwrap();
    counts
}

#[test]
fn insertion_sort_costs_its_inversions() {
    let n = 400;
    let swaps = |scene| counts_of(scene, n as usize, Sort::Insertion).swaps;
    assert_eq!(swaps(Scene::Sorted), 0);
    assert_eq!(swaps(Scene::Coincident), 0);
    assert_eq!(swaps(Scene::Reversed), n * (n - 1) / 2);
    assert!((1..=n / 10).contains(&swaps(Scene::NearlySorted)));
}

/// Sorted and reversed input, one value for all, and every other scene: nothing known makes these
/// sorts quadratic.
#[test]
fn the_other_sorts_stay_n_log_n() {
    let n_log_n = 1024 * 10;
    for &scene in Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&2)) {
        for sort in Sort::ALL.into_iter().filter(|sort| *sort != Sort::Insertion) {
            let comparisons = counts_of(scene, 1024, sort).comparisons;
            assert!(comparisons < 2 * n_log_n, "{}: {sort:?} {comparisons}", scene.name());
        }
    }
}
