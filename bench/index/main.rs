//! The static index against other static trees in Rust: building it, and searching it for 1, 100 and 10,000 hits.
//!
//! All libraries run in one process and in turn, so that what slows the machine slows all. Times are minima over the
//! rounds, and ratios those of minima. What each search finds is compared before any is timed. One thread.

use std::hint::black_box;
use std::time::Instant;

use clap::Parser;
use sweep_and_prune::{Aabb, Index, SearchBuffer};
use sweep_and_prune_scenes::Scene;

mod libraries;

use libraries::{Library, Tree};

/// Which cases to measure.
#[derive(Parser)]
#[command(about)]
struct Options {
    /// How many boxes.
    #[arg(long, value_delimiter = ',', default_value = "10000,100000,1000000")]
    sizes: Vec<usize>,
    /// 2, 3 or both.
    #[arg(long, value_delimiter = ',', default_value = "2,3")]
    dimensions: Vec<usize>,
    /// Names of scenes.
    #[arg(long, value_delimiter = ',', default_value = "uniform,clustered")]
    scenes: Vec<String>,
    /// About how many boxes a search finds.
    #[arg(long, value_delimiter = ',', default_value = "1,100,10000")]
    hits: Vec<usize>,
    /// How often each library runs.
    #[arg(long, default_value_t = 7)]
    rounds: usize,
}

fn main() {
    let options = Options::parse();
    println!(
        "Times are those of sweep-and-prune; ratios are times of others divided by them: above 1 is slower.\n"
    );
    for &dimensions in &options.dimensions {
        match dimensions {
            2 => cases::<2>(&options, &libraries::two()),
            3 => cases::<3>(&options, &libraries::three()),
            _ => eprintln!("there are no boxes of {dimensions} dimensions here"),
        }
    }
}

fn cases<const D: usize>(options: &Options, libraries: &[Library<D>]) {
    let names: Vec<_> = libraries.iter().map(|library| library.name).collect();
    println!("| {D}D | boxes | | sweep-and-prune | {} |", names.join(" | "));
    println!("|---|--:|---|--:|{}", "--:|".repeat(names.len()));
    for name in &options.scenes {
        let Some(scene) = Scene::ALL.iter().find(|scene| scene.name() == name) else {
            eprintln!("there is no scene {name}");
            continue;
        };
        for &size in &options.sizes {
            if let Some(boxes) = scene.boxes::<D, f32>(size, 1) {
                case(options, name, &boxes, libraries);
            }
        }
    }
    println!();
}

/// Prints the rows of some boxes.
fn case<const D: usize>(
    options: &Options,
    scene: &str,
    boxes: &[Aabb<D>],
    libraries: &[Library<D>],
) {
    let row = |what: &str, times: &[Vec<f64>], count: usize| {
        let own = least(&times[0]) / count as f64;
        let ratio = |others: &Vec<f64>| format!("{:.2}", least(others) / least(&times[0]));
        let ratios: Vec<_> = times[1..].iter().map(ratio).collect();
        println!("| {scene} | {} | {what} | {} | {} |", boxes.len(), time(own), ratios.join(" | "));
    };
    let mut own: Box<dyn Tree<D>> = own_tree(boxes);
    let mut others: Vec<_> = libraries.iter().map(|library| (library.build)(boxes)).collect();
    let mut times = vec![Vec::new(); 1 + others.len()];
    for _ in 0..options.rounds {
        times[0].push(seconds(|| drop(black_box(own_tree(boxes)))));
        for (library, times) in libraries.iter().zip(&mut times[1..]) {
            times.push(seconds(|| drop(black_box((library.build)(boxes)))));
        }
    }
    row("build", &times, 1);
    for &hits in &options.hits {
        let areas = areas(boxes, hits);
        let mut found = 0;
        for area in areas.iter().take(100) {
            let expected = own.sorted(area);
            found += expected.len();
            for (other, library) in others.iter_mut().zip(libraries) {
                assert!(other.sorted(area) == expected, "{} finds others", library.name);
            }
        }
        let search = |tree: &mut dyn Tree<D>| {
            seconds(|| {
                for area in &areas {
                    black_box(tree.search(area));
                }
            })
        };
        let mut times = vec![Vec::new(); 1 + others.len()];
        for _ in 0..options.rounds + 1 {
            times[0].push(search(&mut *own));
            for (other, times) in others.iter_mut().zip(&mut times[1..]) {
                times.push(search(&mut **other));
            }
        }
        // The first round fills caches and buffers.
        for times in &mut times {
            times.remove(0);
        }
        let mean = found / areas.len().min(100);
        row(&format!("search, {mean} hits"), &times, areas.len());
    }
}

/// Cubes around boxes that are spread evenly over the set, each about as large as it must be to overlap so many.
fn areas<const D: usize>(boxes: &[Aabb<D>], hits: usize) -> Vec<Aabb<D>> {
    let index = Index::new(boxes).expect("the boxes are valid");
    let count = (200_000 / (hits + 20)).clamp(20, 5000).min(boxes.len());
    (0..count)
        .map(|at| {
            // A prime number of steps, so that neighbors in the scene are not neighbors here.
            let center = boxes[at * 7919 % boxes.len()].center();
            if hits <= 1 {
                return Aabb::new(center, center);
            }
            let far = index.neighbors(center, hits, f64::INFINITY).expect("the center is finite");
            let radius = far.last().map_or(0.0, |it| it.distance_squared.sqrt()) as f32;
            Aabb::from_center(center, [radius * if D == 2 { 0.886 } else { 0.806 }; D])
        })
        .collect()
}

/// This crate's index and its buffer.
struct Own<const D: usize>(Index<D>, SearchBuffer);

fn own_tree<const D: usize>(boxes: &[Aabb<D>]) -> Box<dyn Tree<D>> {
    Box::new(Own(Index::new(boxes).expect("the boxes are valid"), SearchBuffer::new()))
}

impl<const D: usize> Tree<D> for Own<D> {
    fn search(&mut self, area: &Aabb<D>) -> usize {
        self.0.search_into(area, &mut self.1).map_or(0, <[u32]>::len)
    }

    fn sorted(&mut self, area: &Aabb<D>) -> Vec<u32> {
        let mut found = self.0.search(area).expect("the area is valid");
        found.sort_unstable();
        found
    }
}

fn seconds(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

fn time(seconds: f64) -> String {
    match seconds {
        ..1e-6 => format!("{:.0} ns", seconds * 1e9),
        ..1e-3 => format!("{:.2} µs", seconds * 1e6),
        _ => format!("{:.2} ms", seconds * 1e3),
    }
}
