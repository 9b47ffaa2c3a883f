//! The library compiled for this machine, measured as `bench/js/src/worker.js` measures the
//! JavaScript package, and spoken to in the same way: a request a line, an answer a line.
//!
//!     native SCENE DIMENSIONS BOXES [world]

use std::hint::black_box;
use std::io::BufRead;
use std::time::{Duration, Instant};

use sweep_and_prune::{Aabb, BroadPhase, Error, PairFinder};
use sweep_and_prune_js_bench::Boxes;

/// Frames that are checked, as in JavaScript.
const FRAMES_CHECKED: usize = 4;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, dimensions, boxes, rest @ ..] = arguments.as_slice() else {
        return Err("native SCENE DIMENSIONS BOXES [world]".into());
    };
    let (n, is_world) = (boxes.parse()?, rest.first().is_some_and(|word| word == "world"));
    match dimensions.as_str() {
        "2" => serve::<2>(scene, n, is_world),
        "3" => serve::<3>(scene, n, is_world),
        _ => Err("two or three dimensions".into()),
    }
}

fn serve<const D: usize>(
    scene: &str,
    n: usize,
    is_world: bool,
) -> Result<(), Box<dyn std::error::Error>> {
    let mut boxes = Boxes::<D>::new(scene, n).ok_or("there is no such scene")?;
    let mut call = if is_world { world(boxes.turn(0))? } else { finder() };
    println!(r#"{{"ready":true}}"#);
    let (mut turn, mut current) = (0, Vec::new());
    for line in std::io::stdin().lock().lines() {
        let line = line?;
        match line.split_once(' ').unwrap_or((&line, "")) {
            ("check", _) => {
                let is_many = matches!(boxes, Boxes::InMotion(_)) || boxes.turns() > 2;
                let frames = if is_many { FRAMES_CHECKED } else { 1 };
                let mut pairs = 0;
                for frame in 0..frames {
                    boxes.advance();
                    pairs += call(boxes.turn(frame))?;
                }
                println!(r#"{{"pairs":{}}}"#, (pairs as f64 / frames as f64).round());
            }
            ("time", numbers) => {
                let (repeats, batch) = numbers.split_once(' ').ok_or("time REPEATS BATCH")?;
                let (repeats, batch): (usize, u32) = (repeats.parse()?, batch.parse()?);
                let mut times = Vec::new();
                for _ in 0..repeats {
                    let mut sum = Duration::ZERO;
                    for _ in 0..batch {
                        turn += 1;
                        boxes.advance();
                        // A copy made just before, as a program has just written its boxes.
                        current.clear();
                        current.extend_from_slice(boxes.turn(turn));
                        let now = black_box(&current);
                        let (waited, start) = (Waited::now(batch), Instant::now());
                        call(now)?;
                        sum += start.elapsed().saturating_sub(waited.since());
                    }
                    times.push((sum / batch).as_nanos());
                }
                println!(r#"{{"ns":{times:?}}}"#);
            }
            _ => return Err("check, or time REPEATS BATCH".into()),
        }
    }
    Ok(())
}

/// What is measured: a call with boxes, which returns how many pairs there are.
type Call<const D: usize> = Box<dyn FnMut(&[Aabb<D>]) -> Result<usize, Error>>;

fn finder<const D: usize>() -> Call<D> {
    let mut finder = PairFinder::new();
    Box::new(move |boxes| finder.find(boxes).map(|pairs| black_box(pairs).len()))
}

fn world<const D: usize>(first: &[Aabb<D>]) -> Result<Call<D>, Error> {
    let mut world = BroadPhase::new();
    let ids = first.iter().map(|&aabb| world.insert(aabb)).collect::<Result<Vec<_>, _>>()?;
    let mut live = world.update().begun().len();
    Ok(Box::new(move |boxes| {
        world.set_many(&ids, boxes)?;
        let changes = black_box(world.update());
        live = live + changes.begun().len() - changes.ended().len();
        Ok(live)
    }))
}

/// How long the thread has waited for a processor while other programs used them all. Zero where the system does not
/// report it. Calls that are timed in batches are too short to ask: they are seldom interrupted, and asking would take as
/// long as a call.
struct Waited(Option<Duration>);

impl Waited {
    fn now(batch: u32) -> Self {
        Self((batch == 1).then(Self::total))
    }

    fn since(&self) -> Duration {
        self.0.map_or(Duration::ZERO, |before| Self::total().saturating_sub(before))
    }

    fn total() -> Duration {
        let text = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
        let waited = text.split(' ').nth(1).and_then(|number| number.parse().ok());
        Duration::from_nanos(waited.unwrap_or(0))
    }
}
