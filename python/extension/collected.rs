//! Pairs, collected as they are found on one thread.

use std::collections::TryReserveError;
use std::ops::ControlFlow;

use numpy::Element;
use pyo3::prelude::*;

use crate::arrays::{Array, MANY, owned_by_rust, pairs};

/// The pairs found so far. Many are converted at once: their memory is new, and to write to new memory takes longer than to
/// find the pairs. (13 million pairs of 11 million intervals take 0.5 of the time.)
pub struct Collected<V, C> {
    /// All pairs, unless they are many.
    few: Vec<[u32; 2]>,
    many: Vec<[V; 2]>,
    convert: C,
    has_memory: bool,
}

impl<V: Element + Copy, C: Fn(u32) -> V + Copy> Collected<V, C> {
    /// None so far. Few pairs are stored in the memory of `few`; `convert` converts indices.
    pub fn new(mut few: Vec<[u32; 2]>, convert: C) -> Self {
        few.clear();
        Self { few, many: Vec::new(), convert, has_memory: true }
    }

    /// Takes more pairs. Breaks if there is no memory for them.
    pub fn take(&mut self, found: &[[u32; 2]]) -> ControlFlow<()> {
        self.has_memory = self.try_take(found).is_ok();
        if self.has_memory { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }

    fn try_take(&mut self, found: &[[u32; 2]]) -> Result<(), TryReserveError> {
        let Self { few, many, convert, .. } = self;
        if many.is_empty() && few.len() + found.len() <= MANY {
            few.try_reserve(found.len())?;
            few.extend_from_slice(found);
        } else {
            many.try_reserve(few.len() + found.len())?;
            let pairs = few.drain(..).chain(found.iter().copied());
            many.extend(pairs.map(|pair| pair.map(*convert)));
        }
        Ok(())
    }

    /// Whether there was memory for all pairs that were taken.
    pub fn has_memory(&self) -> bool {
        self.has_memory
    }

    /// An array of all pairs. The memory of the few is given back.
    pub fn into_array<'py>(
        self,
        py: Python<'py>,
        memory: &mut Vec<[u32; 2]>,
    ) -> PyResult<Array<'py>> {
        let Self { few, many, convert, .. } = self;
        let array = if many.is_empty() {
            pairs(py, few.iter().map(|pair| pair.map(convert)))
        } else {
            owned_by_rust(py, many)
        };
        *memory = few;
        array
    }
}
