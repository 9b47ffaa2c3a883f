//! A searcher finds the pairs: an algorithm, the library's `PairFinder`, or its `BroadPhase`.

use sweep_and_prune::{Aabb, BroadPhase, Filter, PairFinder, ProxyId};
use sweep_and_prune_algorithms::{Axis, Counts, Error, Method, Runner, RunnerOptions, Sort};

/// Which one.
#[derive(Clone, Copy, Debug)]
pub enum Choice {
    /// [`PairFinder`]: finds all pairs from scratch.
    Finder,
    /// [`BroadPhase`]: keeps a world, and lists its pairs.
    World,
    /// One of the classic algorithms.
    Algorithm(RunnerOptions),
}

/// One searcher with what it keeps from step to step.
#[derive(Debug)]
pub struct Searcher<const D: usize> {
    choice: Choice,
    engine: Engine<D>,
    pairs: Vec<[u32; 2]>,
}

#[derive(Debug)]
enum Engine<const D: usize> {
    Finder(Box<PairFinder<D>>),
    World(Box<BroadPhase<D>>, Vec<ProxyId>),
    Algorithm(Box<Runner<D>>),
}

/// What one run did.
#[derive(Clone, Copy, Debug, Default)]
pub struct Report {
    /// Milliseconds from boxes to the list of all pairs.
    pub ms: f64,
    /// What was counted; the library's two searchers report only pairs.
    pub counts: Option<Counts>,
    /// How many pairs.
    pub pairs: usize,
    /// A hash of the pairs that does not depend on their order.
    pub fingerprint: u64,
}

impl<const D: usize> Searcher<D> {
    /// A searcher that has seen nothing.
    ///
    /// # Errors
    /// [`Error::InvalidAxis`].
    pub fn new(choice: Choice) -> Result<Self, Error> {
        let engine = match choice {
            Choice::Finder => Engine::Finder(Box::default()),
            Choice::World => Engine::World(Box::default(), Vec::new()),
            Choice::Algorithm(options) => {
                options.axis.choose::<D, f32>(&[])?;
                // The first step is not almost sorted, so insertion sort would take O(n²).
                let first = if options.persistent { Sort::Standard } else { options.sort };
                let options = options.first_sort(first);
                Engine::Algorithm(Box::new(Runner::new(options)))
            }
        };
        Ok(Self { choice, engine, pairs: Vec::new() })
    }

    /// Finds the pairs, timed and unobserved. What the algorithm did is counted on a copy, before.
    ///
    /// # Errors
    /// [`Error::Boxes`], which scenes do not have.
    pub fn run(
        &mut self,
        boxes: &[Aabb<D>],
        counting: bool,
        now: impl Fn() -> f64,
    ) -> Result<Report, Error> {
        let counts = if counting { self.count(boxes)? } else { None };
        let start = now();
        match &mut self.engine {
            Engine::Finder(finder) => copy(finder.find(boxes)?, &mut self.pairs),
            Engine::World(world, ids) => {
                if ids.len() == boxes.len() {
                    world.set_many(ids, boxes)?;
                } else {
                    **world = BroadPhase::new();
                    *ids = world.insert_many(boxes, Filter::default())?;
                }
                world.update();
                self.pairs.clear();
                self.pairs.extend(world.pairs().map(|pair| pair.map(ProxyId::slot)));
            }
            Engine::Algorithm(runner) => copy(runner.step(boxes, &mut ())?.pairs, &mut self.pairs),
        }
        let ms = now() - start;
        Ok(Report { ms, counts, pairs: self.pairs.len(), fingerprint: fingerprint(&self.pairs) })
    }

    fn count(&self, boxes: &[Aabb<D>]) -> Result<Option<Counts>, Error> {
        let (Engine::Algorithm(runner), Choice::Algorithm(options)) = (&self.engine, self.choice)
        else {
            return Ok(None);
        };
        if options.method == Method::Pairwise {
            // Brute force always does the same; observing it would take longer than running it.
            let tests = (boxes.len() * boxes.len().saturating_sub(1) / 2) as u64;
            let axis_overlaps = axis_overlaps(boxes, options.axis)? as u64;
            return Ok(Some(Counts { tests, axis_overlaps, ..Counts::default() }));
        }
        let (mut runner, mut counts) = (runner.clone(), Counts::default());
        runner.step(boxes, &mut counts)?;
        counts.axis_overlaps = runner.kept_axis_overlaps().unwrap_or(counts.axis_overlaps);
        Ok(Some(counts))
    }

    /// The pairs of the last run, in the order in which they were found.
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }
}

/// For all alike: into an array of the caller's own.
fn copy(from: &[[u32; 2]], to: &mut Vec<[u32; 2]>) {
    to.clear();
    to.extend_from_slice(from);
}

/// The sum over all pairs of a hash of each (that of SplitMix64), so their order does not matter.
fn fingerprint(pairs: &[[u32; 2]]) -> u64 {
    let mix = |mut z: u64| {
        z = z.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let hash = |&[a, b]: &[u32; 2]| mix(u64::from(a) << 32 | u64::from(b));
    pairs.iter().fold(0, |sum: u64, pair| sum.wrapping_add(hash(pair)))
}

/// What a first run would cost, computed without running it. O(n log n).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Forecast {
    /// How many pairs are tested or flagged.
    pub tests: f64,
    /// How many of them stay in memory.
    pub kept: f64,
}

/// The forecast for a choice: exact for tests, as every algorithm makes one for each pair that
/// overlaps on the axis that it sweeps; the library's two need none.
///
/// # Errors
/// [`Error::InvalidAxis`].
pub fn forecast<const D: usize>(choice: Choice, boxes: &[Aabb<D>]) -> Result<Forecast, Error> {
    let Choice::Algorithm(options) = choice else {
        return Ok(Forecast { tests: 0.0, kept: 0.0 });
    };
    let on_axis = axis_overlaps(boxes, options.axis)?;
    let on_all =
        (0..D).map(|axis| axis_overlaps(boxes, Axis::Fixed(axis))).sum::<Result<_, _>>()?;
    let n = boxes.len() as f64;
    Ok(match options.method {
        Method::Pairwise => Forecast { tests: n * (n - 1.0) / 2.0, kept: 0.0 },
        Method::AxisSweeps | Method::AxisSwapSweeps => Forecast { tests: on_all, kept: on_all },
        Method::SwapSweep => Forecast { tests: on_axis, kept: on_axis },
        _ => Forecast { tests: on_axis, kept: 0.0 },
    })
}

/// How many pairs overlap on the axis: for each box, the boxes that begin before it ends, less the boxes that began before it.
fn axis_overlaps<const D: usize>(boxes: &[Aabb<D>], axis: Axis) -> Result<f64, Error> {
    let axis = axis.choose(boxes)?;
    let mut lefts: Vec<f32> = boxes.iter().map(|aabb| aabb.min[axis]).collect();
    lefts.sort_unstable_by(|a, b| a.partial_cmp(b).expect("scenes have no NaN"));
    let begun = |right: f32| lefts.partition_point(|&left| left <= right) as f64;
    let n = boxes.len() as f64;
    Ok(boxes.iter().map(|aabb| begun(aabb.max[axis])).sum::<f64>() - n * (n + 1.0) / 2.0)
}
