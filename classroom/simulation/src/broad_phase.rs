//! Which broad phase finds the pairs: a choice at run time.

use sweep_and_prune::{Aabb, PairFinder};
use sweep_and_prune_algorithms::{Counts, Error, Runner, RunnerOptions, Sort};

/// What finds the pairs of boxes. The motion is the same for every choice, bit for bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BroadPhase {
    /// The library's [`PairFinder`], the fast path.
    #[default]
    Library,
    /// One of the [`algorithms`](sweep_and_prune_algorithms) of
    /// [`Method::ALL`](sweep_and_prune_algorithms::Method::ALL), which find all pairs.
    Algorithm(RunnerOptions),
}

/// The chosen one with what it keeps from step to step.
#[derive(Debug)]
pub enum Engine<const D: usize> {
    Library(Box<PairFinder<D>>),
    Algorithm(Box<Runner<D>>),
}

impl<const D: usize> Engine<D> {
    /// # Errors
    /// [`Error::InvalidAxis`].
    pub fn new(choice: BroadPhase) -> Result<Self, Error> {
        match choice {
            BroadPhase::Library => Ok(Engine::Library(Box::default())),
            BroadPhase::Algorithm(options) => {
                options.axis.choose::<D, f32>(&[])?;
                // The first step is not almost sorted, so insertion sort would take O(n²).
                let first = if options.persistent { Sort::Standard } else { options.sort };
                let options = options.first_sort(first);
                Ok(Engine::Algorithm(Box::new(Runner::new(options))))
            }
        }
    }

    /// The overlapping pairs, unobserved: as fast as it goes.
    pub fn find(&mut self, boxes: &[Aabb<D>]) -> Result<&[[u32; 2]], Error> {
        match self {
            Engine::Library(finder) => Ok(finder.find(boxes)?),
            Engine::Algorithm(runner) => Ok(runner.step(boxes, &mut ())?.pairs),
        }
    }

    /// What [`find`](Self::find) would do next, counted; on a copy, so that counting neither
    /// costs the real run time nor sorts its array for it. The library's finder counts nothing.
    ///
    /// The overlaps on the axis are all that exist, even if the algorithm keeps them and reports only changes. So the number
    /// means the same for every algorithm.
    pub fn count(&self, boxes: &[Aabb<D>]) -> Result<Option<Counts>, Error> {
        let Engine::Algorithm(runner) = self else { return Ok(None) };
        let mut counts = Counts::default();
        let mut runner = runner.clone();
        runner.step(boxes, &mut counts)?;
        counts.axis_overlaps = runner.kept_axis_overlaps().unwrap_or(counts.axis_overlaps);
        Ok(Some(counts))
    }
}
