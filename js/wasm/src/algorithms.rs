//! The observable algorithms: a runner chosen by names, its counts and trace, and a player of it.
//!
//! All boxes are doubles, which hold those in single precision exactly and compare alike.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::{
    Axis, Counts, Endpoint, Error, Method, Observer, Player, Runner, RunnerOptions, Side, Sort,
    Trace,
};

use crate::broken::{Wrong, WrongRunner};
use crate::call::{self, Running, run, stack, truth};
use crate::status::{Code, report, report_error};

/// A runner of any dimensions, with the rows that it reads.
trait Steps {
    fn rows(&mut self, count: usize) -> Option<*mut f64>;
    fn step(
        &mut self,
        count: usize,
        observer: &mut (Counts, Trace),
        lists: &mut [Vec<[u32; 2]>; 3],
    ) -> Result<usize, Error>;
    fn bytes(&self) -> usize;
    fn copy(&self) -> Box<dyn Steps>;
}

#[derive(Clone)]
struct Typed<const D: usize> {
    boxes: Vec<Aabb<D, f64>>,
    algorithm: Algorithm<D>,
}

#[derive(Clone)]
enum Algorithm<const D: usize> {
    Right(Box<Runner<D, f64>>),
    Wrong(WrongRunner<D>),
}

impl<const D: usize> Typed<D> {
    fn boxed(options: RunnerOptions, wrong: Option<Wrong>) -> Box<dyn Steps> {
        let algorithm = match wrong {
            None => Algorithm::Right(Box::new(Runner::new(options))),
            Some(wrong) => Algorithm::Wrong(WrongRunner::new(wrong, options.axis)),
        };
        Box::new(Self { boxes: Vec::new(), algorithm })
    }
}

impl<const D: usize> Steps for Typed<D> {
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
        observer: &mut (Counts, Trace),
        lists: &mut [Vec<[u32; 2]>; 3],
    ) -> Result<usize, Error> {
        let boxes = &self.boxes[..count.min(self.boxes.len())];
        match &mut self.algorithm {
            Algorithm::Right(runner) => {
                let step = runner.step(boxes, observer)?;
                for (list, found) in lists.iter_mut().zip([step.pairs, step.begun, step.ended]) {
                    list.clear();
                    list.extend_from_slice(found);
                }
                Ok(step.axis)
            }
            Algorithm::Wrong(runner) => {
                let axis = runner.step(boxes, observer)?;
                *lists = runner.found();
                Ok(axis)
            }
        }
    }

    fn bytes(&self) -> usize {
        match &self.algorithm {
            Algorithm::Right(runner) => runner.bytes(),
            Algorithm::Wrong(runner) => runner.bytes(),
        }
    }

    fn copy(&self) -> Box<dyn Steps> {
        Box::new(self.clone())
    }
}

/// What JavaScript holds a pointer to.
#[repr(C)]
struct Handle {
    running: Running,
    dimensions: u32,
    text: Vec<u8>,
    /// None until it is started.
    steps: Option<Box<dyn Steps>>,
    method: Method,
    /// Instead of the method, one that is wrong.
    wrong: Option<Wrong>,
    sort: Sort,
    axis: Axis,
    observer: (Counts, Trace),
    /// Pairs, begun, ended.
    lists: [Vec<[u32; 2]>; 3],
    /// Axis, bytes, and the counts.
    numbers: [f64; 12],
}

impl call::Handle for Handle {
    fn running(&mut self) -> &mut Running {
        &mut self.running
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
            wrong: None,
            sort: Sort::Standard,
            axis: Axis::default(),
            observer: (Counts::default(), Trace::with_limit(trace_words)),
            lists: [Vec::new(), Vec::new(), Vec::new()],
            numbers: [0.0; 12],
        })
    })
}

/// A copy of a runner, which goes on as the runner would, to be freed as well.
#[unsafe(no_mangle)]
extern "C" fn runner_copy(handle: &Handle) -> Box<Handle> {
    stack::check(stack::LARGE);
    Box::new(Handle {
        running: Running::default(),
        text: Vec::new(),
        steps: handle.steps.as_ref().map(|steps| steps.copy()),
        observer: handle.observer.clone(),
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
        0 if cfg!(feature = "broken") && Wrong::from_name(name).is_some() => {
            handle.wrong = Wrong::from_name(name);
            handle.wrong.map(|_| ())
        }
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
        let Handle { method, wrong, sort, axis, .. } = *handle;
        let options = RunnerOptions::new(method).sort(sort).axis(axis).persistent(is_persistent);
        handle.steps = Some(match handle.dimensions {
            1 => Typed::<1>::boxed(options, wrong),
            2 => Typed::<2>::boxed(options, wrong),
            _ => Typed::<3>::boxed(options, wrong),
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
    let Handle { steps: Some(steps), observer, lists, numbers, .. } = handle else {
        return report(Code::Internal, [0, 0]);
    };
    let before = core::mem::take(&mut observer.0);
    match steps.step(count, observer, lists) {
        Ok(axis) => {
            let bytes = steps.bytes();
            *numbers = numbers_of(axis, bytes, &observer.0);
            report(Code::Ok, [numbers.as_ptr().addr(), numbers.len()])
        }
        Err(error) => {
            observer.0 = before;
            match error {
                Error::Boxes(error) => report_error(error),
                Error::InvalidAxis { axis, .. } => report(Code::InvalidArgument, [axis, 0]),
                _ => report(Code::Internal, [0, 0]),
            }
        }
    }
}

/// `classroom/demo/src/algorithms/runner.ts` reads them in this order.
fn numbers_of(axis: usize, bytes: usize, counts: &Counts) -> [f64; 12] {
    let counts = [
        counts.comparisons,
        counts.swaps,
        counts.tests,
        counts.axis_overlaps,
        counts.axis_ends,
        counts.pairs,
        counts.begun,
        counts.ended,
        counts.active,
        counts.max_active,
    ];
    let mut numbers = [0.0; 12];
    numbers[0] = axis as f64;
    numbers[1] = bytes as f64;
    for (number, count) in numbers[2..].iter_mut().zip(counts) {
        *number = count as f64;
    }
    numbers
}

/// Details: where a list is, and how many words: pairs (0), begun (1) or ended (2) ones of the
/// last step, or the trace (3).
#[unsafe(no_mangle)]
extern "C" fn runner_list(handle: &mut Handle, which: usize) -> Code {
    match handle.lists.get(which) {
        Some(list) => report(Code::Ok, [list.as_ptr().addr(), 2 * list.len()]),
        None => {
            let words = handle.observer.1.words();
            report(Code::Ok, [words.as_ptr().addr(), words.len()])
        }
    }
}

/// Whether something was not recorded.
#[unsafe(no_mangle)]
extern "C" fn runner_is_truncated(handle: &mut Handle) -> bool {
    handle.observer.1.is_truncated()
}

/// Forgets the trace.
#[unsafe(no_mangle)]
extern "C" fn runner_clear_trace(handle: &mut Handle) {
    run(handle, stack::LARGE, |handle| handle.observer.1.clear());
}

/// Forgets the trace but for what the next step goes on from (the arrays, the axis overlaps and
/// the pairs held), which is recorded as the only events so far; how many those are.
#[unsafe(no_mangle)]
extern "C" fn runner_trim_trace(handle: &mut Handle) -> usize {
    run(handle, stack::LARGE, |handle| trim(&mut handle.observer.1))
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

/// What JavaScript holds a pointer to.
#[repr(C)]
struct Playing {
    running: Running,
    player: Player,
    state: Vec<f64>,
}

impl call::Handle for Playing {
    fn running(&mut self) -> &mut Running {
        &mut self.running
    }
}

/// A player of what a runner has recorded, to be freed by [`player_free`].
#[unsafe(no_mangle)]
extern "C" fn player_new(handle: &mut Handle) -> Box<Playing> {
    stack::check(stack::LARGE);
    let player = Player::new(handle.observer.1.clone());
    Box::new(Playing { running: Running::default(), player, state: Vec::new() })
}

/// Frees a player and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn player_free(playing: Option<Box<Playing>>) {
    call::free(playing);
}

/// Plays or undoes until `position` events have been played, or all. Returns how many have been played.
#[unsafe(no_mangle)]
extern "C" fn player_seek(playing: &mut Playing, position: usize) -> usize {
    run(playing, stack::LARGE, |playing| {
        playing.player.seek(position);
        playing.player.position()
    })
}

/// Details: where the state is, and how many numbers. These are the axis, the axis of the current
/// array, the position and edge of the line or -1, the ten counts; and then lists, each with its
/// length in front: active boxes, overlaps, held pairs, axis overlaps (axis, a, b), and of each
/// axis the endpoints (edge, at). `classroom/demo/src/algorithms/player.ts` reads them.
#[unsafe(no_mangle)]
extern "C" fn player_state(playing: &mut Playing) -> Code {
    run(playing, stack::LARGE, write_state)
}

fn write_state(playing: &mut Playing) -> Code {
    let state = playing.player.state();
    let out = &mut playing.state;
    out.clear();
    let line = state.line.map_or([-1.0, -1.0], |(position, edge)| {
        [position as f64, edge_number(edge.id, edge.side)]
    });
    out.extend([state.axis as f64, state.array_axis as f64]);
    out.extend(line);
    out.extend(&numbers_of(0, 0, &state.counts)[2..]);
    out.push(state.active.len() as f64);
    out.extend(state.active.iter().map(|&id| f64::from(id)));
    for pairs in [&state.overlaps, &state.held] {
        out.push(2.0 * pairs.len() as f64);
        out.extend(pairs.iter().flatten().map(|&id| f64::from(id)));
    }
    out.push(3.0 * state.axis_overlaps.len() as f64);
    out.extend(
        state
            .axis_overlaps
            .iter()
            .flat_map(|&(axis, [a, b])| [axis as f64, f64::from(a), f64::from(b)]),
    );
    out.push(state.arrays.len() as f64);
    for array in &state.arrays {
        out.push(2.0 * array.len() as f64);
        out.extend(
            array.iter().flat_map(|&Endpoint { at, edge }| {
                [edge_number(edge.id, edge.side), f64::from(at)]
            }),
        );
    }
    report(Code::Ok, [out.as_ptr().addr(), out.len()])
}

/// As in a trace: twice the box, and one more for the right endpoint.
fn edge_number(id: u32, side: Side) -> f64 {
    2.0 * f64::from(id) + f64::from(side as u8)
}
