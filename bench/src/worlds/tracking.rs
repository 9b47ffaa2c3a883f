//! One world that tracks the pairs of a motion: checked, and timed frame by frame.

use std::collections::HashSet;
use std::hint::black_box;
use std::mem::replace;
use std::time::Duration;

use anyhow::{Context, Result, ensure};
use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::{Motion, Moving};

use super::level::{self, Level};
use super::world::{Found, Maker, World};
use crate::fingerprint::Fingerprint;
use crate::machine;
use crate::protocol::{Job, Reply};
use crate::scene::SEED;

/// The number of frames between two comparisons of all pairs with the right ones.
const EVERY: usize = 5;

/// The number of frames before a world is timed, so that it has reached its steady state.
const CHECKED: usize = 3 * EVERY + 1;

/// The number of frames whose pairs are compared.
pub const FRAMES_CHECKED: usize = CHECKED.div_ceil(EVERY);

/// The number of frames over which the memory of a world is measured.
const WEIGHED: usize = 3;

/// The frames that a world tracks, and which boxes moved in the last one.
struct Frames<const D: usize> {
    source: Source<D>,
    last: Vec<Aabb<D>>,
    moved: Vec<u32>,
}

/// Where the boxes of a frame come from.
enum Source<const D: usize> {
    /// A motion, in which each box may move.
    Motion(Moving<D, f32>),
    /// Static boxes and some that move.
    Level(Level<D>),
}

impl<const D: usize> Source<D> {
    fn boxes(&self) -> &[Aabb<D>] {
        match self {
            Self::Motion(moving) => moving.boxes(),
            Self::Level(level) => level.boxes(),
        }
    }
}

impl<const D: usize> Frames<D> {
    /// A motion of `n` boxes, or a level with `n` static ones.
    fn new(name: &str, n: usize) -> Result<Self> {
        let source = if name == level::NAME {
            Source::Level(Level::new(n, SEED))
        } else {
            let motion = Motion::from_name(name);
            let motion = motion.with_context(|| format!("there is no motion '{name}'"))?;
            Source::Motion(motion.start(n, SEED).context("motion needs 1 to 3 dimensions")?)
        };
        Ok(Self { source, last: Vec::new(), moved: Vec::new() })
    }

    fn boxes(&self) -> &[Aabb<D>] {
        self.source.boxes()
    }

    /// How many boxes may move; they are the first.
    fn movers(&self) -> usize {
        match &self.source {
            Source::Motion(moving) => moving.boxes().len(),
            Source::Level(_) => level::MOVERS,
        }
    }

    fn advance(&mut self) {
        let movers = self.movers();
        let Self { source, last, moved } = self;
        last.clear();
        last.extend_from_slice(&source.boxes()[..movers]);
        match source {
            Source::Motion(moving) => moving.advance(),
            Source::Level(level) => level.advance(),
        }
        moved.clear();
        let frames = last.iter().zip(source.boxes()).zip(0..);
        moved.extend(frames.filter(|((a, b), _)| a != b).map(|(_, index)| index));
    }

    /// All pairs of which one box may move.
    fn brute_force(&self) -> Result<Vec<[u32; 2]>> {
        let (boxes, movers) = (self.boxes(), self.movers());
        if movers == boxes.len() {
            return Ok(sweep_and_prune_scenes::brute_force(boxes)?);
        }
        let mut pairs = Vec::new();
        for a in 0..movers {
            let overlap = |&b: &usize| boxes[a].overlaps(&boxes[b]);
            pairs.extend((a + 1..boxes.len()).filter(overlap).map(|b| [a as u32, b as u32]));
        }
        Ok(pairs)
    }
}

/// A world and the motion that it tracks.
pub struct Tracking<const D: usize> {
    make: Maker<D>,
    world: Box<dyn World<D>>,
    frames: Frames<D>,
}

impl<const D: usize> Tracking<D> {
    /// A world that has not begun, and the first frame of a motion of `n` boxes.
    pub fn new(make: Maker<D>, motion: &str, n: usize) -> Result<Self> {
        Ok(Self { make, world: make(), frames: Frames::new(motion, n)? })
    }

    /// The most memory that another such world needs at its start and in the first frames, beyond
    /// the boxes; `None` where the system does not tell.
    fn weigh(&mut self) -> Result<Option<u64>> {
        machine::reset_peak_memory();
        let before = machine::memory();
        let mut world = replace(&mut self.world, (self.make)());
        world.start(self.frames.boxes(), self.frames.movers())?;
        for _ in 0..WEIGHED {
            self.frames.advance();
            world.step(self.frames.boxes(), &self.frames.moved)?;
        }
        Ok(machine::peak_memory().zip(before).map(|(peak, start)| peak - start.min(peak)))
    }
}

impl<const D: usize> Job for Tracking<D> {
    fn check(&mut self) -> Result<Reply> {
        let peak_bytes = self.weigh()?;
        let Self { world, frames, .. } = self;
        let mut live = Live::default();
        let (found, start) = machine::clock(|| world.start(frames.boxes(), frames.movers()));
        live.take(found?)?;
        let (mut fingerprint, mut longest) = (Fingerprint::default(), Duration::ZERO);
        let mut exact = Vec::new();
        for frame in 0..CHECKED {
            if frame > 0 {
                frames.advance();
                let (boxes, moved) = (frames.boxes(), &frames.moved);
                let (found, took) = machine::clock(|| world.step(boxes, moved));
                longest = longest.max(took);
                live.take(found?)?;
            }
            if frame % EVERY == 0 {
                let (pairs, took) = live.exact(&mut **world, frames.boxes());
                fingerprint = fingerprint + Fingerprint::of(&pairs);
                exact.extend(took.map(|took| took.as_nanos() as u64));
            }
        }
        exact.sort_unstable();
        let exact_ns = exact.get(exact.len() / 2).copied();
        Ok(Reply::Checked {
            fingerprint: live.is_known.then_some(fingerprint),
            nanoseconds: longest.as_nanos() as u64,
            peak_bytes,
            start_ns: Some(start.as_nanos() as u64),
            exact_ns,
        })
    }

    fn time(&mut self, repeats: usize, _batch: usize) -> Result<Reply> {
        let Self { world, frames, .. } = self;
        let mut nanoseconds = Vec::with_capacity(repeats);
        for _ in 0..repeats {
            frames.advance();
            let (boxes, moved) = (frames.boxes(), &frames.moved);
            let (found, took) = machine::clock(|| world.step(black_box(boxes), black_box(moved)));
            black_box(found?);
            nanoseconds.push(took.as_nanos() as f64);
        }
        Ok(Reply::Timed { nanoseconds })
    }
}

/// The pairs that a world has reported.
struct Live {
    pairs: HashSet<[u32; 2]>,
    kept: bool,
    is_known: bool,
}

impl Default for Live {
    fn default() -> Self {
        Self { pairs: HashSet::new(), kept: false, is_known: true }
    }
}

impl Live {
    /// Applies what was found. It is an error if a pair begins twice, or ends before it began.
    fn take(&mut self, found: Found<'_>) -> Result<()> {
        let ordered = |&[a, b]: &[u32; 2]| [a.min(b), a.max(b)];
        match found {
            Found::Events { begun, ended } => {
                for pair in ended.iter().map(ordered) {
                    ensure!(self.pairs.remove(&pair), "the pair {pair:?} ended and was none");
                }
                for pair in begun.iter().map(ordered) {
                    ensure!(self.pairs.insert(pair), "the pair {pair:?} began twice");
                }
            }
            Found::Pairs(pairs) => {
                self.pairs.clear();
                self.pairs.extend(pairs.iter().map(ordered));
                ensure!(self.pairs.len() == pairs.len(), "a pair was given twice");
            }
            Found::Kept => self.kept = true,
            Found::Unknown => self.is_known = false,
        }
        Ok(())
    }

    /// The pairs of the boxes themselves; and, if there were others, how long it took to test them.
    fn exact<const D: usize>(
        &self,
        world: &mut dyn World<D>,
        boxes: &[Aabb<D>],
    ) -> (Vec<[u32; 2]>, Option<Duration>) {
        let all: Vec<_> =
            if self.kept { world.kept().to_vec() } else { self.pairs.iter().copied().collect() };
        let mut exact = Vec::with_capacity(all.len());
        let overlap = |&[a, b]: &[u32; 2]| boxes[a as usize].overlaps(&boxes[b as usize]);
        let test = || exact.extend(all.iter().copied().filter(overlap));
        let ((), took) = machine::clock(test);
        let is_larger = exact.len() < all.len();
        (exact, is_larger.then_some(took))
    }
}

/// The right pairs of all frames that are checked, by brute force.
pub fn oracle<const D: usize>(motion: &str, n: usize) -> Result<Fingerprint> {
    let mut frames = Frames::<D>::new(motion, n)?;
    (0..WEIGHED).for_each(|_| frames.advance());
    let mut sum = Fingerprint::default();
    for frame in 0..CHECKED {
        if frame > 0 {
            frames.advance();
        }
        if frame % EVERY == 0 {
            sum = sum + Fingerprint::of(&frames.brute_force()?);
        }
    }
    Ok(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_that_contradict_each_other_are_refused() {
        let mut live = Live::default();
        let mut report = |begun: &[[u32; 2]], ended: &[[u32; 2]]| {
            live.take(Found::Events { begun, ended }).is_ok()
        };
        assert!(report(&[[0, 1], [3, 2]], &[]));
        assert!(report(&[[1, 2]], &[[1, 0]]));
        assert!(!report(&[[2, 1]], &[]), "it began before");
        assert!(!report(&[], &[[0, 1]]), "it ended before");
        assert!(live.take(Found::Pairs(&[[0, 1], [1, 0]])).is_err(), "the same twice");
    }

    #[test]
    fn pairs_of_larger_boxes_are_tested_once_more() -> Result<()> {
        struct Larger([[u32; 2]; 2]);
        impl World<1> for Larger {
            fn start<'a>(&'a mut self, _: &'a [Aabb<1>], _: usize) -> Result<Found<'a>> {
                Ok(Found::Kept)
            }
            fn step<'a>(&'a mut self, _: &'a [Aabb<1>], _: &[u32]) -> Result<Found<'a>> {
                Ok(Found::Kept)
            }
            fn kept(&mut self) -> &[[u32; 2]] {
                &self.0
            }
        }
        let boxes = [[0.0, 2.0], [1.0, 3.0], [4.0, 5.0]].map(|[a, b]| Aabb::new([a], [b]));
        let mut world = Larger([[0, 1], [1, 2]]);
        let mut live = Live::default();
        live.take(world.start(&boxes, boxes.len())?)?;
        let (pairs, took) = live.exact(&mut world, &boxes);
        assert_eq!(pairs, [[0, 1]]);
        assert!(took.is_some());
        Ok(())
    }
}
