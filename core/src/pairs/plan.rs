//! How to go about a set of boxes: a sample of them, and a model of the cost.
//!
//! Two costs pull against each other. Narrower columns leave fewer candidates to test; but a box
//! is copied to each column that it touches, `1 + size / width` of them on the average. The plan
//! takes the sweep axis and the numbers of columns for which the model is least. Its constants
//! are the same for every kernel, since the order of the pairs follows from the plan.

use super::bins::Source;
use super::grid::{Cells, Grid};
use crate::{Aabb, Scalar};

/// Nanoseconds to place, sort and lay out one record, and to begin its scan.
const RECORD: f64 = 24.0;
/// Of these, to place it: all that it takes if the other set has none in its column.
const PLACE: f64 = 6.0;
/// Columns for each of few boxes against many, at least.
const SPARSE: f64 = 4.0;
/// Nanoseconds for one candidate: between what 16 lanes take and what 4 do.
pub(super) const CANDIDATE: f64 = 0.25;
/// Nanoseconds to begin and end a column.
const COLUMN: f64 = 250.0;
/// Records in a slab: they, their keys and their column fit the second cache.
const SLAB: f64 = 4096.0;
/// Most cells on an axis.
const MOST: f64 = 65535.0;
/// Most columns, nearly: with a last step and with slabs still less than 2^29.
const MOST_COLUMNS: f64 = (1 << 24) as f64;
/// Cells are halved so often, less one, to see how boxes cluster: at most, with a full sample.
const LEVELS: usize = 11;
/// A chance that a sample can tell from none.
const SURE: f64 = 1.0 / 2048.0;
/// Costs in such a ratio may come of one scene.
const ALIKE: f64 = 0.95;
/// Most boxes in a sample.
const SAMPLE: usize = 256;

/// What to do with one set of boxes, or with two.
#[derive(Clone, Copy, Debug)]
pub(super) enum Plan<T> {
    /// Cut into columns (perhaps one) and sweep each.
    Cut(Grid<T>),
    /// Part the boxes of one set (0 or 1) by their size on an axis, and take the parts by
    /// themselves.
    Part { set: usize, axis: usize, size: f64 },
}

impl<T: Scalar> Plan<T> {
    /// Whether there is anything to it but to sweep all at once.
    pub fn divides(&self) -> bool {
        !matches!(self, Plan::Cut(grid) if grid.len() == 1)
    }
}

/// A plan and the nanoseconds that it is expected to take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Planned<T> {
    pub plan: Plan<T>,
    pub cost: f64,
}

/// Plans for one set (pairs within it) or two (pairs between them).
pub(super) fn plan<const D: usize, T: Scalar, S: Source<D, T>>(
    sets: &[S],
    may_part: bool,
) -> Planned<T> {
    let magnitude = |set: &S| greatest(sampled(*set).map(|i| magnitude(set.aabb(i))));
    let unit = T::unit(greatest(sets.iter().map(magnitude)));
    let first = Sample::<D>::take(sets[0], unit);
    let second;
    let samples: &[&Sample<D>] = if let Some(&source) = sets.get(1) {
        second = Sample::<D>::take(source, unit);
        &[&first, &second]
    } else {
        &[&first]
    };
    let field = Field::new(samples);
    let (way, cost) = field.cheapest(samples, may_part);
    let plan = match way {
        Way::Cut(cut) => Plan::Cut(cut.grid(&field, unit)),
        Way::Part { set, axis, size } => Plan::Part { set, axis, size: size / unit.to_f64() },
    };
    Planned { plan, cost }
}

/// Boxes drawn evenly from a set, one at a random place of each stretch. The randomness is the
/// same on every run.
fn sampled<const D: usize, T: Scalar, S: Source<D, T>>(source: S) -> impl Iterator<Item = usize> {
    let count = source.len() as u64; // `usize` has 32 bits in WebAssembly
    let len = (count / 32).clamp(24, SAMPLE as u64).min(count);
    let mut random = 0x9E37_79B9_7F4A_7C15u64;
    (0..len).map(move |i| {
        random = random.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(1);
        let (from, to) = (i * count / len, (i + 1) * count / len);
        (from + (random >> 33) % (to - from)) as usize
    })
}

/// The greatest coordinate by its magnitude, infinities left out.
fn magnitude<const D: usize, T: Scalar>(aabb: &Aabb<D, T>) -> f64 {
    let magnitudes = aabb.min.iter().chain(&aabb.max).map(|at| at.to_f64().abs());
    greatest(magnitudes.filter(|at| at.is_finite()))
}

/// The boxes that were drawn.
struct Sample<const D: usize> {
    /// Boxes in the set.
    count: f64,
    len: usize,
    /// Edges by axis, times the unit, held within the limit of the coordinate type.
    min: [[f64; SAMPLE]; D],
    max: [[f64; SAMPLE]; D],
    /// The lower edges once more, sorted.
    sorted: [[f64; SAMPLE]; D],
}

impl<const D: usize> Sample<D> {
    fn take<T: Scalar, S: Source<D, T>>(source: S, unit: T) -> Self {
        let mut sample = Self {
            count: source.len() as f64,
            len: 0,
            min: [[0.0; SAMPLE]; D],
            max: [[0.0; SAMPLE]; D],
            sorted: [[0.0; SAMPLE]; D],
        };
        let limited = |at: T| (at.to_f64() * unit.to_f64()).clamp(-T::LIMIT, T::LIMIT);
        for i in sampled(source) {
            let aabb = source.aabb(i);
            for axis in 0..D {
                sample.min[axis][sample.len] = limited(aabb.min[axis]);
                sample.max[axis][sample.len] = limited(aabb.max[axis]);
            }
            sample.len += 1;
        }
        sample.sort();
        sample
    }

    fn sort(&mut self) {
        for (sorted, min) in self.sorted.iter_mut().zip(&self.min) {
            *sorted = *min;
            sort(&mut sorted[..self.len]);
        }
    }

    /// A box's size on an axis, as far as it lies in the field.
    fn size(&self, field: &Field<D>, axis: usize, i: usize) -> f64 {
        field.clip(axis, self.max[axis][i]) - field.clip(axis, self.min[axis][i])
    }

    /// Sizes that part the largest half, quarter .. of the sample on an axis.
    fn quantiles(&self, field: &Field<D>, axis: usize) -> impl Iterator<Item = f64> {
        let mut sizes = [0.0; SAMPLE];
        for (i, size) in sizes[..self.len].iter_mut().enumerate() {
            *size = self.size(field, axis, i);
        }
        sort(&mut sizes[..self.len]);
        let len = self.len;
        (1..6).map(move |part| sizes[len - 1 - (len >> part)])
    }
}

/// Sorts part of a sample by `f64::total_cmp`: as whole numbers, which is quicker and, in
/// WebAssembly, shares the code of the sort of keys.
fn sort(values: &mut [f64]) {
    const SIGN: u64 = 1 << 63;
    let mut keys = [0; SAMPLE];
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

/// Where the boxes are: the same for the parts of a set as for the whole.
struct Field<const D: usize> {
    /// From where to where, but for a few outliers.
    low: [f64; D],
    high: [f64; D],
    /// The chance that two boxes begin in the same of 1, 2, 4 .. equal cells,
    together: [[f64; LEVELS]; D],
    /// so many of them: the fewer boxes were drawn, the less the finest cells would tell.
    levels: usize,
    /// The extent over which evenly spread boxes would be as near to each other as these are:
    /// less than `high - low` if they are clustered.
    spread: [f64; D],
    /// The chance that two boxes begin at the same coordinate.
    ties: [f64; D],
}

impl<const D: usize> Field<D> {
    fn new(samples: &[&Sample<D>]) -> Self {
        let drawn = samples.iter().map(|sample| sample.len).max().unwrap_or(1);
        let levels = (drawn.next_power_of_two().ilog2() as usize + 3).min(LEVELS);
        let mut field = Field {
            levels,
            low: [0.0; D],
            high: [0.0; D],
            together: [[1.0; LEVELS]; D],
            spread: [0.0; D],
            ties: core::array::from_fn(|axis| ties(samples, axis)),
        };
        for axis in 0..D {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for sample in samples {
                let sorted = &sample.sorted[axis][..sample.len];
                let tail = sample.len / 20;
                let (least, most) = (sorted[tail], sorted[sample.len - 1 - tail]);
                let margin = 0.125 * (most - least);
                low = lesser(greater(least - margin, sorted[0]), low);
                high = greater(lesser(most + margin, sorted[sample.len - 1]), high);
            }
            let (low, high) = snapped(low, high);
            (field.low[axis], field.high[axis]) = (low, high);
            let extent = high - low;
            field.together[axis] = together(samples, axis, levels, low, extent);
            // As fine as the sample can tell.
            let level = (0..levels).rev().find(|&level| field.together[axis][level] > SURE);
            let level = level.unwrap_or(0);
            let cells = (1u32 << level) as f64;
            field.spread[axis] = lesser(extent / cells / field.together[axis][level], extent);
        }
        field
    }

    fn clip(&self, axis: usize, coordinate: f64) -> f64 {
        // Not `clamp`: unchecked boxes come this far, and a NaN must not panic.
        lesser(greater(coordinate, self.low[axis]), self.high[axis])
    }

    fn extent(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// The cheapest way to go about the boxes, and its cost.
    fn cheapest(&self, samples: &[&Sample<D>], may_part: bool) -> (Way<D>, f64) {
        let shapes = [Shape::new(samples[0], self), Shape::new(samples[samples.len() - 1], self)];
        let (cut, cost) = self.cut(&shapes[..samples.len()]);
        let mut best = (Way::Cut(cut), cost);
        let boxes: f64 = shapes[..samples.len()].iter().map(|shape| shape.count).sum();
        if !may_part || cost <= 3.0 * RECORD * boxes {
            return best;
        }
        for set in 0..samples.len() {
            for axis in 0..D {
                for size in samples[set].quantiles(self, axis) {
                    let [small, large] = Shape::parted(samples[set], self, axis, size);
                    if small.count == 0.0 || large.count == 0.0 {
                        continue;
                    }
                    let most = 0.8 * best.1;
                    let cost = if samples.len() == 1 {
                        self.cost_below(most, &[&[small], &[large], &[small, large]])
                    } else {
                        let [mut with_small, mut with_large] = [shapes; 2];
                        (with_small[set], with_large[set]) = (small, large);
                        self.cost_below(most, &[&with_small, &with_large])
                    };
                    if cost < most {
                        best = (Way::Part { set, axis, size }, cost);
                    }
                }
            }
        }
        best
    }

    /// What it costs to go about all of these, or something not below `most`.
    fn cost_below(&self, most: f64, parts: &[&[Shape<D>]]) -> f64 {
        let mut cost = 0.0;
        for part in parts {
            cost += self.cut(part).1;
            if cost >= most {
                break;
            }
        }
        cost
    }

    /// The cheapest way to cut, and its cost.
    fn cut(&self, shapes: &[Shape<D>]) -> (Cut<D>, f64) {
        let mut best = (Cut { sweep: 0, columns: [1.0; D] }, f64::INFINITY);
        for sweep in 0..D {
            let (mut cut, mut cost) = self.refined(shapes, Cut { sweep, columns: [1.0; D] });
            if let [first, second] = shapes {
                // Of few boxes against many most columns hold none, once there are many more
                // columns than boxes; until then more columns do not pay.
                let fewer = lesser(first.count, second.count);
                let mut most = Cut { sweep, columns: [1.0; D] };
                while most.columns.iter().product::<f64>() < SPARSE * fewer {
                    for axis in (0..D).filter(|&axis| axis != sweep && self.extent(axis) > 0.0) {
                        most.columns[axis] *= 2.0;
                    }
                    if most.columns == [1.0; D] {
                        break;
                    }
                }
                let (sparse, sparse_cost) = self.refined(shapes, most);
                if sparse_cost < ALIKE * cost {
                    (cut, cost) = (sparse, sparse_cost);
                }
            }
            // By so much that the axis does not change from call to call where all are alike.
            if cost < ALIKE * best.1 {
                best = (cut, cost);
            }
        }
        let (cut, _) = &mut best;
        let records: f64 = shapes.iter().map(|shape| shape.records(self, cut)).sum();
        let slabs = whole(records / cut.columns.iter().product::<f64>() / SLAB);
        // Only if few boxes reach from slab to slab.
        let largest = greatest(shapes.iter().map(|shape| shape.mean[cut.sweep]));
        if slabs > 1.0 && largest * slabs < 0.25 * self.extent(cut.sweep) {
            cut.columns[cut.sweep] = slabs;
        }
        best
    }

    /// A cut made finer step by step, as long as that pays, and its cost.
    fn refined(&self, shapes: &[Shape<D>], mut cut: Cut<D>) -> (Cut<D>, f64) {
        let mut cost = self.cost(shapes, &cut);
        while cut.columns.iter().product::<f64>() < MOST_COLUMNS {
            let mut next = (cut, cost);
            for axis in (0..D).filter(|&axis| axis != cut.sweep && self.extent(axis) > 0.0) {
                let mut finer = cut;
                finer.columns[axis] = whole(cut.columns[axis] * 1.25) + 1.0;
                let finer_cost = self.cost(shapes, &finer);
                let most = if next.1 < cost { ALIKE * next.1 } else { cost };
                if finer_cost < most {
                    next = (finer, finer_cost);
                }
            }
            if next.1 >= cost {
                break;
            }
            (cut, cost) = next;
        }
        (cut, cost)
    }

    /// The chance that two boxes begin in the same of so many columns.
    fn together(&self, axis: usize, columns: f64) -> f64 {
        // Between the powers of two, and beyond the last, as if evenly spread.
        let level = ((columns as u32).ilog2() as usize).min(self.levels - 1);
        let beyond = columns / f64::from(1u32 << level);
        let finer = self.together[axis][(level + 1).min(self.levels - 1)];
        greater(self.together[axis][level] / beyond, finer)
    }

    fn cost(&self, shapes: &[Shape<D>], cut: &Cut<D>) -> f64 {
        let columns: f64 = cut.columns.iter().product();
        // The chance that two boxes are in the same column.
        let mut together = 1.0;
        for axis in (0..D).filter(|&axis| cut.columns[axis] > 1.0) {
            together *= self.together(axis, cut.columns[axis]);
        }
        let mut records = 0.0;
        let mut candidates = together;
        let mut chance = self.ties[cut.sweep];
        for shape in shapes {
            let count = shape.records(self, cut);
            records += count;
            candidates *= count;
            if shapes.len() == 1 {
                candidates *= count;
            }
            chance += if self.spread[cut.sweep] > 0.0 {
                lesser(shape.mean[cut.sweep] / self.spread[cut.sweep], 1.0)
            } else {
                1.0
            };
        }
        let pairs = candidates * lesser(chance, 1.0);
        if let [first, second] = shapes {
            let counts = [first, second].map(|shape| shape.records(self, cut));
            // The share of the columns that have any of each set: as many as records, at most.
            let [with_first, with_second] = counts.map(|count| lesser(count / columns, 1.0));
            let shared = counts[0] * with_second + counts[1] * with_first;
            return records * PLACE
                + shared * (RECORD - PLACE)
                + pairs * CANDIDATE
                + columns * with_first * with_second * COLUMN;
        }
        records * RECORD + pairs * CANDIDATE + columns * COLUMN
    }
}

/// The interval with its ends at whole multiples of a power of two, an eighth to a sixteenth of its
/// extent: that of boxes which move little is the same from call to call. It holds all of the old
/// one but a few hundredths, and where boxes reach a little over a round number that is not the
/// next end.
fn snapped(low: f64, high: f64) -> (f64, f64) {
    const EXPONENT: u64 = 0x7FF << 52;
    let step = f64::from_bits((high - low).to_bits() & EXPONENT) / 8.0;
    if step < f64::MIN_POSITIVE {
        return (low, high);
    }
    let low = floor(low / step + 0.125);
    let high = -floor(0.125 - high / step);
    (low * step, greater(high, low + 1.0) * step)
}

/// The greatest whole number up to a value; `f64::floor` is not in `core`.
fn floor(value: f64) -> f64 {
    const ALL_WHOLE: f64 = (1u64 << 52) as f64;
    if value.abs() >= ALL_WHOLE {
        return value;
    }
    let whole = value as i64 as f64;
    if whole > value { whole - 1.0 } else { whole }
}

/// The whole part; `f64::floor` is not in `core`.
fn whole(value: f64) -> f64 {
    value as u32 as f64
}

/// The lesser; the limit if the value is no number. (`f64::min` is a call in WebAssembly.)
fn lesser(value: f64, limit: f64) -> f64 {
    if value < limit { value } else { limit }
}

/// The greater; the limit if the value is no number.
pub(super) fn greater(value: f64, limit: f64) -> f64 {
    if value > limit { value } else { limit }
}

/// The greatest; at least 0.
fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most, value| greater(value, most))
}

/// The chance that two boxes begin in the same of 1, 2, 4 .. equal cells, from the finest up.
fn together<const D: usize>(
    samples: &[&Sample<D>],
    axis: usize,
    levels: usize,
    low: f64,
    extent: f64,
) -> [f64; LEVELS] {
    let finest = 1 << (levels - 1);
    let mut counts = [[0u32; 1 << (LEVELS - 1)]; 2];
    let scale = if extent > 0.0 { finest as f64 / extent } else { 0.0 };
    for (counts, sample) in counts.iter_mut().zip(samples) {
        for at in &sample.min[axis][..sample.len] {
            let cell = ((at - low) * scale) as usize; // below and beyond: the outermost
            counts[cell.min(finest - 1)] += 1;
        }
    }
    let mut chances = [1.0; LEVELS];
    let [first, second] = &mut counts;
    let len = samples[0].len as f64;
    for level in (0..levels).rev() {
        let cells = 1 << level;
        let pairs: u32 = if samples.len() == 1 {
            first[..cells].iter().map(|&count| count * count.saturating_sub(1)).sum()
        } else {
            first[..cells].iter().zip(&second[..cells]).map(|(a, b)| a * b).sum()
        };
        let all = if samples.len() == 1 { len * (len - 1.0) } else { len * samples[1].len as f64 };
        chances[level] = if all > 0.0 { f64::from(pairs) / all } else { 1.0 };
        for counts in [&mut *first, &mut *second].into_iter().take(samples.len()) {
            for cell in 0..cells / 2 {
                counts[cell] = counts[2 * cell] + counts[2 * cell + 1];
            }
        }
    }
    chances
}

/// The chance that two boxes begin at the same coordinate.
fn ties<const D: usize>(samples: &[&Sample<D>], axis: usize) -> f64 {
    let [first, last] = [samples[0], samples[samples.len() - 1]];
    let mut pairs = 0;
    let mut begin = 0;
    for (i, at) in first.sorted[axis][..first.len].iter().enumerate() {
        // In one sample, those before it; of another, all.
        let others = &last.sorted[axis][..if samples.len() == 1 { i } else { last.len }];
        begin += others[begin..].iter().take_while(|&other| other < at).count();
        pairs += others[begin..].iter().take_while(|&other| other == at).count();
    }
    let all =
        if samples.len() == 1 { first.len * (first.len - 1) / 2 } else { first.len * last.len };
    pairs as f64 / all.max(1) as f64
}

/// How many boxes, and how large on the average.
#[derive(Clone, Copy)]
struct Shape<const D: usize> {
    count: f64,
    mean: [f64; D],
}

impl<const D: usize> Shape<D> {
    fn new(sample: &Sample<D>, field: &Field<D>) -> Self {
        Self::of(sample, field, |_| true)
    }

    /// The boxes up to a size on an axis, and those above.
    fn parted(sample: &Sample<D>, field: &Field<D>, axis: usize, size: f64) -> [Self; 2] {
        [
            Self::of(sample, field, |i| sample.size(field, axis, i) <= size),
            Self::of(sample, field, |i| sample.size(field, axis, i) > size),
        ]
    }

    fn of(sample: &Sample<D>, field: &Field<D>, belongs: impl Fn(usize) -> bool) -> Self {
        let (mut len, mut sum) = (0.0, [0.0; D]);
        for i in (0..sample.len).filter(|&i| belongs(i)) {
            len += 1.0;
            for (axis, sum) in sum.iter_mut().enumerate() {
                *sum += sample.size(field, axis, i) / SAMPLE as f64;
            }
        }
        let scale = if len > 0.0 { SAMPLE as f64 / len } else { 0.0 };
        Self { count: sample.count * len / sample.len as f64, mean: sum.map(|sum| sum * scale) }
    }

    /// Boxes and copies.
    fn records(&self, field: &Field<D>, cut: &Cut<D>) -> f64 {
        let mut records = self.count;
        for axis in 0..D {
            if cut.columns[axis] > 1.0 {
                records *= 1.0 + self.mean[axis] / field.extent(axis) * cut.columns[axis];
            }
        }
        records
    }
}

/// A [`Plan`] in the units of the field.
#[derive(Clone, Copy)]
enum Way<const D: usize> {
    Cut(Cut<D>),
    Part { set: usize, axis: usize, size: f64 },
}

/// A sweep axis; columns on the others, slabs on it.
#[derive(Clone, Copy)]
struct Cut<const D: usize> {
    sweep: usize,
    columns: [f64; D],
}

impl<const D: usize> Cut<D> {
    fn grid<T: Scalar>(&self, field: &Field<D>, unit: T) -> Grid<T> {
        let cells = core::array::from_fn(|axis| {
            if self.columns[axis] > 1.0 {
                let count = lesser(self.columns[axis], MOST);
                Cells::new(axis, unit, field.low[axis], field.high[axis], count as u32)
            } else {
                Cells::one(axis)
            }
        });
        Grid::new::<D>(self.sweep, cells)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Boxes of a size at whole multiples of a step below 100, on two axes.
    fn boxes<T: Scalar>(step: f64, size: f64) -> alloc::vec::Vec<Aabb<2, T>> {
        let at = |i: u32| f64::from(i.wrapping_mul(0x9E37_79B9) >> 16) * (100.0 / 65536.0);
        let edge = |i: u32, size: f64| T::from_f64((whole(at(i)) + size) * step);
        let aabb = |i| {
            let corner = |size| [edge(i, size), edge(i ^ 0xABCD_EF01, size)];
            Aabb::new(corner(0.0), corner(size))
        };
        (0..10_000).map(aabb).collect()
    }

    /// How many columns are planned.
    fn columns<T: Scalar>(step: f64, size: f64) -> usize {
        match plan(&[&boxes::<T>(step, size)[..]], true).plan {
            Plan::Cut(grid) => grid.len(),
            Plan::Part { .. } => 0,
        }
    }

    #[test]
    fn points_on_few_coordinates_are_cut_as_boxes_are() {
        assert!(columns::<f32>(1.0, 0.0) > 8);
        assert!(columns::<f32>(1.0, 1.0) > 8);
    }

    #[test]
    fn plans_do_not_depend_on_the_unit() {
        let usual = columns::<f32>(1.0, 1.0);
        for step in [f64::from(f32::from_bits(1)), 2f64.powi(-120), 2f64.powi(120)] {
            assert_eq!(columns::<f32>(step, 1.0), usual, "{step}");
        }
        for step in [f64::from_bits(1), 2f64.powi(-1000), 2f64.powi(1000)] {
            assert_eq!(columns::<f64>(step, 1.0), usual, "{step}");
        }
        // In other units other coordinates are round, to which the ends of the field are snapped:
        // that may come to a step finer or coarser, by a quarter.
        let is_alike = |columns: usize| 3 * columns <= 4 * usual && 3 * usual <= 4 * columns;
        for step in [1e-40, 1e-30, 1e30, 3.3e36] {
            assert!(is_alike(columns::<f32>(step, 1.0)), "{step}");
        }
        for step in [1e-310, 1e-290, 1e290, 1.7e306] {
            assert!(is_alike(columns::<f64>(step, 1.0)), "{step}");
        }
    }
}
