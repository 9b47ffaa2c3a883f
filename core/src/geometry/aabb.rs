//! The axis-aligned box, the overlap rule, and what a valid box is.

use super::Scalar;
use crate::error::Error;

/// An axis-aligned box in `D` dimensions: the closed intervals `min[axis] ..= max[axis]`.
///
/// A box is valid if `min <= max` on each axis. Points and flat boxes are valid, and infinite
/// coordinates are allowed (a ground half-space). Boxes that are NaN or inverted are not valid: every
/// function that takes boxes returns an error that names the box.
///
/// In memory a box is `2 * D` scalars: the min corner, then the max corner.
///
/// ```
/// use sweep_and_prune::Aabb;
///
/// let player = Aabb::new([0.0, 0.0], [1.0, 2.0]);
/// let ground = Aabb::new([f32::NEG_INFINITY, f32::NEG_INFINITY], [f32::INFINITY, 0.0]);
/// assert!(player.overlaps(&ground)); // touching boxes overlap
/// ```
///
/// Where boxes that only touch must not pair, as the cells of a grid, each ends just below where the next one begins:
///
/// ```
/// use sweep_and_prune::Aabb;
///
/// let cell = |x: f32| Aabb::new([x], [(x + 1.0).next_down()]);
/// assert!(!cell(0.0).overlaps(&cell(1.0)));
/// ```
///
/// Boxes are made from corners, from a center, or from arrays and tuples in the order of their
/// coordinates in memory:
///
/// ```
/// use sweep_and_prune::Aabb;
///
/// let aabb = Aabb::new([0.0, 0.0], [2.0, 4.0]);
/// assert_eq!(aabb, Aabb::from_center([1.0, 2.0], [1.0, 2.0]));
/// assert_eq!(aabb, Aabb::from([0.0, 0.0, 2.0, 4.0]));
/// assert_eq!(aabb, Aabb::from(([0.0, 0.0], [2.0, 4.0])));
/// let [min, max]: [[f32; 2]; 2] = aabb.into();
/// ```
///
/// With the features `glam030` to `glam034` and `mint` a pair of their vectors converts to a box and back. With
/// `bytemuck` a `&[f32]` can be cast to a `&[Aabb<2>]`, and with `serde` a box is `{ min, max }`.
#[derive(Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb<const D: usize, T = f32> {
    /// The min corner.
    pub min: [T; D],
    /// The max corner.
    pub max: [T; D],
}

// Not derived: that copies corner by corner, and a list box by box. So a world of 1,000 bodies is cloned in 0.16 of the time.
impl<const D: usize, T: Copy> Clone for Aabb<D, T> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<const D: usize, T: Scalar> Aabb<D, T> {
    /// A box from its min corner and its max corner. Any values are accepted; see
    /// [`is_valid`](Self::is_valid).
    #[inline]
    pub const fn new(min: [T; D], max: [T; D]) -> Self {
        Self { min, max }
    }

    /// A box from its center and its half sizes (not its full sizes) along each axis. Any values
    /// are accepted; a negative half size gives an inverted box. The corners are rounded to the
    /// nearest `T`.
    ///
    /// ```
    /// use sweep_and_prune::Aabb;
    ///
    /// let sphere = Aabb::from_center([5.0, 0.0, 1.0], [0.5; 3]); // of radius 0.5
    /// assert_eq!(sphere, Aabb::new([4.5, -0.5, 0.5], [5.5, 0.5, 1.5]));
    /// ```
    #[inline]
    #[must_use]
    pub fn from_center(center: [T; D], half_extents: [T; D]) -> Self {
        Self {
            min: core::array::from_fn(|axis| center[axis] - half_extents[axis]),
            max: core::array::from_fn(|axis| center[axis] + half_extents[axis]),
        }
    }

    /// The smallest box that contains all these points, or `None` if there are none. With a NaN among the coordinates
    /// the box is not valid.
    ///
    /// ```
    /// use sweep_and_prune::Aabb;
    ///
    /// let triangle = [[0.0, 0.0], [4.0, 1.0], [1.0, 3.0]];
    /// assert_eq!(Aabb::from_points(triangle), Some(Aabb::new([0.0, 0.0], [4.0, 3.0])));
    /// ```
    #[must_use]
    pub fn from_points(points: impl IntoIterator<Item = [T; D]>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let mut aabb = Self::new(first, first);
        for point in points {
            for (axis, &at) in point.iter().enumerate() {
                let is_nan = at.partial_cmp(&at).is_none();
                // A corner that is NaN stays so, since nothing is less or greater.
                if at < aabb.min[axis] || is_nan {
                    aabb.min[axis] = at;
                }
                if at > aabb.max[axis] || is_nan {
                    aabb.max[axis] = at;
                }
            }
        }
        Some(aabb)
    }

    /// The point in the middle, rounded to the nearest `T`. NaN on an axis that reaches from
    /// negative to positive infinity.
    #[inline]
    #[must_use]
    pub fn center(&self) -> [T; D] {
        core::array::from_fn(|axis| midpoint(self.min[axis], self.max[axis]))
    }

    /// The full size along each axis: `max - min`. Half of it is
    /// [`half_extents`](Self::half_extents).
    #[inline]
    #[must_use]
    pub fn extents(&self) -> [T; D] {
        core::array::from_fn(|axis| self.max[axis] - self.min[axis])
    }

    /// Half of the size along each axis, as [`from_center`](Self::from_center) expects it.
    #[inline]
    #[must_use]
    pub fn half_extents(&self) -> [T; D] {
        let half = T::from_f64(0.5);
        core::array::from_fn(|axis| {
            let extent = self.max[axis] - self.min[axis];
            // The size of a huge box may be infinite where its half is not.
            if extent < T::INFINITY {
                extent * half
            } else {
                self.max[axis] * half - self.min[axis] * half
            }
        })
    }

    /// Whether two boxes share a point. Intervals are closed: touching boxes overlap.
    ///
    /// One axis that separates the boxes is enough to reject them, so the test ends at the first.
    #[inline]
    pub fn overlaps(&self, other: &Self) -> bool {
        (0..D).all(|axis| self.overlaps_on(axis, other))
    }

    /// [`overlaps`](Self::overlaps) without a branch: compares every axis. Faster where the processor
    /// cannot predict the result.
    #[inline]
    pub(crate) fn overlaps_branch_free(&self, other: &Self) -> bool {
        (0..D).fold(true, |all, axis| {
            all & (self.min[axis] <= other.max[axis]) & (other.min[axis] <= self.max[axis])
        })
    }

    /// Whether every point of `inner` lies in this box.
    #[inline]
    pub fn contains(&self, inner: &Self) -> bool {
        (0..D).fold(true, |all, axis| {
            all & (self.min[axis] <= inner.min[axis]) & (inner.max[axis] <= self.max[axis])
        })
    }

    /// The smallest box that contains both.
    #[inline]
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let mut union = *self;
        for axis in 0..D {
            if other.min[axis] < union.min[axis] {
                union.min[axis] = other.min[axis];
            }
            if other.max[axis] > union.max[axis] {
                union.max[axis] = other.max[axis];
            }
        }
        union
    }

    /// The box of all points that lie in both boxes, or `None` if they do not overlap. Of boxes that touch it is flat.
    ///
    /// ```
    /// use sweep_and_prune::Aabb;
    ///
    /// let a = Aabb::new([0.0, 0.0], [2.0, 2.0]);
    /// let b = Aabb::new([1.0, 1.0], [3.0, 3.0]);
    /// assert_eq!(a.intersection(&b), Some(Aabb::new([1.0, 1.0], [2.0, 2.0])));
    /// assert_eq!(a.intersection(&b.translate([9.0, 0.0])), None);
    /// ```
    #[inline]
    #[must_use]
    pub fn intersection(&self, other: &Self) -> Option<Self> {
        self.overlaps(other).then(|| {
            let mut both = *self;
            for axis in 0..D {
                if other.min[axis] > both.min[axis] {
                    both.min[axis] = other.min[axis];
                }
                if other.max[axis] < both.max[axis] {
                    both.max[axis] = other.max[axis];
                }
            }
            both
        })
    }

    /// The box with each side moved outwards by `amount`, rounded to the nearest `T`. A negative amount shrinks it, and
    /// inverts it if the amount is more than half of its size.
    ///
    /// ```
    /// use sweep_and_prune::Aabb;
    ///
    /// let aabb = Aabb::new([0.0, 0.0], [2.0, 4.0]);
    /// assert_eq!(aabb.grow(0.5), Aabb::new([-0.5, -0.5], [2.5, 4.5]));
    /// ```
    #[inline]
    #[must_use]
    pub fn grow(&self, amount: T) -> Self {
        Self { min: self.min.map(|at| at - amount), max: self.max.map(|at| at + amount) }
    }

    /// The box moved by an offset. Both corners are rounded to the nearest `T`, so its size may change a little.
    ///
    /// ```
    /// use sweep_and_prune::Aabb;
    ///
    /// let aabb = Aabb::new([0.0, 0.0], [2.0, 4.0]);
    /// assert_eq!(aabb.translate([1.0, -1.0]), Aabb::new([1.0, -1.0], [3.0, 3.0]));
    /// ```
    #[inline]
    #[must_use]
    pub fn translate(&self, offset: [T; D]) -> Self {
        Self {
            min: core::array::from_fn(|axis| self.min[axis] + offset[axis]),
            max: core::array::from_fn(|axis| self.max[axis] + offset[axis]),
        }
    }

    /// Whether the intervals of two boxes share a point on one axis. This is the overlap rule of
    /// the whole project: intervals are closed on both sides.
    ///
    /// # Panics
    /// If `axis >= D`.
    #[inline]
    pub fn overlaps_on(&self, axis: usize, other: &Self) -> bool {
        self.min[axis] <= other.max[axis] && other.min[axis] <= self.max[axis]
    }

    /// Whether `min <= max` on each axis. A box with a NaN is never valid.
    #[inline]
    pub fn is_valid(&self) -> bool {
        self.invalid_axis().is_none()
    }

    /// Refuses an invalid box; `index` is its position in what was passed.
    #[inline]
    pub(crate) fn check(&self, index: usize) -> Result<(), Error> {
        self.invalid_axis().map_or(Ok(()), |axis| {
            Err(invalid_box(index, axis, self.min[axis].to_f64(), self.max[axis].to_f64()))
        })
    }

    /// The first axis on which the box is inverted or NaN.
    #[inline]
    pub fn invalid_axis(&self) -> Option<usize> {
        // Also false for a NaN on either side.
        let is_interval = |&axis: &usize| self.min[axis] <= self.max[axis];
        (0..D).find(|axis| !is_interval(axis))
    }
}

/// The error for an invalid box. Apart, so that the checks of boxes are short.
#[cold]
#[inline(never)]
fn invalid_box(index: usize, axis: usize, min: f64, max: f64) -> Error {
    Error::InvalidBox { set: 0, index, axis, min: min.into(), max: max.into() }
}

/// The middle of an interval. The sum comes first because it is exact for tiny numbers; where it
/// overflows, the halves are added.
#[inline]
fn midpoint<T: Scalar>(min: T, max: T) -> T {
    let half = T::from_f64(0.5);
    let sum = min + max;
    let overflows = !(T::NEG_INFINITY < sum && sum < T::INFINITY);
    if overflows { min * half + max * half } else { sum * half }
}

/// Checks that each box is valid and that the indices of the boxes fit in a `u32`. O(n) time.
///
/// The functions that find pairs check their input themselves.
///
/// # Errors
/// [`Error::TooManyBoxes`], or [`Error::InvalidBox`] with the smallest index of an invalid box and its
/// first invalid axis.
#[cfg_attr(not(target_arch = "wasm32"), inline(never))]
pub fn validate<const D: usize, T: Scalar>(boxes: &[Aabb<D, T>]) -> Result<(), Error> {
    check_count(boxes.len())?;
    boxes.iter().enumerate().try_for_each(|(index, aabb)| aabb.check(index))
}

/// Checks that the indices of `count` boxes fit in a `u32`.
///
/// # Errors
/// [`Error::TooManyBoxes`].
pub(crate) fn check_count(count: usize) -> Result<(), Error> {
    // Not `count > BOX_LIMIT`: where addresses have 32 bits, that is never true, and Clippy objects.
    u32::try_from(count).map(|_| ()).map_err(|_| Error::TooManyBoxes { count })
}
