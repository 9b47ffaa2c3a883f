//! What is measured: the plan of a run, part by part, and where its results are kept.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use sweep_and_prune_scenes::Motion;

use crate::contest::{Contest, Kind};
use crate::peers::{self, Entrant, OURS, OURS_ON_TWO, WITNESSES};
use crate::record::{Case, Outcome, Record, put};
use crate::report::time;
use crate::{machine, roofline, scene, worlds};

/// The numbers of boxes of the small inputs.
const SMALL: [usize; 8] = [0, 1, 2, 5, 10, 20, 50, 100];

/// What to measure: everything, unless parts are named.
#[derive(Args)]
pub struct Options {
    /// Finding all pairs on six scenes, every peer.
    #[arg(long)]
    pairs: bool,
    /// Finding all pairs on all other scenes, a few peers: is ours ever slow?
    #[arg(long)]
    flat: bool,
    /// Finding all pairs of at most 100 boxes, beside brute force.
    #[arg(long)]
    small: bool,
    /// Following a world from frame to frame.
    #[arg(long)]
    worlds: bool,
    /// How close the stages of finding all pairs come to what the machine can do.
    #[arg(long)]
    roofline: bool,
    /// Few boxes and few rounds: minutes instead of half an hour.
    #[arg(long)]
    quick: bool,
    /// Leave out the cases that the file of results has, to go on where a run was stopped.
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
    /// Only the contenders whose names begin with one of these, and ours.
    #[arg(long, value_delimiter = ',')]
    peers: Vec<String>,
    /// Rounds of a case.
    #[arg(long)]
    rounds: Option<usize>,
    /// Seconds after which a contender is stopped and recorded as too slow.
    #[arg(long, default_value_t = 1.5)]
    limit: f64,
    /// After so many minutes no case is begun; `--resume` goes on from there.
    #[arg(long)]
    minutes: Option<f64>,
    /// The file of results; those of other boxes in it are kept. By default it is named for the
    /// processor and the day, in the folder of results.
    #[arg(long)]
    output: Option<PathBuf>,
}

/// One case that is to be measured.
struct Planned {
    kind: Kind,
    scene: String,
    dimensions: usize,
    boxes: usize,
    /// Whoever's name begins with one of these takes part, and ours; everyone if there are none.
    peers: Vec<String>,
    rounds: usize,
}

impl Options {
    /// Whether no part is named, which asks for all.
    fn everything(&self) -> bool {
        !(self.pairs || self.flat || self.small || self.worlds || self.roofline)
    }

    /// The cases, in the order in which they are measured: part by part, the most asked for first,
    /// and in each few boxes first, since who is slow there need not be tried with many.
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
                // Of a million, whether the time a body stays flat.
                let peers: &[&str] = if boxes > 100_000 { &[OURS] } else { &[] };
                self.add(&mut plan, Kind::Worlds, &motions, boxes, peers, 5)?;
            }
        }
        if all || self.flat {
            for boxes in self.sizes(&[10_000, 100_000, 1_000_000]) {
                // Of a million, one that is seldom slow is enough to agree with.
                let witnesses = if boxes > 100_000 { &WITNESSES[..1] } else { &WITNESSES };
                let rounds = if boxes > 100_000 { 2 } else { 3 };
                let peers = [&[OURS_ON_TWO], witnesses].concat();
                let scenes = self.scenes(scene::others);
                self.add(&mut plan, Kind::Pairs, &scenes, boxes, &peers, rounds)?;
            }
        }
        Ok(plan)
    }

    /// Adds a case for each scene in each number of dimensions.
    fn add(
        &self,
        plan: &mut Vec<Planned>,
        kind: Kind,
        scenes: &[String],
        boxes: usize,
        peers: &[&str],
        rounds: usize,
    ) -> Result<()> {
        let rounds = self.rounds.unwrap_or(if self.quick { 3 } else { rounds }).max(1);
        let peers = if self.peers.is_empty() {
            peers.iter().map(|&name| name.to_owned()).collect()
        } else {
            self.peers.clone()
        };
        for scene in scenes {
            for &dimensions in &self.dimensions {
                if scene::exists(scene, dimensions)? {
                    let (scene, peers) = (scene.clone(), peers.clone());
                    plan.push(Planned { kind, scene, dimensions, boxes, peers, rounds });
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
    fn wants(&self, entrant: &Entrant) -> bool {
        let named = self.peers.iter().any(|name| entrant.name.starts_with(name.as_str()));
        entrant.dimensions.contains(&self.dimensions)
            && (self.peers.is_empty() || named || entrant.name == OURS)
    }
}

/// Measures everything that the options ask for, and keeps the results after every case.
pub fn run(options: &Options) -> Result<()> {
    ensure!(
        options.dimensions.iter().all(|dimensions| [2, 3].contains(dimensions)),
        "only two and three dimensions are measured"
    );
    let finders: Vec<_> = peers::all().iter().map(peers::Peer::entrant).collect();
    let followers: Vec<_> = worlds::all().iter().map(peers::Peer::entrant).collect();
    let mut plan = options.plan()?;
    let machine = machine::describe();
    let (mut record, path) = open(options, &finders, &followers, machine)?;
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
        let contest = Contest {
            kind,
            scene,
            dimensions,
            boxes,
            rounds: planned.rounds,
            limit: Duration::from_secs_f64(options.limit),
            bar: &bar,
        };
        let entrants = if kind == Kind::Worlds { &followers } else { &finders };
        let entrants = entrants.iter().filter(|entrant| planned.wants(entrant)).collect();
        match contest.run(entrants, &mut slow)? {
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
    }
}

/// The record of this machine and day, with what is in it so far.
fn open(
    options: &Options,
    finders: &[Entrant],
    followers: &[Entrant],
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
        roofline: None,
    };
    if path.exists() {
        let kept = Record::read(&path)?;
        let (date, machine, rustc) = (record.date, record.machine, record.rustc);
        record = Record { date, machine, rustc, ..kept };
    }
    // Some are both, and called in another way.
    let finders = finders.iter().map(|it| (it.name.to_owned(), it));
    let followers = followers.iter().map(|it| (format!("{}, world", it.name), it));
    for (name, entrant) in finders.chain(followers) {
        record.versions.insert(name.clone(), entrant.version.clone());
        record.how.insert(name, entrant.how.into());
    }
    Ok((record, path))
}

/// One line on a case: ours and the fastest rival.
fn summary(case: &Case) -> String {
    let mut line =
        format!("{} {}D {}: {} pairs", case.scene, case.dimensions, case.boxes, case.pairs);
    if let Some(ours) = case.times(OURS) {
        line += &format!(", {OURS} {}", time(ours.median_ns));
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
