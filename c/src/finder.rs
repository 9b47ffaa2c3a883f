//! A pair finder with its threads.

use std::ffi::c_void;
use std::ops::ControlFlow;

use sweep_and_prune::{Aabb, PairFinder, Scalar, Search};

use crate::common::{sap_pair, sap_pairs_callback};
use crate::failure::Failure;
use crate::memory::List;
use crate::threads::Threads;

/// One set of boxes, or two.
#[derive(Clone, Copy)]
pub struct Sets<'b, const D: usize, T> {
    pub boxes: &'b [Aabb<D, T>],
    pub others: Option<&'b [Aabb<D, T>]>,
}

/// What the handle of a finder holds.
pub struct Finder<const D: usize, T: Scalar> {
    finder: PairFinder<D, T>,
    threads: Threads,
}

impl<const D: usize, T: Scalar> Finder<D, T> {
    /// A finder that uses at most this many threads.
    pub fn new(threads: u32) -> Result<Self, Failure> {
        let threads = Threads::new(threads)?;
        let finder = PairFinder::new().threads(threads.count());
        Ok(Self { finder, threads })
    }

    /// All pairs, in memory of the finder.
    pub fn find(&mut self, sets: Sets<'_, D, T>) -> Result<&[sap_pair], Failure> {
        let Self { finder, threads } = self;
        let pairs = threads.run(|| search(finder, sets).pairs())?;
        Ok(as_pairs(pairs))
    }

    /// All pairs, in memory of the caller.
    pub fn find_into(
        &mut self,
        sets: Sets<'_, D, T>,
        mut pairs: List<sap_pair>,
    ) -> Result<(), Failure> {
        let receive = |chunk: &[[u32; 2]]| {
            pairs.extend(as_pairs(chunk));
            ControlFlow::<()>::Continue(())
        };
        // It never breaks.
        let _ = search(&mut self.finder, sets).for_each_chunk(receive)?;
        pairs.end()
    }

    /// How many pairs there are.
    pub fn count(&mut self, sets: Sets<'_, D, T>) -> Result<u64, Failure> {
        let Self { finder, threads } = self;
        Ok(threads.run(|| search(finder, sets).count())?)
    }

    /// Calls back with chunks of pairs.
    ///
    /// # Safety The callback may be called with this context.
    pub unsafe fn each(
        &mut self,
        sets: Sets<'_, D, T>,
        callback: sap_pairs_callback,
        context: *mut c_void,
    ) -> Result<(), Failure> {
        let callback = callback.ok_or(Failure::Argument { name: "callback", fault: "is NULL" })?;
        let receive = |chunk: &[[u32; 2]]| {
            // SAFETY: as promised above; `sap_pair` is two `u32`.
            if unsafe { callback(context, chunk.as_ptr().cast(), chunk.len()) } {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        };
        // To stop is no error.
        let _ = search(&mut self.finder, sets).for_each_chunk(receive)?;
        Ok(())
    }
}

fn search<'f, 'b, const D: usize, T: Scalar>(
    finder: &'f mut PairFinder<D, T>,
    Sets { boxes, others }: Sets<'b, D, T>,
) -> Search<'f, 'b, D, T> {
    let search = finder.search(boxes);
    match others {
        None => search,
        Some(others) => search.against(others),
    }
}

fn as_pairs(pairs: &[[u32; 2]]) -> &[sap_pair] {
    // SAFETY: a `sap_pair` is laid out as C does, two `u32` one after the other, as `[u32; 2]` is.
    unsafe { std::slice::from_raw_parts(pairs.as_ptr().cast(), pairs.len()) }
}
