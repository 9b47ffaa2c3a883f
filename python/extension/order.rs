//! Sorts pairs by their rows.

use std::cmp::Ordering;

use numpy::ndarray::ArrayView1;
use numpy::{Element, PyArray1, PyArrayMethods};
use pyo3::exceptions::{PyIndexError, PyMemoryError};
use pyo3::prelude::*;

use crate::arrays::{Array, numbers};
use crate::run::run;

/// There are at most 2^BUCKET_BITS buckets: few enough that the cache holds the places where they are written.
const BUCKET_BITS: u32 = 10;

/// Sorts pairs of rows by the first row and then by the second one. Rows are less than 2^32, and the first ones less
/// than `rows`. The arrays are the package's own: nothing writes to them during the call.
///
/// Pairs go to buckets of neighboring first rows; a bucket fits a cache, where it is sorted by counting. The second rows
/// of each first row are sorted last. O(pairs + rows) time where each row has few partners.
///
/// The core sorts its candidates otherwise, by radix: faster where its two further arrays of pairs are kept from call to
/// call, as there. Here they would be new memory in each call, and sorting would take 1.2 to 3 times as long (30,000 to
/// 10,000,000 pairs, paired runs on a busy machine, 2026-11-26).
#[pyfunction]
pub fn in_order<'py>(
    first: &Bound<'py, PyArray1<i64>>,
    second: &Bound<'py, PyArray1<i64>>,
    rows: usize,
) -> PyResult<(Array<'py>, Array<'py>)> {
    let py = first.py();
    let (a, b) = (first.try_readonly()?, second.try_readonly()?);
    let (a, b) = (a.as_array(), b.as_array());
    if a.iter().zip(b).is_sorted() {
        return Ok((first.clone().into_any(), second.clone().into_any()));
    }
    let mut pairs = filled([0; 2], a.len().min(b.len()))?;
    let shift = (usize::BITS - rows.leading_zeros()).saturating_sub(BUCKET_BITS);
    let mut bucket_ends = filled(0, (rows >> shift) + 1)?;
    let placed =
        run(py, a.len(), 1, None, |_| to_buckets(a, b, rows, shift, &mut bucket_ends, &mut pairs))?;
    placed.ok_or_else(|| PyIndexError::new_err("a row is out of range"))?;
    let mut row_ends = filled(0, 1 << shift)?;
    let begins = [0].into_iter().chain(bucket_ends.iter().copied());
    let buckets = begins.zip(&bucket_ends).map(|(begin, &end)| begin..end);
    let mut partners = filled(0, buckets.clone().map(|bucket| bucket.len()).max().unwrap_or(0))?;
    run(py, a.len(), 1, None, |_| {
        buckets.for_each(|bucket| sort_bucket(&mut pairs[bucket], &mut row_ends, &mut partners));
    })?;
    let column = |side: usize| numbers(py, pairs.iter().map(move |pair| i64::from(pair[side])));
    Ok((column(0)?, column(1)?))
}

/// Writes the pairs bucket by bucket, and where each bucket ends. `None` if a row is out of range.
fn to_buckets(
    a: ArrayView1<'_, i64>,
    b: ArrayView1<'_, i64>,
    rows: usize,
    shift: u32,
    ends: &mut [usize],
    pairs: &mut [[u32; 2]],
) -> Option<()> {
    for &row in a {
        let row = usize::try_from(row).ok().filter(|&row| row < rows)?;
        ends[row >> shift] += 1;
    }
    to_places(ends);
    for (&row, &partner) in a.iter().zip(b) {
        let place = &mut ends[row as usize >> shift];
        *pairs.get_mut(*place)? = [row as u32, u32::try_from(partner).ok()?];
        *place += 1;
    }
    Some(())
}

/// Sorts the pairs of a bucket. `ends` is as long as a bucket has rows, and `partners` at least as long as it has pairs.
fn sort_bucket(bucket: &mut [[u32; 2]], ends: &mut [usize], partners: &mut [u32]) {
    let Some(&[some_row, _]) = bucket.first() else { return };
    let mask = ends.len() as u32 - 1; // a power of two
    let first_row = some_row & !mask;
    ends.fill(0);
    for &[row, _] in &*bucket {
        ends[(row & mask) as usize] += 1;
    }
    to_places(ends);
    for &[row, partner] in &*bucket {
        let place = &mut ends[(row & mask) as usize];
        partners[*place] = partner;
        *place += 1;
    }
    let mut begin = 0;
    for (row, &end) in (0..).zip(&*ends) {
        let partners = &mut partners[begin..end];
        partners.sort_unstable();
        for (pair, &partner) in bucket[begin..end].iter_mut().zip(&*partners) {
            *pair = [first_row | row, partner];
        }
        begin = end;
    }
}

/// Where the pairs of the `k` nearest partners of each row stand: by rows, then by distance and partner. First rows are less
/// than `rows`; distances are `f64` or `i64`, without NaN. The arrays are the package's own: nothing writes to them during
/// the call. O(pairs + rows) time where each row has few partners.
#[pyfunction]
pub fn nearest_of_rows<'py>(
    first: &Bound<'py, PyArray1<i64>>,
    second: &Bound<'py, PyArray1<i64>>,
    distances: &Bound<'py, PyAny>,
    rows: usize,
    k: usize,
) -> PyResult<Array<'py>> {
    match distances.cast::<PyArray1<f64>>() {
        Ok(distances) => nearest_by(first, second, distances, rows, k),
        Err(_) => nearest_by(first, second, distances.cast::<PyArray1<i64>>()?, rows, k),
    }
}

fn nearest_by<'py, T: Element + Copy + PartialOrd + Sync>(
    first: &Bound<'py, PyArray1<i64>>,
    second: &Bound<'py, PyArray1<i64>>,
    distances: &Bound<'py, PyArray1<T>>,
    rows: usize,
    k: usize,
) -> PyResult<Array<'py>> {
    let py = first.py();
    let (first, second) = (first.try_readonly()?, second.try_readonly()?);
    let distances = distances.try_readonly()?;
    let (first, second, distances) = (first.as_array(), second.as_array(), distances.as_slice()?);
    let count = first.len().min(second.len()).min(distances.len());
    let mut places = filled(0, count)?;
    let mut ends = filled(0, rows)?;
    let kept = run(py, count, 1, None, |_| {
        by_rows(first, &mut places, &mut ends)?;
        let compare = |&a: &usize, &b: &usize| {
            let by_distance = distances[a].partial_cmp(&distances[b]).unwrap_or(Ordering::Equal);
            by_distance.then_with(|| second[a].cmp(&second[b]))
        };
        let (mut begin, mut kept) = (0, 0);
        for &end in &ends {
            places[begin..end].sort_unstable_by(compare);
            let last = end.min(begin.saturating_add(k));
            places.copy_within(begin..last, kept);
            kept += last - begin;
            begin = end;
        }
        Some(kept)
    })?;
    places.truncate(kept.ok_or_else(|| PyIndexError::new_err("a row is out of range"))?);
    numbers(py, places.into_iter().map(|place| place as i64))
}

/// Writes where the pairs of each row stand, and where those of each row end. `None` if a row is out of range.
fn by_rows(first: ArrayView1<'_, i64>, places: &mut [usize], ends: &mut [usize]) -> Option<()> {
    for &row in first.iter().take(places.len()) {
        *ends.get_mut(usize::try_from(row).ok()?)? += 1;
    }
    to_places(ends);
    for (place, &row) in first.iter().take(places.len()).enumerate() {
        let end = &mut ends[row as usize];
        places[*end] = place;
        *end += 1;
    }
    Some(())
}

/// Turns counts into the places where each begins. When all have been placed, these are where each ends.
fn to_places(counts: &mut [usize]) {
    let mut begin = 0;
    for count in counts {
        begin += std::mem::replace(count, begin);
    }
}

fn filled<T: Clone>(value: T, count: usize) -> PyResult<Vec<T>> {
    let mut memory = Vec::new();
    let reserved = memory.try_reserve_exact(count);
    reserved.map_err(|_| PyMemoryError::new_err("no memory to sort the pairs"))?;
    memory.resize(count, value);
    Ok(memory)
}
