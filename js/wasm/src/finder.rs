//! Finding pairs: a finder of either precision, chosen at run time.
//!
//! Each type of box costs nine kilobytes to download, so there are three: single precision in the
//! plane and in space, double precision in space. Fewer dimensions are boxes that are flat on the
//! others; JavaScript writes them so.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::ControlFlow::{self, Break, Continue};

use sweep_and_prune::{Aabb, Error, PairFinder, Scalar};

use crate::status::{Code, tell, tell_error};

/// What becomes of the pairs; `js/src/pair-finder.ts` has the same list.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Use {
    Store,
    Count,
    Stream,
}

/// Stands for the count of the second set where there is only one.
const NO_SET: usize = usize::MAX;

/// So many pairs, and up to as many more, are handed on together.
const MANY: usize = 4096;

/// Takes pairs. It is the same for every use, so that the search, which is compiled for what takes
/// its pairs, is compiled once.
struct Taker {
    purpose: Use,
    buffer: Vec<[u32; 2]>,
    count: u64,
}

impl Taker {
    #[inline]
    fn take(&mut self, pairs: &[[u32; 2]]) -> ControlFlow<()> {
        self.count += pairs.len() as u64;
        if self.purpose != Use::Count {
            self.buffer.extend_from_slice(pairs);
        }
        if self.purpose == Use::Stream && self.buffer.len() >= MANY {
            return self.flush();
        }
        Continue(())
    }

    fn start(&mut self, purpose: Use) {
        (self.purpose, self.count) = (purpose, 0);
        self.buffer.clear();
    }

    /// Hands on what is in the buffer.
    fn flush(&mut self) -> ControlFlow<()> {
        let goes_on = hand_on(&self.buffer);
        self.buffer.clear();
        if goes_on { Continue(()) } else { Break(()) }
    }
}

#[cfg(target_arch = "wasm32")]
fn hand_on(pairs: &[[u32; 2]]) -> bool {
    crate::runtime::each(pairs.as_ptr(), pairs.len())
}

#[cfg(not(target_arch = "wasm32"))]
fn hand_on(_: &[[u32; 2]]) -> bool {
    true
}

/// A finder with the rows that it reads, whatever their type.
trait Find {
    /// Where to write `count` boxes of a set; `None` if there is no memory for them.
    fn rows(&mut self, set: usize, count: usize) -> Option<*mut u8>;

    /// Finds the pairs of the first boxes of one set, or of two.
    fn find(&mut self, counts: [usize; 2], taker: &mut Taker) -> Result<(), Error>;
}

struct Rows<const D: usize, T: Scalar> {
    sets: [Vec<Aabb<D, T>>; 2],
    finder: PairFinder<D, T>,
}

impl<const D: usize, T: Scalar> Rows<D, T> {
    fn boxed() -> Box<dyn Find> {
        Box::new(Self { sets: [Vec::new(), Vec::new()], finder: PairFinder::new() })
    }
}

impl<const D: usize, T: Scalar> Find for Rows<D, T> {
    fn rows(&mut self, set: usize, count: usize) -> Option<*mut u8> {
        let boxes = self.sets.get_mut(set)?;
        if let Some(more) = count.checked_sub(boxes.len()) {
            boxes.try_reserve(more).ok()?;
            boxes.resize(count, Aabb::new([T::default(); D], [T::default(); D]));
        }
        Some(boxes.as_mut_ptr().cast())
    }

    fn find(&mut self, counts: [usize; 2], taker: &mut Taker) -> Result<(), Error> {
        let [a, b] = &self.sets;
        let a = &a[..counts[0].min(a.len())];
        // One closure for both: the search is compiled for its type.
        let each = |pairs: &[[u32; 2]]| taker.take(pairs);
        if counts[1] == NO_SET {
            let _ = self.finder.for_each_slice(a, each)?;
        } else {
            let b = &b[..counts[1].min(b.len())];
            let _ = self.finder.for_each_slice_between(a, b, each)?;
        }
        Ok(())
    }
}

/// What JavaScript holds a pointer to.
struct Finder {
    find: Box<dyn Find>,
    taker: Taker,
}

/// A new finder, to be freed by [`finder_free`]; null if there is none for such boxes.
#[unsafe(no_mangle)]
extern "C" fn finder_new(dimensions: u32, is_double: bool) -> Option<Box<Finder>> {
    let find = match (dimensions, is_double) {
        (2, false) => Rows::<2, f32>::boxed(),
        (3, false) => Rows::<3, f32>::boxed(),
        (3, true) => Rows::<3, f64>::boxed(),
        _ => return None,
    };
    let taker = Taker { purpose: Use::Store, buffer: Vec::new(), count: 0 };
    Some(Box::new(Finder { find, taker }))
}

/// Where to write `count` rows of boxes of set 0 or 1, valid until the next call with this finder;
/// null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn finder_rows(finder: Option<&mut Finder>, set: usize, count: usize) -> *mut u8 {
    finder.and_then(|finder| finder.find.rows(set, count)).unwrap_or(core::ptr::null_mut())
}

/// Finds the pairs of the first `a` rows of set 0, or those between them and the first `b` of
/// set 1, if `b` is not 2^32 - 1. Details, by `purpose`:
/// 0, to store: where the pairs are and how many, valid until the next call with this finder;
/// 1, to count: how many, the low and the high word;
/// 2, to stream, through the import `each`: none.
#[unsafe(no_mangle)]
extern "C" fn finder_find(finder: Option<&mut Finder>, a: usize, b: usize, purpose: u32) -> Code {
    let Some(Finder { find, taker }) = finder else { return tell(Code::Internal, [0, 0]) };
    taker.start(match purpose {
        0 => Use::Store,
        1 => Use::Count,
        _ => Use::Stream,
    });
    if let Err(error) = find.find([a, b], taker) {
        return tell_error(error);
    }
    match taker.purpose {
        Use::Store => tell(Code::Ok, [taker.buffer.as_ptr().addr(), taker.buffer.len()]),
        Use::Count => tell(Code::Ok, [taker.count as usize, (taker.count >> 32) as usize]),
        Use::Stream => {
            // Empty if the callback broke off.
            if !taker.buffer.is_empty() {
                let _ = taker.flush();
            }
            tell(Code::Ok, [0, 0])
        }
    }
}

/// Frees a finder and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn finder_free(finder: Option<Box<Finder>>) {
    drop(finder);
}
