//! Two revisions of the core in one process, called in turn: see `bench/compare`, which builds this with the older
//! revision as the crate `old` and the working tree as the crate `new`. Both must have the functions used here.

use std::time::Instant;

use games::Game;
use scenes::{Motion, Random, Scene};

mod games;

const SEED: u64 = 1;
const SCENES: [&str; 6] = ["uniform", "clustered", "mixed", "slab", "tower", "box-pruning"];
/// The scene `box-pruning` has too many pairs beyond this number of boxes.
const MOST_OF_BOX_PRUNING: usize = 100_000;
/// At least this number of calls is timed, however long they take, and at most the other.
const CALLS: (usize, usize) = (7, 3000);
/// Up to this many boxes, each call has a scene of its own, so that a branch predictor cannot learn the hits of one.
const MOST_VARIED: usize = 10_000;
/// The number of scenes of a kind.
const VARIED: usize = 100;
/// The frames of a world before it is timed.
const WARM_UP: usize = 40;

struct Options {
    sizes: Vec<usize>,
    dimensions: Vec<usize>,
    only: Vec<String>,
    scenes: Vec<String>,
    seconds: f64,
    threads: usize,
    /// Whether the revisions may report pairs in different orders.
    any_order: bool,
}

impl Options {
    fn from_arguments() -> Result<Self, String> {
        let mut options = Self {
            sizes: vec![1_000, 10_000, 100_000, 1_000_000],
            dimensions: vec![2, 3],
            only: ["finder", "between", "world", "game"].map(str::to_owned).to_vec(),
            scenes: Vec::new(),
            seconds: 0.7,
            threads: 1,
            any_order: false,
        };
        let mut arguments = std::env::args().skip(1);
        while let Some(name) = arguments.next() {
            if name == "--any-order" {
                options.any_order = true;
                continue;
            }
            let value = arguments.next().ok_or(format!("{name} needs a value"))?;
            let wrong = || format!("{name} cannot be '{value}'");
            let names = || value.split(',').map(str::to_owned).collect::<Vec<_>>();
            let numbers = || {
                value
                    .split(',')
                    .map(|it| it.parse().map_err(|_| wrong()))
                    .collect::<Result<Vec<_>, _>>()
            };
            match name.as_str() {
                "--sizes" => options.sizes = numbers()?,
                "--dimensions" => options.dimensions = numbers()?,
                "--only" => options.only = names(),
                "--scenes" => options.scenes = names(),
                "--seconds" => options.seconds = value.parse().map_err(|_| wrong())?,
                "--threads" => options.threads = value.parse().map_err(|_| wrong())?,
                _ => return Err(format!("there is no option {name}")),
            }
        }
        Ok(options)
    }

    fn wants(&self, scene: &str) -> bool {
        self.scenes.is_empty() || self.scenes.iter().any(|name| name == scene)
    }

    fn wants_kind(&self, kind: &str) -> bool {
        self.only.iter().any(|name| name == kind)
    }
}

/// The times of calls in turn, in seconds.
#[derive(Default)]
struct Times {
    old: Vec<f64>,
    new: Vec<f64>,
}

impl Times {
    fn ratio_of_minima(&self) -> f64 {
        minimum(&self.new) / minimum(&self.old)
    }

    fn median_of_ratios(&self) -> f64 {
        median(self.new.iter().zip(&self.old).map(|(new, old)| new / old).collect())
    }

    /// The ratio of all times together. Rare calls that take long, such as the rebuilds of a world, have their full weight
    /// in it.
    fn ratio_of_totals(&self) -> f64 {
        self.new.iter().sum::<f64>() / self.old.iter().sum::<f64>()
    }

    /// Calls both, the one that is first alternating with `round`, and keeps their times.
    fn push<A, B>(
        &mut self,
        round: usize,
        old: impl FnOnce() -> A,
        new: impl FnOnce() -> B,
    ) -> (A, B) {
        let ((old_time, old), (new_time, new)) = if round.is_multiple_of(2) {
            let old = time(old);
            (old, time(new))
        } else {
            let new = time(new);
            (time(old), new)
        };
        self.old.push(old_time);
        self.new.push(new_time);
        (old, new)
    }
}

fn minimum(times: &[f64]) -> f64 {
    times.iter().copied().fold(f64::INFINITY, f64::min)
}

fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    numbers[numbers.len() / 2]
}

fn time<R>(call: impl FnOnce() -> R) -> (f64, R) {
    let start = Instant::now();
    let result = call();
    (start.elapsed().as_secs_f64(), result)
}

fn converted<const D: usize>(boxes: &[old::Aabb<D>]) -> Vec<new::Aabb<D>> {
    boxes.iter().map(|it| new::Aabb::new(it.min, it.max)).collect()
}

/// The boxes of the next call.
enum Source<'a, const D: usize> {
    /// Frame after frame of a motion, or scene after scene of a kind.
    Next(&'a mut dyn FnMut() -> Vec<old::Aabb<D>>),
    /// Many boxes at rest. They are found once in another order before each timed call, as in the benchmark, so that
    /// nothing known from the last call helps.
    AtRest(Vec<old::Aabb<D>>),
}

/// Finds all pairs in at least `least` calls: those of one set, or those between a third of the boxes and the others.
fn find<const D: usize>(
    options: &Options,
    least: usize,
    between: bool,
    mut source: Source<D>,
) -> Times {
    let mut old = old::PairFinder::<D>::new().threads(options.threads);
    let mut new = new::PairFinder::<D>::new().threads(options.threads);
    macro_rules! pairs {
        ($finder:ident, $boxes:expr) => {{
            let (some, others) = $boxes.split_at(if between { $boxes.len() / 3 } else { 0 });
            let search =
                if between { $finder.search(some).against(others) } else { $finder.search(others) };
            search.pairs().expect("valid boxes")
        }};
    }
    let mut times = Times::default();
    let mut boxes = match &source {
        Source::Next(_) => Vec::new(),
        Source::AtRest(boxes) => boxes.clone(),
    };
    let mut shuffled = boxes.clone();
    Random::new(SEED).shuffle(&mut shuffled);
    let start = Instant::now();
    for round in 0..CALLS.1 {
        if round >= least && start.elapsed().as_secs_f64() > options.seconds {
            break;
        }
        match &mut source {
            Source::Next(next) => boxes = next(),
            Source::AtRest(_) => {
                pairs!(old, shuffled);
                let same = converted(&shuffled);
                pairs!(new, same);
            }
        }
        let same = converted(&boxes);
        let (by_old, by_new) = times.push(round, || pairs!(old, boxes), || pairs!(new, same));
        if options.any_order && by_old != by_new {
            let [mut by_old, mut by_new] = [by_old, by_new].map(<[_]>::to_vec);
            by_old.sort_unstable();
            by_new.sort_unstable();
            assert!(by_old == by_new, "the revisions find other pairs");
        } else {
            assert!(by_old == by_new, "the revisions find other pairs or another order");
        }
    }
    times
}

/// Bodies that move, frame after frame.
trait Moving<const D: usize> {
    fn boxes(&self) -> &[old::Aabb<D>];
    fn advance(&mut self);
    fn is_static(&self, _body: usize) -> bool {
        false
    }
}

impl<const D: usize> Moving<D> for scenes::Moving<D> {
    fn boxes(&self) -> &[old::Aabb<D>] {
        self.boxes()
    }

    fn advance(&mut self) {
        self.advance();
    }
}

/// Tracks the pairs of bodies that move. Also how long the new world takes in all, compared with the new finder from
/// scratch.
fn track<const D: usize>(options: &Options, moving: &mut impl Moving<D>) -> (Times, f64) {
    let count = moving.boxes().len();
    let (mut old, mut new) = (old::BroadPhase::<D>::new(), new::BroadPhase::<D>::new());
    let mut finder = new::PairFinder::<D>::new();
    let (old_ids, new_ids): (Vec<_>, Vec<_>) = (0..count)
        .map(|body| {
            let (aabb, is_static) = (moving.boxes()[body], moving.is_static(body));
            let same = new::Aabb::new(aabb.min, aabb.max);
            let (mut by_old, mut by_new) = (old::Filter::default(), new::Filter::default());
            (by_old.is_static, by_new.is_static) = (is_static, is_static);
            (
                old.insert_with(aabb, by_old).expect("a valid box"),
                new.insert_with(same, by_new).expect("a valid box"),
            )
        })
        .unzip();
    old.update();
    new.update();
    let mut last = moving.boxes().to_vec();
    let (mut times, mut from_scratch) = (Times::default(), 0.0);
    let start = Instant::now();
    for round in 0..CALLS.1 {
        if round >= WARM_UP + CALLS.0 && start.elapsed().as_secs_f64() > 2.0 * options.seconds {
            break;
        }
        moving.advance();
        let moved: Vec<usize> = (0..count).filter(|&at| moving.boxes()[at] != last[at]).collect();
        let boxes: Vec<_> = moved.iter().map(|&at| moving.boxes()[at]).collect();
        let same = converted(&boxes);
        let ids: Vec<_> = moved.iter().map(|&at| old_ids[at]).collect();
        let same_ids: Vec<_> = moved.iter().map(|&at| new_ids[at]).collect();
        last.clear();
        last.extend_from_slice(moving.boxes());
        let (by_old, by_new) = times.push(
            round,
            || {
                old.set_many(&ids, &boxes).expect("bodies of this world");
                let changes = old.update();
                (changes.begun().slots().to_vec(), changes.ended().slots().to_vec())
            },
            || {
                new.set_many(&same_ids, &same).expect("bodies of this world");
                let changes = new.update();
                (changes.begun().slots().to_vec(), changes.ended().slots().to_vec())
            },
        );
        assert!(by_old == by_new, "the revisions report other events or another order");
        if round < WARM_UP {
            times = Times::default();
            continue;
        }
        let all = converted(moving.boxes());
        let (scratch, _) = time(|| finder.find(&all).expect("valid boxes").len());
        from_scratch += scratch;
    }
    let over_scratch = times.new.iter().sum::<f64>() / from_scratch;
    (times, over_scratch)
}

/// The scenes of a kind. Those with the same boxes for every seed differ in their order.
fn varied<const D: usize>(draw: impl Fn(u64) -> Vec<old::Aabb<D>>) -> Vec<Vec<old::Aabb<D>>> {
    let mut scenes: Vec<_> = (SEED..).take(VARIED).map(draw).collect();
    if scenes[0] == scenes[1] {
        for (scene, seed) in scenes.iter_mut().zip(SEED..) {
            Random::new(seed).shuffle(scene);
        }
    }
    scenes
}

fn note(over_scratch: f64) -> String {
    format!("; {over_scratch:.2} of the time from scratch")
}

/// One line of the report: its name, and the ratios of minima, of medians and of totals.
type Line = (String, [f64; 3]);

fn report(
    kind: &str,
    dimensions: usize,
    scene: &str,
    boxes: usize,
    times: &Times,
    note: &str,
) -> Line {
    let name = format!("{kind} {scene} {dimensions}D {boxes}");
    let ratios = [times.ratio_of_minima(), times.median_of_ratios(), times.ratio_of_totals()];
    let [minima, medians, totals] = ratios;
    println!(
        "{name:36} minima {minima:.3}  medians {medians:.3}  totals {totals:.3}  old {:>9.4} ms, {} calls{note}",
        1e3 * minimum(&times.old),
        times.old.len(),
    );
    (name, ratios)
}

fn compare<const D: usize>(options: &Options, lines: &mut Vec<Line>) {
    for &boxes in &options.sizes {
        for kind in ["finder", "between"].into_iter().filter(|kind| options.wants_kind(kind)) {
            let between = kind == "between";
            for name in SCENES.into_iter().filter(|name| options.wants(name)) {
                let scene = Scene::from_name(name).expect("a scene");
                let too_many = name == "box-pruning" && boxes > MOST_OF_BOX_PRUNING;
                if !scene.dimensions().contains(&D) || too_many {
                    continue;
                }
                let draw =
                    |seed| scene.boxes::<D, f32>(boxes, seed).expect("a scene of these dimensions");
                let times = if boxes > MOST_VARIED {
                    find(options, CALLS.0, between, Source::AtRest(draw(SEED)))
                } else {
                    let scenes = varied(draw);
                    let mut turns = scenes.iter().cycle();
                    let mut next = || turns.next().expect("scenes").clone();
                    find(options, VARIED, between, Source::Next(&mut next))
                };
                lines.push(report(kind, D, name, boxes, &times, ""));
            }
            for motion in [Motion::Drift, Motion::Fast, Motion::MostlyStill]
                .into_iter()
                .filter(|it| options.wants(it.name()))
            {
                let mut moving =
                    motion.start::<D, f32>(boxes, SEED).expect("one to three dimensions");
                let mut next = || {
                    moving.advance();
                    moving.boxes().to_vec()
                };
                let times = find(options, CALLS.0, between, Source::Next(&mut next));
                lines.push(report(kind, D, motion.name(), boxes, &times, ""));
            }
        }
        if options.wants_kind("world") {
            for motion in Motion::ALL.into_iter().filter(|motion| options.wants(motion.name())) {
                let mut moving =
                    motion.start::<D, f32>(boxes, SEED).expect("one to three dimensions");
                let (times, over_scratch) = track::<D>(options, &mut moving);
                lines.push(report("world", D, motion.name(), boxes, &times, &note(over_scratch)));
            }
        }
        if options.wants_kind("game") {
            for game in games::ALL.iter().filter(|game| options.wants(game.name)) {
                let (times, over_scratch) = track::<D>(options, &mut Game::new(game, boxes));
                lines.push(report("game", D, game.name, boxes, &times, &note(over_scratch)));
            }
        }
    }
}

fn main() {
    let options = Options::from_arguments().unwrap_or_else(|why| {
        eprintln!("{why}: see bench/compare --help");
        std::process::exit(2);
    });
    let mut lines = Vec::new();
    for dimensions in &options.dimensions {
        match dimensions {
            2 => compare::<2>(&options, &mut lines),
            _ => compare::<3>(&options, &mut lines),
        }
    }
    let mean = |of: usize| {
        (lines.iter().map(|(_, ratios)| ratios[of].ln()).sum::<f64>() / lines.len() as f64).exp()
    };
    println!(
        "geometric mean: minima {:.3}, medians {:.3}, totals {:.3}",
        mean(0),
        mean(1),
        mean(2)
    );
    if let Some((name, ratios)) = lines.iter().max_by(|(_, a), (_, b)| a[1].total_cmp(&b[1])) {
        println!("slowest: {name}, median {:.3}", ratios[1]);
    }
}
