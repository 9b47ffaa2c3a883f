//! The static index, behind a trait.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::ControlFlow;

use sweep_and_prune::{
    Aabb, Cast, Error, Hit, Index, IndexInfo, Lists, Neighbor, Scalar, SearchBuffer,
};

use crate::Kind;
use crate::rows::{Coordinates, Rows, aabb, point};

/// A static index of any kind of box. Coordinates of few boxes and points go in as `f64`, and are rounded if
/// the index is of single precision.
pub trait AnyIndex: Send + Sync {
    /// How many boxes it holds.
    fn len(&self) -> usize;

    /// Whether it holds no box.
    fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Its bytes: see [`Index::as_bytes`].
    fn bytes(&self) -> &[u8];

    /// The boxes that overlap an area, of `2 * D` numbers; at most `limit`, which may be any of them.
    ///
    /// # Errors
    /// As [`Index::search`].
    fn search<'b>(
        &self,
        area: &[f64],
        limit: usize,
        found: &'b mut Found,
    ) -> Result<&'b [u32], Error>;

    /// The boxes that overlap each of some areas, on at most so many threads.
    ///
    /// # Errors
    /// As [`Index::search_many`].
    fn search_many(&self, areas: Coordinates<'_>, threads: usize) -> Result<Lists<u32>, Error>;

    /// The `k` boxes nearest to each point, of `D` numbers.
    ///
    /// # Errors
    /// As [`Index::neighbors_many`].
    fn neighbors(
        &self,
        points: &[f64],
        k: usize,
        max_distance: f64,
    ) -> Result<Lists<Neighbor<u32>>, Error>;

    /// What a ray hits: all of it, or the first. Its origin and its direction have `D` numbers each.
    ///
    /// # Errors
    /// As [`Index::cast_all`].
    fn ray(&self, numbers: &[f64], limit: f64, is_all: bool) -> Result<Vec<Hit<u32>>, Error>;

    /// What a line segment meets. Its ends have `D` numbers each.
    ///
    /// # Errors
    /// As [`Index::segment`].
    fn segment(&self, numbers: &[f64]) -> Result<Vec<Hit<u32>>, Error>;
}

/// The memory of searches.
#[derive(Debug, Default)]
pub struct Found {
    buffer: SearchBuffer,
    limited: Vec<u32>,
}

/// Boxes of which an index is built. The binding writes them to its rows.
pub trait AnyIndexBuilder {
    /// Where to write so many rows; `None` if there is no memory for them.
    fn rows(&mut self, count: usize) -> Option<*mut u8>;

    /// Builds the index of the first rows.
    ///
    /// # Errors
    /// As [`Index::new`].
    fn build(&mut self, count: usize) -> Result<Box<dyn AnyIndex>, Error>;
}

/// The builder for one kind of box.
pub struct TypedIndexBuilder<const D: usize, T>(Rows<D, T>);

impl<const D: usize, T: Scalar> TypedIndexBuilder<D, T> {
    /// A builder without rows.
    pub const fn new() -> Self {
        Self(Rows::new())
    }
}

impl<const D: usize, T: Scalar> Default for TypedIndexBuilder<D, T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const D: usize, T: Scalar> AnyIndexBuilder for TypedIndexBuilder<D, T> {
    fn rows(&mut self, count: usize) -> Option<*mut u8> {
        self.0.reserve(count)
    }

    fn build(&mut self, count: usize) -> Result<Box<dyn AnyIndex>, Error> {
        Ok(Box::new(Index::new(self.0.first(count))?))
    }
}

/// An index from the bytes of one.
fn from_bytes<const D: usize, T: Scalar, B: AsRef<[u8]> + Send + Sync + 'static>(
    bytes: B,
) -> Result<Box<dyn AnyIndex>, Error> {
    Ok(Box::new(Index::<D, T, B>::from_bytes(bytes)?))
}

impl<const D: usize, T: Scalar, B: AsRef<[u8]> + Send + Sync> AnyIndex for Index<D, T, B> {
    fn len(&self) -> usize {
        Index::len(self)
    }

    fn bytes(&self) -> &[u8] {
        self.as_bytes()
    }

    fn search<'b>(
        &self,
        area: &[f64],
        limit: usize,
        found: &'b mut Found,
    ) -> Result<&'b [u32], Error> {
        let area: Aabb<D, T> = aabb(area);
        if limit >= self.len() {
            return self.search_into(&area, &mut found.buffer);
        }
        let limited = &mut found.limited;
        limited.clear();
        limited.try_reserve(limit).map_err(|_| Error::OutOfMemory)?;
        let _ = self.visit(&area, |index| {
            if limit > 0 {
                limited.push(index);
            }
            if limited.len() < limit { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        })?;
        Ok(limited)
    }

    fn search_many(&self, areas: Coordinates<'_>, threads: usize) -> Result<Lists<u32>, Error> {
        let mut rows = Rows::<D, T>::new();
        let count = rows.write(areas)?;
        let index = Index::<D, T, &[u8]>::from_bytes(self.as_bytes())?;
        #[cfg(feature = "parallel")]
        let index = index.threads(threads);
        #[cfg(not(feature = "parallel"))]
        let _ = threads;
        index.search_many(rows.first(count))
    }

    fn neighbors(
        &self,
        points: &[f64],
        k: usize,
        max_distance: f64,
    ) -> Result<Lists<Neighbor<u32>>, Error> {
        let points: Vec<[T; D]> = points.chunks_exact(D).map(point).collect();
        self.neighbors_many(&points, k, max_distance)
    }

    fn ray(&self, numbers: &[f64], limit: f64, is_all: bool) -> Result<Vec<Hit<u32>>, Error> {
        let cast = Cast::ray(point(numbers), point(&numbers[D..]), T::from_f64(limit));
        if is_all { self.cast_all(&cast) } else { Ok(self.cast(&cast)?.into_iter().collect()) }
    }

    fn segment(&self, numbers: &[f64]) -> Result<Vec<Hit<u32>>, Error> {
        Index::segment(self, point(numbers), point(&numbers[D..]))
    }
}

impl Kind {
    /// The type of the boxes in an index. The rest of the bytes may still be missing.
    ///
    /// # Errors
    /// [`Error::InvalidIndex`] if the bytes do not begin as those of an index do.
    #[inline]
    pub fn of_index(bytes: &[u8]) -> Result<Self, Error> {
        let IndexInfo { dimensions, scalar_bytes, .. } = IndexInfo::read(bytes)?;
        Ok(Self { dimensions, is_double: scalar_bytes == 8 })
    }

    /// A builder of an index; `None` unless there are 1 to 3 dimensions.
    // Inline as `pair_finder`.
    #[inline]
    pub fn index_builder(self) -> Option<Box<dyn AnyIndexBuilder + Send>> {
        Some(match (self.dimensions, self.is_double) {
            (1, false) => Box::new(TypedIndexBuilder::<1, f32>::new()),
            (2, false) => Box::new(TypedIndexBuilder::<2, f32>::new()),
            (3, false) => Box::new(TypedIndexBuilder::<3, f32>::new()),
            (1, true) => Box::new(TypedIndexBuilder::<1, f64>::new()),
            (2, true) => Box::new(TypedIndexBuilder::<2, f64>::new()),
            (3, true) => Box::new(TypedIndexBuilder::<3, f64>::new()),
            _ => return None,
        })
    }

    /// An index of this kind from its bytes; `None` unless there are 1 to 3 dimensions.
    ///
    /// # Errors
    /// As [`Index::from_bytes`].
    #[inline]
    pub fn index<B: AsRef<[u8]> + Send + Sync + 'static>(
        self,
        bytes: B,
    ) -> Option<Result<Box<dyn AnyIndex>, Error>> {
        Some(match (self.dimensions, self.is_double) {
            (1, false) => from_bytes::<1, f32, B>(bytes),
            (2, false) => from_bytes::<2, f32, B>(bytes),
            (3, false) => from_bytes::<3, f32, B>(bytes),
            (1, true) => from_bytes::<1, f64, B>(bytes),
            (2, true) => from_bytes::<2, f64, B>(bytes),
            (3, true) => from_bytes::<3, f64, B>(bytes),
            _ => return None,
        })
    }
}
