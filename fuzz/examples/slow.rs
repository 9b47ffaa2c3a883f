//! Looks for slow inputs: changes scenes at random and keeps what makes a search take longer for each box and pair.
//!
//! ```text
//! cargo run --release --package sweep-and-prune-fuzz --example slow -- [SECONDS] [SEED]
//! ```
//! A scene is a few groups of boxes. Each group has a place, a spread and sizes on each axis, of any order of magnitude. The
//! measure is the processor time of one thread for each box and pair, the least of several searches, compared with uniform
//! boxes. On a busy machine it is right within a factor of about 1.5. Scenes that are more than ten times slower are
//! faults: they are printed in full, and the exit status is 1.

use std::process::ExitCode;
use std::time::{Duration, Instant};

use cpu_time::ThreadTime;
use sweep_and_prune::{Aabb, PairFinder, Scalar};
use sweep_and_prune_scenes::Random;

/// A scene with more pairs for each box says little about boxes.
const MOST_PAIRS: u64 = 20;
/// How many changes a scene is given.
const CHANGES: usize = 150;
/// A scene that takes this many times as long as uniform boxes is a fault.
const FAULT: f64 = 10.0;

/// Boxes of one kind.
#[derive(Clone, Debug)]
struct Group {
    boxes: usize,
    center: [f64; 3],
    spread: [f64; 3],
    size: [f64; 3],
    /// Sizes differ by up to this power of ten.
    decades: f64,
    /// How many distinct places there are on an axis; 0 for any.
    places: usize,
    /// The share of the boxes in the second set.
    second: f64,
    /// Whether its boxes alternate with the boxes of the groups before it, instead of following them: a pattern that a sample
    /// may miss.
    alternates: bool,
}

/// From 1e-6 to 1, or 0.
fn magnitude(random: &mut Random) -> f64 {
    if random.below(6) == 0 { 0.0 } else { 10f64.powf(-6.0 * random.unit()) }
}

impl Group {
    fn random(random: &mut Random) -> Self {
        let side = random.unit() * 2.0;
        Self {
            boxes: [30, 200, 1000, 4000, 10_000][random.below(5)],
            center: random.point(),
            spread: [magnitude(random), magnitude(random), magnitude(random)],
            size: [magnitude(random), magnitude(random), magnitude(random)],
            decades: if random.below(2) == 0 { 0.0 } else { 3.0 * side },
            places: [0, 0, 2, 30][random.below(4)],
            second: [0.5, 0.0, 1.0, 0.02][random.below(4)],
            alternates: random.below(2) == 0,
        }
    }

    fn change(&mut self, random: &mut Random) {
        let (other, axis) = (Self::random(random), random.below(3));
        match random.below(8) {
            0 => self.boxes = (self.boxes as f64 * (0.5 + random.unit())) as usize + 1,
            1 => self.center[axis] = other.center[axis],
            2 => self.spread[axis] = other.spread[axis],
            3 => self.size[axis] = other.size[axis],
            4 => self.size[axis] *= 0.5 + random.unit(),
            5 => self.spread[axis] *= 0.5 + random.unit(),
            6 => (self.decades, self.places) = (other.decades, other.places),
            _ => (self.second, self.alternates) = (other.second, other.alternates),
        }
        self.boxes = self.boxes.min(20_000);
    }
}

/// Items of two lists in turn, and then the rest of the longer list.
fn in_turn<B>(first: Vec<B>, second: Vec<B>) -> Vec<B> {
    let (mut first, mut second) = (first.into_iter(), second.into_iter());
    let pair = || Some([first.next(), second.next()]);
    std::iter::from_fn(pair)
        .take_while(|pair| pair.iter().any(Option::is_some))
        .flatten()
        .flatten()
        .collect()
}

/// The boxes of a scene, of both sets.
fn boxes<const D: usize, T: Scalar>(scene: &[Group]) -> [Vec<Aabb<D, T>>; 2] {
    let mut sets = [vec![], vec![]];
    let mut random = Random::new(5);
    for group in scene {
        let mut added = [vec![], vec![]];
        for _ in 0..group.boxes {
            let scale = 10f64.powf(-group.decades * random.unit());
            let mut aabb = Aabb::new([T::default(); D], [T::default(); D]);
            for axis in 0..D {
                let mut at = random.unit();
                if group.places > 0 {
                    at = (at * group.places as f64).floor() / group.places as f64;
                }
                let min = group.center[axis] + group.spread[axis] * at;
                aabb.min[axis] = T::from_f64(min);
                aabb.max[axis] = T::from_f64(min + group.size[axis] * scale);
            }
            added[usize::from(random.unit() < group.second)].push(aabb);
        }
        for (set, added) in sets.iter_mut().zip(added) {
            if group.alternates {
                *set = in_turn(std::mem::take(set), added);
            } else {
                set.extend(added);
            }
        }
    }
    sets
}

/// The processor time of a search, in nanoseconds for each box and pair. None if there are too many pairs.
fn cost<const D: usize, T: Scalar>(
    sets: &[Vec<Aabb<D, T>>; 2],
    has_two_sets: bool,
    times: usize,
) -> Option<f64> {
    let [first, second] = sets;
    let all = [&first[..], &second[..]].concat();
    let most = MOST_PAIRS * all.len() as u64;
    let mut finder = PairFinder::<D, T>::new();
    let mut search = || {
        let search =
            if has_two_sets { finder.search(first).against(second) } else { finder.search(&all) };
        search.count().expect("the boxes are valid")
    };
    let mut best = f64::INFINITY;
    let mut pairs = 0;
    for _ in 0..times {
        let begun = ThreadTime::now();
        pairs = search();
        best = best.min(begun.elapsed().as_nanos() as f64);
        if pairs > most {
            return None;
        }
    }
    Some(best / (all.len() as u64 + pairs) as f64)
}

/// The cost of this many uniform boxes.
fn uniform<const D: usize, T: Scalar>(count: usize, has_two_sets: bool, times: usize) -> f64 {
    let size = [0.5 * (count as f64).powf(-1.0 / D as f64); 3];
    let group = Group {
        boxes: count,
        center: [0.0; 3],
        spread: [1.0; 3],
        size,
        decades: 0.0,
        places: 0,
        second: 0.5,
        alternates: false,
    };
    cost(&boxes::<D, T>(&[group]), has_two_sets, times).expect("uniform boxes have few pairs")
}

/// How many times slower a scene is than uniform boxes; 0 if it has too many pairs or too few boxes to tell.
fn slowness<const D: usize, T: Scalar>(scene: &[Group], has_two_sets: bool, times: usize) -> f64 {
    let sets = boxes::<D, T>(scene);
    let count = sets[0].len() + sets[1].len();
    // With few boxes, most of the time is the call and not the search.
    if count < 300 {
        return 0.0;
    }
    let cost = cost(&sets, has_two_sets, times);
    cost.map_or(0.0, |cost| cost / uniform::<D, T>(count, has_two_sets, times))
}

/// How many times slower a scene is than uniform boxes, and the scene, after changes that made it slower.
fn climb<const D: usize, T: Scalar>(
    random: &mut Random,
    has_two_sets: bool,
    end: Instant,
) -> (f64, Vec<Group>) {
    let mut scene: Vec<_> = (0..1 + random.below(4)).map(|_| Group::random(random)).collect();
    let mut worst = 0.0;
    for _ in 0..CHANGES {
        if Instant::now() > end {
            break;
        }
        let mut changed = scene.clone();
        for _ in 0..=random.below(3) {
            let which = random.below(changed.len());
            match random.below(12) {
                0 if changed.len() < 6 => changed.push(Group::random(random)),
                1 if changed.len() > 1 => _ = changed.swap_remove(which),
                _ => changed[which].change(random),
            }
        }
        let slowness = slowness::<D, T>(&changed, has_two_sets, 3);
        if slowness > worst {
            (worst, scene) = (slowness, changed);
        }
    }
    // The least of a few times can be too large by chance, and this search would find exactly those chances.
    let worst = slowness::<D, T>(&scene, has_two_sets, 21);
    (worst, scene)
}

fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1).map(|text| text.parse().expect("numbers"));
    let (seconds, seed) = (arguments.next().unwrap_or(60), arguments.next().unwrap_or(1));
    let end = Instant::now() + Duration::from_secs(seconds);
    let mut random = Random::new(seed);
    let mut worst = [0.0f64; 8];
    let mut scenes = 0;
    let mut is_fault = false;
    while Instant::now() < end {
        let kind = scenes % worst.len();
        let has_two_sets = kind % 2 == 1;
        let (slowness, scene) = match kind / 2 {
            0 => climb::<3, f32>(&mut random, has_two_sets, end),
            1 => climb::<2, f32>(&mut random, has_two_sets, end),
            2 => climb::<1, f32>(&mut random, has_two_sets, end),
            _ => climb::<3, f64>(&mut random, has_two_sets, end),
        };
        scenes += 1;
        if slowness > worst[kind] {
            worst[kind] = slowness;
            let name = ["3D f32", "2D f32", "1D f32", "3D f64"][kind / 2];
            println!(
                "{name}, {} sets: {slowness:.1} times slower than uniform: {scene:?}",
                1 + kind % 2
            );
            is_fault |= slowness > FAULT;
        }
    }
    println!(
        "{scenes} scenes with {CHANGES} changes each: at most {worst:.1?} times slower than uniform"
    );
    ExitCode::from(u8::from(is_fault))
}
