//! Checks and times the contenders: each case is one set of boxes, each round of a case runs every
//! contender once, so that what slows the machine slows them all, and ratios are taken within a
//! round.

use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::{Result, ensure};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};

use crate::fingerprint::Fingerprint;
use crate::peers::{self, OURS, Peer};
use crate::record::{Case, Entry, Outcome, Record, Times, median};
use crate::remote::{self, Remote};
use crate::report::time;
use crate::worker::{Reply, Request};
use crate::{machine, scene};

/// Up to so many boxes brute force is the reference; beyond, two contenders that agree.
const ORACLE_LIMIT: usize = 10_000;
/// Short runs are repeated until a round of a contender takes about so long.
const ROUND: Duration = Duration::from_millis(20);
/// Fewer boxes than this are found in batches of calls, of about so many boxes together.
const BATCHED: usize = 1000;
/// No contender takes part in more rounds once it has taken so long, but for the first three.
const PATIENCE: Duration = Duration::from_secs(8);
/// Sets of boxes with more pairs than about this are left out.
const MOST_PAIRS: f64 = 5e7;

/// What to measure.
#[derive(Args)]
pub struct Options {
    /// Few boxes and few rounds: a minute instead of an hour.
    #[arg(long)]
    quick: bool,
    /// Names of scenes (all for every one) or of motions, or files of raw boxes (rows of 2 × D
    /// little-endian f32) that end in .f32, with their whole path.
    #[arg(long, value_delimiter = ',', default_values = scene::DEFAULT)]
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
    #[arg(long, default_value_t = 5.0)]
    limit: f64,
    /// The file of results; those of other boxes in it are kept. By default it is named for the
    /// processor and the day, in the folder of results.
    #[arg(long)]
    output: Option<PathBuf>,
}

impl Options {
    fn sizes(&self) -> Vec<usize> {
        let default: &[usize] =
            if self.quick { &[1_000, 10_000] } else { &[1_000, 10_000, 100_000, 1_000_000] };
        let mut sizes = if self.sizes.is_empty() { default.to_vec() } else { self.sizes.clone() };
        sizes.sort_unstable();
        sizes
    }

    fn rounds(&self) -> usize {
        self.rounds.unwrap_or(if self.quick { 3 } else { 9 }).max(1)
    }

    fn limit(&self) -> Duration {
        Duration::from_secs_f64(self.limit)
    }

    fn wants(&self, peer: &Peer, dimensions: usize) -> bool {
        let named = self.peers.iter().any(|name| peer.name.starts_with(name.as_str()));
        let exists = if dimensions == 2 { peer.two.is_some() } else { peer.three.is_some() };
        exists && (self.peers.is_empty() || named || peer.name == OURS)
    }
}

/// Measures everything that the options ask for, and keeps the results after every case.
pub fn run(options: &Options) -> Result<()> {
    ensure!(
        options.dimensions.iter().all(|dimensions| [2, 3].contains(dimensions)),
        "only two and three dimensions are measured"
    );
    let peers = peers::all();
    let mut plan = Vec::new();
    for name in &scene::named(&options.scenes) {
        for &dimensions in &options.dimensions {
            if scene::exists(name, dimensions)? {
                let sizes = options.sizes().into_iter();
                plan.extend(sizes.map(|boxes| (name.clone(), dimensions, boxes)));
            }
        }
    }

    let machine = machine::describe();
    let (mut record, path) = open(options, &peers, machine)?;
    println!(
        "{}, {} cores, copies {:.1} GB/s, load {}",
        record.machine.cpu,
        record.machine.cores,
        record.machine.copy_bytes_per_second / 1e9,
        record.machine.load.map_or("unknown".into(), |load| load.to_string()),
    );
    let bar = ProgressBar::new((plan.len() * (options.rounds() + 1)) as u64);
    bar.set_style(ProgressStyle::with_template("{elapsed} {wide_bar} {pos}/{len} {msg:60!}")?);
    let mut slow = HashMap::new();
    for (name, dimensions, boxes) in plan {
        let case = Setting { options, scene: &name, dimensions, boxes, bar: &bar };
        let contenders = peers.iter().filter(|peer| options.wants(peer, dimensions)).collect();
        match case.measure(contenders, &mut slow)? {
            Ok(case) => {
                bar.suspend(|| println!("{}", summary(&case)));
                record.put(case);
                record.write(&path)?;
            }
            Err(why) => {
                bar.suspend(|| println!("{name} {dimensions}D {boxes}: left out, {why}"));
            }
        }
    }
    bar.finish_and_clear();
    println!("Kept in {}", path.display());
    Ok(())
}

/// The record of this machine and day, with what is in it so far.
fn open(
    options: &Options,
    peers: &[Peer],
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
    };
    if path.exists() {
        let kept = Record::read(&path)?;
        (record.versions, record.how, record.cases) = (kept.versions, kept.how, kept.cases);
    }
    record.versions.extend(peers.iter().map(|peer| (peer.name.into(), peer.version())));
    record.how.extend(peers.iter().map(|peer| (peer.name.into(), peer.how.into())));
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

/// One set of boxes that is to be measured.
struct Setting<'a> {
    options: &'a Options,
    scene: &'a str,
    dimensions: usize,
    boxes: usize,
    bar: &'a ProgressBar,
}

/// How long a contender took for a number of boxes of a scene; without end if it was stopped.
type Slow = HashMap<(String, usize, &'static str), (usize, Duration)>;

/// A contender whose worker runs.
struct Running<'a> {
    peer: &'a Peer,
    worker: Remote,
    first: Duration,
    fingerprint: Fingerprint,
    peak_bytes: Option<u64>,
    rounds: Vec<(usize, f64)>,
    spent: Duration,
}

impl Setting<'_> {
    /// Checks and times the contenders, or says why these boxes are left out.
    fn measure(&self, contenders: Vec<&Peer>, slow: &mut Slow) -> Result<Result<Case, String>> {
        self.bar.set_message(format!("{} {}D {}", self.scene, self.dimensions, self.boxes));
        let expected = match self.dimensions {
            2 => scene::estimated_pairs::<2>(self.scene, self.boxes)?,
            _ => scene::estimated_pairs::<3>(self.scene, self.boxes)?,
        };
        if expected > MOST_PAIRS {
            self.bar.inc(1 + self.options.rounds() as u64);
            return Ok(Err(format!("about {expected:.0e} pairs")));
        }

        let mut running = Vec::new();
        let mut untimed = Vec::new();
        for peer in contenders {
            match self.check(peer, slow)? {
                Ok(contender) => running.push(contender),
                Err(why) => untimed.push((peer, why)),
            }
        }
        self.bar.inc(1);

        let Some((reference, fingerprint)) = self.reference(&running)? else {
            self.bar.inc(self.options.rounds() as u64);
            return Ok(Err("no two contenders agree".into()));
        };
        running.retain(|contender| {
            let right = contender.fingerprint == fingerprint;
            if !right {
                let found = contender.fingerprint.pairs;
                untimed.push((contender.peer, format!("other pairs, {found} of them")));
            }
            right
        });
        for round in 0..self.options.rounds() {
            self.round(round, &mut running, &mut untimed)?;
            self.bar.inc(1);
        }

        let ours: HashMap<usize, f64> = running
            .iter()
            .find(|contender| contender.peer.name == OURS)
            .map(|contender| contender.rounds.iter().copied().collect())
            .unwrap_or_default();
        let timed = running.into_iter().map(|contender| Entry {
            name: contender.peer.name.into(),
            rival: contender.peer.rival,
            outcome: Outcome::Timed(contender.times(&ours)),
        });
        let untimed = untimed.into_iter().map(|(peer, why)| Entry {
            name: peer.name.into(),
            rival: peer.rival,
            outcome: Outcome::Untimed { why },
        });
        Ok(Ok(Case {
            scene: self.scene.into(),
            dimensions: self.dimensions,
            boxes: self.boxes,
            pairs: fingerprint.pairs / scene::frames_checked(self.scene) as u64,
            reference,
            revision: machine::revision(),
            results: timed.chain(untimed).collect(),
        }))
    }

    /// Starts a contender's worker and has it find the pairs once, or says why it cannot be timed.
    fn check<'a>(&self, peer: &'a Peer, slow: &mut Slow) -> Result<Result<Running<'a>, String>> {
        let limit = self.options.limit();
        let too_slow = format!("over {} s", self.options.limit);
        let key = (self.scene.to_owned(), self.dimensions, peer.name);
        if let Some(&(boxes, took)) = slow.get(&key) {
            // Nothing here takes less than proportionally longer for more boxes.
            if took.saturating_mul((self.boxes / boxes.max(1)) as u32) > limit {
                return Ok(Err(format!("{too_slow}, as its time for {boxes} boxes shows")));
            }
        }
        let mut worker = Remote::start(peer.name, self.scene, self.dimensions, self.boxes)?;
        let (fingerprint, nanoseconds, peak_bytes) = match worker.ask(&Request::Check, limit)? {
            remote::Outcome::Reply(Reply::Checked { fingerprint, nanoseconds, peak_bytes }) => {
                (fingerprint, nanoseconds, peak_bytes)
            }
            remote::Outcome::Late => {
                slow.insert(key, (self.boxes, Duration::MAX));
                return Ok(Err(too_slow));
            }
            other => return Ok(Err(failure(other))),
        };
        let first = Duration::from_nanos(nanoseconds);
        slow.insert(key, (self.boxes, first));
        let (rounds, spent) = (Vec::new(), Duration::ZERO);
        Ok(Ok(Running { peer, worker, first, fingerprint, peak_bytes, rounds, spent }))
    }

    /// The right pairs, and in words how we know; nothing if no two contenders agree.
    fn reference(&self, running: &[Running]) -> Result<Option<(String, Fingerprint)>> {
        if self.boxes <= ORACLE_LIMIT {
            let right = match self.dimensions {
                2 => scene::oracle::<2>(self.scene, self.boxes)?,
                _ => scene::oracle::<3>(self.scene, self.boxes)?,
            };
            return Ok(Some(("brute force".into(), right)));
        }
        // All of ours count as one witness.
        let witness = |one: &&Running| one.peer.rival || one.peer.name == OURS;
        let witnesses: Vec<_> = running.iter().filter(witness).rev().collect();
        Ok(witnesses.iter().enumerate().find_map(|(at, one)| {
            let other = witnesses[at + 1..].iter().find(|it| it.fingerprint == one.fingerprint)?;
            Some((format!("{} and {} agree", other.peer.name, one.peer.name), one.fingerprint))
        }))
    }

    /// Runs every contender once, each round beginning with another.
    fn round<'a>(
        &self,
        round: usize,
        running: &mut Vec<Running<'a>>,
        untimed: &mut Vec<(&'a Peer, String)>,
    ) -> Result<()> {
        let count = running.len();
        let mut lost = Vec::new();
        for at in (0..count).map(|at| (at + round) % count) {
            let contender = &mut running[at];
            if round >= 3 && contender.spent > PATIENCE {
                continue;
            }
            let batch = (BATCHED / self.boxes.max(1)).clamp(1, 256);
            let repeats = ROUND.as_nanos() / (contender.first.as_nanos().max(1) * batch as u128);
            let request = Request::Time { repeats: repeats.clamp(1, 200) as usize, batch };
            // The limit is for what takes too long once; here it only guards against hanging.
            match contender.worker.ask(&request, 10 * self.options.limit() + 20 * ROUND)? {
                remote::Outcome::Reply(Reply::Timed { nanoseconds }) => {
                    let all = nanoseconds.iter().sum::<f64>() * batch as f64;
                    contender.spent += Duration::from_nanos(all as u64);
                    contender.rounds.push((round, median(&nanoseconds)));
                }
                other => lost.push((at, failure(other))),
            }
        }
        lost.sort_unstable();
        for (at, why) in lost.into_iter().rev() {
            untimed.push((running.remove(at).peer, why));
        }
        Ok(())
    }
}

/// What went wrong, of an outcome that is not what was asked for.
fn failure(outcome: remote::Outcome) -> String {
    match outcome {
        remote::Outcome::Reply(Reply::Failed { message }) => message,
        remote::Outcome::Reply(_) => "an answer to another question".into(),
        remote::Outcome::Late => "no answer any more".into(),
        remote::Outcome::Ended(how) => how,
    }
}

impl Running<'_> {
    /// The times over the rounds, against ours in the same rounds.
    fn times(&self, ours: &HashMap<usize, f64>) -> Times {
        let rounds: Vec<_> = self.rounds.iter().map(|&(_, time)| time).collect();
        let ratios: Vec<_> =
            self.rounds.iter().filter_map(|(round, time)| Some(time / ours.get(round)?)).collect();
        Times {
            median_ns: median(&rounds),
            min_ns: rounds.iter().copied().fold(f64::INFINITY, f64::min),
            rounds_ns: rounds,
            ratio: (!ratios.is_empty()).then(|| median(&ratios)),
            peak_bytes: self.peak_bytes,
        }
    }
}
