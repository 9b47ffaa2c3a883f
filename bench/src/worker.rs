//! One library on one scene, in a process of its own: its memory can be measured, its crash
//! does no harm, and it can be stopped when it takes too long.
//!
//! It reads a [`Request`] a line from standard input and answers each with a [`Reply`].

use std::hint::black_box;
use std::io::{BufRead, Write};
use std::time::Duration;

use anyhow::{Context, Result, bail};
use clap::Args;
use sweep_and_prune::Aabb;

use crate::fingerprint::Fingerprint;
use crate::libraries::{self, Finder};
use crate::protocol::{Job, Kind, MARK, Reply, Request};
use crate::scene::{Boxes, WARM_UP};
use crate::worlds::{self, Tracking};
use crate::{intervals, machine};

/// What to run.
#[derive(Args)]
pub struct Options {
    #[arg(long)]
    library: String,
    #[arg(long)]
    scene: String,
    #[arg(long)]
    dimensions: usize,
    #[arg(long)]
    boxes: usize,
    /// How many scenes of a kind to draw, if not the default number.
    #[arg(long)]
    seeds: Option<usize>,
    #[arg(long, value_enum)]
    kind: Kind,
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
    let Options { library: name, scene, boxes, seeds, .. } = options;
    let unknown = || format!("there is no library '{name}'");
    let other = "not in this number of dimensions";
    if options.kind == Kind::Intervals {
        let library = intervals::all().into_iter().find(|it| it.name == name);
        let make = library.with_context(unknown)?.make;
        return Ok(Box::new(intervals::Finding::new(make, scene, *boxes, *seeds)?));
    }
    if options.kind.tracks() {
        let is_level = options.kind == Kind::Statics;
        let worlds = if is_level { worlds::with_statics() } else { worlds::all() };
        let world = worlds.into_iter().find(|it| it.name == name).with_context(unknown)?;
        return Ok(match options.dimensions {
            2 => Box::new(Tracking::new(world.two.context(other)?, scene, *boxes)?),
            3 => Box::new(Tracking::new(world.three.context(other)?, scene, *boxes)?),
            _ => bail!(other),
        });
    }
    let library = libraries::all().into_iter().find(|it| it.name == name).with_context(unknown)?;
    Ok(match options.dimensions {
        2 => Box::new(Finding::new(library.two.context(other)?(), scene, *boxes, *seeds)?),
        3 => Box::new(Finding::new(library.three.context(other)?(), scene, *boxes, *seeds)?),
        _ => bail!(other),
    })
}

fn answer(reply: &Reply) -> Result<()> {
    let mut out = std::io::stdout().lock();
    // A library may have left the line unfinished.
    writeln!(out, "\n{MARK}{}", serde_json::to_string(reply)?)?;
    Ok(out.flush()?)
}

/// A library and the boxes whose pairs it finds.
struct Finding<const D: usize> {
    library: Box<dyn Finder<D>>,
    boxes: Boxes<D>,
}

impl<const D: usize> Finding<D> {
    fn new(
        library: Box<dyn Finder<D>>,
        scene: &str,
        n: usize,
        seeds: Option<usize>,
    ) -> Result<Self> {
        Ok(Self { library, boxes: Boxes::new(scene, n, seeds)? })
    }
}

impl<const D: usize> Job for Finding<D> {
    fn check(&mut self) -> Result<Reply> {
        machine::reset_peak_memory();
        let before = machine::memory();
        let (mut fingerprint, mut longest) = (Fingerprint::default(), Duration::ZERO);
        self.boxes.frames(|boxes| {
            let (pairs, took) = machine::clock(|| self.library.find(boxes));
            longest = longest.max(took);
            fingerprint = fingerprint + Fingerprint::of(pairs?);
            Ok(())
        })?;
        let peak = machine::peak_memory().zip(before);
        let peak_bytes = peak.map(|(peak, start)| peak - start.min(peak));
        let nanoseconds = longest.as_nanos() as u64;
        let fingerprint = Some(fingerprint);
        Ok(Reply::Checked { fingerprint, nanoseconds, peak_bytes, start_ns: None, exact_ns: None })
    }

    /// Times calls on boxes in motion frame by frame, on one scene of a kind after another, and on boxes at rest so
    /// that nothing known from the last call helps.
    fn time(&mut self, repeats: usize, batch: usize) -> Result<Reply> {
        let library = &mut *self.library;
        let mut nanoseconds = Vec::with_capacity(repeats);
        if let Boxes::Varied { scenes, next, .. } = &mut self.boxes {
            for _ in 0..WARM_UP {
                black_box(library.find(&scenes[*next])?);
                *next = (*next + 1) % scenes.len();
            }
        }
        for _ in 0..repeats {
            match &mut self.boxes {
                Boxes::Varied { scenes, next, current } if batch == 1 => {
                    current.clone_from(&scenes[*next]);
                    *next = (*next + 1) % scenes.len();
                    nanoseconds.push(mean_time(library, &[current])?);
                }
                Boxes::Varied { scenes, next, .. } => {
                    let turns = scenes.iter().cycle().skip(*next).take(batch);
                    let turns: Vec<&[Aabb<D>]> = turns.map(Vec::as_slice).collect();
                    *next = (*next + batch) % scenes.len();
                    nanoseconds.push(mean_time(library, &turns)?);
                }
                Boxes::InMotion(moving) => {
                    moving.advance();
                    nanoseconds.push(mean_time(library, &[moving.boxes()])?);
                }
                Boxes::AtRest { boxes, shuffled } if batch == 1 => {
                    library.forget(shuffled)?;
                    nanoseconds.push(mean_time(library, &[boxes])?);
                }
                Boxes::AtRest { boxes, shuffled } => {
                    let turns: Vec<&[Aabb<D>]> = [&**boxes, &**shuffled].repeat(batch.div_ceil(2));
                    nanoseconds.push(mean_time(library, &turns)?);
                }
            }
        }
        Ok(Reply::Timed { nanoseconds })
    }
}

/// The mean time of a call, in nanoseconds.
fn mean_time<const D: usize>(library: &mut dyn Finder<D>, turns: &[&[Aabb<D>]]) -> Result<f64> {
    let (result, took) = machine::clock(|| {
        turns.iter().try_for_each(|boxes| {
            black_box(library.find(black_box(boxes))?);
            Ok(())
        })
    });
    result.map(|()| took.as_nanos() as f64 / turns.len() as f64)
}
