//! The order of the boxes along the axis of the sweep.

use sweep_and_prune::Aabb;

/// Up to this many boxes, a digit of the radix sort has the smaller number of bits.
const FEW: usize = 3000;
/// The bits of a digit, for few boxes and for more. The sort looks at the two highest digits.
const BITS: [u32; 2] = [8, 11];
/// The insertion sort that follows may move this many items for each box. Beyond that, a comparison sort is faster.
const MOVES: usize = 8;
/// The order of the last call is repaired if at most one item in this many is below the item before it.
const REPAIR: usize = 16;

/// An integer for a coordinate: the integers are in the order of the coordinates, and both zeros are equal.
pub fn key(coordinate: f32) -> i32 {
    let bits = (coordinate + 0.0).to_bits() as i32;
    bits ^ ((bits >> 31) & i32::MAX)
}

/// A key and the index of its box below it, so that comparing two items compares the keys.
fn item(coordinate: f32, index: u32) -> u64 {
    let key = key(coordinate) as u32 ^ (1 << 31);
    u64::from(key) << 32 | u64::from(index)
}

/// The order of the boxes, kept from call to call.
#[derive(Default)]
pub struct Order {
    items: Vec<u64>,
    spare: Vec<u64>,
}

impl Order {
    /// The boxes in order: the lower half of each item is the index of a box.
    pub fn items(&self) -> &[u64] {
        &self.items
    }

    /// Sorts the boxes by their min corner on the axis of the largest variance, and returns the axis.
    pub fn sort<const D: usize>(&mut self, boxes: &[Aabb<D>]) -> usize {
        let (axis, least, greatest) = survey(boxes);
        if self.items.len() == boxes.len() && self.repair(boxes, axis) {
            return axis;
        }
        self.items.clear();
        self.items.extend(boxes.iter().zip(0..).map(|(aabb, at)| item(aabb.min[axis], at)));
        let least = (item(least, 0) >> 32) as u32;
        let range = ((item(greatest, 0) >> 32) as u32).saturating_sub(least);
        if boxes.len() <= FEW {
            self.sort_digits::<{ 1 << BITS[0] }>(least, range);
        } else {
            self.sort_digits::<{ 1 << BITS[1] }>(least, range);
        }
        if !insertion_sort(&mut self.items) {
            self.items.sort_unstable();
        }
        axis
    }

    /// Brings the items up to date in the order of the last call, and sorts them if few are out of order.
    fn repair<const D: usize>(&mut self, boxes: &[Aabb<D>], axis: usize) -> bool {
        let mut allowed = boxes.len() / REPAIR;
        let mut last = 0;
        self.spare.clear();
        for &old in &self.items {
            let index = old as u32;
            let new = item(boxes[index as usize].min[axis], index);
            if new < last {
                if allowed == 0 {
                    return false;
                }
                allowed -= 1;
            }
            last = new;
            self.spare.push(new);
        }
        std::mem::swap(&mut self.items, &mut self.spare);
        insertion_sort(&mut self.items)
    }

    /// Sorts by the two highest digits of the keys, whose number of values is `VALUES`.
    fn sort_digits<const VALUES: usize>(&mut self, least: u32, range: u32) {
        let bits = VALUES.trailing_zeros();
        let shift = (u32::BITS - range.leading_zeros()).saturating_sub(2 * bits);
        let digits = |item: u64| ((item >> 32) as u32).wrapping_sub(least) >> shift;
        let low = |item: u64| digits(item) as usize % VALUES;
        let high = |item: u64| (digits(item) >> bits) as usize % VALUES;
        let (mut of_low, mut of_high) = ([0u32; VALUES], [0u32; VALUES]);
        for &item in &self.items {
            of_low[low(item)] += 1;
            of_high[high(item)] += 1;
        }
        self.spare.resize(self.items.len(), 0);
        scatter(&self.items, &mut self.spare, &mut of_low, low);
        // Keys that differ only in the lower digit are sorted now.
        if of_high[0] as usize == self.items.len() {
            std::mem::swap(&mut self.items, &mut self.spare);
        } else {
            scatter(&self.spare, &mut self.items, &mut of_high, high);
        }
    }
}

/// The axis on which the centers vary most, and the least and greatest coordinate of a min corner on it.
fn survey<const D: usize>(boxes: &[Aabb<D>]) -> (usize, f32, f32) {
    let mut sums = [0.0f32; D];
    let mut squares = [0.0f32; D];
    let mut least = [f32::INFINITY; D];
    let mut greatest = [f32::NEG_INFINITY; D];
    // Differences from one box, since the squares of large coordinates would lose the differences.
    let origin = boxes.first().map_or([0.0; D], |aabb| aabb.min);
    for aabb in boxes {
        for axis in 0..D {
            let (min, max) = (aabb.min[axis], aabb.max[axis]);
            let twice = (min - origin[axis]) + (max - origin[axis]);
            sums[axis] += twice;
            squares[axis] += twice * twice;
            least[axis] = if min < least[axis] { min } else { least[axis] };
            greatest[axis] = if min > greatest[axis] { min } else { greatest[axis] };
        }
    }
    let count = boxes.len() as f32;
    let variance = |axis: usize| squares[axis] - sums[axis] * sums[axis] / count;
    let axis =
        (1..D).fold(0, |best, axis| if variance(axis) > variance(best) { axis } else { best });
    (axis, least[axis], greatest[axis])
}

/// Moves each item to its place by one digit and keeps the order of equal digits.
fn scatter(from: &[u64], to: &mut [u64], counts: &mut [u32], digit: impl Fn(u64) -> usize) {
    let mut start = 0;
    for count in &mut *counts {
        start += std::mem::replace(count, start);
    }
    for &item in from {
        let place = &mut counts[digit(item)];
        to[*place as usize] = item;
        *place += 1;
    }
}

/// Sorts items that are nearly in order, or gives up after [`MOVES`] moves for each item.
fn insertion_sort(items: &mut [u64]) -> bool {
    let mut left = MOVES * items.len();
    for at in 1..items.len() {
        let item = items[at];
        let mut to = at;
        while to > 0 && items[to - 1] > item {
            items[to] = items[to - 1];
            to -= 1;
        }
        items[to] = item;
        if at - to > left {
            return false;
        }
        left -= at - to;
    }
    true
}
