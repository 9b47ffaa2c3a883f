//! One thread: there are no helpers, so there is never a [`Team`] or [`Threads`].

use core::marker::PhantomData;
use core::ops::Range;

use crate::Scalar;
use crate::pairs::columns::{Columns, Filled};
use crate::pairs::grid::Grid;
use crate::pairs::placements::Placements;
use crate::pairs::sink::Sink;
use crate::pairs::source::Source;
use crate::pairs::task::Stop;

/// A sink of a search that may use threads.
pub trait Receiver: Sink {}

impl<S: Sink> Receiver for S {}

/// What the other threads work with: nothing.
#[derive(Debug)]
pub struct Helpers<W>(PhantomData<W>);

/// Several threads.
#[derive(Clone, Copy)]
pub enum Threads {}

/// Helpers at work.
pub struct Team<W>(Threads, PhantomData<W>);

impl<W> Helpers<W> {
    pub fn new() -> Self {
        Self(PhantomData)
    }

    #[cfg(feature = "std")]
    pub fn for_each(&mut self, _: impl FnMut(&mut W)) {}

    #[inline(always)]
    pub fn threads<O: Receiver>(&self, _boxes: usize) -> Option<Threads> {
        None
    }

    #[inline(always)]
    pub fn team<O: Receiver>(&mut self, _boxes: usize) -> Option<Team<W>> {
        None
    }

    #[inline(always)]
    pub fn rest(&mut self, _: Option<Team<W>>) {}
}

impl Threads {
    pub fn in_chunks<O: Receiver>(
        self,
        _items: Range<usize>,
        _chunk: usize,
        _sink: &mut O,
        _find: impl Fn(Range<usize>, &mut O) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        match self {}
    }
}

impl<W> Team<W> {
    pub fn in_chunks<O: Receiver>(
        &mut self,
        _items: Range<usize>,
        _chunk: usize,
        _own: &mut W,
        _sink: &mut O,
        _find: impl Fn(&mut W, Range<usize>, &mut O) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        match self.0 {}
    }

    pub fn fill<const D: usize, T: Scalar, S: Source<D, T>>(
        &mut self,
        _columns: &mut Columns<D, T>,
        _source: &[S],
        _grid: &Grid<T>,
        _other: Option<&Columns<D, T>>,
        _own: &mut Placements,
        _placements: fn(&mut W) -> &mut Placements,
    ) -> Result<(), Stop> {
        match self.0 {}
    }

    pub fn search<const D: usize, T: Scalar, O: Receiver>(
        &mut self,
        _own: &mut W,
        _helpers: fn(&mut W) -> &mut Helpers<W>,
        _filled: &Filled<'_, D, T>,
        _sink: &mut O,
        _find: impl Fn(&mut W, Range<usize>, &mut O) -> Result<(), Stop>,
    ) -> Result<(), Stop> {
        match self.0 {}
    }
}
