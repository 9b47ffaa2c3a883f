//! The work of inputs that are hard on trees and grids: tests of nodes and boxes, for each box and pair, against uniform
//! boxes. `GPU_BOXES` sets the number of boxes.

use crate::support::{finder, setting, upload};
use sweep_and_prune::{Aabb, count_pairs, find_pairs_between};
use sweep_and_prune_gpu::PairFinder;
use sweep_and_prune_scenes::{Random, Scene};

type Box3 = Aabb<3, f32>;

fn boxes() -> usize {
    setting("GPU_BOXES", 6000)
}

/// A box by its center and its half sizes.
fn around(center: [f64; 3], half: [f64; 3]) -> Box3 {
    Aabb::from_center(center.map(|at| at as f32), half.map(|at| at as f32))
}

/// Tests for each box and pair of one set or two.
fn work(finder: &mut PairFinder<3>, sets: &[&[Box3]]) -> f64 {
    let uploaded: Vec<_> = sets.iter().map(|set| upload(set)).collect();
    let tests = finder.count_tests(&uploaded.iter().collect::<Vec<_>>()).unwrap();
    let count: usize = sets.iter().map(|set| set.len()).sum();
    let pairs = match sets {
        [first, second] => find_pairs_between(first, second).unwrap().len(),
        _ => count_pairs(sets[0]).unwrap() as usize,
    };
    tests.into_iter().map(u64::from).sum::<u64>() as f64 / (count + pairs) as f64
}

fn check(name: &str, sets: &[&[Box3]]) {
    check_within(10.0, name, sets);
}

fn check_within(most: f64, name: &str, sets: &[&[Box3]]) {
    let uniform = Scene::Uniform.boxes::<3, f32>(boxes(), 1).unwrap();
    let mut finder = finder::<3>();
    let times = work(&mut finder, sets) / work(&mut finder, &[&uniform]);
    println!("{name}: {times:.2} times uniform");
    assert!(times < most, "{name}: {times} times the work of uniform boxes");
}

#[test]
fn boxes_of_any_shape() {
    let mut random = Random::new(1);
    // Each side is between 2^-12 and 2^-2, and all lengths between are as likely.
    let mut side = || 2f64.powf(-2.0 - 10.0 * random.unit());
    let sides: Vec<[f64; 3]> = (0..boxes()).map(|_| [side(), side(), side()]).collect();
    let shapes: Vec<_> = sides.into_iter().map(|half| around(random.point(), half)).collect();
    check("any shape", &[&shapes]);
}

#[test]
fn boxes_of_any_shape_with_few_pairs() {
    let mut random = Random::new(5);
    // Each side is between a thousandth of the distance between two boxes and ten times it: few overlap. The hardest input that
    // is known: there are over a hundred shapes, and each box looks for others among the boxes of each shape.
    let distance = (boxes() as f64).cbrt().recip();
    let mut side = || 0.3 * distance * 10f64.powf(4.0 * random.unit() - 3.0);
    let sides: Vec<[f64; 3]> = (0..boxes()).map(|_| [side(), side(), side()]).collect();
    let shapes: Vec<_> = sides.into_iter().map(|half| around(random.point(), half)).collect();
    check_within(40.0, "any shape, few pairs", &[&shapes]);
}

#[test]
fn small_boxes_beside_a_stack_of_large_ones() {
    let mut random = Random::new(2);
    let mut small = Scene::Uniform.boxes::<3, f32>(boxes(), 2).unwrap();
    // They do not touch the stack.
    small.iter_mut().for_each(|aabb| *aabb = aabb.translate([1.1, 0.0, 0.0]));
    small.extend((0..boxes() / 50).map(|_| around([0.5; 3], [0.5 - 0.01 * random.unit(); 3])));
    check("beside a stack", &[&small]);
}

#[test]
fn a_lattice_without_pairs() {
    let width = (boxes() as f64).cbrt() as usize;
    let cell = |i: usize| [i % width, i / width % width, i / width / width].map(|at| at as f64);
    let lattice: Vec<_> = (0..width.pow(3)).map(|i| around(cell(i), [0.4; 3])).collect();
    check("lattice", &[&lattice]);
}

#[test]
fn two_sets_that_are_crowded_but_apart() {
    let crowd = |at: f64| vec![around([at, 0.0, 0.0], [1.0; 3]); boxes() / 2];
    check("two crowds", &[&crowd(0.0), &crowd(3.0)]);
}

#[test]
fn sizes_that_differ_by_a_factor_of_fifteen() {
    let mut random = Random::new(3);
    let small = 0.5 * (2.4 / boxes() as f64).cbrt() / 8.0;
    let mixed: Vec<_> = (0..boxes())
        .map(|i| around(random.point(), [small * if i % 2 == 0 { 1.0 } else { 15.0 }; 3]))
        .collect();
    check("two sizes", &[&mixed]);
}

#[test]
fn a_line_of_boxes() {
    let line: Vec<_> = (0..boxes()).map(|i| around([i as f64, 0.0, 0.0], [0.6; 3])).collect();
    check("line", &[&line]);
}

#[test]
fn crossing_beams_in_separate_layers() {
    let mut random = Random::new(4);
    let layers = (boxes() as f64).sqrt();
    let beams: Vec<_> = (0..boxes())
        .map(|i| {
            let layer = random.below(layers as usize) as f64 + 0.5 * (i % 2) as f64;
            let mut center = random.point::<3>();
            center[2] = layer / layers;
            let mut half = [0.1 / layers; 3];
            half[i % 2] = 0.5;
            around(center, half)
        })
        .collect();
    check("beams", &[&beams]);
}
