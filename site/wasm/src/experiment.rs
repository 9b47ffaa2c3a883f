//! A world of two or of three dimensions and its searchers, behind one trait.

use sweep_and_prune::PairFinder;
use sweep_and_prune_exchange::clock;

use crate::SCENES;
use crate::motion::{LAWS, Moving, resize};
use crate::searcher::{Choice, Forecast, Report, Searcher, forecast};

/// The most boxes of a world.
const MOST_BOXES: f64 = 100_000.0;

/// What the exports do, whatever the dimensions. `None` is a refusal.
pub trait Experiment {
    fn advance(&mut self);
    fn boxes(&self) -> *const f32;
    fn count_pairs(&self) -> Option<u64>;
    fn enter(&mut self, choice: Choice) -> Option<()>;
    fn forecast(&self, choice: Choice) -> Option<Forecast>;
    fn run(&mut self, searcher: usize, counting: bool) -> Option<Report>;
    fn pairs(&self, searcher: usize) -> Option<*const u32>;
}

struct Inside<const D: usize> {
    world: Moving<D>,
    searchers: Vec<Searcher<D>>,
}

/// Makes the world that the area describes.
pub fn open(area: &[f64; 16]) -> Option<Box<dyn Experiment>> {
    match area[0] as u32 {
        2 => inside::<2>(area),
        3 => inside::<3>(area),
        _ => None,
    }
}

fn inside<const D: usize>(area: &[f64; 16]) -> Option<Box<dyn Experiment>> {
    let [_, scene, law, boxes, seed, size, spread, ..] = *area;
    let sensible = (0.0..=MOST_BOXES).contains(&boxes)
        && (0.01..=100.0).contains(&size)
        && (1.0..=1000.0).contains(&spread)
        && scene >= 0.0
        && law >= 0.0;
    let scene = SCENES.get(scene as usize).filter(|_| sensible)?;
    let seed = seed as u64;
    let mut boxes = scene.boxes::<D, f32>(boxes as usize, seed)?;
    resize(&mut boxes, size, spread, seed);
    let world = Moving::new(boxes, LAWS.get(law as usize)?, seed);
    Some(Box::new(Inside { world, searchers: Vec::new() }))
}

impl<const D: usize> Experiment for Inside<D> {
    fn advance(&mut self) {
        self.world.advance();
    }

    fn boxes(&self) -> *const f32 {
        // A box is its min corner and then its max corner, without padding.
        const { assert!(size_of::<sweep_and_prune::Aabb<D>>() == 8 * D) };
        self.world.boxes().as_ptr().cast()
    }

    fn count_pairs(&self) -> Option<u64> {
        PairFinder::new().search(self.world.boxes()).count().ok()
    }

    fn enter(&mut self, choice: Choice) -> Option<()> {
        self.searchers.push(Searcher::new(choice).ok()?);
        Some(())
    }

    fn forecast(&self, choice: Choice) -> Option<Forecast> {
        forecast(choice, self.world.boxes()).ok()
    }

    fn run(&mut self, searcher: usize, counting: bool) -> Option<Report> {
        let searcher = self.searchers.get_mut(searcher)?;
        searcher.run(self.world.boxes(), counting, clock).ok()
    }

    fn pairs(&self, searcher: usize) -> Option<*const u32> {
        Some(self.searchers.get(searcher)?.pairs().as_ptr().cast())
    }
}
