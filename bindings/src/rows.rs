//! Rows of boxes that a binding fills and the core reads.

use alloc::vec::Vec;

use sweep_and_prune::{Aabb, Error, Scalar};

/// The coordinates of boxes, one box after another: min corner, max corner.
#[derive(Clone, Copy, Debug)]
pub enum Coordinates<'a> {
    /// In single precision.
    Single(&'a [f32]),
    /// In double precision. An object of single precision rounds them.
    Double(&'a [f64]),
}

/// Boxes that are written again for each call. The memory is kept and only grows.
pub(crate) struct Rows<const D: usize, T>(Vec<Aabb<D, T>>);

impl<const D: usize, T: Scalar> Rows<D, T> {
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Where to write `count` boxes; `None` if there is no memory for them.
    pub fn reserve(&mut self, count: usize) -> Option<*mut u8> {
        if let Some(more) = count.checked_sub(self.0.len()) {
            self.0.try_reserve(more).ok()?;
            self.0.resize(count, Aabb::new([T::default(); D], [T::default(); D]));
        }
        Some(self.0.as_mut_ptr().cast())
    }

    /// Copies boxes to the first rows, and returns how many there are.
    pub fn write(&mut self, coordinates: Coordinates<'_>) -> Result<usize, Error> {
        match coordinates {
            Coordinates::Single(numbers) => self.copy(numbers),
            Coordinates::Double(numbers) => self.copy(numbers),
        }
    }

    fn copy<S: Copy + Into<f64>>(&mut self, numbers: &[S]) -> Result<usize, Error> {
        let count = numbers.len() / (2 * D);
        self.reserve(count).ok_or(Error::OutOfMemory)?;
        for (row, corners) in self.0.iter_mut().zip(numbers.chunks_exact(2 * D)) {
            *row = aabb(corners);
        }
        Ok(count)
    }

    /// The first `count` rows, or all if there are fewer.
    pub fn first(&self, count: usize) -> &[Aabb<D, T>] {
        &self.0[..count.min(self.0.len())]
    }
}

/// A point from its first `D` numbers.
pub(crate) fn point<const D: usize, T: Scalar, S: Copy + Into<f64>>(numbers: &[S]) -> [T; D] {
    core::array::from_fn(|axis| T::from_f64(numbers[axis].into()))
}

/// A box from its first `2 * D` numbers.
pub(crate) fn aabb<const D: usize, T: Scalar, S: Copy + Into<f64>>(numbers: &[S]) -> Aabb<D, T> {
    Aabb::new(point(numbers), point(&numbers[D..]))
}
