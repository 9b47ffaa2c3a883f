//! The sweep. The kernels do the work; here their output is handed on as it fills up.

use core::ops::ControlFlow;

use super::kernel::{Cursor, Kernel, SortedBoxes};
use super::sink::Sink;
use super::task::{Progress, Stop, Task};
use crate::Scalar;

/// How to sweep.
#[derive(Clone, Copy)]
pub(super) struct Sweep<'a> {
    pub kernel: Kernel,
    /// How many axes are tested beside the sweep axis.
    pub others: usize,
    pub task: Task<'a>,
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
            let count =
                self.kernel.sweep(sets, self.others, self.task.pair_order, &mut cursor, out);
            sink.take(count)?;
            if cursor.is_done() {
                return Ok(());
            }
            if self.task.progress.map(Progress::report) == Some(ControlFlow::Break(())) {
                return Err(Stop::Cancelled);
            }
        }
    }
}
