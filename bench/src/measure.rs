//! What is measured: the plan of a run, part by part, and where its results are kept.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use sweep_and_prune_scenes::Motion;

use crate::comparison::Comparison;
use crate::libraries::{self, LibraryInfo, ON_TWO_THREADS, THIS_CRATE, WITNESSES};
use crate::protocol::Kind;
use crate::record::{Case, Outcome, Record, put};
use crate::report::time;
use crate::worlds::TREE_FROM_SCRATCH;
use crate::{intervals, machine, roofline, scene, worlds};

/// The numbers of boxes of the small inputs.
const SMALL: [usize; 8] = [0, 1, 2, 5, 10, 20, 50, 100];

/// What to measure: everything, unless parts are named.
#[derive(Args)]
pub struct Options {
    /// Finding all pairs on six scenes, every library.
    #[arg(long)]
    pairs: bool,
    /// Finding all pairs on all other scenes, against a few libraries: is this one ever slow?
    #[arg(long)]
    flat: bool,
    /// Finding all pairs of at most 100 boxes, beside brute force.
    #[arg(long)]
    small: bool,
    /// Tracking pairs from frame to frame.
    #[arg(long)]
    worlds: bool,
    /// Tracking the pairs of 2,000 boxes that move among many static ones.
    #[arg(long)]
    statics: bool,
    /// Finding and counting the pairs of intervals; only if named, since its libraries are compiled for this processor.
    #[arg(long)]
    intervals: bool,
    /// How close the stages of finding all pairs come to what the machine can do.
    #[arg(long)]
    roofline: bool,
    /// Few boxes and few rounds: minutes instead of half an hour.
    #[arg(long)]
    quick: bool,
    /// Continue a run that was stopped: leave out the cases that the file of results already has.
    #[arg(long)]
    resume: bool,
    /// Names of scenes (all for every one) or of motions, or files of raw boxes (rows of 2 × D
    /// little-endian f32) that end in .f32, with their whole path; for worlds, of motions.
    #[arg(long, value_delimiter = ',')]
    scenes: Vec<String>,
    /// Numbers of boxes.
    #[arg(long, value_delimiter = ',')]
    sizes: Vec<usize>,
    /// Numbers of dimensions.
    #[arg(long, value_delimiter = ',', default_values_t = [2, 3])]
    dimensions: Vec<usize>,
    /// Only the libraries whose names begin with one of these, and this one.
    #[arg(long, value_delimiter = ',')]
    libraries: Vec<String>,
    /// Scenes of each kind up to 10,000 boxes, one for each seed: by default 200,000 boxes in all, but at least 100 scenes
    /// and at most 2,000.
    #[arg(long)]
    seeds: Option<usize>,
    /// Rounds of a case.
    #[arg(long)]
    rounds: Option<usize>,
    /// Seconds after which a library is stopped and recorded as too slow.
    #[arg(long, default_value_t = 1.5)]
    limit: f64,
    /// Begin no case after this many minutes; `--resume` continues from there.
    #[arg(long)]
    minutes: Option<f64>,
    /// The file of results. Cases that are not measured again stay in it. By default it is named for the processor and the
    /// day, in the folder of results.
    #[arg(long)]
    output: Option<PathBuf>,
}

/// How many seconds a library of intervals may take for each interval, if that is more than the limit.
const LIMIT_OF_INTERVAL: f64 = 1e-5;

/// One case to measure.
struct Planned {
    kind: Kind,
    scene: String,
    dimensions: usize,
    boxes: usize,
    /// Libraries whose names begin with one of these take part, and this one; all if there are none.
    libraries: Vec<String>,
    rounds: usize,
}

impl Options {
    /// Whether no part is named, which asks for all.
    fn everything(&self) -> bool {
        let boxes = self.pairs || self.flat || self.small || self.worlds || self.statics;
        !(boxes || self.intervals || self.roofline)
    }

    /// The cases, in the order in which they are measured: part by part, the most asked for first,
    /// and in each few boxes first, since a library that is slow there need not be tried with many.
    fn plan(&self) -> Result<Vec<Planned>> {
        let all = self.everything();
        let six = || scene::DEFAULT.map(str::to_owned).to_vec();
        let mut plan = Vec::new();
        if all || self.pairs {
            for boxes in self.sizes(&[1_000, 10_000, 100_000, 1_000_000]) {
                let rounds = match boxes {
                    0..=10_000 => 9,
                    10_001..=100_000 => 5,
                    _ => 3,
                };
                self.add(&mut plan, Kind::Pairs, &self.scenes(six), boxes, &[], rounds)?;
            }
        }
        if all || self.small {
            for boxes in if self.sizes.is_empty() { SMALL.to_vec() } else { self.sizes.clone() } {
                self.add(&mut plan, Kind::Pairs, &self.scenes(six), boxes, &["brute force"], 5)?;
            }
        }
        if all || self.worlds {
            let motions = self.scenes(|| Motion::ALL.map(|it| it.name().to_owned()).to_vec());
            for boxes in self.sizes(&[1_000, 10_000, 100_000, 1_000_000]) {
                // A million shows whether the time per body stays flat; the tree is a second opinion on the pairs.
                let libraries: &[&str] =
                    if boxes > 100_000 { &[THIS_CRATE, TREE_FROM_SCRATCH] } else { &[] };
                self.add(&mut plan, Kind::Worlds, &motions, boxes, libraries, 5)?;
            }
        }
        if all || self.statics {
            for boxes in self.sizes(&[10_000, 100_000, 1_000_000, 2_000_000]) {
                self.add(&mut plan, Kind::Statics, &[worlds::LEVEL.into()], boxes, &[], 5)?;
            }
        }
        if self.intervals {
            let names = self.scenes(intervals::names);
            for boxes in self.sizes(&[1_000, 10_000, 100_000, 1_000_000]) {
                let rounds = if boxes > 100_000 { 3 } else { 5 };
                self.add(&mut plan, Kind::Intervals, &names, boxes, &[], rounds)?;
            }
            if self.scenes.is_empty() && self.sizes.is_empty() && !self.quick {
                let names = ["pairs", "counts"]
                    .map(|asked| format!("{} random {asked}", intervals::AILIST));
                self.add(&mut plan, Kind::Intervals, &names, intervals::AILIST_READS, &[], 2)?;
            }
        }
        if all || self.flat {
            for boxes in self.sizes(&[10_000, 100_000, 1_000_000]) {
                // For a million, one library that is seldom slow suffices as a second opinion.
                let witnesses = if boxes > 100_000 { &WITNESSES[..1] } else { &WITNESSES };
                let rounds = if boxes > 100_000 { 2 } else { 3 };
                let libraries = [&[ON_TWO_THREADS], witnesses].concat();
                let scenes = self.scenes(scene::others);
                self.add(&mut plan, Kind::Pairs, &scenes, boxes, &libraries, rounds)?;
            }
        }
        ensure!(
            !plan.is_empty() || self.roofline,
            "nothing to measure: no scene or motion of these names is in what was asked for"
        );
        Ok(plan)
    }

    /// Adds a case for each scene in each number of dimensions, unless an earlier part has it, with more libraries.
    fn add(
        &self,
        plan: &mut Vec<Planned>,
        kind: Kind,
        scenes: &[String],
        boxes: usize,
        libraries: &[&str],
        rounds: usize,
    ) -> Result<()> {
        let rounds = self.rounds.unwrap_or(if self.quick { 3 } else { rounds }).max(1);
        let libraries = if self.libraries.is_empty() {
            libraries.iter().map(|&name| name.to_owned()).collect()
        } else {
            self.libraries.clone()
        };
        for scene in scenes {
            let dimensions = if kind == Kind::Intervals { &[1][..] } else { &self.dimensions };
            for &dimensions in dimensions {
                let exists = match kind {
                    Kind::Pairs => scene::exists(scene, dimensions)?,
                    Kind::Worlds => scene::exists(scene, dimensions)? && scene::moves(scene),
                    Kind::Statics | Kind::Intervals => true,
                };
                let same = |it: &Planned| {
                    (it.kind, it.dimensions, it.boxes) == (kind, dimensions, boxes)
                        && it.scene == *scene
                };
                if exists && !plan.iter().any(same) {
                    let (scene, libraries) = (scene.clone(), libraries.clone());
                    plan.push(Planned { kind, scene, dimensions, boxes, libraries, rounds });
                }
            }
        }
        Ok(())
    }

    fn scenes(&self, default: impl FnOnce() -> Vec<String>) -> Vec<String> {
        if self.scenes.is_empty() { default() } else { scene::named(&self.scenes) }
    }

    fn sizes(&self, default: &[usize]) -> Vec<usize> {
        let most = if self.quick { 10_000 } else { usize::MAX };
        let default = default.iter().copied().filter(|&boxes| boxes <= most);
        if self.sizes.is_empty() { default.collect() } else { self.sizes.clone() }
    }
}

impl Planned {
    fn wants(&self, info: &LibraryInfo) -> bool {
        let named = self.libraries.iter().any(|name| info.name.starts_with(name.as_str()));
        info.dimensions.contains(&self.dimensions)
            && (self.libraries.is_empty() || named || info.name == THIS_CRATE)
    }
}

/// Measures everything that the options ask for, and keeps the results after every case.
pub fn run(options: &Options) -> Result<()> {
    ensure!(
        options.dimensions.iter().all(|dimensions| [2, 3].contains(dimensions)),
        "only two and three dimensions are measured"
    );
    let finders: Vec<_> = libraries::all().iter().map(libraries::Library::info).collect();
    let trackers: Vec<_> = worlds::all().iter().map(libraries::Library::info).collect();
    let levels: Vec<_> = worlds::with_statics().iter().map(libraries::Library::info).collect();
    let lines: Vec<_> = intervals::all().iter().map(intervals::IntervalLibrary::info).collect();
    let mut plan = options.plan()?;
    let machine = machine::describe();
    let (mut record, path) = open(options, [&finders, &trackers, &levels, &lines], machine)?;
    if options.resume {
        plan.retain(|planned| {
            let key = (planned.scene.as_str(), planned.dimensions, planned.boxes);
            !kept(&mut record, planned.kind).iter().any(|case| case.key() == key)
        });
    }
    println!(
        "{}, {} cores, copies {:.1} GB/s, load {}",
        record.machine.cpu,
        record.machine.cores,
        record.machine.copy_bytes_per_second / 1e9,
        record.machine.load.map_or("unknown".into(), |load| load.to_string()),
    );
    if options.everything() || options.roofline {
        let copy_rate = record.machine.copy_bytes_per_second;
        record.roofline = Some(roofline::measure(copy_rate, options.quick)?);
        record.write(&path)?;
    }
    let steps = plan.iter().map(|planned| 1 + planned.rounds as u64).sum();
    let bar = ProgressBar::new(steps);
    bar.set_style(ProgressStyle::with_template("{elapsed} {wide_bar} {pos}/{len} {msg:60!}")?);
    let mut slow = HashMap::new();
    let begun = Instant::now();
    for planned in plan {
        if options.minutes.is_some_and(|most| begun.elapsed().as_secs_f64() > 60.0 * most) {
            bar.suspend(|| println!("The time is up: --resume goes on from here"));
            break;
        }
        let Planned { kind, ref scene, dimensions, boxes, .. } = planned;
        let comparison = Comparison {
            kind,
            scene,
            dimensions,
            boxes,
            seeds: options.seeds,
            rounds: planned.rounds,
            limit: Duration::from_secs_f64(match kind {
                Kind::Intervals => options.limit.max(boxes as f64 * LIMIT_OF_INTERVAL),
                _ => options.limit,
            }),
            bar: &bar,
        };
        let infos = match kind {
            Kind::Pairs => &finders,
            Kind::Worlds => &trackers,
            Kind::Statics => &levels,
            Kind::Intervals => &lines,
        };
        let infos = infos.iter().filter(|info| planned.wants(info)).collect();
        match comparison.run(infos, &mut slow)? {
            Ok(case) => {
                bar.suspend(|| println!("{}", summary(&case)));
                put(kept(&mut record, kind), case);
                record.write(&path)?;
            }
            Err(why) => {
                bar.suspend(|| println!("{scene} {dimensions}D {boxes}: left out, {why}"));
            }
        }
    }
    bar.finish_and_clear();
    println!("Kept in {}", path.display());
    Ok(())
}

/// The cases of a kind.
fn kept(record: &mut Record, kind: Kind) -> &mut Vec<Case> {
    match kind {
        Kind::Pairs => &mut record.cases,
        Kind::Worlds => &mut record.worlds,
        Kind::Statics => &mut record.statics,
        Kind::Intervals => &mut record.intervals,
    }
}

/// The record of this machine and day, with what is in it so far.
fn open(
    options: &Options,
    infos: [&[LibraryInfo]; 4],
    machine: crate::record::Machine,
) -> Result<(Record, PathBuf)> {
    let date = chrono::Utc::now().format("%Y-%m-%d").to_string();
    let path = options.output.clone().unwrap_or_else(|| {
        let letters = machine.cpu.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' });
        let name = letters.collect::<String>().to_lowercase();
        let words: Vec<_> = name.split('-').filter(|word| !word.is_empty()).collect();
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("results");
        folder.join(format!("{}-{date}.json", words.join("-")))
    });
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut record = Record {
        date,
        machine,
        rustc: env!("RUSTC_VERSION").into(),
        versions: BTreeMap::new(),
        how: BTreeMap::new(),
        cases: Vec::new(),
        worlds: Vec::new(),
        statics: Vec::new(),
        intervals: Vec::new(),
        roofline: None,
    };
    if path.exists() {
        let kept = Record::read(&path)?;
        let (date, machine, rustc) = (record.date, record.machine, record.rustc);
        record = Record { date, machine, rustc, ..kept };
    }
    // Some libraries take part in several parts, called in different ways.
    for (infos, part) in infos.into_iter().zip(["", ", world", ", static boxes", ", intervals"]) {
        for info in infos {
            let name = format!("{}{part}", info.name);
            record.versions.insert(name.clone(), info.version.clone());
            record.how.insert(name, info.how.into());
        }
    }
    Ok((record, path))
}

/// One line on a case: this library and the fastest alternative.
fn summary(case: &Case) -> String {
    let mut line =
        format!("{} {}D {}: {} pairs", case.scene, case.dimensions, case.boxes, case.pairs);
    if let Some(own) = case.times(THIS_CRATE) {
        line += &format!(", {THIS_CRATE} {}", time(own.median_ns));
    }
    if let Some((name, times)) = case.ranking().first() {
        line += &format!(", {name} {}", time(times.median_ns));
        if let Some(ratio) = times.ratio {
            line += &format!(" ({ratio:.2} times)");
        }
    }
    for entry in &case.results {
        if let Outcome::Untimed { why } = &entry.outcome {
            line += &format!("; {}: {why}", entry.name);
        }
    }
    line
}
