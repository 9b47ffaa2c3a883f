//! The sweep. The kernels do the work; here their output is handed on as it fills up.

use core::ops::ControlFlow;

use super::control::{Progress, Stop};
use super::kernel::{Cursor, Kernel, PairOrder, SortedBoxes};
use super::sink::Sink;
use crate::Scalar;

/// How to sweep.
#[derive(Clone, Copy)]
pub(super) struct Sweep<'a> {
    pub kernel: Kernel,
    /// How many axes are tested beside the sweep axis.
    pub others: usize,
    pub pair_order: PairOrder,
    pub progress: Option<&'a Progress<'a>>,
}

impl Sweep<'_> {
    /// Sends the pairs within one set, or between two, to the sink: those of the probes from a cursor
    /// to its end, with all boxes ahead of them.
    pub fn run<T: Scalar, O: Sink>(
        self,
        sets: &[SortedBoxes<T>],
        mut cursor: Cursor,
        sink: &mut O,
    ) -> Result<(), Stop> {
        loop {
            let out = sink.spare()?;
            let count = if let [a, b] = sets {
                self.kernel.between([a, b], self.others, self.pair_order, &mut cursor, out)
            } else {
                self.kernel.within(&sets[0], self.others, &mut cursor, out)
            };
            sink.take(count)?;
            if cursor.is_done() {
                return Ok(());
            }
            if self.progress.map(Progress::report) == Some(ControlFlow::Break(())) {
                return Err(Stop::Cancelled);
            }
        }
    }
}

/// About how many candidates a sweep would test, from so many probes.
pub(super) fn candidates<T: Scalar>(sets: &[SortedBoxes<T>], probes: u64) -> u64 {
    let last = &sets[sets.len() - 1];
    let one_way = |boxes: &SortedBoxes<T>, against: &SortedBoxes<T>| {
        let left = &against.left[..against.len()];
        let len = boxes.len() as u64; // `usize` has 32 bits in WebAssembly
        let ahead: u64 = (0..probes)
            .map(|probe| {
                let i = ((2 * probe + 1) * len / (2 * probes)) as usize;
                let end = left.partition_point(|&left| left <= boxes.right[i]);
                (end - left.partition_point(|&left| left < boxes.left[i])) as u64
            })
            .sum();
        ahead * len / probes
    };
    match sets {
        [first, _] => one_way(first, last) + one_way(last, first),
        _ => one_way(last, last),
    }
}
