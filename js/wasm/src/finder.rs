//! Finding pairs: a finder for any number of dimensions and either precision, chosen at run time.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Aabb, Error, PairFinder, Scalar};

use crate::status::{Code, tell, tell_error};

/// A finder with the rows that it reads, whatever their type.
trait Find {
    /// Where to write `count` boxes; `None` if there is no memory for them.
    fn rows(&mut self, count: usize) -> Option<*mut u8>;

    /// The pairs of the first `count` boxes written.
    fn find(&mut self, count: usize) -> Result<&[[u32; 2]], Error>;
}

struct Rows<const D: usize, T: Scalar> {
    boxes: Vec<Aabb<D, T>>,
    finder: PairFinder<D, T>,
}

impl<const D: usize, T: Scalar> Rows<D, T> {
    fn boxed() -> Box<dyn Find> {
        Box::new(Self { boxes: Vec::new(), finder: PairFinder::new() })
    }
}

impl<const D: usize, T: Scalar> Find for Rows<D, T> {
    fn rows(&mut self, count: usize) -> Option<*mut u8> {
        if let Some(more) = count.checked_sub(self.boxes.len()) {
            self.boxes.try_reserve(more).ok()?;
            self.boxes.resize(count, Aabb::new([T::default(); D], [T::default(); D]));
        }
        Some(self.boxes.as_mut_ptr().cast())
    }

    fn find(&mut self, count: usize) -> Result<&[[u32; 2]], Error> {
        let count = count.min(self.boxes.len());
        self.finder.find(&self.boxes[..count])
    }
}

/// What JavaScript holds a pointer to.
struct Finder(Box<dyn Find>);

/// A new finder, to be freed by [`finder_free`]; null if there are not that many dimensions.
#[unsafe(no_mangle)]
extern "C" fn finder_new(dimensions: u32, is_double: bool) -> Option<Box<Finder>> {
    let find = match (dimensions, is_double) {
        (1, false) => Rows::<1, f32>::boxed(),
        (2, false) => Rows::<2, f32>::boxed(),
        (3, false) => Rows::<3, f32>::boxed(),
        (1, true) => Rows::<1, f64>::boxed(),
        (2, true) => Rows::<2, f64>::boxed(),
        (3, true) => Rows::<3, f64>::boxed(),
        _ => return None,
    };
    Some(Box::new(Finder(find)))
}

/// Where to write `count` rows of boxes, valid until the next call with this finder; null if
/// there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn finder_rows(finder: Option<&mut Finder>, count: usize) -> *mut u8 {
    finder.and_then(|finder| finder.0.rows(count)).unwrap_or(core::ptr::null_mut())
}

/// Finds the pairs of the first `count` rows. Details: where they are and how many; they are
/// valid until the next call with this finder.
#[unsafe(no_mangle)]
extern "C" fn finder_find(finder: Option<&mut Finder>, count: usize) -> Code {
    let Some(finder) = finder else { return tell(Code::Internal, [0, 0]) };
    match finder.0.find(count) {
        Ok(pairs) => tell(Code::Ok, [pairs.as_ptr().addr(), pairs.len()]),
        Err(error) => tell_error(error),
    }
}

/// Frees a finder and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn finder_free(finder: Option<Box<Finder>>) {
    drop(finder);
}
