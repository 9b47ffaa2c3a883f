//! Finding the pairs between two sets must not take more than 3 times as long as finding all pairs of
//! both sets together, also where a share of both is parked at one place of a large, sparse world.
//!
//! It measures time, so it is left out unless asked for:
//! `cargo test --release -p sweep-and-prune --test pairs_between_speed -- --ignored --nocapture`

use std::hint::black_box;
use std::time::{Duration, Instant};

use sweep_and_prune::{Aabb, PairFinder};

/// How boxes lie in a world of a width of 2^20.
#[derive(Clone, Copy, Debug)]
struct Scene {
    counts: [usize; 2],
    /// One in this many is parked at the origin; 0 for none.
    parked: usize,
    size: f32,
}

/// Parked and random boxes, always the same.
fn boxes<const D: usize>(scene: Scene, set: usize) -> Vec<Aabb<D>> {
    let mut state = 1 + set as u32;
    let mut random = || {
        state = state.wrapping_mul(0x9E37_79B1).wrapping_add(0x85EB_CA6B);
        (state >> 8) as f32 / 16.0
    };
    (0..scene.counts[set])
        .map(|i| {
            let is_parked = scene.parked > 0 && i % scene.parked == 0;
            let min = if is_parked { [0.0; D] } else { [0; D].map(|_| random()) };
            Aabb::new(min, min.map(|at| at + scene.size))
        })
        .collect()
}

/// How many times as long the search between takes: the minima of alternating rounds.
fn ratio<const D: usize>(scene: Scene) -> f64 {
    let [a, b] = [0, 1].map(|set| boxes::<D>(scene, set));
    let both = [&a[..], &b[..]].concat();
    let mut finder = PairFinder::new();
    let [mut between, mut together] = [Duration::MAX; 2];
    for _ in 0..15 {
        let start = Instant::now();
        black_box(finder.find_between(black_box(&a), black_box(&b)).unwrap());
        between = between.min(start.elapsed());
        let start = Instant::now();
        black_box(finder.find(black_box(&both)).unwrap());
        together = together.min(start.elapsed());
    }
    let ratio = between.as_secs_f64() / together.as_secs_f64();
    println!("{D}D {scene:?}: {between:?} against {together:?}, {ratio:.2} times");
    ratio
}

#[test]
#[ignore = "measures time"]
fn pairs_between_two_sets_take_at_most_three_times_all_pairs() {
    let mut worst = 0.0f64;
    for counts in [[130, 130], [200, 200], [100, 1000], [1000, 1000], [1000, 4000], [40, 20_000]] {
        for parked in [0, 2, 10] {
            for size in [0.0, 100.0] {
                let scene = Scene { counts, parked, size };
                worst = worst.max(ratio::<2>(scene)).max(ratio::<3>(scene));
            }
        }
    }
    assert!(worst <= 3.0, "{worst:.2} times");
}
