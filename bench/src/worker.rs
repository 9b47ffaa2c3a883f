//! One contender on one scene, in a process of its own: its memory can be measured, its crash
//! does no harm, and it can be stopped when it takes too long.
//!
//! It reads a [`Request`] a line from standard input and answers each with a [`Reply`].

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use clap::Args;
use serde::{Deserialize, Serialize};
use sweep_and_prune::Aabb;

use crate::fingerprint::Fingerprint;
use crate::peers::{self, Contender};
use crate::{machine, scene};

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
        /// How long this first call took.
        nanoseconds: u64,
        /// The most memory in use during the call, less what was in use before; `None` where
        /// the system does not tell.
        peak_bytes: Option<u64>,
    },
    /// The answer to [`Request::Time`].
    Timed {
        /// How long each call took.
        nanoseconds: Vec<u64>,
    },
    /// The contender returned an error.
    Failed {
        /// The error.
        message: String,
    },
}

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
    let boxes = scene::boxes::<D>(&options.scene, options.boxes)?;
    let shuffled = scene::shuffled(&boxes);
    answer(&Reply::Ready)?;
    for line in std::io::stdin().lock().lines() {
        let reply = match serde_json::from_str(&line?)? {
            Request::Check => check(&mut *contender, &boxes),
            Request::Time { repeats } => time(&mut *contender, &boxes, &shuffled, repeats),
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

fn check<const D: usize>(contender: &mut dyn Contender<D>, boxes: &[Aabb<D>]) -> Result<Reply> {
    machine::reset_peak_memory();
    let before = machine::memory();
    let start = Instant::now();
    let pairs = contender.find(boxes)?;
    let nanoseconds = start.elapsed().as_nanos() as u64;
    let fingerprint = Fingerprint::of(pairs);
    let peak_bytes = machine::peak_memory().zip(before).map(|(peak, start)| peak - start.min(peak));
    Ok(Reply::Checked { fingerprint, nanoseconds, peak_bytes })
}

fn time<const D: usize>(
    contender: &mut dyn Contender<D>,
    boxes: &[Aabb<D>],
    shuffled: &[Aabb<D>],
    repeats: usize,
) -> Result<Reply> {
    let mut nanoseconds = Vec::with_capacity(repeats);
    for _ in 0..repeats {
        contender.forget(shuffled)?;
        let start = Instant::now();
        black_box(contender.find(black_box(boxes))?);
        nanoseconds.push(start.elapsed().as_nanos() as u64);
    }
    Ok(Reply::Timed { nanoseconds })
}
