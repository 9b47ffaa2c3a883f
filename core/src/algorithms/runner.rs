//! One interface to every algorithm: choose by name, step, read the pairs.

use alloc::vec::Vec;

use super::axis::Axis;
use super::observer::Observer;
use super::pairwise::pairwise_observed;
use super::sorted_pairwise::SortedPairwise;
use super::sorts::Sort;
use crate::{Aabb, Error, Scalar, validate};

/// Which algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Method {
    /// Global pairwise: every box against every other.
    Pairwise,
    /// Sort by left edge, test each box against those that begin before it ends.
    SortedPairwise,
}

impl Method {
    /// Every method.
    pub const ALL: [Method; 2] = [Method::Pairwise, Method::SortedPairwise];

    /// The name that a person reads.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Pairwise => "global pairwise",
            Method::SortedPairwise => "sorted pairwise",
        }
    }
}

/// An algorithm and how to run it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RunnerOptions {
    /// Which algorithm.
    pub method: Method,
    /// How it sorts, if it does.
    pub sort: Sort,
    /// Along which axis it sweeps, chosen anew each step.
    pub axis: Axis,
    /// Whether the order of one step is where the next begins.
    pub persistent: bool,
}

/// What one step found.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// The overlapping pairs, each once, smaller index first, in the order found.
    pub pairs: &'a [[u32; 2]],
    /// The axis that was swept.
    pub axis: usize,
}

/// Runs one algorithm over the boxes of one step after another.
///
/// ```
/// use sweep_and_prune::Aabb;
/// use sweep_and_prune::algorithms::{Axis, Counts, Method, Runner, RunnerOptions, Sort};
///
/// let boxes = [Aabb::new([0.0], [2.0]), Aabb::new([1.0], [3.0]), Aabb::new([5.0], [6.0])];
/// let mut runner = Runner::new(RunnerOptions {
///     method: Method::SortedPairwise,
///     sort: Sort::Insertion,
///     axis: Axis::Fixed(0),
///     persistent: true,
/// });
/// let mut counts = Counts::default();
/// assert_eq!(runner.step(&boxes, &mut counts)?.pairs, [[0, 1]]);
/// assert_eq!((counts.comparisons, counts.swaps, counts.tests), (2, 0, 1));
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Runner<const D: usize, T = f32> {
    options: RunnerOptions,
    sorted: SortedPairwise<T>,
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize, T: Scalar> Runner<D, T> {
    /// A runner with no state yet.
    pub fn new(options: RunnerOptions) -> Self {
        Self { options, sorted: SortedPairwise::new(), pairs: Vec::new() }
    }

    /// The options it was made with.
    pub fn options(&self) -> RunnerOptions {
        self.options
    }

    /// Finds all overlapping pairs of `boxes`, telling the observer every step.
    ///
    /// # Errors
    /// [`Error::InvalidBox`], [`Error::TooManyBoxes`] or [`Error::InvalidAxis`]; then nothing has
    /// changed.
    pub fn step<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        observer: &mut O,
    ) -> Result<Step<'_>, Error> {
        validate(boxes)?;
        let RunnerOptions { method, sort, axis, persistent } = self.options;
        let axis = axis.choose(boxes)?;
        self.pairs.clear();
        match method {
            Method::Pairwise => pairwise_observed(boxes, axis, observer, &mut self.pairs),
            Method::SortedPairwise => {
                if !persistent {
                    self.sorted.forget();
                }
                self.sorted.find(boxes, axis, sort, observer, &mut self.pairs);
            }
        }
        Ok(Step { pairs: &self.pairs, axis })
    }
}
