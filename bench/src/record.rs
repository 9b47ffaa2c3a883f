//! What is kept of a run: one file a machine and day, in JSON.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use serde::{Deserialize, Serialize};

/// One file of results.
#[derive(Clone, Serialize, Deserialize)]
pub struct Record {
    /// The date of the run, year-month-day.
    pub date: String,
    /// Where it ran.
    pub machine: Machine,
    /// The compiler, as `rustc --version` says it.
    pub rustc: String,
    /// The libraries and their versions.
    pub versions: BTreeMap<String, String>,
    /// The libraries and how each was called.
    pub how: BTreeMap<String, String>,
    /// Finding all pairs, by scene, dimensions and number of boxes.
    pub cases: Vec<Case>,
    /// Tracking pairs, by motion, dimensions and number of boxes. Times are per frame.
    #[serde(default)]
    pub worlds: Vec<Case>,
    /// Tracking the pairs of boxes that move among many static ones, by the number of static boxes. Times are per frame.
    #[serde(default)]
    pub statics: Vec<Case>,
    /// Finding or counting the pairs of intervals.
    #[serde(default)]
    pub intervals: Vec<Case>,
    /// How close finding all pairs comes to what the machine can do.
    #[serde(default)]
    pub roofline: Option<Roofline>,
}

/// What the machine can do, and how much of it each stage of finding all pairs reaches.
#[derive(Clone, Serialize, Deserialize)]
pub struct Roofline {
    /// Bytes read plus bytes written a second when one thread copies a large buffer.
    pub copy_bytes_per_second: f64,
    /// By number of dimensions, the boxes that the kernel tests a second when all is in the
    /// nearest cache and none overlap.
    pub kernel_tests_per_second: BTreeMap<String, f64>,
    /// The stages, in their order.
    pub stages: Vec<Stage>,
}

/// A stage of finding all pairs.
#[derive(Clone, Serialize, Deserialize)]
pub struct Stage {
    /// The scene's name.
    pub scene: String,
    /// 2 or 3.
    pub dimensions: usize,
    /// The number of boxes.
    pub boxes: usize,
    /// The stage's name.
    pub stage: String,
    /// Its time.
    pub ns: f64,
    /// What it has to read and write.
    pub bytes: f64,
    /// What it has to test.
    pub tests: f64,
    /// The time of these bytes at the rate at which as many are copied, or of these tests at the
    /// rate above: the longer of the two.
    pub limit_ns: f64,
    /// `limit_ns` over `ns`, at most 1.
    pub share: f64,
}

/// What the times depend on in the machine.
#[derive(Clone, Serialize, Deserialize)]
pub struct Machine {
    /// The processor's name, family and model.
    pub cpu: String,
    /// The processors that the process may use.
    pub cores: usize,
    /// The vector extensions that the processor has, of those that matter here.
    pub vectors: Vec<String>,
    /// The main memory in bytes.
    pub memory_bytes: Option<u64>,
    /// The operating system.
    pub system: String,
    /// The rate of the time stamp counter in MHz, measured; `None` off x86-64.
    pub tsc_mhz: Option<f64>,
    /// Bytes read plus bytes written a second when one thread copies a large buffer.
    pub copy_bytes_per_second: f64,
    /// The machine's load average when the run began: above 0.5 others were at work.
    pub load: Option<f64>,
}

/// One set of boxes and what the libraries made of it.
#[derive(Clone, Serialize, Deserialize)]
pub struct Case {
    /// The scene's name.
    pub scene: String,
    /// 2 or 3.
    pub dimensions: usize,
    /// The number of boxes.
    pub boxes: usize,
    /// The number of pairs; of boxes in motion the mean over the frames checked.
    pub pairs: u64,
    /// What every library's pairs were checked against.
    pub reference: String,
    /// The commit of this repository that was measured, where Git tells.
    pub revision: Option<String>,
    /// What each library did.
    pub results: Vec<Entry>,
}

/// One library on one set of boxes.
#[derive(Clone, Serialize, Deserialize)]
pub struct Entry {
    /// The library's name.
    pub name: String,
    /// Whether it is another library, or this one in another setting.
    pub alternative: bool,
    /// What came of it.
    pub outcome: Outcome,
}

/// What came of a library.
#[derive(Clone, Serialize, Deserialize)]
pub enum Outcome {
    /// Its pairs were right, and it was timed.
    Timed(Times),
    /// It was not timed: too slow, in error, or with other pairs than the reference.
    Untimed {
        /// Why.
        why: String,
    },
}

/// The times of a library, from raw boxes to stored pairs.
#[derive(Clone, Serialize, Deserialize)]
pub struct Times {
    /// The median over the rounds.
    pub median_ns: f64,
    /// The least over the rounds.
    pub min_ns: f64,
    /// Each round's time (the median of its repeats).
    pub rounds_ns: Vec<f64>,
    /// The median over the rounds of this library's time over that of sweep-and-prune in the same round.
    pub ratio: Option<f64>,
    /// The most memory in use during the first call, of a world in the first frames, beyond the
    /// boxes.
    pub peak_bytes: Option<u64>,
    /// Of a world, how long it takes to insert all boxes and to find their first pairs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start_ns: Option<f64>,
    /// Of a world, the longest of the first updates, which are not among the rounds.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub longest_ns: Option<f64>,
    /// Of a world that reports the pairs of larger or rounded boxes, how long it takes to test them for overlap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exact_ns: Option<f64>,
}

impl Entry {
    /// The times, if it was timed.
    pub fn times(&self) -> Option<&Times> {
        match &self.outcome {
            Outcome::Timed(times) => Some(times),
            Outcome::Untimed { .. } => None,
        }
    }
}

impl Case {
    /// The times of a library.
    pub fn times(&self, name: &str) -> Option<&Times> {
        self.results.iter().find(|entry| entry.name == name)?.times()
    }

    /// The alternatives that were timed, the fastest first.
    pub fn ranking(&self) -> Vec<(&str, &Times)> {
        let alternatives = self.results.iter().filter(|entry| entry.alternative);
        let mut ranking: Vec<_> =
            alternatives.filter_map(|entry| Some((entry.name.as_str(), entry.times()?))).collect();
        ranking.sort_by(|(_, a), (_, b)| a.median_ns.total_cmp(&b.median_ns));
        ranking
    }

    /// What no two cases of a kind have in common.
    pub fn key(&self) -> (&str, usize, usize) {
        (&self.scene, self.dimensions, self.boxes)
    }
}

impl Record {
    /// Reads a file of results.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).with_context(|| format!("reading {}", path.display()))?;
        serde_json::from_slice(&text).with_context(|| format!("parsing {}", path.display()))
    }

    /// Replaces the file, whole or not at all.
    pub fn write(&self, path: &Path) -> Result<()> {
        let text = serde_json::to_string_pretty(self)? + "\n";
        // A name that no other process writes to; if a file has it, that is an error.
        let part = path.with_extension(format!("{}.part", std::process::id()));
        std::fs::File::create_new(&part)
            .and_then(|mut file| std::io::Write::write_all(&mut file, text.as_bytes()))
            .with_context(|| format!("writing {}", part.display()))?;
        std::fs::rename(&part, path).with_context(|| format!("writing {}", path.display()))
    }
}

/// Adds a case. If there is one with the same boxes, replaces it.
pub fn put(cases: &mut Vec<Case>, case: Case) {
    match cases.iter_mut().find(|kept| kept.key() == case.key()) {
        Some(kept) => *kept = case,
        None => cases.push(case),
    }
}

/// The median of at least one number; the mean of the middle two of an even count.
pub fn median(numbers: &[f64]) -> f64 {
    let mut sorted = numbers.to_vec();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.len() / 2;
    if sorted.len().is_multiple_of(2) {
        (sorted[middle - 1] + sorted[middle]) / 2.0
    } else {
        sorted[middle]
    }
}
