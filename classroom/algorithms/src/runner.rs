//! One interface to every algorithm: choose by name, step, read the pairs.

use alloc::vec::Vec;

use crate::axis::Axis;
use crate::axis_sweeps::AxisSweeps;
use crate::endpoint::Side;
use crate::endpoint_array::EndpointArray;
use crate::endpoint_sweep::endpoint_sweep;
use crate::error::Error;
use crate::observer::Observer;
use crate::one_to_n::one_to_n;
use crate::pairwise::pairwise;
use crate::sorted_pairwise::sorted_pairwise;
use crate::sorts::Sort;
use crate::swap_sweep::SwapSweep;
use crate::touching::Touching;
use sweep_and_prune::{Aabb, Error as BoxError, Scalar};

/// Which algorithm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Method {
    /// Global pairwise: every box against every other. Pairs sorted.
    Pairwise,
    /// Sorts by left edge, then tests each box against those that begin before it ends. Pairs in the
    /// order of the sweep.
    SortedPairwise,
    /// The one-to-n scan of the endpoints between this box's own: the pairs of one box, and not
    /// even all of those. It misses boxes that enclose it on the axis.
    OneToN(u32),
    /// Sweeps a line over both endpoints of every box. Pairs in the order of the sweep.
    EndpointSweep,
    /// The endpoint sweep on every axis; a pair must be flagged on each. Pairs in the order of the
    /// last sweep.
    AxisSweeps,
    /// Insertion sort on one axis; its swaps show which overlaps begin and end. Pairs in an order
    /// that depends only on the steps so far.
    SwapSweep,
    /// The swap-driven sweep on every axis. Pairs in an order that depends only on the steps so far.
    AxisSwapSweeps,
}

impl Method {
    /// Every method that finds all the pairs, so not the one-to-n scan.
    pub const ALL: [Method; 6] = [
        Method::Pairwise,
        Method::SortedPairwise,
        Method::EndpointSweep,
        Method::AxisSweeps,
        Method::SwapSweep,
        Method::AxisSwapSweeps,
    ];

    /// The name for readers.
    pub const fn name(self) -> &'static str {
        match self {
            Method::Pairwise => "global pairwise",
            Method::SortedPairwise => "sorted pairwise",
            Method::OneToN(_) => "one-to-n scan",
            Method::EndpointSweep => "endpoint sweep",
            Method::AxisSweeps => "endpoint sweep on every axis",
            Method::SwapSweep => "swap-driven sweep",
            Method::AxisSwapSweeps => "swap-driven sweep on every axis",
        }
    }

    /// The method with this [`name`](Self::name); the one-to-n scan for box 0.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().chain([Method::OneToN(0)]).find(|method| method.name() == name)
    }

    /// Whether it keeps endpoints sorted, so that [`Sort`] matters. The swap-driven forms use it to
    /// sort the boxes that are added; insertion sort always sorts those that move.
    pub const fn sorts(self) -> bool {
        !matches!(self, Method::Pairwise)
    }
}

/// An algorithm and how to run it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub struct RunnerOptions {
    /// Which algorithm.
    pub method: Method,
    /// How it sorts, if it does.
    pub sort: Sort,
    /// How it sorts where no earlier order helps: in the first step, in every step unless persistent, and where
    /// the sweep axis has changed. `None` is as `sort`. Insertion sort needs O(n²) comparisons there.
    pub first_sort: Option<Sort>,
    /// Along which axis it sweeps, chosen in each step. The persistent swap-driven form starts over
    /// when the axis changes; the begun and ended pairs are correct all the same.
    pub axis: Axis,
    /// Whether each step starts from the state of the last: the order of the endpoints and, in the
    /// swap-driven forms, the overlaps. Only then are begun and ended pairs reported.
    pub persistent: bool,
}

impl RunnerOptions {
    /// This method with the standard sort, along the axis of largest variance, from scratch in each step.
    pub const fn new(method: Method) -> Self {
        let (sort, axis) = (Sort::Standard, Axis::LargestVariance);
        Self { method, sort, first_sort: None, axis, persistent: false }
    }

    /// Sets how it sorts.
    #[must_use]
    pub const fn sort(self, sort: Sort) -> Self {
        Self { sort, ..self }
    }

    /// Sets how it sorts where no earlier order helps.
    #[must_use]
    pub const fn first_sort(self, sort: Sort) -> Self {
        Self { first_sort: Some(sort), ..self }
    }

    /// Sets along which axis it sweeps.
    #[must_use]
    pub const fn axis(self, axis: Axis) -> Self {
        Self { axis, ..self }
    }

    /// Sets whether each step starts from the state of the last.
    #[must_use]
    pub const fn persistent(self, persistent: bool) -> Self {
        Self { persistent, ..self }
    }
}

/// What one step found.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// The overlapping pairs, each once, smaller index first, in the order of the method; the
    /// same in every build and on every machine.
    pub pairs: &'a [[u32; 2]],
    /// The pairs that the step before did not have, sorted. Empty unless persistent.
    pub begun: &'a [[u32; 2]],
    /// The pairs that only the step before had, sorted. Empty unless persistent.
    pub ended: &'a [[u32; 2]],
    /// The axis that was swept, or swept first.
    pub axis: usize,
}

/// Runs one algorithm over the boxes of one step after another.
///
/// A box is its index: the box at index 3 in one step is the one at index 3 in the next. Boxes
/// are added and removed, one or many at a time, by a slice that is longer or shorter, or, with
/// [`step_where`](Self::step_where), anywhere within it.
///
/// ```
/// use sweep_and_prune::Aabb;
/// use sweep_and_prune_algorithms::{Axis, Counts, Method, Runner, RunnerOptions};
///
/// let mut boxes = [Aabb::new([0.0], [2.0]), Aabb::new([1.0], [3.0]), Aabb::new([5.0], [6.0])];
/// let options = RunnerOptions::new(Method::SwapSweep).axis(Axis::Fixed(0)).persistent(true);
/// let mut runner = Runner::new(options);
/// assert_eq!(runner.step(&boxes, &mut ())?.pairs, [[0, 1]]);
///
/// boxes[1] = Aabb::new([4.0], [7.0]);
/// let mut counts = Counts::default();
/// let step = runner.step(&boxes, &mut counts)?;
/// assert_eq!((step.begun, step.ended), (&[[1, 2]][..], &[[0, 1]][..]));
/// // The left end of box 1 passed the right end of box 0; its right end passed both of box 2.
/// assert_eq!(counts.swaps, 3);
/// # Ok::<(), sweep_and_prune_algorithms::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Runner<const D: usize, T = f32> {
    options: RunnerOptions,
    /// The boxes of the last step, ascending.
    ids: Vec<u32>,
    /// The boxes of this step, ascending.
    next_ids: Vec<u32>,
    /// What only this step has.
    added: Vec<u32>,
    /// What only the last step had.
    removed: Vec<u32>,
    /// The axis of the last step.
    last_axis: Option<usize>,
    state: State<D, T>,
    pairs: Vec<[u32; 2]>,
    /// The pairs of the last step, sorted, if the method does not keep them itself.
    last_pairs: Vec<[u32; 2]>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

/// What a method works on.
#[derive(Clone, Debug)]
enum State<const D: usize, T> {
    /// The endpoints, for all methods that sweep at most one axis from scratch. Global pairwise leaves it empty.
    Endpoints(EndpointArray<T>, Touching),
    Axes(AxisSweeps<D, T>),
    Swaps(SwapSweep<T>),
}

impl<const D: usize, T: Scalar> State<D, T> {
    fn new(method: Method) -> Self {
        match method {
            Method::AxisSweeps => State::Axes(AxisSweeps::new()),
            Method::SwapSweep => State::Swaps(SwapSweep::on_axis(0)),
            Method::AxisSwapSweeps => State::Swaps(SwapSweep::on_every_axis(D)),
            _ => State::Endpoints(EndpointArray::default(), Touching::default()),
        }
    }

    /// Starts over without boxes. Keeps memory where that is simple.
    fn forget(&mut self, method: Method) {
        match self {
            State::Endpoints(array, _) => array.endpoints.clear(),
            State::Axes(sweeps) => sweeps.arrays.iter_mut().for_each(|a| a.endpoints.clear()),
            State::Swaps(_) => *self = Self::new(method),
        }
    }
}

impl<const D: usize, T: Scalar> Runner<D, T> {
    /// A runner with no state yet.
    pub fn new(options: RunnerOptions) -> Self {
        Self {
            options,
            ids: Vec::new(),
            next_ids: Vec::new(),
            added: Vec::new(),
            removed: Vec::new(),
            last_axis: None,
            state: State::new(options.method),
            pairs: Vec::new(),
            last_pairs: Vec::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    /// The options it was made with.
    pub fn options(&self) -> RunnerOptions {
        self.options
    }

    /// The memory that the algorithm holds to work with, in bytes: endpoints, flags and pairs that
    /// it keeps; not the pairs that it hands out, which are the same for all.
    pub fn bytes(&self) -> usize {
        match &self.state {
            State::Endpoints(array, touching) => array.bytes() + touching.bytes(),
            State::Axes(sweeps) => sweeps.bytes(),
            State::Swaps(sweep) => sweep.bytes(),
        }
    }

    /// How many pairs overlap on the swept axes after the last step, summed over those axes. Only the
    /// swap-driven forms keep these overlaps and report their changes. The others find and report all
    /// of them in every step, and return `None` here.
    pub fn kept_axis_overlaps(&self) -> Option<u64> {
        match &self.state {
            State::Swaps(sweep) => Some(sweep.axis_overlaps()),
            _ => None,
        }
    }

    /// Finds all overlapping pairs of `boxes`, and reports every operation to the observer.
    ///
    /// # Errors
    /// [`Error::Boxes`] or [`Error::InvalidAxis`]. After an error nothing has changed.
    pub fn step<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        observer: &mut O,
    ) -> Result<Step<'_>, Error> {
        self.step_where(boxes, |_| true, observer)
    }

    /// Finds all overlapping pairs of the boxes whose index is `present`. The others are holes: their
    /// coordinates are not read and need not be valid.
    ///
    /// # Errors
    /// Those of [`step`](Self::step).
    pub fn step_where<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        present: impl Fn(u32) -> bool,
        observer: &mut O,
    ) -> Result<Step<'_>, Error> {
        if boxes.len() > BoxError::BOX_LIMIT {
            return Err(BoxError::TooManyBoxes { count: boxes.len() }.into());
        }
        self.next_ids.clear();
        self.next_ids.extend((0..boxes.len() as u32).filter(|&id| present(id)));
        for &id in &self.next_ids {
            check(&boxes[id as usize], id as usize)?;
        }
        let axis = self.options.axis.choose_among(boxes, &self.next_ids)?;
        // Nothing can fail from here on.
        let persistent = self.options.persistent;
        observer.step(axis, persistent && matches!(self.state, State::Swaps(_)));
        let sort = self.update_ids(axis, observer);
        self.pairs.clear();
        self.begun.clear();
        self.ended.clear();
        self.find(boxes, axis, sort, observer);
        if persistent {
            self.report_changes(observer);
        }
        Ok(Step { pairs: &self.pairs, begun: &self.begun, ended: &self.ended, axis })
    }

    /// Brings `ids` up to `next_ids`, and finds which boxes were added and removed. Returns how to sort.
    fn update_ids<O: Observer>(&mut self, axis: usize, observer: &mut O) -> Sort {
        if !self.options.persistent {
            self.state.forget(self.options.method);
            self.ids.clear();
        }
        if let State::Swaps(sweep) = &mut self.state
            && sweep.axis().is_some_and(|last| last != axis)
        {
            sweep.turn_to(axis, &self.ids, observer);
            self.ids.clear();
        }
        let RunnerOptions { sort, first_sort, .. } = self.options;
        let is_first = self.ids.is_empty() || self.last_axis != Some(axis);
        self.last_axis = Some(axis);
        difference(&self.next_ids, &self.ids, &mut self.added);
        difference(&self.ids, &self.next_ids, &mut self.removed);
        core::mem::swap(&mut self.ids, &mut self.next_ids);
        first_sort.filter(|_| is_first).unwrap_or(sort)
    }

    fn find<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, T>],
        axis: usize,
        sort: Sort,
        observer: &mut O,
    ) {
        let Self { options, ids, added, removed, state, pairs, .. } = self;
        let RunnerOptions { method, .. } = *options;
        match state {
            State::Endpoints(..) if method == Method::Pairwise => {
                pairwise(boxes, ids, axis, observer, pairs);
            }
            State::Endpoints(array, touching) => {
                array.remove(removed);
                let only_lefts = method == Method::SortedPairwise;
                let sides: &[_] =
                    if only_lefts { &[Side::Left] } else { &[Side::Left, Side::Right] };
                array.append(added, sides);
                array.sort(boxes, axis, sort, observer);
                match method {
                    Method::SortedPairwise => sorted_pairwise(boxes, array, axis, observer, pairs),
                    Method::OneToN(id) => one_to_n(boxes, array, id, axis, observer, pairs),
                    _ => endpoint_sweep(boxes, array, touching, axis, observer, pairs),
                }
            }
            State::Axes(sweeps) => {
                for array in &mut sweeps.arrays {
                    array.remove(removed);
                    array.append(added, &[Side::Left, Side::Right]);
                }
                sweeps.find(boxes, axis, sort, observer, pairs);
            }
            State::Swaps(sweep) => {
                sweep.remove(removed, observer);
                sweep.move_all(boxes, observer);
                sweep.insert(boxes, added, sort, observer);
                sweep.report(boxes, observer, pairs);
            }
        }
    }

    /// Finds which pairs began and ended. The swap-driven forms keep track of that; for the others
    /// the pairs of two steps are compared.
    fn report_changes<O: Observer>(&mut self, observer: &mut O) {
        if let State::Swaps(sweep) = &mut self.state {
            sweep.changes(&mut self.begun, &mut self.ended);
        } else {
            let mut sorted = self.pairs.clone();
            sorted.sort_unstable();
            difference(&sorted, &self.last_pairs, &mut self.begun);
            difference(&self.last_pairs, &sorted, &mut self.ended);
            self.last_pairs = sorted;
        }
        self.begun.iter().for_each(|&[a, b]| observer.begin(a, b));
        self.ended.iter().for_each(|&[a, b]| observer.end(a, b));
    }
}

/// Checks that a box is valid. (The core's `validate` would also check holes.)
fn check<const D: usize, T: Scalar>(aabb: &Aabb<D, T>, index: usize) -> Result<(), BoxError> {
    let Some(axis) = aabb.invalid_axis() else { return Ok(()) };
    let [min, max] = [aabb.min, aabb.max].map(|corner| corner[axis].to_f64().into());
    Err(BoxError::InvalidBox { set: 0, index, axis, min, max })
}

/// Writes what is in `a` and not in `b`, both ascending, into `out`.
fn difference<V: Copy + Ord>(a: &[V], b: &[V], out: &mut Vec<V>) {
    out.clear();
    if a == b {
        return;
    }
    let mut b = b.iter().peekable();
    for &value in a {
        while b.next_if(|&&other| other < value).is_some() {}
        if b.peek() != Some(&&value) {
            out.push(value);
        }
    }
}
