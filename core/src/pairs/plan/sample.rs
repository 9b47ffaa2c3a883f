//! A sample of a set of boxes, from which the plan is made.

use crate::Scalar;
use crate::float::{greater, lesser};
use crate::geometry::Arithmetic;
use crate::pairs::source::Source;
use crate::sampling::positions;

/// The most boxes in a sample.
pub const MOST_SAMPLED: usize = 256;
/// One box in this many is drawn.
const SAMPLED_ONE_IN: usize = 32;
/// The smallest sample.
const LEAST_SAMPLED: usize = 24;

/// The most axes. Plans have this many in all dimensions, so that their code is compiled once.
pub const AXES: usize = 3;

/// The boxes that were drawn from a set.
pub struct Sample {
    pub dimensions: usize,
    /// Boxes in the set.
    pub count: f64,
    /// Boxes in the sample.
    pub len: usize,
    /// Corners by axis; times the unit, once they are [scaled](scale).
    pub min: [[f64; MOST_SAMPLED]; AXES],
    pub max: [[f64; MOST_SAMPLED]; AXES],
}

impl Sample {
    pub const fn empty(dimensions: usize) -> Self {
        Self {
            dimensions,
            count: 0.0,
            len: 0,
            min: [[0.0; MOST_SAMPLED]; AXES],
            max: [[0.0; MOST_SAMPLED]; AXES],
        }
    }

    /// Draws from a set. (Into an empty sample: one that is returned is copied once more.)
    pub fn draw<const D: usize, T: Scalar, S: Source<D, T>>(&mut self, source: &[S]) {
        let len = (source.len() / SAMPLED_ONE_IN).clamp(LEAST_SAMPLED, MOST_SAMPLED);
        self.draw_some(source, len);
    }

    /// Draws this many boxes, or all if there are fewer.
    #[inline(never)]
    pub fn draw_some<const D: usize, T: Scalar, S: Source<D, T>>(
        &mut self,
        source: &[S],
        len: usize,
    ) {
        self.count = source.len() as f64;
        for i in positions(source.len(), len) {
            let aabb = source[i].aabb();
            for axis in 0..D {
                self.min[axis][self.len] = aabb.min[axis].to_f64();
                self.max[axis][self.len] = aabb.max[axis].to_f64();
            }
            self.len += 1;
        }
    }

    /// The size of a box on an axis.
    pub fn size(&self, axis: usize, i: usize) -> f64 {
        self.max[axis][i] - self.min[axis][i]
    }

    /// Sizes that the largest half, quarter .. of the boxes exceed on an axis. Of boxes of the same size,
    /// all or none do.
    pub fn quantiles(&self, axis: usize) -> impl Iterator<Item = f64> {
        let sizes = self.sorted_sizes(axis);
        let len = self.len;
        (1..6).map(move |quantile| {
            let size = sizes[len - 1 - (len >> quantile)];
            let smaller = sizes[..len].partition_point(|&other| other < size);
            smaller.checked_sub(1).map_or(size, |last| 0.5 * (sizes[last] + size))
        })
    }

    /// The sizes of the boxes on an axis, in order; behind the last is nothing of use.
    #[inline(never)]
    pub fn sorted_sizes(&self, axis: usize) -> [f64; MOST_SAMPLED] {
        let mut sizes = [0.0; MOST_SAMPLED];
        let used = &mut sizes[..self.len];
        used.iter_mut().enumerate().for_each(|(i, size)| *size = self.size(axis, i));
        sort(used);
        sizes
    }
}

/// Multiplies the corners of some samples by their [unit](Arithmetic::unit), and clamps them to the limit of the coordinate
/// type. Returns the unit.
#[inline(never)]
pub fn scale<T: Scalar>(samples: &mut [&mut Sample]) -> T {
    let mut most = 0.0;
    for_each_edge(samples, |at| {
        if at.is_finite() && at.abs() > most {
            most = at.abs();
        }
    });
    let unit = T::Arithmetic::unit(most);
    let limit = T::Arithmetic::LIMIT;
    for_each_edge(samples, |at| *at = lesser(greater(*at * unit.to_f64(), -limit), limit));
    unit
}

fn for_each_edge(samples: &mut [&mut Sample], mut each: impl FnMut(&mut f64)) {
    for sample in samples {
        for corners in [&mut sample.min, &mut sample.max] {
            for edges in &mut corners[..sample.dimensions] {
                edges[..sample.len].iter_mut().for_each(&mut each);
            }
        }
    }
}

/// Sorts at most [`MOST_SAMPLED`] values by `f64::total_cmp`: as whole numbers, which is faster and, in
/// WebAssembly, shares the code of the sort of keys.
pub fn sort(values: &mut [f64]) {
    const SIGN: u64 = 1 << 63;
    let mut keys = [0; MOST_SAMPLED];
    let keys = &mut keys[..values.len()];
    for (key, value) in keys.iter_mut().zip(&*values) {
        let bits = value.to_bits();
        *key = if bits & SIGN == 0 { bits | SIGN } else { !bits };
    }
    keys.sort_unstable();
    for (value, &key) in values.iter_mut().zip(&*keys) {
        *value = f64::from_bits(if key & SIGN == 0 { !key } else { key ^ SIGN });
    }
}
