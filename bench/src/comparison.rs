//! One comparison: the libraries on one set of boxes, or on one motion. Each is checked first; then
//! each round runs every library once, so that what slows the machine slows them all, and ratios
//! are taken within a round.

use std::collections::HashMap;
use std::time::Duration;

use anyhow::Result;
use indicatif::ProgressBar;

use crate::fingerprint::Fingerprint;
use crate::libraries::{LibraryInfo, ON_TWO_THREADS, THIS_CRATE};
use crate::protocol::{Kind, Reply, Request};
use crate::record::{Case, Entry, Outcome, Times, median};
use crate::remote::{self, Remote};

use crate::worlds::FROM_SCRATCH;
use crate::{intervals, machine, scene, worlds};

/// Up to this many boxes brute force is the reference; above, two libraries that agree.
const ORACLE_LIMIT: usize = 10_000;
/// The same for static boxes, which are not tested against each other.
const STATICS_ORACLE_LIMIT: usize = 100_000;
/// With fewer boxes than this, calls are timed in batches that have about this many boxes together.
const BATCHED: usize = 1000;
/// After this time a library takes part in no more rounds, except for the first three.
const PATIENCE: Duration = Duration::from_secs(2);
/// A library that would take longer than this for all scenes of a round takes fewer scenes, and goes on with the others
/// in the next round.
const LONGEST_ROUND: Duration = Duration::from_secs(1);
/// The fewest scenes of a round.
const FEWEST_SCENES: u128 = 10;
/// Sets of boxes with more pairs than about this are left out.
const MOST_PAIRS: f64 = 5e7;
/// How many times the limit a world may take to be checked, over many frames.
const WORLD_CHECK: u32 = 3;
/// How long the check of a world takes for each box. None of it is the library's time: the check applies the events of the
/// first frames one by one.
const CHECK_OF_BOX: Duration = Duration::from_micros(10);

impl Kind {
    /// About how long a round of a library takes: short runs are repeated until they fill it.
    fn round(self) -> Duration {
        match self {
            Self::Pairs | Self::Intervals => Duration::from_millis(20),
            Self::Worlds | Self::Statics => Duration::from_millis(60),
        }
    }

    /// The least and the most repeats of a round.
    fn repeats(self) -> (u128, u128) {
        match self {
            Self::Pairs | Self::Intervals => (1, 200),
            Self::Worlds | Self::Statics => (4, 400),
        }
    }

    /// A round's time from the times of its repeats. A world may do work now and then that pays for many frames, and
    /// different scenes (`varied`) take different times, so all of them count.
    fn sum_up(self, varied: bool, nanoseconds: &[f64]) -> f64 {
        match self {
            Self::Pairs if !varied => median(nanoseconds),
            _ => nanoseconds.iter().sum::<f64>() / nanoseconds.len() as f64,
        }
    }
}

/// One set of boxes to measure.
pub struct Comparison<'a> {
    /// What the libraries do.
    pub kind: Kind,
    /// The name of the scene, of the motion, or of the draw of intervals and what is asked.
    pub scene: &'a str,
    /// 2 or 3; 1 for intervals.
    pub dimensions: usize,
    /// The number of boxes, of static boxes, or of intervals in the first set.
    pub boxes: usize,
    /// How many scenes of a kind are drawn, if not the default number.
    pub seeds: Option<usize>,
    /// Rounds in which each library is timed.
    pub rounds: usize,
    /// After this time a library is stopped.
    pub limit: Duration,
    /// Shows the progress: one step for the check and one for each round.
    pub bar: &'a ProgressBar,
}

/// How long a library took for a number of boxes of a scene; infinite if it was stopped. Of a world only that it was: its
/// first updates may build what later ones use.
pub type Slow = HashMap<(Kind, String, usize, &'static str), (usize, Duration)>;

/// A library whose worker runs.
struct Running<'a> {
    info: &'a LibraryInfo,
    worker: Remote,
    first: Duration,
    /// `None` if the library does not tell its pairs.
    fingerprint: Option<Fingerprint>,
    peak_bytes: Option<u64>,
    start_ns: Option<u64>,
    exact_ns: Option<u64>,
    rounds: Vec<(usize, f64)>,
    spent: Duration,
}

impl Comparison<'_> {
    /// Checks and times the libraries, or says why these boxes are left out.
    pub fn run(
        &self,
        libraries: Vec<&LibraryInfo>,
        slow: &mut Slow,
    ) -> Result<Result<Case, String>> {
        self.bar.set_message(format!("{} {}D {}", self.scene, self.dimensions, self.boxes));
        let expected = match self.dimensions {
            // These draw as many pairs as they are meant to.
            _ if matches!(self.kind, Kind::Statics | Kind::Intervals) => 0.0,
            2 => scene::estimated_pairs::<2>(self.scene, self.boxes)?,
            _ => scene::estimated_pairs::<3>(self.scene, self.boxes)?,
        };
        if expected > MOST_PAIRS {
            self.bar.inc(1 + self.rounds as u64);
            return Ok(Err(format!("about {expected:.0e} pairs")));
        }

        let mut running = Vec::new();
        let mut untimed = Vec::new();
        for info in libraries {
            match self.check(info, slow)? {
                Ok(library) => running.push(library),
                Err(why) => untimed.push((info, why)),
            }
        }
        self.bar.inc(1);

        let Some((reference, fingerprint)) = self.reference(&running)? else {
            self.bar.inc(self.rounds as u64);
            return Ok(Err("no two libraries agree".into()));
        };
        running.retain(|library| {
            let Some(found) = library.fingerprint else { return true };
            let right = found == fingerprint;
            if !right {
                let found = found.pairs;
                untimed.push((library.info, format!("other pairs, {found} of them")));
            }
            right
        });
        for round in 0..self.rounds {
            self.round(round, &mut running, &mut untimed)?;
            self.bar.inc(1);
        }

        let own: HashMap<usize, f64> = running
            .iter()
            .find(|library| library.info.name == THIS_CRATE)
            .map(|library| library.rounds.iter().copied().collect())
            .unwrap_or_default();
        let timed = running.into_iter().map(|library| {
            let times = library.times(self.kind, &own);
            if !self.kind.tracks() {
                // Not the first call, which may have had to get its memory.
                let took = Duration::from_nanos(times.median_ns as u64);
                slow.insert(self.key(library.info), (self.boxes, took));
            }
            Entry {
                name: library.info.name.into(),
                alternative: library.info.alternative,
                outcome: Outcome::Timed(times),
            }
        });
        let untimed = untimed.into_iter().map(|(info, why)| Entry {
            name: info.name.into(),
            alternative: info.alternative,
            outcome: Outcome::Untimed { why },
        });
        Ok(Ok(Case {
            scene: self.scene.into(),
            dimensions: self.dimensions,
            boxes: self.boxes,
            pairs: fingerprint.pairs / self.frames_checked(),
            reference,
            revision: machine::revision(),
            results: timed.chain(untimed).collect(),
        }))
    }

    /// Starts a library's worker and has it find the pairs once, or says why it cannot be timed.
    fn check<'a>(
        &self,
        info: &'a LibraryInfo,
        slow: &mut Slow,
    ) -> Result<Result<Running<'a>, String>> {
        // A world has as long for its first frames together as its check may take.
        let (limit, too_slow) = match self.kind {
            // For each frame, and once more for what else a check does.
            Kind::Pairs | Kind::Intervals => (
                (self.frames_checked() as u32 + 1) * self.limit,
                format!("over {} s", self.limit.as_secs_f64()),
            ),
            Kind::Worlds | Kind::Statics => {
                let limit = WORLD_CHECK * self.limit + CHECK_OF_BOX * self.boxes as u32;
                (limit, format!("over {} s for the first frames", limit.as_secs_f64()))
            }
        };
        let key = self.key(info);
        if let Some(&(boxes, took)) = slow.get(&key) {
            // Every library's time grows at least in proportion to the boxes.
            if took.saturating_mul((self.boxes / boxes.max(1)) as u32) > self.limit {
                return Ok(Err(format!("{too_slow}, as its time for {boxes} boxes shows")));
            }
        }
        let mut worker = Remote::start(
            self.kind,
            info.name,
            self.scene,
            self.dimensions,
            self.boxes,
            self.seeds,
        )?;
        match worker.ask(&Request::Check, limit)? {
            remote::Outcome::Reply(Reply::Checked {
                fingerprint,
                nanoseconds,
                peak_bytes,
                start_ns,
                exact_ns,
            }) => {
                let first = Duration::from_nanos(nanoseconds);
                if matches!(self.kind, Kind::Pairs | Kind::Intervals) && first > self.limit {
                    slow.insert(key, (self.boxes, first));
                    return Ok(Err(too_slow));
                }
                Ok(Ok(Running {
                    info,
                    worker,
                    first,
                    fingerprint,
                    peak_bytes,
                    start_ns,
                    exact_ns,
                    rounds: Vec::new(),
                    spent: Duration::ZERO,
                }))
            }
            remote::Outcome::Late => {
                slow.insert(key, (self.boxes, Duration::MAX));
                Ok(Err(too_slow))
            }
            other => Ok(Err(failure(other))),
        }
    }

    /// What a library's time is kept by.
    fn key(&self, info: &LibraryInfo) -> (Kind, String, usize, &'static str) {
        (self.kind, self.scene.to_owned(), self.dimensions, info.name)
    }

    /// How many frames are checked.
    fn frames_checked(&self) -> u64 {
        match self.kind {
            Kind::Pairs | Kind::Intervals => scene::frames_checked(self.scene, self.boxes) as u64,
            Kind::Worlds | Kind::Statics => worlds::FRAMES_CHECKED as u64,
        }
    }

    /// The right pairs, and in words how we know them; `None` if no two libraries agree.
    fn reference(&self, running: &[Running]) -> Result<Option<(String, Fingerprint)>> {
        let most = if self.kind == Kind::Statics { STATICS_ORACLE_LIMIT } else { ORACLE_LIMIT };
        if self.boxes <= most {
            let right = match (self.kind, self.dimensions) {
                (Kind::Pairs, 2) => scene::oracle::<2>(self.scene, self.boxes)?,
                (Kind::Pairs, _) => scene::oracle::<3>(self.scene, self.boxes)?,
                (Kind::Intervals, _) => intervals::oracle(self.scene, self.boxes)?,
                (Kind::Worlds | Kind::Statics, 2) => worlds::oracle::<2>(self.scene, self.boxes)?,
                (Kind::Worlds | Kind::Statics, _) => worlds::oracle::<3>(self.scene, self.boxes)?,
            };
            return Ok(Some(("brute force".into(), right)));
        }
        // All settings of this library count as one witness.
        let witness = |one: &&Running| {
            let speaks =
                one.info.alternative || [THIS_CRATE, FROM_SCRATCH].contains(&one.info.name);
            speaks && one.fingerprint.is_some()
        };
        let witnesses: Vec<_> = running.iter().filter(witness).rev().collect();
        if let [own] = witnesses[..] {
            let on_two = running.iter().find(|it| it.info.name == ON_TWO_THREADS);
            if own.info.name == THIS_CRATE
                && on_two.is_some_and(|it| it.fingerprint == own.fingerprint)
            {
                let how = "no alternative in time; one thread and two agree";
                return Ok(own.fingerprint.map(|right| (how.into(), right)));
            }
        }
        Ok(witnesses.iter().enumerate().find_map(|(at, one)| {
            let other = witnesses[at + 1..].iter().find(|it| {
                // Two settings of one library may share a fault. Of this repository, those that are beside the library
                // share no code with it.
                let is_another = it.info.package != one.info.package
                    || (it.info.package.is_none() && (it.info.alternative || one.info.alternative));
                is_another && it.fingerprint == one.fingerprint
            })?;
            Some((format!("{} and {} agree", other.info.name, one.info.name), one.fingerprint?))
        }))
    }

    /// Runs every library once, each round beginning with another.
    fn round<'a>(
        &self,
        round: usize,
        running: &mut Vec<Running<'a>>,
        untimed: &mut Vec<(&'a LibraryInfo, String)>,
    ) -> Result<()> {
        let count = running.len();
        let varied = match self.kind {
            Kind::Pairs | Kind::Intervals => scene::varied(self.scene, self.boxes, self.seeds),
            Kind::Worlds | Kind::Statics => None,
        };
        let mut lost = Vec::new();
        for at in (0..count).map(|at| (at + round) % count) {
            let library = &mut running[at];
            if round >= 3 && library.spent > PATIENCE {
                continue;
            }
            let batch = (BATCHED / self.boxes.max(1)).clamp(1, 256);
            let round_time = self.kind.round();
            let (least, most) = self.kind.repeats();
            let once = library.first.as_nanos().max(1) * batch as u128;
            let repeats = match varied {
                Some(scenes) => {
                    let all = scenes.div_ceil(batch) as u128;
                    (LONGEST_ROUND.as_nanos() / once).max(FEWEST_SCENES).min(all)
                }
                None => (round_time.as_nanos() / once).clamp(least, most),
            };
            let request = Request::Time { repeats: repeats as usize, batch };
            // The first call had the limit; here it only guards against hanging.
            match library.worker.ask(&request, 20 * self.limit + 20 * round_time)? {
                remote::Outcome::Reply(Reply::Timed { nanoseconds }) => {
                    let all = nanoseconds.iter().sum::<f64>() * batch as f64;
                    library.spent += Duration::from_nanos(all as u64);
                    library.rounds.push((round, self.kind.sum_up(varied.is_some(), &nanoseconds)));
                }
                other => lost.push((at, failure(other))),
            }
        }
        lost.sort_unstable();
        for (at, why) in lost.into_iter().rev() {
            untimed.push((running.remove(at).info, why));
        }
        Ok(())
    }
}

/// What went wrong, in words.
fn failure(outcome: remote::Outcome) -> String {
    match outcome {
        remote::Outcome::Reply(Reply::Failed { message }) => message,
        remote::Outcome::Reply(_) => "an answer to another question".into(),
        remote::Outcome::Late => "no answer any more".into(),
        remote::Outcome::Ended(how) => how,
    }
}

impl Running<'_> {
    /// The times over the rounds, against this library in the same rounds.
    fn times(&self, kind: Kind, own: &HashMap<usize, f64>) -> Times {
        let rounds: Vec<_> = self.rounds.iter().map(|&(_, time)| time).collect();
        let ratios: Vec<_> =
            self.rounds.iter().filter_map(|(round, time)| Some(time / own.get(round)?)).collect();
        Times {
            median_ns: median(&rounds),
            min_ns: rounds.iter().copied().fold(f64::INFINITY, f64::min),
            rounds_ns: rounds,
            ratio: (!ratios.is_empty()).then(|| median(&ratios)),
            peak_bytes: self.peak_bytes,
            start_ns: self.start_ns.map(|ns| ns as f64),
            longest_ns: kind.tracks().then_some(self.first.as_nanos() as f64),
            exact_ns: self.exact_ns.map(|ns| ns as f64),
        }
    }
}
