//! A world of two or of three dimensions and its searchers, behind one trait.

use sweep_and_prune::{Aabb, PairFinder};
use sweep_and_prune_exchange::clock;

use crate::motion::{LAWS, Moving, resize};
use crate::scenes::SCENES;
use crate::searcher::{Choice, Forecast, Report, Searcher, forecast};

/// The most boxes of a world.
pub const MOST_BOXES: f64 = 100_000.0;

/// What the exports do, whatever the dimensions. `None` is a refusal.
pub trait Experiment {
    /// Moves the world on by one step.
    fn advance(&mut self);
    /// How many dimensions the boxes have.
    fn dimensions(&self) -> usize;
    /// Puts other boxes in the place of the world's; the searchers stay.
    fn place(&mut self, rows: &[f32], area: &[f64; 16]) -> Option<()>;
    /// The boxes, rows of min corner and max corner.
    fn boxes(&self) -> *const f32;
    /// How many pairs overlap now.
    fn count_pairs(&self) -> Option<u64>;
    /// Adds a searcher.
    fn enter(&mut self, choice: Choice) -> Option<()>;
    /// What a searcher's first run would cost.
    fn forecast(&self, choice: Choice) -> Option<Forecast>;
    /// Lets a searcher find the pairs.
    fn run(&mut self, searcher: usize, counting: bool) -> Option<Report>;
    /// The pairs of a searcher's last run.
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

/// Makes a world of the boxes in these rows, as the area describes it otherwise.
pub fn open_given(rows: &[f32], area: &[f64; 16]) -> Option<Box<dyn Experiment>> {
    match area[0] as u32 {
        2 => given::<2>(rows, area),
        3 => given::<3>(rows, area),
        _ => None,
    }
}

fn given<const D: usize>(rows: &[f32], area: &[f64; 16]) -> Option<Box<dyn Experiment>> {
    Some(Box::new(Inside { world: moving::<D>(rows, area)?, searchers: Vec::new() }))
}

/// The boxes of rows of min corner and max corner, about to move; none if one is invalid or not finite.
fn moving<const D: usize>(rows: &[f32], area: &[f64; 16]) -> Option<Moving<D>> {
    let [_, _, law, _, seed, ..] = *area;
    let corner = |row: &[f32]| std::array::from_fn(|axis| row[axis]);
    let boxes: Vec<Aabb<D>> =
        rows.chunks_exact(2 * D).map(|row| Aabb::new(corner(row), corner(&row[D..]))).collect();
    let is_sensible = rows.len() == boxes.len() * 2 * D
        && rows.iter().all(|at| at.is_finite())
        && boxes.iter().all(|aabb| aabb.invalid_axis().is_none())
        && law >= 0.0;
    let law = LAWS.get(law as usize).filter(|_| is_sensible)?;
    Some(Moving::new(boxes, law, seed as u64))
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

    fn dimensions(&self) -> usize {
        D
    }

    fn place(&mut self, rows: &[f32], area: &[f64; 16]) -> Option<()> {
        self.world = moving(rows, area)?;
        Some(())
    }

    fn boxes(&self) -> *const f32 {
        // A box is its min corner and then its max corner, without padding.
        const { assert!(size_of::<Aabb<D>>() == 8 * D) };
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
