//! A runner chosen by names: it runs an algorithm step by step, counts what it does and records it.
//!
//! All boxes are doubles, which hold those in single precision exactly and compare alike.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::{
    Axis, Counts, Error, Method, Observer, Player, Runner, RunnerOptions, Sort, Trace,
};
use sweep_and_prune_wasm_runtime::call::{self, Running, run, stack, truth};
use sweep_and_prune_wasm_runtime::status::{Code, report, report_error};

use crate::numbers;

/// What an algorithm found in a step: its pairs, those that began, those that ended.
pub type Lists = [Vec<[u32; 2]>; 3];

/// What watches an algorithm.
pub type Recorder = (Counts, Trace);

/// An algorithm that runs step by step over boxes of `D` dimensions.
pub trait Algorithm<const D: usize>: Clone + 'static {
    /// Finds the pairs of these boxes; returns the axis that it swept.
    ///
    /// # Errors
    /// As [`Runner::step`]; then nothing has changed.
    fn step(
        &mut self,
        boxes: &[Aabb<D, f64>],
        recorder: &mut Recorder,
        lists: &mut Lists,
    ) -> Result<usize, Error>;

    /// The memory that it uses, in bytes.
    fn bytes(&self) -> usize;
}

impl<const D: usize> Algorithm<D> for Box<Runner<D, f64>> {
    fn step(
        &mut self,
        boxes: &[Aabb<D, f64>],
        recorder: &mut Recorder,
        lists: &mut Lists,
    ) -> Result<usize, Error> {
        let step = Runner::step(self, boxes, recorder)?;
        for (list, found) in lists.iter_mut().zip([step.pairs, step.begun, step.ended]) {
            list.clear();
            list.extend_from_slice(found);
        }
        Ok(step.axis)
    }

    fn bytes(&self) -> usize {
        Runner::bytes(self)
    }
}

/// An algorithm of any dimensions, with the rows that it reads.
pub trait Steps {
    /// Where `count` rows of boxes are; `None` if there is no memory for them.
    fn rows(&mut self, count: usize) -> Option<*mut f64>;

    /// Runs one step over the first `count` rows; returns the axis.
    ///
    /// # Errors
    /// As [`Algorithm::step`].
    fn step(
        &mut self,
        count: usize,
        recorder: &mut Recorder,
        lists: &mut Lists,
    ) -> Result<usize, Error>;

    /// The memory that the algorithm uses, in bytes.
    fn bytes(&self) -> usize;

    /// A copy, which continues as this one would.
    fn copy(&self) -> Box<dyn Steps>;
}

#[derive(Clone)]
struct Typed<const D: usize, A> {
    boxes: Vec<Aabb<D, f64>>,
    algorithm: A,
}

impl<const D: usize, A: Algorithm<D>> Steps for Typed<D, A> {
    fn rows(&mut self, count: usize) -> Option<*mut f64> {
        if let Some(more) = count.checked_sub(self.boxes.len()) {
            self.boxes.try_reserve(more).ok()?;
            self.boxes.resize(count, Aabb::new([0.0; D], [0.0; D]));
        }
        Some(self.boxes.as_mut_ptr().cast())
    }

    fn step(
        &mut self,
        count: usize,
        recorder: &mut Recorder,
        lists: &mut Lists,
    ) -> Result<usize, Error> {
        let boxes = &self.boxes[..count.min(self.boxes.len())];
        self.algorithm.step(boxes, recorder, lists)
    }

    fn bytes(&self) -> usize {
        self.algorithm.bytes()
    }

    fn copy(&self) -> Box<dyn Steps> {
        Box::new(self.clone())
    }
}

/// An algorithm and the rows that it reads.
pub fn steps<const D: usize>(algorithm: impl Algorithm<D>) -> Box<dyn Steps> {
    Box::new(Typed { boxes: Vec::new(), algorithm })
}

/// Makes an algorithm that [`Method`] does not have, for a number of dimensions and an axis.
pub type Variant = Box<dyn Fn(u32, Axis) -> Box<dyn Steps>>;

/// What JavaScript holds a pointer to.
#[repr(C)]
pub struct Handle {
    running: Running,
    dimensions: u32,
    text: Vec<u8>,
    /// None until it is started.
    steps: Option<Box<dyn Steps>>,
    method: Method,
    /// Instead of the method.
    variant: Option<Variant>,
    sort: Sort,
    axis: Axis,
    recorder: Recorder,
    lists: Lists,
    /// Axis, bytes, and the counts.
    numbers: [f64; 12],
}

impl call::Handle for Handle {
    fn running(&mut self) -> &mut Running {
        &mut self.running
    }
}

impl Handle {
    /// The name that JavaScript has written.
    pub fn name(&self) -> Option<&str> {
        core::str::from_utf8(&self.text).ok()
    }

    /// Runs this instead of a method.
    pub fn set_variant(&mut self, variant: Variant) {
        self.variant = Some(variant);
    }

    /// What was recorded.
    pub fn trace(&self) -> &Trace {
        &self.recorder.1
    }
}

/// A new runner, to be chosen and started; records up to `trace_words` words of trace.
#[unsafe(no_mangle)]
extern "C" fn runner_new(dimensions: u32, trace_words: usize) -> Option<Box<Handle>> {
    stack::check(stack::LARGE);
    (1..=3).contains(&dimensions).then(|| {
        Box::new(Handle {
            running: Running::default(),
            dimensions,
            text: Vec::new(),
            steps: None,
            method: Method::Pairwise,
            variant: None,
            sort: Sort::Standard,
            axis: Axis::default(),
            recorder: (Counts::default(), Trace::with_limit(trace_words)),
            lists: Lists::default(),
            numbers: [0.0; 12],
        })
    })
}

/// A copy of a runner, which continues as the runner would. It has to be freed, too.
#[unsafe(no_mangle)]
extern "C" fn runner_copy(handle: &Handle) -> Box<Handle> {
    stack::check(stack::LARGE);
    Box::new(Handle {
        running: Running::default(),
        text: Vec::new(),
        steps: handle.steps.as_ref().map(|steps| steps.copy()),
        variant: None, // it is started
        recorder: handle.recorder.clone(),
        lists: handle.lists.clone(),
        ..*handle
    })
}

/// Frees a runner and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn runner_free(handle: Option<Box<Handle>>) {
    call::free(handle);
}

/// Where to write a name of `length` bytes.
#[unsafe(no_mangle)]
extern "C" fn runner_text(handle: &mut Handle, length: usize) -> *mut u8 {
    run(handle, stack::SMALL, |handle| {
        handle.text.clear();
        handle.text.resize(length, 0);
        handle.text.as_mut_ptr()
    })
}

/// Chooses the method (0), the sort (1) or the axis (2) of the name in the text. Whether there is
/// one. `index` is the box of the one-to-n scan, or the fixed axis.
#[unsafe(no_mangle)]
extern "C" fn runner_choose(handle: &mut Handle, part: u32, index: u32) -> bool {
    run(handle, stack::SMALL, |handle| choose(handle, part, index))
}

fn choose(handle: &mut Handle, part: u32, index: u32) -> bool {
    let Ok(name) = core::str::from_utf8(&handle.text) else { return false };
    match part {
        0 => Method::from_name(name).map(|method| {
            handle.method = match method {
                Method::OneToN(_) => Method::OneToN(index),
                method => method,
            };
        }),
        1 => Sort::from_name(name).map(|sort| handle.sort = sort),
        2 => Axis::from_name(name).map(|axis| {
            handle.axis = match axis {
                Axis::Fixed(_) => Axis::Fixed(index as usize),
                axis => axis,
            };
        }),
        _ => None,
    }
    .is_some()
}

/// Starts it as chosen.
#[unsafe(no_mangle)]
extern "C" fn runner_start(handle: &mut Handle, is_persistent: u32) -> Code {
    let Some(is_persistent) = truth(is_persistent) else { return report(Code::Internal, [0, 0]) };
    run(handle, stack::LARGE, |handle| {
        let Handle { method, sort, axis, .. } = *handle;
        let options = RunnerOptions::new(method).sort(sort).axis(axis).persistent(is_persistent);
        handle.steps = Some(match (&handle.variant, handle.dimensions) {
            (Some(variant), dimensions) => variant(dimensions, axis),
            (None, 1) => steps(Box::new(Runner::<1, f64>::new(options))),
            (None, 2) => steps(Box::new(Runner::<2, f64>::new(options))),
            (None, _) => steps(Box::new(Runner::<3, f64>::new(options))),
        });
        report(Code::Ok, [0, 0])
    })
}

/// Where to write `count` rows of boxes; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn runner_rows(handle: &mut Handle, count: usize) -> *mut f64 {
    let rows = run(handle, stack::SMALL, |handle| {
        handle.steps.as_mut().and_then(|steps| steps.rows(count))
    });
    rows.unwrap_or(core::ptr::null_mut())
}

/// Runs one step over the first `count` rows. Details: where the numbers are.
#[unsafe(no_mangle)]
extern "C" fn runner_step(handle: &mut Handle, count: usize) -> Code {
    run(handle, stack::LARGE, |handle| step(handle, count))
}

fn step(handle: &mut Handle, count: usize) -> Code {
    let Handle { steps: Some(steps), recorder, lists, numbers, .. } = handle else {
        return report(Code::Internal, [0, 0]);
    };
    let before = core::mem::take(&mut recorder.0);
    match steps.step(count, recorder, lists) {
        Ok(axis) => {
            numbers[..2].copy_from_slice(&[axis as f64, steps.bytes() as f64]);
            numbers[2..].copy_from_slice(&numbers::counts(&recorder.0));
            report(Code::Ok, [numbers.as_ptr().addr(), numbers.len()])
        }
        Err(error) => {
            recorder.0 = before;
            match error {
                Error::Boxes(error) => report_error(error),
                Error::InvalidAxis { axis, .. } => report(Code::InvalidArgument, [axis, 0]),
                _ => report(Code::Internal, [0, 0]),
            }
        }
    }
}

/// Details: where a list is, and how many words: pairs (0), begun (1) or ended (2) ones of the
/// last step, or the trace (3).
#[unsafe(no_mangle)]
extern "C" fn runner_list(handle: &mut Handle, which: usize) -> Code {
    match handle.lists.get(which) {
        Some(list) => report(Code::Ok, [list.as_ptr().addr(), 2 * list.len()]),
        None => {
            let words = handle.recorder.1.words();
            report(Code::Ok, [words.as_ptr().addr(), words.len()])
        }
    }
}

/// Whether something was not recorded.
#[unsafe(no_mangle)]
extern "C" fn runner_is_truncated(handle: &mut Handle) -> bool {
    handle.recorder.1.is_truncated()
}

/// Clears the trace.
#[unsafe(no_mangle)]
extern "C" fn runner_clear_trace(handle: &mut Handle) {
    run(handle, stack::LARGE, |handle| handle.recorder.1.clear());
}

/// Clears the trace except for what the next step continues from: the arrays, the axis overlaps and the current pairs are then
/// its only events. Returns how many there are.
#[unsafe(no_mangle)]
extern "C" fn runner_trim_trace(handle: &mut Handle) -> usize {
    run(handle, stack::LARGE, |handle| trim(&mut handle.recorder.1))
}

fn trim(trace: &mut Trace) -> usize {
    let mut player = Player::new(trace.clone());
    player.seek(trace.len());
    trace.clear();
    let state = player.state();
    for (axis, array) in state.arrays.iter().enumerate().filter(|(_, array)| !array.is_empty()) {
        trace.array(axis, array);
    }
    for &(axis, [a, b]) in &state.axis_overlaps {
        trace.axis_overlap(axis, a, b);
    }
    for &[a, b] in &state.held {
        trace.begin(a, b);
    }
    trace.len()
}
