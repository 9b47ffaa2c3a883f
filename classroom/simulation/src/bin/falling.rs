//! Spheres fall into a box; brute force and sweep and prune look for the pairs that touch.

use std::io::{IsTerminal, stdout};
use std::process::ExitCode;
use std::time::Instant;

use clap::{Parser, value_parser};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use sweep_and_prune::{Aabb, PairFinder};
use sweep_and_prune_algorithms::{Counts, Method, Runner, RunnerOptions};
use sweep_and_prune_simulation::scenes::{self, Population};
use sweep_and_prune_simulation::{Setup, Simulation};

/// Spheres fall into a box; brute force and sweep and prune look for the pairs that touch.
#[derive(Parser)]
#[command(version)]
struct Options {
    /// How many bodies; with 100,000 brute force alone takes many seconds
    #[arg(long, default_value_t = 10_000, value_parser = value_parser!(u32).range(2..=100_000))]
    bodies: u32,
    /// How many steps of 1/60 s
    #[arg(long, default_value_t = 180, value_parser = value_parser!(u32).range(1..=100_000))]
    steps: u32,
    /// The same seed gives the same bodies, steps and state hash everywhere
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// 2: discs, 3: spheres
    #[arg(long, default_value_t = 3, value_parser = value_parser!(u32).range(2..=3))]
    dimensions: u32,
}

fn main() -> ExitCode {
    let options = Options::parse();
    let done = match options.dimensions {
        2 => run::<2>(&options, "discs", 0.04),
        _ => run::<3>(&options, "spheres", 0.2),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("falling: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Lets the bodies fall by the fastest broad phase, and now and then stops to compare.
fn run<const D: usize>(
    options: &Options,
    what: &str,
    size: f32,
) -> Result<(), Box<dyn std::error::Error>> {
    let &Options { bodies, steps, seed, .. } = options;
    let setup: Setup<D> = scenes::falling(Population { bodies, size, spread: 1.0, seed })?;
    let mut simulation = Simulation::new(&setup)?;
    simulation.set_counting(false);

    let clock = Instant::now();
    let now = || clock.elapsed().as_secs_f64() * 1e3;
    let progress = progress_bar(steps, &format!("{} {what} fall", grouped(bodies.into())));
    let samples = samples(bodies, steps);
    let mut comparison = Comparison::default();
    let (mut broad, mut narrow, mut total) = (0.0, 0.0, 0.0);
    for step in 1..=steps {
        let report = simulation.step(now)?;
        broad += report.broad_phase_ms;
        narrow += report.narrow_phase_ms;
        total += report.total_ms;
        // The last of each of as many equal parts as there are samples.
        if u64::from(step) * samples % u64::from(steps) < samples {
            comparison.sample(simulation.boxes(), now)?;
        }
        progress.inc(1);
    }
    progress.finish_and_clear();

    println!(
        "{} {what} fell for {:.1} s: {} of {}, seed {seed}\n",
        grouped(bodies.into()),
        steps as f32 * setup.time_step,
        several(steps.into(), "step"),
        several(setup.substeps.into(), "substep"),
    );
    comparison.print();
    let steps = f64::from(steps);
    println!("\na step with find_pairs   {:>9.2} ms", total / steps);
    println!("  of it broad phase      {:>9.2} ms", broad / steps);
    println!("  of it narrow phase     {:>9.2} ms", narrow / steps);
    println!("state hash        {:016x}", simulation.hash());
    Ok(())
}

/// How often to compare: six times, fewer where brute force takes long.
fn samples(bodies: u32, steps: u32) -> u64 {
    let tests = u64::from(bodies) * u64::from(bodies - 1) / 2;
    (300_000_000 / tests).clamp(1, 6).min(steps.into())
}

/// On a terminal only.
fn progress_bar(steps: u32, message: &str) -> ProgressBar {
    let progress = ProgressBar::new(steps.into()).with_message(message.to_owned());
    if !stdout().is_terminal() {
        progress.set_draw_target(ProgressDrawTarget::hidden());
    }
    let style = ProgressStyle::with_template("{msg} [{bar:40}] {pos}/{len} steps");
    progress.with_style(style.expect("the template is well formed"))
}

/// Counts and times of several ways to find the pairs of the same boxes.
#[derive(Default)]
struct Comparison {
    samples: u64,
    pairs: u64,
    brute_tests: u64,
    sweep_tests: u64,
    brute_ms: f64,
    sweep_ms: f64,
    finder_ms: f64,
}

impl Comparison {
    /// Checks that all algorithms find the same pairs, then counts and times them.
    fn sample<const D: usize>(
        &mut self,
        boxes: &[Aabb<D>],
        now: impl Fn() -> f64,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let mut brute = runner(Method::Pairwise);
        let mut sweep = runner(Method::SortedPairwise);
        let mut finder = PairFinder::new();

        // Not measured: the first run allocates memory.
        let expected = sorted(finder.find(boxes)?);
        let mut counts = Counts::default();
        let swept = sorted(sweep.step(boxes, &mut counts)?.pairs);

        let start = now();
        let forced = brute.step(boxes, &mut ())?.pairs;
        let forced_ms = now() - start;
        if sorted(forced) != expected || swept != expected {
            return Err("the algorithms disagree on the pairs; this is a bug".into());
        }

        self.samples += 1;
        self.pairs += expected.len() as u64;
        let n = boxes.len() as u64;
        self.brute_tests += n * (n - 1) / 2;
        self.sweep_tests += counts.tests;
        self.brute_ms += forced_ms;
        let start = now();
        sweep.step(boxes, &mut ())?;
        self.sweep_ms += now() - start;
        let start = now();
        finder.find(boxes)?;
        self.finder_ms += now() - start;
        Ok(())
    }

    fn print(&self) {
        println!("one broad phase          tests             ms     times faster");
        let line = |name: &str, tests: Option<u64>, ms: f64| {
            let tests = tests.map_or("-".to_owned(), |tests| grouped(tests / self.samples));
            let ratio = self.brute_ms / ms;
            println!("{name:<16} {tests:>13} {:>14.2} {ratio:>16.1}", ms / self.samples as f64);
        };
        line("brute force", Some(self.brute_tests), self.brute_ms);
        line("sorted pairwise", Some(self.sweep_tests), self.sweep_ms);
        line("find_pairs", None, self.finder_ms);
        println!(
            "{}, the same by all three; mean of {}",
            several(self.pairs / self.samples, "pair"),
            several(self.samples, "sample"),
        );
    }
}

fn runner<const D: usize>(method: Method) -> Runner<D> {
    Runner::new(RunnerOptions::new(method))
}

fn sorted(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut pairs = pairs.to_vec();
    pairs.sort_unstable();
    pairs
}

/// "1 step", "2 steps".
fn several(number: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(number), if number == 1 { "" } else { "s" })
}

/// 12345678 as 12,345,678.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups: Vec<&str> =
        digits.as_bytes().rchunks(3).rev().map(|g| std::str::from_utf8(g).unwrap_or("")).collect();
    groups.join(",")
}
