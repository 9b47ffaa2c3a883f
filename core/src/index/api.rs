//! The API of the index.

use alloc::vec::Vec;
use core::fmt;
use core::marker::PhantomData;
use core::ops::ControlFlow;

use super::build::{IndexBuffer, build};
use super::format::{IndexInfo, Layout};
use super::nearest::{FromPoint, Moving, NearestFirst, Reach, Reached};
use super::search::{Search, SearchBuffer, Visit};
use crate::geometry::{check_each, fault_in, is_finite, is_length};
use crate::lists::Lists;
use crate::pairs::Kernel;
#[cfg(feature = "parallel")]
use crate::pairs::map_on_threads;
use crate::{Aabb, Cast, Error, Hit, IndexFault, Neighbor, Scalar};

/// A static index: built once over boxes that do not move, it finds those that overlap a box, that a ray
/// hits, or that are nearest to a point.
///
/// Boxes are named by their index in the slice that it was built from. For boxes that move, use
/// [`BroadPhase`](crate::BroadPhase); for all overlapping pairs, [`find_pairs`](crate::find_pairs).
///
/// ```
/// use sweep_and_prune::{Aabb, Index};
///
/// let boxes = [
///     Aabb::new([0.0, 0.0], [2.0, 2.0]),
///     Aabb::new([5.0, 5.0], [6.0, 6.0]),
///     Aabb::new([2.0, 1.0], [3.0, 4.0]),
/// ];
/// let index = Index::new(&boxes)?;
/// let mut found = index.search(&Aabb::new([1.0, 1.0], [2.0, 2.0]))?;
/// found.sort_unstable();
/// assert_eq!(found, [0, 2]); // touching boxes overlap
/// let nearest = index.neighbors([4.0, 4.0], 1, f64::INFINITY)?;
/// assert_eq!(nearest[0].id, 2);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
///
/// # Cost
/// Building takes O(n log n) time: 40 to 100 ns a box up to a million boxes. Beside the index it takes 24 to
/// 56 bytes a box while it builds. The index itself takes 1.07 times the memory of the boxes, and 4 bytes a
/// box. A search takes O(log n + results) time on typical inputs, O(n) at most.
///
/// # Order
/// The order of the boxes that a search finds is not sorted, but it is the same on every machine. Neighbors
/// and hits are sorted by distance, and by index where they are equally far.
///
/// # Bytes
/// The index *is* its bytes: [`as_bytes`](Self::as_bytes) gives them, and
/// [`from_bytes`](Self::from_bytes) makes an index of them without reading more than the header and without a
/// copy. `B` is what holds them: an [`IndexBuffer`] if it was built here, else anything that gives the same
/// bytes each time: `&[u8]`, `Vec<u8>`, a memory-mapped file. Equal boxes give equal bytes on every machine.
///
/// ```
/// use sweep_and_prune::{Aabb, Index};
///
/// let index = Index::new(&[Aabb::new([1.0f32], [2.0]); 100])?;
/// let file = index.as_bytes().to_vec();
/// let index = Index::<1, f32, _>::from_bytes(&file[..])?;
/// assert_eq!(index.search(&Aabb::new([2.0], [3.0]))?.len(), 100);
/// # Ok::<(), sweep_and_prune::Error>(())
/// ```
#[derive(Clone)]
pub struct Index<const D: usize, T: Scalar = f32, B = IndexBuffer> {
    bytes: B,
    layout: Layout,
    kernel: Kernel,
    #[cfg(feature = "parallel")]
    threads: usize,
    scalar: PhantomData<T>,
}

impl<const D: usize, T: Scalar> Index<D, T> {
    /// Builds an index of some boxes.
    ///
    /// # Errors
    /// [`Error::InvalidBox`] with the index of the first box that is inverted or NaN,
    /// [`Error::TooManyBoxes`], or [`Error::OutOfMemory`].
    pub fn new(boxes: &[Aabb<D, T>]) -> Result<Self, Error> {
        let (layout, buffer) = build(boxes)?;
        Ok(Self::of(layout, buffer))
    }

    /// Copies the bytes of an index to memory that is aligned as searches like it best.
    ///
    /// # Errors
    /// As [`from_bytes`](Self::from_bytes), and [`Error::OutOfMemory`].
    pub fn copy_from_bytes(bytes: &[u8]) -> Result<Self, Error> {
        let layout = Index::<D, T, &[u8]>::from_bytes(bytes)?.layout;
        let buffer = IndexBuffer::copy_of(bytes).map_err(|_| Error::OutOfMemory)?;
        Ok(Self::of(layout, buffer))
    }
}

impl<const D: usize, T: Scalar, B: AsRef<[u8]>> Index<D, T, B> {
    /// An index from the [bytes](Self::as_bytes) of one, without a copy. It reads the header only, so it takes
    /// the same short time for any number of boxes.
    ///
    /// The bytes may have any alignment. If they begin at a multiple of 64, as those of files that are mapped
    /// to memory do, searches take least time; [`copy_from_bytes`](Index::copy_from_bytes) copies others there.
    ///
    /// Any bytes are safe: there is no checksum, so an index of damaged bytes may find wrong boxes. But it
    /// finds no index beyond its [`len`](Self::len), does not panic, and searches always end.
    ///
    /// # Errors
    /// [`Error::InvalidIndex`] if the bytes do not begin as those of an index do, or are of another version,
    /// of other dimensions, of another coordinate type, or of another length than its boxes have.
    pub fn from_bytes(bytes: B) -> Result<Self, Error> {
        let found = bytes.as_ref().len();
        let IndexInfo { dimensions, scalar_bytes, len } = IndexInfo::read(bytes.as_ref())?;
        if (dimensions, scalar_bytes) != (D, T::BYTES) {
            return Err(Error::InvalidIndex(IndexFault::OtherIndex { dimensions, scalar_bytes }));
        }
        let layout = usize::try_from(len).ok().and_then(Layout::new::<D, T>);
        let layout = layout.filter(|layout| layout.bytes == found);
        let wrong = Error::InvalidIndex(IndexFault::Length { found, boxes: len });
        Ok(Self::of(layout.ok_or(wrong)?, bytes))
    }

    fn of(layout: Layout, bytes: B) -> Self {
        Self {
            bytes,
            layout,
            kernel: Kernel::best(),
            #[cfg(feature = "parallel")]
            threads: 1,
            scalar: PhantomData,
        }
    }

    /// Uses this kernel, for tests and comparisons. The results are the same. Without `std` there is no
    /// choice: only the best kernel is compiled.
    #[cfg(feature = "std")]
    #[must_use]
    pub fn kernel(self, kernel: Kernel) -> Self {
        Self { kernel, ..self }
    }

    /// Answers many queries at once on this many threads of rayon's current pool; 0 counts as 1. The results
    /// are the same.
    #[cfg(feature = "parallel")]
    #[must_use]
    pub fn threads(self, threads: usize) -> Self {
        Self { threads: threads.max(1), ..self }
    }

    /// The bytes of the index, to store or send: the same on every machine.
    #[inline]
    pub fn as_bytes(&self) -> &[u8] {
        self.bytes.as_ref()
    }

    /// How many boxes it holds.
    #[inline]
    pub fn len(&self) -> usize {
        self.layout.count
    }

    /// Whether it holds no box.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The boxes that overlap `area`, in no particular order.
    ///
    /// # Errors
    /// [`Error::InvalidBox`] if the area is, or [`Error::OutOfMemory`].
    pub fn search(&self, area: &Aabb<D, T>) -> Result<Vec<u32>, Error> {
        let mut buffer = SearchBuffer::new();
        self.search_into(area, &mut buffer)?;
        Ok(buffer.into_found())
    }

    /// The boxes of [`search`](Self::search), in a buffer that is kept from search to search, so that a steady
    /// state allocates nothing.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, Index, SearchBuffer};
    ///
    /// let index = Index::new(&[Aabb::new([0.0f64], [9.0]), Aabb::new([5.0], [6.0])])?;
    /// let mut buffer = SearchBuffer::new();
    /// for (at, count) in [(1.0, 1), (5.5, 2), (10.0, 0)] {
    ///     assert_eq!(index.search_into(&Aabb::new([at], [at]), &mut buffer)?.len(), count);
    /// }
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`search`](Self::search).
    #[inline]
    pub fn search_into<'b>(
        &self,
        area: &Aabb<D, T>,
        buffer: &'b mut SearchBuffer,
    ) -> Result<&'b [u32], Error> {
        area.check(0)?;
        buffer.clear();
        self.view().add(area, buffer)?;
        Ok(buffer.found())
    }

    /// Shows the boxes that overlap `area` to `visit`, until it breaks: to filter them, or to stop after some
    /// of them. The order is not that of [`search`](Self::search), which takes less time to find many boxes.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, Index};
    ///
    /// let index = Index::new(&[Aabb::new([0.0], [1.0]); 1000])?;
    /// let any = index.visit(&Aabb::new([0.5], [0.5]), ControlFlow::Break)?;
    /// assert!(any.is_break());
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidBox`] if the area is.
    pub fn visit<R>(
        &self,
        area: &Aabb<D, T>,
        visit: impl FnMut(u32) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        area.check(0)?;
        let View { layout, bytes, .. } = self.view();
        Ok(self.kernel.run(Visit { layout, bytes, area: *area, visit }))
    }

    /// The boxes that overlap each of many areas: a list for each, in the order of [`search`](Self::search).
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, Index};
    ///
    /// let index = Index::new(&[Aabb::new([0.0], [9.0]), Aabb::new([5.0], [6.0])])?;
    /// let lists = index.search_many(&[Aabb::new([1.0], [2.0]), Aabb::new([6.0], [9.0])])?;
    /// assert_eq!((&lists[0], lists[1].len()), (&[0][..], 2));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidBox`] with the index of the first invalid area, or [`Error::OutOfMemory`].
    pub fn search_many(&self, areas: &[Aabb<D, T>]) -> Result<Lists<u32>, Error> {
        crate::validate(areas)?;
        self.many(areas, |view, areas| {
            let mut buffer = SearchBuffer::new();
            let mut ends = crate::memory::reserved(areas.len()).map_err(|_| Error::OutOfMemory)?;
            for area in areas {
                view.add(area, &mut buffer)?;
                ends.push(buffer.count());
            }
            Ok(Lists { ends, values: buffer.into_found() })
        })
    }

    /// The `k` boxes nearest to a point, or all if there are fewer, that are at most `max_distance` away;
    /// sorted by distance and then by index.
    ///
    /// Distances are compared as squares in `f64`: they overflow beyond 1e154, which coordinates of type `f32`
    /// cannot reach.
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if the point is not finite, or the distance is negative or NaN; or
    /// [`Error::OutOfMemory`].
    pub fn neighbors(
        &self,
        point: [T; D],
        k: usize,
        max_distance: f64,
    ) -> Result<Vec<Neighbor<u32>>, Error> {
        Ok(self.neighbors_many(&[point], k, max_distance)?.values)
    }

    /// [`neighbors`](Self::neighbors) of each of many points.
    ///
    /// # Errors
    /// As [`neighbors`](Self::neighbors), with the index of the first bad point.
    pub fn neighbors_many(
        &self,
        points: &[[T; D]],
        k: usize,
        max_distance: f64,
    ) -> Result<Lists<Neighbor<u32>>, Error> {
        check_points(points, max_distance)?;
        self.many(points, |view, points| {
            let (mut lists, mut reached) = (Lists::new(), Reached::new());
            for &point in points {
                let start = lists.values.len();
                let keep = |neighbor| {
                    lists.values.push(neighbor);
                    if lists.values.len() - start < k {
                        ControlFlow::Continue(())
                    } else {
                        ControlFlow::Break(())
                    }
                };
                if k > 0 {
                    let _ = view.near(point, max_distance, &mut reached, keep)?;
                }
                lists.end();
            }
            Ok(lists)
        })
    }

    /// Shows boxes to `visit`, the nearest to a point first, until it breaks: to filter them, or to stop where
    /// only the caller knows.
    ///
    /// ```
    /// use std::ops::ControlFlow;
    /// use sweep_and_prune::{Aabb, Index};
    ///
    /// let index = Index::new(&[0.0, 3.0, 8.0].map(|at| Aabb::new([at], [at])))?;
    /// let nearest_odd = index.visit_neighbors([7.0], f64::INFINITY, |neighbor| {
    ///     if neighbor.id % 2 == 1 { ControlFlow::Break(neighbor) } else { ControlFlow::Continue(()) }
    /// })?;
    /// let ControlFlow::Break(neighbor) = nearest_odd else { panic!("there is one") };
    /// assert_eq!((neighbor.id, neighbor.distance_squared), (1, 16.0));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`neighbors`](Self::neighbors).
    pub fn visit_neighbors<R>(
        &self,
        point: [T; D],
        max_distance: f64,
        visit: impl FnMut(Neighbor<u32>) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        check_points(&[point], max_distance)?;
        self.view().near(point, max_distance, &mut Reached::new(), visit)
    }

    /// The box that a ray or a moving box hits first; of several at once that with the smallest index.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, Cast, Index};
    ///
    /// let index = Index::new(&[Aabb::new([5.0, -1.0], [6.0, 1.0]), Aabb::new([3.0, 1.0], [4.0, 2.0])])?;
    /// let hit = index.cast(&Cast::ray([0.0, 0.0], [1.0, 0.0], 100.0))?.unwrap();
    /// assert_eq!((hit.id, hit.t), (0, 5.0));
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if its box or direction is not finite, its box is inverted, or its limit is
    /// negative or NaN; or [`Error::OutOfMemory`].
    #[doc(alias("ray", "ray_cast", "box_cast"))]
    pub fn cast(&self, cast: &Cast<D, T>) -> Result<Option<Hit<u32>>, Error> {
        Ok(self.cast_many(core::slice::from_ref(cast))?[0])
    }

    /// [`cast`](Self::cast) for each of many.
    ///
    /// # Errors
    /// As [`cast`](Self::cast), with the index of the first bad one.
    pub fn cast_many(&self, casts: &[Cast<D, T>]) -> Result<Vec<Option<Hit<u32>>>, Error> {
        check_each(casts, Cast::fault)?;
        let lists = self.many(casts, |view, casts| {
            let (mut lists, mut reached) = (Lists::new(), Reached::new());
            for cast in casts {
                let hit = view.hits(moving(cast), &mut reached, ControlFlow::Break)?;
                lists.values.push(hit.break_value());
                lists.end();
            }
            Ok(lists)
        })?;
        Ok(lists.values)
    }

    /// Everything that a ray or a moving box hits, sorted by t and then by index.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn cast_all(&self, cast: &Cast<D, T>) -> Result<Vec<Hit<u32>>, Error> {
        check_each(core::slice::from_ref(cast), Cast::fault)?;
        self.view().all_hits(moving(cast))
    }

    /// Shows what a ray or a moving box hits to `visit`, the first hit first, until it breaks.
    ///
    /// # Errors
    /// As [`cast`](Self::cast).
    pub fn visit_cast<R>(
        &self,
        cast: &Cast<D, T>,
        visit: impl FnMut(Hit<u32>) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        check_each(core::slice::from_ref(cast), Cast::fault)?;
        self.view().hits(moving(cast), &mut Reached::new(), visit)
    }

    /// Everything that the line segment between two points meets, both ends included, sorted by t and then
    /// by index. t is 0 at `from` and 1 at `to`.
    ///
    /// ```
    /// use sweep_and_prune::{Aabb, Index};
    ///
    /// let index = Index::new(&[Aabb::new([8.0, 4.0], [9.0, 5.0]), Aabb::new([2.0, 0.0], [3.0, 3.0])])?;
    /// let hits = index.segment([0.0, 0.0], [8.0, 4.0])?;
    /// assert_eq!(hits.iter().map(|hit| (hit.id, hit.t)).collect::<Vec<_>>(), [(1, 0.25), (0, 1.0)]);
    /// # Ok::<(), sweep_and_prune::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidQuery`] if a point is not finite, or `to` is so far from `from` that the distance
    /// overflows an `f64`; or [`Error::OutOfMemory`].
    pub fn segment(&self, from: [T; D], to: [T; D]) -> Result<Vec<Hit<u32>>, Error> {
        let speed: [f64; D] = core::array::from_fn(|axis| to[axis].to_f64() - from[axis].to_f64());
        check_each(&[()], |()| {
            fault_in("from", &from, is_finite)
                .or(fault_in("to", &to, is_finite))
                .or(fault_in("to", &speed, is_finite))
        })?;
        self.view().all_hits(Moving { from: Aabb::new(from, from), speed, limit: 1.0 })
    }

    #[inline]
    fn view(&self) -> View<'_, D, T> {
        let Self { bytes, layout, kernel, .. } = self;
        View { bytes: bytes.as_ref(), layout, kernel: *kernel, scalar: PhantomData }
    }

    /// Answers chunks of queries, on threads where that pays.
    #[cfg(feature = "parallel")]
    fn many<Q: Sync, V: Copy + Send>(
        &self,
        queries: &[Q],
        answer: impl Fn(View<'_, D, T>, &[Q]) -> Result<Lists<V>, Error> + Sync,
    ) -> Result<Lists<V>, Error> {
        /// Fewer queries than this are not worth waking a thread.
        const FEW: usize = 64;
        /// Chunks for each thread: some take longer than others.
        const CHUNKS: usize = 8;
        let view = self.view();
        let chunk = queries.len().div_ceil(CHUNKS * self.threads).max(FEW);
        if self.threads == 1 || queries.len() <= chunk {
            return answer(view, queries);
        }
        let lists =
            map_on_threads(self.threads, queries.chunks(chunk), |chunk| answer(view, chunk));
        let mut all = Lists::new();
        for lists in lists {
            let lists = lists?;
            let start = all.values.len();
            all.values.try_reserve(lists.values.len()).map_err(|_| Error::OutOfMemory)?;
            all.values.extend_from_slice(&lists.values);
            all.ends.extend(lists.ends.iter().map(|end| start + end));
        }
        Ok(all)
    }

    #[cfg(not(feature = "parallel"))]
    fn many<Q, V>(
        &self,
        queries: &[Q],
        answer: impl Fn(View<'_, D, T>, &[Q]) -> Result<Lists<V>, Error>,
    ) -> Result<Lists<V>, Error> {
        answer(self.view(), queries)
    }
}

/// What a query needs, whatever holds the bytes.
#[derive(Clone, Copy)]
struct View<'a, const D: usize, T> {
    /// As long as the layout says.
    bytes: &'a [u8],
    layout: &'a Layout,
    kernel: Kernel,
    scalar: PhantomData<T>,
}

impl<const D: usize, T: Scalar> View<'_, D, T> {
    /// Adds the boxes that overlap a valid area to a buffer.
    #[inline]
    fn add(self, area: &Aabb<D, T>, buffer: &mut SearchBuffer) -> Result<(), Error> {
        let Self { layout, bytes, .. } = self;
        let search = Search { layout, bytes, area: *area, buffer };
        self.kernel.run(search).map_err(|_| Error::OutOfMemory)
    }

    fn near<R>(
        self,
        point: [T; D],
        max_distance: f64,
        reached: &mut Reached,
        mut visit: impl FnMut(Neighbor<u32>) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        let reach = FromPoint { point: point.map(T::to_f64), limit: max_distance * max_distance };
        self.nearest_first(reach, reached, |id, distance_squared| {
            visit(Neighbor { id, distance_squared })
        })
    }

    fn hits<R>(
        self,
        moving: Moving<D, T>,
        reached: &mut Reached,
        mut visit: impl FnMut(Hit<u32>) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        self.nearest_first(moving, reached, |id, t| visit(Hit { id, t }))
    }

    fn all_hits(self, moving: Moving<D, T>) -> Result<Vec<Hit<u32>>, Error> {
        let mut hits = Vec::new();
        let _ = self.hits(moving, &mut Reached::new(), |hit| {
            hits.push(hit);
            ControlFlow::<()>::Continue(())
        })?;
        Ok(hits)
    }

    fn nearest_first<R>(
        self,
        reach: impl Reach<D, T>,
        reached: &mut Reached,
        visit: impl FnMut(u32, f64) -> ControlFlow<R>,
    ) -> Result<ControlFlow<R>, Error> {
        let Self { layout, bytes, scalar, .. } = self;
        let work = NearestFirst { layout, bytes, reach, reached, visit, scalar };
        self.kernel.run(work).map_err(|_| Error::OutOfMemory)
    }
}

impl<const D: usize, T: Scalar, B> fmt::Debug for Index<D, T, B> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Index").field("len", &self.layout.count).finish_non_exhaustive()
    }
}

/// Refuses the first bad point, or a bad distance.
fn check_points<const D: usize, T: Scalar>(
    points: &[[T; D]],
    max_distance: f64,
) -> Result<(), Error> {
    check_each(&[max_distance], |limit| fault_in("max_distance", &[*limit], is_length))?;
    check_each(points, |point| fault_in("point", point, is_finite))
}

fn moving<const D: usize, T: Scalar>(cast: &Cast<D, T>) -> Moving<D, T> {
    Moving { from: cast.from, speed: cast.direction.map(T::to_f64), limit: cast.limit.to_f64() }
}
