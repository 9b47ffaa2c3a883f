//! A static index of any kind of box.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Error, Hit, IndexFault, Neighbor};
use sweep_and_prune_bindings::{AnyIndex, AnyIndexBuilder, Coordinates, Found, Kind};

use crate::status::{Code, report, report_error};

/// How many numbers a query has at most: an area, or a point and a limit.
const NUMBERS: usize = 8;

/// What JavaScript holds a pointer to.
struct Handle {
    index: Box<dyn AnyIndex>,
    found: Found,
    /// What goes in: the numbers of a query; and out: where the values of an answer are.
    numbers: [f64; NUMBERS],
    /// The coordinates of many queries.
    rows: Vec<f64>,
    /// Answers: indices, and a value for each.
    indices: Vec<u32>,
    values: Vec<f64>,
}

fn handle(index: Box<dyn AnyIndex>) -> usize {
    let handle = Handle {
        index,
        found: Found::default(),
        numbers: [0.0; NUMBERS],
        rows: Vec::new(),
        indices: Vec::new(),
        values: Vec::new(),
    };
    Box::into_raw(Box::new(handle)).addr()
}

/// A builder, to be passed to [`index_build`] once; null if there is none for such boxes.
#[unsafe(no_mangle)]
extern "C" fn index_builder(
    dimensions: usize,
    is_double: bool,
) -> Option<Box<Box<dyn AnyIndexBuilder + Send>>> {
    Kind { dimensions, is_double }.index_builder().map(Box::new)
}

/// Where to write `count` rows of boxes; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn index_rows(
    builder: Option<&mut Box<dyn AnyIndexBuilder + Send>>,
    count: usize,
) -> *mut u8 {
    builder.and_then(|builder| builder.rows(count)).unwrap_or(core::ptr::null_mut())
}

/// Builds the index of the first rows, and frees the builder. Details: the index, to be freed by
/// [`index_free`].
#[unsafe(no_mangle)]
extern "C" fn index_build(
    builder: Option<Box<Box<dyn AnyIndexBuilder + Send>>>,
    count: usize,
) -> Code {
    let Some(mut builder) = builder else { return report(Code::Internal, [0, 0]) };
    match builder.build(count) {
        Ok(index) => report(Code::Ok, [handle(index), 0]),
        Err(error) => report_error(error),
    }
}

/// The bytes of an index, while JavaScript writes them.
struct Bytes(Vec<u8>);

/// A buffer for the bytes of an index, to be passed to [`index_from`] once. Details: it, and where to write.
#[unsafe(no_mangle)]
extern "C" fn index_bytes_in(len: usize) -> Code {
    let mut bytes = Vec::<u8>::new();
    if bytes.try_reserve_exact(len).is_err() {
        return report_error(Error::OutOfMemory);
    }
    let at = bytes.as_mut_ptr().addr();
    report(Code::Ok, [Box::into_raw(Box::new(Bytes(bytes))).addr(), at])
}

/// The index of bytes that JavaScript has written, and frees their buffer. Details: the index, to be freed by
/// [`index_free`].
///
/// # Safety
/// JavaScript has written `len` bytes to the buffer, which was made for so many.
#[unsafe(no_mangle)]
unsafe extern "C" fn index_from(bytes: Option<Box<Bytes>>, len: usize) -> Code {
    let Some(bytes) = bytes else { return report(Code::Internal, [0, 0]) };
    let Bytes(mut bytes) = *bytes;
    if bytes.capacity() < len {
        return report(Code::Internal, [0, 0]);
    }
    // SAFETY: the caller's promise.
    unsafe { bytes.set_len(len) };
    let foreign = Error::InvalidIndex(IndexFault::Foreign);
    let index = Kind::of_index(&bytes).and_then(|kind| kind.index(bytes).ok_or(foreign)?);
    match index {
        Ok(index) => report(Code::Ok, [handle(index), 0]),
        Err(error) => report_error(error),
    }
}

/// Frees an index and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn index_free(handle: Option<Box<Handle>>) {
    drop(handle);
}

/// How many boxes there are. Details: where the bytes are, and how many.
#[unsafe(no_mangle)]
extern "C" fn index_data(handle: Option<&Handle>) -> usize {
    let Some(Handle { index, .. }) = handle else { return 0 };
    report(Code::Ok, [index.bytes().as_ptr().addr(), index.bytes().len()]);
    index.len()
}

/// What the index is: dimensions, plus 8 if it is of double precision.
#[unsafe(no_mangle)]
extern "C" fn index_kind(handle: Option<&Handle>) -> usize {
    let kind = handle.and_then(|handle| Kind::of_index(handle.index.bytes()).ok());
    kind.map_or(0, |kind| kind.dimensions + 8 * usize::from(kind.is_double))
}

/// Where the numbers of a query are written.
#[unsafe(no_mangle)]
extern "C" fn index_numbers(handle: Option<&mut Handle>) -> *mut f64 {
    handle.map_or(core::ptr::null_mut(), |handle| handle.numbers.as_mut_ptr())
}

/// Where to write `count` numbers of many queries; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn index_query_rows(handle: Option<&mut Handle>, count: usize) -> *mut f64 {
    let Some(Handle { rows, .. }) = handle else { return core::ptr::null_mut() };
    rows.clear();
    if rows.try_reserve(count).is_err() {
        return core::ptr::null_mut();
    }
    rows.resize(count, 0.0);
    rows.as_mut_ptr()
}

/// Finds what overlaps the area in the numbers. Details: where the indices are, and how many.
#[unsafe(no_mangle)]
extern "C" fn index_search(handle: Option<&mut Handle>, limit: usize) -> Code {
    let Some(Handle { index, found, numbers, .. }) = handle else {
        return report(Code::Internal, [0, 0]);
    };
    match index.search(numbers, limit, found) {
        Ok(found) => report(Code::Ok, [found.as_ptr().addr(), found.len()]),
        Err(error) => report_error(error),
    }
}

/// Finds what overlaps each area in the rows. Details: where the pairs of a query and an index are, as one
/// word after another, and how many words.
#[unsafe(no_mangle)]
extern "C" fn index_search_many(handle: Option<&mut Handle>) -> Code {
    let Some(Handle { index, rows, indices, .. }) = handle else {
        return report(Code::Internal, [0, 0]);
    };
    let lists = match index.search_many(Coordinates::Double(rows), 1) {
        Ok(lists) => lists,
        Err(error) => return report_error(error),
    };
    indices.clear();
    if indices.try_reserve(2 * lists.values().len()).is_err() {
        return report_error(Error::OutOfMemory);
    }
    for (query, list) in lists.iter().enumerate() {
        for &found in list {
            indices.extend_from_slice(&[query as u32, found]);
        }
    }
    report(Code::Ok, [indices.as_ptr().addr(), indices.len()])
}

/// Finds the boxes nearest to the point in the numbers. Details: where the indices are, and how many; the
/// first number says where the squares of the distances are.
#[unsafe(no_mangle)]
extern "C" fn index_neighbors(
    handle: Option<&mut Handle>,
    dimensions: usize,
    k: usize,
    max_distance: f64,
) -> Code {
    let Some(handle) = handle else { return report(Code::Internal, [0, 0]) };
    let point = &handle.numbers[..dimensions.min(NUMBERS)];
    match handle.index.neighbors(point, k, max_distance) {
        Ok(lists) => {
            let answer =
                |&Neighbor { id, distance_squared, .. }: &Neighbor<u32>| (id, distance_squared);
            handle.answer(lists.values().iter().map(answer))
        }
        Err(error) => report_error(error),
    }
}

/// Finds what a ray hits, or with a negative limit a line segment; its numbers are two points, or a point and
/// a direction. Details as those of [`index_neighbors`], with the times of the hits.
#[unsafe(no_mangle)]
extern "C" fn index_cast(handle: Option<&mut Handle>, limit: f64, is_all: bool) -> Code {
    let Some(handle) = handle else { return report(Code::Internal, [0, 0]) };
    let hits = if limit < 0.0 {
        handle.index.segment(&handle.numbers)
    } else {
        handle.index.ray(&handle.numbers, limit, is_all)
    };
    match hits {
        Ok(hits) => handle.answer(hits.iter().map(|&Hit { id, t, .. }| (id, t))),
        Err(error) => report_error(error),
    }
}

impl Handle {
    fn answer(&mut self, answers: impl ExactSizeIterator<Item = (u32, f64)>) -> Code {
        let Self { indices, values, numbers, .. } = self;
        indices.clear();
        values.clear();
        let count = answers.len();
        if indices.try_reserve(count).is_err() || values.try_reserve(count).is_err() {
            return report_error(Error::OutOfMemory);
        }
        for (index, value) in answers {
            indices.push(index);
            values.push(value);
        }
        numbers[0] = values.as_ptr().addr() as f64;
        report(Code::Ok, [indices.as_ptr().addr(), count])
    }
}
