//! One library of intervals that answers one question: checked and timed.

use std::hint::black_box;

use anyhow::Result;

use super::draw::{Named, Question, Sets};
use super::library::Intervals;
use crate::fingerprint::Fingerprint;
use crate::machine;
use crate::protocol::{Job, Reply};
use crate::scene::{self, SEED};

/// How many draws take turns where not many are drawn.
const TURNS: usize = 3;
/// With more intervals than this in the first set, there is one draw, and a library keeps nothing from call to call: so
/// only one of them holds hundreds of millions of pairs.
const MOST_KEPT: usize = 2_000_000;

/// A library, its draws and the question.
pub struct Finding {
    make: fn() -> Box<dyn Intervals>,
    library: Box<dyn Intervals>,
    draws: Vec<Sets>,
    question: Question,
    next: usize,
    keeps: bool,
}

impl Finding {
    /// A library that has not begun, and the draws of `n` intervals in the first set.
    pub fn new(
        make: fn() -> Box<dyn Intervals>,
        name: &str,
        n: usize,
        seeds: Option<usize>,
    ) -> Result<Self> {
        let named = Named::new(name)?;
        let keeps = n <= MOST_KEPT;
        let count = if keeps { scene::varied(name, n, seeds).unwrap_or(TURNS) } else { 1 };
        let draws = (SEED..).take(count).map(|seed| named.sets(n, seed)).collect();
        let question = named.question;
        Ok(Self { make, library: make(), draws, question, next: 0, keeps })
    }

    /// Has the library answer for the next draw, and says how many nanoseconds it took.
    fn answer(&mut self) -> Result<(Fingerprint, f64)> {
        if !self.keeps {
            self.library = (self.make)();
        }
        self.library.prepare(&self.draws[self.next]);
        let is_within = self.draws[self.next].second.is_none();
        self.next = (self.next + 1) % self.draws.len();
        let library = &mut *self.library;
        let (answer, took) = match self.question {
            Question::Pairs => {
                let (pairs, took) = machine::clock(|| library.pairs());
                (fingerprint(black_box(pairs?), is_within), took)
            }
            Question::Count => {
                let (count, took) = machine::clock(|| library.count());
                (Fingerprint { pairs: count?, hash: 0 }, took)
            }
        };
        if !self.keeps {
            self.library = (self.make)();
        }
        Ok((answer, took.as_nanos() as f64))
    }
}

impl Job for Finding {
    fn check(&mut self) -> Result<Reply> {
        let checked = checked(self.draws[0].first.len());
        machine::reset_peak_memory();
        let before = machine::memory();
        let (mut fingerprint, mut longest) = (Fingerprint::default(), 0.0);
        for _ in 0..checked {
            let (answer, took) = self.answer()?;
            fingerprint = fingerprint + answer;
            longest = took.max(longest);
        }
        self.next = 0;
        let peak = machine::peak_memory().zip(before);
        Ok(Reply::Checked {
            fingerprint: Some(fingerprint),
            nanoseconds: longest as u64,
            peak_bytes: peak.map(|(peak, start)| peak - start.min(peak)),
            start_ns: None,
            exact_ns: None,
        })
    }

    fn time(&mut self, repeats: usize, _batch: usize) -> Result<Reply> {
        let answers = std::iter::repeat_with(|| Ok(self.answer()?.1)).take(repeats);
        Ok(Reply::Timed { nanoseconds: answers.collect::<Result<_>>()? })
    }
}

fn fingerprint(pairs: &[[u32; 2]], is_within: bool) -> Fingerprint {
    if is_within { Fingerprint::of(pairs) } else { Fingerprint::between(pairs) }
}

/// How many draws are checked.
fn checked(n: usize) -> usize {
    scene::frames_checked("", n)
}

/// The right answers for all draws that are checked, by brute force.
pub fn oracle(name: &str, n: usize) -> Result<Fingerprint> {
    let named = Named::new(name)?;
    let mut sum = Fingerprint::default();
    for seed in (SEED..).take(checked(n)) {
        let Sets { first, second, .. } = named.sets(n, seed);
        let mut pairs = Vec::new();
        for (a, &[from, to]) in (0..).zip(&first) {
            let others = (0..).zip(second.as_ref().unwrap_or(&first));
            let meets = |&(b, other): &(u32, &[i32; 2])| {
                (second.is_some() || a < b) && from <= other[1] && other[0] <= to
            };
            pairs.extend(others.filter(meets).map(|(b, _)| [a, b]));
        }
        sum = sum
            + match named.question {
                Question::Pairs => fingerprint(&pairs, second.is_none()),
                Question::Count => Fingerprint { pairs: pairs.len() as u64, hash: 0 },
            };
    }
    Ok(sum)
}
