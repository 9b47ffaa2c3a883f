//! Plays a trace forward and backward.
//!
//! What an event changes is small and can be undone: a swap is its own inverse, and what was added to
//! a set is removed again. The few events that overwrite something (a new array, a new step, the
//! position of the sweep line) push the old value onto a stack.

use alloc::boxed::Box;
use alloc::collections::BTreeSet;
use alloc::vec::Vec;
use core::mem;

use crate::counts::Counts;
use crate::endpoint::{Edge, Endpoint};
use crate::trace::{Event, Trace};

/// What to draw at one moment of a trace.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlayerState {
    /// The axis along which the current step sweeps, or sweeps first.
    pub axis: usize,
    /// The array of endpoints on each axis, in its order at this moment of the sort. Coordinates are rounded to `f32`.
    pub arrays: Vec<Vec<Endpoint<f32>>>,
    /// The axis whose array is being sorted or swept.
    pub array_axis: usize,
    /// The position in that array, and the endpoint there, that the sweep line reached last.
    pub line: Option<(usize, Edge)>,
    /// The boxes that the sweep line touches.
    pub active: BTreeSet<u32>,
    /// The pairs that the algorithm has found to overlap on a swept axis: (axis, pair).
    pub axis_overlaps: BTreeSet<(usize, [u32; 2])>,
    /// The pairs found in this step.
    pub overlaps: BTreeSet<[u32; 2]>,
    /// The pairs that have begun and not ended.
    pub held: BTreeSet<[u32; 2]>,
    /// What was counted in this step.
    pub counts: Counts,
}

/// What an event overwrote, to be restored when it is undone.
#[derive(Clone, Debug)]
enum Overwritten {
    Line(Option<(usize, Edge)>),
    MaxActive(u64),
    /// The array of the axis, how many arrays there were, and which was the current one.
    Array(Vec<Endpoint<f32>>, usize, usize),
    /// What a step dropped from the state when it began.
    Step(Box<PlayerState>),
}

/// Plays a [`Trace`], event by event, in both directions. After an event and its undoing the
/// state is what it was before. Memory: the trace, the state, and what was overwritten.
#[derive(Clone, Debug)]
pub struct Player {
    trace: Trace,
    /// The number of words that have been played.
    words: usize,
    state: PlayerState,
    /// For each event played, what `apply` returned.
    changed: Vec<bool>,
    overwritten: Vec<Overwritten>,
}

impl Player {
    /// A player at the beginning of a trace.
    pub fn new(trace: Trace) -> Self {
        Self {
            trace,
            words: 0,
            state: PlayerState::default(),
            changed: Vec::new(),
            overwritten: Vec::new(),
        }
    }

    /// The trace that is played.
    pub fn trace(&self) -> &Trace {
        &self.trace
    }

    /// How many events have been played.
    pub fn position(&self) -> usize {
        self.changed.len()
    }

    /// What to draw.
    pub fn state(&self) -> &PlayerState {
        &self.state
    }

    /// The event that was played last: what to highlight.
    pub fn current(&self) -> Option<Event<'_>> {
        Event::last_of(&self.trace.words()[..self.words]).map(|(event, _)| event)
    }

    /// Plays the next event, if there is one, and returns it.
    pub fn forward(&mut self) -> Option<Event<'_>> {
        let (event, length) = Event::first_of(&self.trace.words()[self.words..])?;
        self.changed.push(self.state.apply(event, &mut self.overwritten));
        self.words += length;
        Some(event)
    }

    /// Undoes the event that was played last, if there is one, and returns it.
    pub fn backward(&mut self) -> Option<Event<'_>> {
        let (event, length) = Event::last_of(&self.trace.words()[..self.words])?;
        let changed = self.changed.pop()?;
        self.state.undo(event, changed, &mut self.overwritten);
        self.words -= length;
        Some(event)
    }

    /// Plays or undoes events until `position` events have been played, or all of them.
    pub fn seek(&mut self, position: usize) {
        while self.position() < position && self.forward().is_some() {}
        while self.position() > position && self.backward().is_some() {}
    }
}

impl PlayerState {
    /// Returns whether the event changed anything: it may add what is there, or remove or swap what is not.
    fn apply(&mut self, event: Event<'_>, overwritten: &mut Vec<Overwritten>) -> bool {
        self.count(event, 1);
        let changed = self.toggle(event, true);
        match event {
            Event::Step { axis, keeps_axis_overlaps } => {
                let mut next = PlayerState { axis, ..PlayerState::default() };
                self.hand_on(&mut next, keeps_axis_overlaps);
                overwritten.push(Overwritten::Step(Box::new(mem::replace(self, next))));
            }
            Event::Array { axis, endpoints } => {
                let arrays = self.arrays.len();
                self.arrays.resize(arrays.max(axis + 1), Vec::new());
                let before = mem::replace(&mut self.arrays[axis], endpoints.iter().collect());
                let last_axis = mem::replace(&mut self.array_axis, axis);
                overwritten.push(Overwritten::Array(before, arrays, last_axis));
            }
            Event::Visit { position, edge } => {
                overwritten.push(Overwritten::Line(self.line.replace((position, edge))));
            }
            Event::Enter { .. } => {
                overwritten.push(Overwritten::MaxActive(self.counts.max_active));
                self.counts.max_active = self.counts.max_active.max(self.counts.active);
            }
            _ => {}
        }
        changed
    }

    /// Undoes what `apply` did, which returned `changed`.
    fn undo(&mut self, event: Event<'_>, changed: bool, overwritten: &mut Vec<Overwritten>) {
        if changed {
            self.toggle(event, false);
        }
        match event {
            Event::Step { keeps_axis_overlaps, .. } => {
                if let Some(Overwritten::Step(mut before)) = overwritten.pop() {
                    self.hand_on(&mut before, keeps_axis_overlaps);
                    *self = *before;
                }
            }
            Event::Array { axis, .. } => {
                if let Some(Overwritten::Array(before, arrays, last_axis)) = overwritten.pop() {
                    self.arrays[axis] = before;
                    self.arrays.truncate(arrays);
                    self.array_axis = last_axis;
                }
            }
            Event::Visit { .. } => {
                if let Some(Overwritten::Line(line)) = overwritten.pop() {
                    self.line = line;
                }
            }
            Event::Enter { .. } => {
                if let Some(Overwritten::MaxActive(most)) = overwritten.pop() {
                    self.counts.max_active = most;
                }
            }
            _ => {}
        }
        self.count(event, -1);
    }

    /// Adds, removes or swaps what an event says, or undoes that. Returns whether that changed anything.
    fn toggle(&mut self, event: Event<'_>, forward: bool) -> bool {
        fn put<V: Ord>(set: &mut BTreeSet<V>, value: V, is_in: bool) -> bool {
            if is_in { set.insert(value) } else { set.remove(&value) }
        }
        let on_axis = &mut self.axis_overlaps;
        let changed = match event {
            Event::Swap { positions, .. } => self.swap(positions),
            Event::Enter { id } => put(&mut self.active, id, forward),
            Event::Leave { id } => put(&mut self.active, id, !forward),
            Event::AxisOverlap { axis, a, b } => put(on_axis, (axis, [a, b]), forward),
            Event::AxisApart { axis, a, b } => put(on_axis, (axis, [a, b]), !forward),
            Event::Overlap { a, b } => put(&mut self.overlaps, [a, b], forward),
            Event::Begin { a, b } => put(&mut self.held, [a, b], forward),
            Event::End { a, b } => put(&mut self.held, [a, b], !forward),
            _ => true,
        };
        self.counts.active = self.active.len() as u64;
        changed
    }

    /// Moves to another state what the next step keeps.
    fn hand_on(&mut self, to: &mut PlayerState, axis_overlaps: bool) {
        to.arrays = mem::take(&mut self.arrays);
        to.array_axis = self.array_axis;
        to.held = mem::take(&mut self.held);
        if axis_overlaps {
            to.axis_overlaps = mem::take(&mut self.axis_overlaps);
        }
    }

    /// Swaps two positions of the current array, if it has them.
    fn swap(&mut self, [i, j]: [usize; 2]) -> bool {
        let Some(array) = self.arrays.get_mut(self.array_axis) else { return false };
        let inside = i.max(j) < array.len();
        if inside {
            array.swap(i, j);
        }
        inside
    }

    /// Counts an event once more, or once less.
    fn count(&mut self, event: Event<'_>, by: i64) {
        let counts = &mut self.counts;
        let count = match event {
            Event::Compare { .. } => &mut counts.comparisons,
            Event::Swap { .. } => &mut counts.swaps,
            Event::Test { .. } => &mut counts.tests,
            Event::AxisOverlap { .. } => &mut counts.axis_overlaps,
            Event::AxisApart { .. } => &mut counts.axis_ends,
            Event::Overlap { .. } => &mut counts.pairs,
            Event::Begin { .. } => &mut counts.begun,
            Event::End { .. } => &mut counts.ended,
            _ => return,
        };
        *count = count.wrapping_add_signed(by);
    }
}
