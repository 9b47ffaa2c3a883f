//! Stage 3: the sweep. The kernels do the work; here their output is handed on as it fills up.

use super::kernel::{Arrange, Column, Cursor, Kernel};
use super::search::Stop;
use super::sink::Sink;
use super::watch::Watch;
use crate::Scalar;

/// How to sweep.
#[derive(Clone, Copy)]
pub(super) struct Sweep<'a> {
    pub kernel: Kernel,
    /// How many axes are tested beside the sweep axis.
    pub others: usize,
    pub arrange: Arrange,
    pub watch: Option<&'a Watch<'a>>,
}

impl Sweep<'_> {
    /// Sends the pairs within the one column, or between the two, to the sink.
    pub fn run<T: Scalar, O: Sink>(self, columns: &[Column<T>], sink: &mut O) -> Result<(), Stop> {
        self.stretch(columns, Cursor::default(), sink)
    }

    /// Sends those of a stretch of the boxes with all ahead of them, from a cursor to its end.
    pub fn stretch<T: Scalar, O: Sink>(
        self,
        columns: &[Column<T>],
        mut cursor: Cursor,
        sink: &mut O,
    ) -> Result<(), Stop> {
        loop {
            let room = sink.room()?;
            let count = if let [first, second] = columns {
                self.kernel.between([first, second], self.others, self.arrange, &mut cursor, room)
            } else {
                self.kernel.within(&columns[0], self.others, &mut cursor, room)
            };
            sink.take(count)?;
            if cursor.done {
                return Ok(());
            }
            if self.watch.is_some_and(|watch| watch.look().is_break()) {
                return Err(Stop::Enough);
            }
        }
    }
}

/// About how many candidates a sweep would test, from `probes` of its boxes.
pub(super) fn candidates<T: Scalar>(columns: &[Column<T>], probes: u64) -> u64 {
    let last = &columns[columns.len() - 1];
    let one_way = |column: &Column<T>, against: &Column<T>| {
        let left = &against.left[..against.len()];
        let len = column.len() as u64; // `usize` has 32 bits in WebAssembly
        let ahead: u64 = (0..probes)
            .map(|probe| {
                let i = ((2 * probe + 1) * len / (2 * probes)) as usize;
                let end = left.partition_point(|&left| left <= column.right[i]);
                (end - left.partition_point(|&left| left < column.left[i])) as u64
            })
            .sum();
        ahead * len / probes
    };
    match columns {
        [first, _] => one_way(first, last) + one_way(last, first),
        _ => one_way(last, last),
    }
}
