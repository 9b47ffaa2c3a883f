//! How close finding all pairs comes to what the machine can do: what it must read, write and test,
//! at the rates that the machine reaches when it does nothing else.
//!
//! The stages are measured from outside, by runs that end earlier. A run that is cancelled at its first report of progress
//! has made the plan, filled the columns, and sorted and swept only the first of them. A run that only sorts has not swept.
//! A run that counts has swept, and a run that stores the pairs has done everything.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use anyhow::{Context, Result};
use sweep_and_prune::{Aabb, PairFinder};
use sweep_and_prune_scenes::{Random, Scene};

use crate::machine;
use crate::record::{Roofline, Stage, median};
use crate::scene::SEED;

/// The scene and its sizes.
const SCENE: Scene = Scene::Uniform;
const SIZES: [usize; 3] = [10_000, 100_000, 1_000_000];

/// What the finder moves for a box beside its coordinates: its index and a word of marks.
const TAGS: usize = 8;

/// Measures everything, in half a minute at most.
pub fn measure(copy_bytes_per_second: f64, quick: bool) -> Result<Roofline> {
    let rates = [(2, test_rate::<2>()?), (3, test_rate::<3>()?)];
    let mut stages = Vec::new();
    for boxes in SIZES.into_iter().filter(|&boxes| !quick || boxes <= 10_000) {
        stages.extend(of::<2>(boxes, rates[0].1)?);
        stages.extend(of::<3>(boxes, rates[1].1)?);
    }
    let kernel_tests_per_second: BTreeMap<_, _> =
        rates.into_iter().map(|(dimensions, rate)| (dimensions.to_string(), rate)).collect();
    Ok(Roofline { copy_bytes_per_second, kernel_tests_per_second, stages })
}

/// The most box tests per second: every box of a small set against every other, where none overlap. Such a small set is
/// neither split into columns nor sorted, and it fits in the first-level cache.
fn test_rate<const D: usize>() -> Result<f64> {
    const CALLS: usize = 200;
    let mut finder = PairFinder::<D>::new();
    let mut best = 0.0f64;
    for boxes in [64, 96, 128].repeat(20) {
        let corner = |at: usize| [2.0 * at as f32; D];
        let apart = |at: usize| Aabb::new(corner(at), corner(at).map(|at| at + 1.0));
        let apart: Vec<_> = (0..boxes).map(apart).collect();
        let start = Instant::now();
        (0..CALLS).try_for_each(|_| finder.search(black_box(&apart)).count().map(|_| ()))?;
        let took = start.elapsed().max(Duration::from_nanos(1));
        let tests = CALLS * boxes * (boxes - 1) / 2;
        best = best.max(tests as f64 / took.as_secs_f64());
    }
    Ok(best)
}

/// The stages of a search with this many boxes.
fn of<const D: usize>(n: usize, test_rate: f64) -> Result<Vec<Stage>> {
    let boxes = SCENE.boxes::<D, f32>(n, SEED).context("in two and three dimensions")?;
    let mut shuffled = boxes.clone();
    Random::new(SEED).shuffle(&mut shuffled);
    let mut finder = PairFinder::<D>::new();
    let found = finder.find(&boxes)?;
    let (pairs, output) = (found.len(), size_of_val(found) as f64);

    let rounds = (2_000_000 / n).clamp(7, 51);
    let mut rounds_ns = [(); 4].map(|()| Vec::with_capacity(rounds));
    for _ in 0..rounds {
        for (until, rounds_ns) in rounds_ns.iter_mut().enumerate() {
            // A search in another order first, so that nothing learnt from the last call helps.
            finder.find(&shuffled)?;
            let (result, took) = machine::clock(|| run(&mut finder, black_box(&boxes), until));
            result?;
            rounds_ns.push(took.as_nanos() as f64);
        }
    }
    // The differences are taken within a round, where whatever slowed the machine slowed both.
    let less = |a: usize, b: usize| -> Vec<f64> {
        rounds_ns[a].iter().zip(&rounds_ns[b]).map(|(a, b)| a - b).collect()
    };
    let differences = [less(1, 0), less(2, 1), less(3, 2)];
    let [ordered, swept, output_only] = differences.map(|it| median(&it).max(0.0));
    let [binned, stored] = [0, 3].map(|at: usize| median(&rounds_ns[at]));

    let read = size_of_val(&boxes[..]) as f64;
    let records = (n * (size_of::<Aabb<D>>() + TAGS)) as f64;
    let stage = |stage: &str, ns: f64, bytes: f64, tests: usize| {
        let copy_ns = bytes / machine::copy_bandwidth(bytes as usize) * 1e9;
        let limit_ns = copy_ns.max(tests as f64 / test_rate * 1e9);
        Stage {
            scene: SCENE.name().into(),
            dimensions: D,
            boxes: n,
            stage: stage.into(),
            ns,
            bytes,
            tests: tests as f64,
            limit_ns,
            share: (limit_ns / ns).min(1.0),
        }
    };
    Ok(vec![
        stage("plan and columns", binned, read + records, 0),
        // What is ordered stays in the caches until it is swept.
        stage("order", ordered, records, 0),
        stage("sweep", swept, 0.0, pairs),
        stage("output", output_only, output, 0),
        stage("all", stored, read + 2.0 * records + output, pairs),
    ])
}

/// One call that ends after the columns, the order, the sweep, or when the pairs are stored.
fn run<const D: usize>(finder: &mut PairFinder<D>, boxes: &[Aabb<D>], until: usize) -> Result<()> {
    match until {
        0 => black_box(
            finder.search(boxes).progress(&|_| ControlFlow::Break(())).pairs().ok().map(<[_]>::len),
        ),
        1 => finder.search(black_box(boxes)).sort_only().map(|()| None)?,
        2 => black_box(Some(finder.search(boxes).count()? as usize)),
        _ => black_box(Some(finder.find(boxes)?.len())),
    };
    Ok(())
}
