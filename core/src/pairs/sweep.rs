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
    /// Whether all axes are tested, as by brute force, or only those beside the sweep axis.
    pub all_axes: bool,
    pub task: Task<'a>,
}

impl Sweep<'_> {
    /// Sends the pairs within one set, or between two, to the sink: those of the probes from a cursor
    /// to its end, with all boxes ahead of them.
    pub fn run<const D: usize, T: Scalar, O: Sink>(
        self,
        sets: &[SortedBoxes<T>],
        mut cursor: Cursor,
        sink: &mut O,
    ) -> Result<(), Stop> {
        loop {
            let out = sink.spare()?;
            let count = self.kernel.sweep::<D, T>(
                sets,
                self.all_axes,
                self.task.pair_order,
                &mut cursor,
                out,
            );
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
