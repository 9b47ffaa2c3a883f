//! Fills the columns of a grid on several threads.
//!
//! Each thread lists and counts a chunk of the boxes. The counts of all threads give each thread its places in every
//! column, so that all of them write to one array, in the order in which one thread would.

use alloc::vec::Vec;
use core::iter::once;

use super::threads::for_each_on_threads;
use crate::Scalar;
use crate::pairs::columns::{Columns, most_records, write};
use crate::pairs::grid::Grid;
use crate::pairs::placements::Placements;
use crate::pairs::source::Source;
use crate::pairs::task::Stop;

/// Fills columns as [`Columns::fill`] does, on as many threads as there are `placements`, at least one.
///
/// # Errors
/// A [`Stop`].
pub fn fill_on_threads<const D: usize, T: Scalar, S: Source<D, T>>(
    columns: &mut Columns<D, T>,
    source: &[S],
    grid: &Grid<T>,
    other: Option<&Columns<D, T>>,
    placements: &mut [&mut Placements],
) -> Result<(), Stop> {
    let (chunks, boxes) = (placements.len(), source.len());
    let limit = most_records(boxes);
    columns.chunk_ends.resize_with(chunks - 1, Vec::new);
    let all_ends = columns.chunk_ends.iter_mut().chain(once(&mut columns.ends));
    let mut counted: Vec<_> = placements.iter().map(|_| None).collect();
    let chunk = placements.iter_mut().zip(all_ends).zip(&mut counted).enumerate();
    for_each_on_threads(chunk, |(chunk, ((placements, ends), counted))| {
        let range = boxes * chunk / chunks..boxes * (chunk + 1) / chunks;
        *counted = Some(placements.list(source, range, grid, limit).and_then(|len| {
            if let Some(other) = other {
                placements.retain(|column| !other.column(column).is_empty());
            }
            Ok((len, placements.count(ends)?))
        }));
    });
    let stops = counted.iter().flatten().filter_map(|counted| counted.as_ref().err());
    if let Some(&stop) = stops.min() {
        return Err(stop);
    }
    let counted = counted.into_iter().flatten().flatten();
    let (lens, mut counted): (Vec<u64>, Vec<_>) = counted.unzip();
    if lens.into_iter().sum::<u64>() > limit {
        return Err(Stop::TooMany);
    }
    let slots = columns.records.slots(&mut counted)?;
    for_each_on_threads(slots, |slots| write(source, slots));
    Ok(())
}
