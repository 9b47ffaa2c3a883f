//! Pairs of boxes on a line that come sorted by left edge, as files of intervals mostly do. Nothing is copied or sorted.
//!
//! ```text
//! between two sets:
//!     for each box of the smaller set
//!         first = the first box of the larger set, from that of the box before on, that does not end before it
//!         begun = the first box of the larger set, from that of the box before on, that does not begin before it
//!         report the boxes from first up to begun that reach it
//!         report the boxes from begun on until one begins after it ends
//! within one set:
//!     for each box, report the boxes behind it until one begins after it ends
//! ```
//!
//! Only the boxes from `first` up to `begun` are tested. One long box keeps `first` where it is: then there may be too many.

use alloc::collections::TryReserveError;
use alloc::vec::Vec;
use core::ops::{ControlFlow, Range};

use super::one_by_one::OneByOne;
use super::sink::Sink;
use super::source::Source;
use super::task::{Progress, Stop, Task};
use crate::Scalar;
use crate::memory::grow;

/// The most tests for each box of both sets, in the mean. With more, boxes are sorted and swept.
const MEAN_TESTS: usize = 2;

/// Where the boxes of the larger set are that each box of the smaller one is tested against: `first` and `begun`.
#[derive(Debug, Default)]
pub(super) struct Spans {
    all: Vec<[u32; 2]>,
}

/// Sorted sets, and what pairs with what.
pub(super) struct InOrder<'a, S> {
    smaller: &'a [S],
    larger: &'a [S],
    /// For each box of the smaller set; `None` within one set.
    spans: Option<&'a [[u32; 2]]>,
    /// Whether pairs begin with the box of the larger set.
    swap: bool,
}

/// Whether boxes come sorted by left edge. Looks no further than to the first that does not.
pub(super) fn is_sorted<const D: usize, T: Scalar, S: Source<D, T>>(set: &[S]) -> bool {
    set.is_sorted_by(|a, b| a.aabb().min[0] <= b.aabb().min[0])
}

impl Spans {
    /// For one or two sets that are valid and sorted, how to search them. None if too much would be tested.
    pub fn fill<'a, const D: usize, T: Scalar, S: Source<D, T>>(
        &'a mut self,
        sets: &[&'a [S]],
    ) -> Result<Option<InOrder<'a, S>>, TryReserveError> {
        let [first, second] = match *sets {
            [first, second] => [first, second],
            _ => {
                return Ok(Some(InOrder {
                    smaller: sets[0],
                    larger: sets[0],
                    spans: None,
                    swap: false,
                }));
            }
        };
        let swap = first.len() > second.len();
        let [smaller, larger] = if swap { [second, first] } else { [first, second] };
        grow(&mut self.all, smaller.len(), [0; 2])?;
        let spans = &mut self.all[..smaller.len()];
        let (mut first, mut begun, mut tests) = (0, 0, 0);
        for (span, each) in spans.iter_mut().zip(smaller) {
            let start = each.aabb().min[0];
            while first < larger.len() && larger[first].aabb().max[0] < start {
                first += 1;
            }
            begun = begun.max(first);
            while begun < larger.len() && larger[begun].aabb().min[0] < start {
                begun += 1;
            }
            tests += begun - first;
            *span = [first as u32, begun as u32];
        }
        let is_crowded = tests > MEAN_TESTS * (smaller.len() + larger.len());
        Ok((!is_crowded).then_some(InOrder { smaller, larger, spans: Some(spans), swap }))
    }
}

impl<const D: usize, T: Scalar, S: Source<D, T>> OneByOne<D, T> for InOrder<'_, S> {
    fn len(&self) -> usize {
        self.smaller.len()
    }

    fn run<O: Sink>(&self, range: Range<usize>, task: Task<'_>, sink: &mut O) -> Result<(), Stop> {
        let Self { smaller, larger, .. } = *self;
        let (mut out, mut count) = (sink.spare()?, 0);
        for i in range {
            let aabb = smaller[i].aabb();
            let [first, begun] = match self.spans {
                Some(spans) => spans[i].map(|at| at as usize),
                None => [i + 1; 2],
            };
            let pair = |j: usize| {
                let [a, b] = [i as u32, j as u32];
                if self.swap { [b, a] } else { [a, b] }
            };
            let begin = larger[begun..].iter();
            let end = begun + begin.take_while(|other| other.aabb().min[0] <= aabb.max[0]).count();
            let mut at = first;
            while at < end {
                if out.len() == count {
                    sink.take(count)?;
                    if task.progress.map(Progress::report) == Some(ControlFlow::Break(())) {
                        return Err(Stop::Cancelled);
                    }
                    (out, count) = (sink.spare()?, 0);
                }
                let spare = out.len() - count;
                if at < begun {
                    let tested = at..begun.min(at + spare);
                    at = tested.end;
                    for j in tested {
                        out[count] = pair(j);
                        // Without a branch: which of them reach it is unpredictable.
                        count += usize::from(aabb.min[0] <= larger[j].aabb().max[0]);
                    }
                } else {
                    let found = at..end.min(at + spare);
                    at = found.end;
                    for (to, j) in out[count..].iter_mut().zip(found.clone()) {
                        *to = pair(j);
                    }
                    count += found.len();
                }
            }
        }
        sink.take(count)
    }
}

#[cfg(test)]
mod tests {
    use std::vec::Vec;

    use super::*;
    use crate::Aabb;

    #[test]
    fn a_long_box_that_all_are_tested_against_is_noticed() {
        let short = |at: usize| Aabb::<1>::new([at as f32], [at as f32]);
        let short: Vec<_> = (0..2000).map(short).collect();
        let mut larger = short.clone();
        larger.push(Aabb::new([3000.0], [4000.0]));
        let is_searched = |larger: &[Aabb<1>], smaller: &[Aabb<1>]| {
            assert!(is_sorted(larger) && is_sorted(smaller));
            Spans::default().fill(&[larger, smaller]).expect("memory").is_some()
        };
        assert!(is_searched(&larger, &short));
        larger[0].max[0] = 1.5;
        assert!(is_searched(&larger, &short));
        larger[0].max[0] = 2000.0;
        assert!(!is_searched(&larger, &short));
    }

    #[test]
    fn boxes_are_sorted_only_if_all_are() {
        let mut boxes: Vec<_> =
            (0..100).map(|at| Aabb::<1>::new([0.5 * at as f32], [1e3])).collect();
        boxes[50] = boxes[49];
        assert!(is_sorted(&boxes));
        boxes.swap(98, 99);
        assert!(!is_sorted(&boxes));
    }
}
