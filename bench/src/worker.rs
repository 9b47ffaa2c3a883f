//! One contender on one scene, in a process of its own: its memory can be measured, its crash
//! does no harm, and it can be stopped when it takes too long.
//!
//! It reads a [`Request`] a line from standard input and answers each with a [`Reply`].

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail};
use clap::Args;
use serde::{Deserialize, Serialize};
use sweep_and_prune::Aabb;

use crate::fingerprint::Fingerprint;
use crate::machine;
use crate::peers::{self, Contender};
use crate::scene::Boxes;

/// What to run.
#[derive(Args)]
pub struct Options {
    #[arg(long)]
    peer: String,
    #[arg(long)]
    scene: String,
    #[arg(long)]
    dimensions: usize,
    #[arg(long)]
    boxes: usize,
}

/// What the harness asks of a worker.
#[derive(Serialize, Deserialize)]
pub enum Request {
    /// Find the pairs once and tell what they are.
    Check,
    /// Find the pairs so many times and tell how long each took.
    Time {
        /// How many times.
        repeats: usize,
        /// How many calls are timed together, where one alone is too short for the clock.
        batch: usize,
    },
}

/// What a worker answers.
#[derive(Serialize, Deserialize)]
pub enum Reply {
    /// The boxes are there, the contender is made.
    Ready,
    /// The answer to [`Request::Check`].
    Checked {
        /// The pairs.
        fingerprint: Fingerprint,
        /// How long the longest of these first calls took.
        nanoseconds: u64,
        /// The most memory in use during the call, less what was in use before; `None` where
        /// the system does not tell.
        peak_bytes: Option<u64>,
    },
    /// The answer to [`Request::Time`].
    Timed {
        /// How long each call took, in the mean of a batch.
        nanoseconds: Vec<f64>,
    },
    /// The contender returned an error.
    Failed {
        /// The error.
        message: String,
    },
}

/// A time shorter than this is taken as it is: it is seldom interrupted, and to ask whether it was
/// would take as long.
const WAIT_COUNTS: Duration = Duration::from_micros(100);

/// Marks the lines of the protocol; a peer may print what it likes on others.
pub const MARK: &str = "@reply ";

/// Serves requests until standard input ends.
pub fn run(options: &Options) -> Result<()> {
    let peer = peers::all().into_iter().find(|peer| peer.name == options.peer);
    let peer = peer.with_context(|| format!("there is no peer '{}'", options.peer))?;
    match options.dimensions {
        2 => serve(peer.two.context("not in two dimensions")?(), options),
        3 => serve(peer.three.context("not in three dimensions")?(), options),
        other => bail!("two or three dimensions, not {other}"),
    }
}

fn serve<const D: usize>(mut contender: Box<dyn Contender<D>>, options: &Options) -> Result<()> {
    let mut boxes = Boxes::<D>::new(&options.scene, options.boxes)?;
    answer(&Reply::Ready)?;
    for line in std::io::stdin().lock().lines() {
        let reply = match serde_json::from_str(&line?)? {
            Request::Check => check(&mut *contender, &mut boxes),
            Request::Time { repeats, batch } => time(&mut *contender, &mut boxes, repeats, batch),
        };
        answer(&reply.unwrap_or_else(|error| Reply::Failed { message: format!("{error:#}") }))?;
    }
    Ok(())
}

fn answer(reply: &Reply) -> Result<()> {
    let mut out = std::io::stdout().lock();
    // A peer may have left the line unfinished.
    writeln!(out, "\n{MARK}{}", serde_json::to_string(reply)?)?;
    Ok(out.flush()?)
}

fn check<const D: usize>(contender: &mut dyn Contender<D>, boxes: &mut Boxes<D>) -> Result<Reply> {
    machine::reset_peak_memory();
    let before = machine::memory();
    let mut fingerprint = Fingerprint::default();
    let mut nanoseconds = 0;
    boxes.frames(|boxes| {
        let (waited, start) = (machine::waited("self"), Instant::now());
        let pairs = contender.find(boxes)?;
        let took = start.elapsed().saturating_sub(machine::waited("self").saturating_sub(waited));
        nanoseconds = nanoseconds.max(took.as_nanos() as u64);
        fingerprint = fingerprint + Fingerprint::of(pairs);
        Ok(())
    })?;
    let peak_bytes = machine::peak_memory().zip(before).map(|(peak, start)| peak - start.min(peak));
    Ok(Reply::Checked { fingerprint, nanoseconds, peak_bytes })
}

/// Times calls on boxes in motion frame by frame, and on boxes at rest so that nothing known from
/// the last call helps.
fn time<const D: usize>(
    contender: &mut dyn Contender<D>,
    boxes: &mut Boxes<D>,
    repeats: usize,
    batch: usize,
) -> Result<Reply> {
    let mut nanoseconds = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        match boxes {
            Boxes::InMotion(moving) => {
                moving.advance();
                nanoseconds.push(clock(contender, &[moving.boxes()])?);
            }
            Boxes::AtRest { boxes, shuffled } if batch == 1 => {
                contender.forget(shuffled)?;
                nanoseconds.push(clock(contender, &[boxes])?);
            }
            Boxes::AtRest { boxes, shuffled } => {
                let turns: Vec<&[Aabb<D>]> = [&**boxes, &**shuffled].repeat(batch.div_ceil(2));
                nanoseconds.push(clock(contender, &turns)?);
            }
        }
    }
    Ok(Reply::Timed { nanoseconds })
}

/// The mean time of a call, in nanoseconds, without what the thread waited for a processor.
fn clock<const D: usize>(contender: &mut dyn Contender<D>, turns: &[&[Aabb<D>]]) -> Result<f64> {
    let waited = machine::waited("self");
    let start = Instant::now();
    for boxes in turns {
        black_box(contender.find(black_box(boxes))?);
    }
    let mut elapsed = start.elapsed();
    if elapsed > WAIT_COUNTS {
        elapsed = elapsed.saturating_sub(machine::waited("self").saturating_sub(waited));
    }
    Ok(elapsed.as_nanos() as f64 / turns.len() as f64)
}
