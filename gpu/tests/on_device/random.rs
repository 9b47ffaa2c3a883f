//! Random boxes on few distinct coordinates against brute force: many small worlds in one call, filters, two sets and
//! invalid boxes.

use crate::support::{core_pairs, finder, numbers, setting, upload};
use sweep_and_prune::Aabb;
use sweep_and_prune_gpu::PairFinder;
use sweep_and_prune_scenes::Random;

/// How many random scenes each test has; `GPU_SCENES` sets another number.
fn scenes() -> usize {
    setting("GPU_SCENES", 1000)
}

/// Scenes that one call searches, each in a world of its own.
const WORLDS: usize = 1000;

/// Few values, so that ties are common: both zeros, infinities, subnormal numbers, neighbors and the limits.
const COORDINATES: [f32; 16] = [
    f32::NEG_INFINITY,
    f32::MIN,
    -1.0,
    -1e-45,
    -0.0,
    0.0,
    1e-45,
    3e-45,
    f32::MIN_POSITIVE,
    1.0,
    1.0 + f32::EPSILON,
    2.0,
    3.0,
    4.0,
    f32::MAX,
    f32::INFINITY,
];

/// Whether a scene has boxes that are NaN or inverted.
#[derive(Clone, Copy, PartialEq)]
enum Validity {
    Valid,
    SomeInvalid,
}

fn random_box<const D: usize>(random: &mut Random, validity: Validity) -> Aabb<D, f32> {
    let mut aabb = Aabb::new([0.0; D], [0.0; D]);
    let is_invalid = validity == Validity::SomeInvalid && random.below(6) == 0;
    for axis in 0..D {
        let a = COORDINATES[random.below(COORDINATES.len())];
        let b = COORDINATES[random.below(COORDINATES.len())];
        (aabb.min[axis], aabb.max[axis]) = match random.below(4) {
            0 => (a, a),
            _ => (a.min(b), a.max(b)),
        };
    }
    if is_invalid {
        let axis = random.below(D);
        (aabb.min[axis], aabb.max[axis]) = match random.below(4) {
            0 => (f32::NAN, 1.0),
            1 => (-1.0, -f32::NAN),
            2 => (f32::NAN, f32::NAN),
            _ => (2.0, 1.0),
        };
    }
    aabb
}

/// A batch of scenes: all their boxes, and for each box the world, the category and the mask.
struct Batch<const D: usize> {
    boxes: Vec<Aabb<D, f32>>,
    worlds: Vec<u32>,
    filters: Vec<[u32; 2]>,
}

fn batch<const D: usize>(random: &mut Random, validity: Validity) -> Batch<D> {
    let mut batch = Batch { boxes: Vec::new(), worlds: Vec::new(), filters: Vec::new() };
    for world in 0..WORLDS {
        for _ in 0..random.below(24) {
            batch.boxes.push(random_box(random, validity));
            // Worlds may have any number.
            batch.worlds.push((world as u32).wrapping_mul(0x9e37_79b1) >> 1);
            batch.filters.push([1 << random.below(3), random.below(8) as u32]);
        }
    }
    // Boxes of one world need not be neighbors.
    let mut order: Vec<usize> = (0..batch.boxes.len()).collect();
    random.shuffle(&mut order);
    Batch {
        boxes: order.iter().map(|&i| batch.boxes[i]).collect(),
        worlds: order.iter().map(|&i| batch.worlds[i]).collect(),
        filters: order.iter().map(|&i| batch.filters[i]).collect(),
    }
}

impl<const D: usize> Batch<D> {
    /// The indices of the boxes of each world.
    fn by_world(&self) -> std::collections::HashMap<u32, Vec<usize>> {
        let mut by_world: std::collections::HashMap<u32, Vec<usize>> = Default::default();
        for (i, &world) in self.worlds.iter().enumerate() {
            by_world.entry(world).or_default().push(i);
        }
        by_world
    }

    /// Whether a box of this batch pairs with one of another, but for their worlds.
    fn pairs(&self, a: usize, other: &Self, b: usize, filtered: bool) -> bool {
        let ([category, mask], [other_category, other_mask]) = (self.filters[a], other.filters[b]);
        let allowed = category & other_mask != 0 && other_category & mask != 0;
        self.boxes[a].is_valid()
            && other.boxes[b].is_valid()
            && self.boxes[a].overlaps(&other.boxes[b])
            && (allowed || !filtered)
    }

    fn upload(&self, filtered: bool) -> sweep_and_prune_gpu::Boxes<D> {
        let boxes = upload(&self.boxes).worlds(&numbers(&self.worlds));
        if filtered { boxes.filters(&numbers(self.filters.as_flattened())) } else { boxes }
    }

    /// All pairs, by brute force within each world.
    fn expected(&self, filtered: bool) -> Vec<[u32; 2]> {
        let mut pairs = Vec::new();
        for world in self.by_world().values() {
            for (at, &a) in world.iter().enumerate() {
                for &b in &world[at + 1..] {
                    if self.pairs(a, self, b, filtered) {
                        pairs.push([a as u32, b as u32]);
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    /// All pairs with another batch, by brute force within each world.
    fn expected_between(&self, other: &Self, filtered: bool) -> Vec<[u32; 2]> {
        let (worlds, others) = (self.by_world(), other.by_world());
        let mut pairs = Vec::new();
        for (number, world) in &worlds {
            for &a in world {
                for &b in others.get(number).into_iter().flatten() {
                    if self.pairs(a, other, b, filtered) {
                        pairs.push([a as u32, b as u32]);
                    }
                }
            }
        }
        pairs.sort_unstable();
        pairs
    }

    fn invalid(&self) -> (u32, Option<usize>) {
        let invalid = |aabb: &Aabb<D, f32>| !aabb.is_valid();
        let count = self.boxes.iter().filter(|aabb| invalid(aabb)).count();
        (count as u32, self.boxes.iter().position(invalid))
    }
}

fn check_batches<const D: usize>(seed: u64) {
    let mut random = Random::new(seed);
    let mut finder = finder::<D>();
    for number in 0..scenes().div_ceil(WORLDS) {
        let validity = if number % 2 == 0 { Validity::Valid } else { Validity::SomeInvalid };
        let filtered = number % 4 < 2;
        check_one_set(&mut finder, &batch(&mut random, validity), filtered);
        let (first, second) = (batch(&mut random, validity), batch(&mut random, validity));
        let found = finder.find_between(&first.upload(filtered), &second.upload(filtered)).unwrap();
        let summary = found.summary();
        assert!(found.read().unwrap() == first.expected_between(&second, filtered));
        let ((a, first_a), (b, first_b)) = (first.invalid(), second.invalid());
        let first_invalid = first_a.or(first_b.map(|index| first.boxes.len() + index));
        assert_eq!(summary.invalid, a + b);
        assert_eq!(summary.first_invalid, first_invalid.unwrap_or(0) as u32);
    }
}

fn check_one_set<const D: usize>(finder: &mut PairFinder<D>, batch: &Batch<D>, filtered: bool) {
    let found = finder.find(&batch.upload(filtered)).unwrap();
    let summary = found.summary();
    assert!(found.read().unwrap() == batch.expected(filtered));
    let (invalid, first) = batch.invalid();
    assert_eq!(summary.invalid, invalid);
    assert_eq!(summary.first_invalid, first.unwrap_or(0) as u32);
}

#[test]
fn random_scenes_in_2d_have_the_pairs_of_brute_force() {
    check_batches::<2>(1);
}

#[test]
fn random_scenes_in_3d_have_the_pairs_of_brute_force() {
    check_batches::<3>(2);
}

#[test]
fn one_world_of_few_coordinates_has_the_pairs_of_the_core() {
    let mut random = Random::new(3);
    let mut finder = finder::<3>();
    for count in [2, 3, 7, 8, 9, 63, 64, 65, 255, 256, 257, 1100] {
        let boxes: Vec<_> =
            (0..count).map(|_| random_box::<3>(&mut random, Validity::Valid)).collect();
        let found = finder.find(&upload(&boxes)).unwrap().read().unwrap();
        assert!(found == core_pairs(&boxes), "{count} boxes");
    }
}

#[test]
fn filters_of_one_set_alone_apply() {
    let mut random = Random::new(4);
    let mut finder = finder::<2>();
    let (mut first, second) =
        (batch::<2>(&mut random, Validity::Valid), batch::<2>(&mut random, Validity::Valid));
    let found = finder.find_between(&first.upload(true), &second.upload(false)).unwrap();
    let found = found.read().unwrap();
    // A set without filters pairs with every category and has every category.
    let open = Batch { filters: vec![[u32::MAX; 2]; second.boxes.len()], ..second };
    assert!(found == first.expected_between(&open, true));
    // Mask 0 pairs with nothing.
    first.filters.fill([u32::MAX, 0]);
    assert!(finder.find(&first.upload(true)).unwrap().is_empty());
}

#[test]
fn a_world_of_2_to_the_31_is_invalid() {
    let mut finder = finder::<2>();
    let boxes = upload(&[Aabb::new([0.0; 2], [1.0; 2]); 4]);
    let found = finder
        .find(&boxes.worlds(&numbers(&[u32::MAX >> 1, 1 << 31, u32::MAX, u32::MAX >> 1])))
        .unwrap();
    assert_eq!((found.summary().invalid, found.summary().first_invalid), (2, 1));
    assert_eq!(found.read().unwrap(), [[0, 3]]);
}
