//! One contender on one scene, in a process of its own: its memory can be measured, its crash
//! does no harm, and it can be stopped when it takes too long.
//!
//! It reads a [`Request`] a line from standard input and answers each with a [`Reply`].

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use clap::Args;
use serde::{Deserialize, Serialize};
use sweep_and_prune::Aabb;

use crate::fingerprint::Fingerprint;
use crate::machine;
use crate::peers::{self, Contender};
use crate::scene::Boxes;
use crate::worlds::{self, Following};

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
    /// The peer is a world and the scene a motion.
    #[arg(long)]
    world: bool,
}

/// What the harness asks of a worker.
#[derive(Serialize, Deserialize)]
pub enum Request {
    /// Find the pairs once, or follow the world for a while, and tell what they are.
    Check,
    /// Find the pairs, or go on to the next frame, so many times and tell how long each took.
    Time {
        /// How many times.
        repeats: usize,
        /// How many calls to find are timed together, where one alone is too short for the clock.
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
        /// Of a world with pairs that are none, how long it takes to tell which those are.
        exact_ns: Option<u64>,
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

/// Marks the lines of the protocol; a peer may print what it likes on others.
pub const MARK: &str = "@reply ";

/// What a worker can do.
pub trait Job {
    /// The answer to [`Request::Check`].
    fn check(&mut self) -> Result<Reply>;

    /// The answer to [`Request::Time`].
    fn time(&mut self, repeats: usize, batch: usize) -> Result<Reply>;
}

/// Serves requests until standard input ends.
pub fn run(options: &Options) -> Result<()> {
    let mut job = job(options)?;
    answer(&Reply::Ready)?;
    for line in std::io::stdin().lock().lines() {
        let reply = match serde_json::from_str(&line?)? {
            Request::Check => job.check(),
            Request::Time { repeats, batch } => job.time(repeats, batch),
        };
        answer(&reply.unwrap_or_else(|error| Reply::Failed { message: format!("{error:#}") }))?;
    }
    Ok(())
}

fn job(options: &Options) -> Result<Box<dyn Job>> {
    let Options { peer: name, scene, boxes, .. } = options;
    let unknown = || format!("there is no peer '{name}'");
    let other = "not in this number of dimensions";
    if options.world {
        let world = worlds::all().into_iter().find(|it| it.name == name).with_context(unknown)?;
        return Ok(match options.dimensions {
            2 => Box::new(Following::new(world.two.context(other)?, scene, *boxes)?),
            3 => Box::new(Following::new(world.three.context(other)?, scene, *boxes)?),
            _ => bail!(other),
        });
    }
    let peer = peers::all().into_iter().find(|it| it.name == name).with_context(unknown)?;
    Ok(match options.dimensions {
        2 => Box::new(Finding::new(peer.two.context(other)?(), scene, *boxes)?),
        3 => Box::new(Finding::new(peer.three.context(other)?(), scene, *boxes)?),
        _ => bail!(other),
    })
}

fn answer(reply: &Reply) -> Result<()> {
    let mut out = std::io::stdout().lock();
    // A peer may have left the line unfinished.
    writeln!(out, "\n{MARK}{}", serde_json::to_string(reply)?)?;
    Ok(out.flush()?)
}

/// A contender and the boxes whose pairs it finds.
struct Finding<const D: usize> {
    contender: Box<dyn Contender<D>>,
    boxes: Boxes<D>,
}

impl<const D: usize> Finding<D> {
    fn new(contender: Box<dyn Contender<D>>, scene: &str, n: usize) -> Result<Self> {
        Ok(Self { contender, boxes: Boxes::new(scene, n)? })
    }
}

impl<const D: usize> Job for Finding<D> {
    fn check(&mut self) -> Result<Reply> {
        machine::reset_peak_memory();
        let before = machine::memory();
        let (mut fingerprint, mut longest) = (Fingerprint::default(), Duration::ZERO);
        self.boxes.frames(|boxes| {
            let (pairs, took) = machine::clock(|| self.contender.find(boxes));
            longest = longest.max(took);
            fingerprint = fingerprint + Fingerprint::of(pairs?);
            Ok(())
        })?;
        let peak = machine::peak_memory().zip(before);
        let peak_bytes = peak.map(|(peak, start)| peak - start.min(peak));
        let nanoseconds = longest.as_nanos() as u64;
        Ok(Reply::Checked { fingerprint, nanoseconds, peak_bytes, exact_ns: None })
    }

    /// Times calls on boxes in motion frame by frame, and on boxes at rest so that nothing known
    /// from the last call helps.
    fn time(&mut self, repeats: usize, batch: usize) -> Result<Reply> {
        let contender = &mut *self.contender;
        let mut nanoseconds = Vec::with_capacity(repeats);
        for _ in 0..repeats {
            match &mut self.boxes {
                Boxes::InMotion(moving) => {
                    moving.advance();
                    nanoseconds.push(mean_time(contender, &[moving.boxes()])?);
                }
                Boxes::AtRest { boxes, shuffled } if batch == 1 => {
                    contender.forget(shuffled)?;
                    nanoseconds.push(mean_time(contender, &[boxes])?);
                }
                Boxes::AtRest { boxes, shuffled } => {
                    let turns: Vec<&[Aabb<D>]> = [&**boxes, &**shuffled].repeat(batch.div_ceil(2));
                    nanoseconds.push(mean_time(contender, &turns)?);
                }
            }
        }
        Ok(Reply::Timed { nanoseconds })
    }
}

/// The mean time of a call, in nanoseconds.
fn mean_time<const D: usize>(
    contender: &mut dyn Contender<D>,
    turns: &[&[Aabb<D>]],
) -> Result<f64> {
    let (result, took) = machine::clock(|| {
        turns.iter().try_for_each(|boxes| {
            black_box(contender.find(black_box(boxes))?);
            Ok(())
        })
    });
    result.map(|()| took.as_nanos() as f64 / turns.len() as f64)
}
