//! The distribution of the boxes of the samples: how far they reach, how they cluster.

use super::sample::{AXES, MOST_SAMPLED, Sample, sort};
use crate::float::{floor, greater, lesser};

/// How many resolutions the histogram of an axis has: 1, 2, 4, ... 2^(RESOLUTIONS - 1) cells. Small samples use fewer.
const RESOLUTIONS: usize = 11;
/// The most cells.
const MOST_CELLS: usize = 1 << (RESOLUTIONS - 1);
/// The smallest chance that a sample can tell from none.
const LEAST_SURE_CHANCE: f64 = 1.0 / 2048.0;

/// The distribution of the boxes. Small and large boxes are assumed to share it.
pub struct Distribution {
    pub dimensions: usize,
    /// The interval that holds the boxes, apart from a few outliers.
    pub low: [f64; AXES],
    pub high: [f64; AXES],
    /// The chance that two boxes begin in the same cell, of 1, 2, 4, ... equal cells.
    share_cell: [[f64; RESOLUTIONS]; AXES],
    /// How many of these chances are known: the fewer boxes were drawn, the less the finest cells would tell.
    levels: usize,
    /// The extent over which evenly spread boxes would be as near to each other as these are:
    /// less than `high - low` if they are clustered.
    pub spread: [f64; AXES],
    /// The chance that two boxes begin at the same coordinate.
    pub ties: [f64; AXES],
}

impl Distribution {
    pub fn new(samples: &[&Sample]) -> Self {
        let drawn = samples.iter().map(|sample| sample.len).max().unwrap_or(1);
        let levels = (drawn.next_power_of_two().ilog2() as usize + 3).min(RESOLUTIONS);
        let mut distribution = Distribution {
            dimensions: samples[0].dimensions,
            levels,
            low: [0.0; AXES],
            high: [0.0; AXES],
            share_cell: [[1.0; RESOLUTIONS]; AXES],
            spread: [0.0; AXES],
            ties: [0.0; AXES],
        };
        let mut sorted = [[0.0; MOST_SAMPLED]; 2];
        let mut counts = [[0; MOST_CELLS]; 2];
        for axis in 0..distribution.dimensions {
            for (sorted, sample) in sorted.iter_mut().zip(samples) {
                let sorted = &mut sorted[..sample.len];
                sorted.copy_from_slice(&sample.min[axis][..sample.len]);
                sort(sorted);
            }
            distribution.ties[axis] = ties(&sorted, samples);
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            for (sorted, sample) in sorted.iter().zip(samples) {
                let tail = sample.len / 20;
                let (least, most) = (sorted[tail], sorted[sample.len - 1 - tail]);
                let margin = 0.125 * (most - least);
                low = lesser(greater(least - margin, sorted[0]), low);
                high = greater(lesser(most + margin, sorted[sample.len - 1]), high);
            }
            let (low, high) = snapped(low, high);
            (distribution.low[axis], distribution.high[axis]) = (low, high);
            let extent = high - low;
            distribution.share_cell[axis] =
                chances_to_share_a_cell(samples, axis, levels, low, extent, &mut counts);
            // As fine as the sample can tell.
            let level = (0..levels)
                .rev()
                .find(|&level| distribution.share_cell[axis][level] > LEAST_SURE_CHANCE);
            let level = level.unwrap_or(0);
            let cells = (1u32 << level) as f64;
            distribution.spread[axis] =
                lesser(extent / cells / distribution.share_cell[axis][level], extent);
        }
        distribution
    }

    fn clip(&self, axis: usize, coordinate: f64) -> f64 {
        // Not `clamp`: unchecked boxes come this far, and a NaN must not panic.
        lesser(greater(coordinate, self.low[axis]), self.high[axis])
    }

    pub fn extent(&self, axis: usize) -> f64 {
        self.high[axis] - self.low[axis]
    }

    /// The size of the part of a sampled box on an axis that lies within the distribution.
    pub fn size(&self, sample: &Sample, axis: usize, i: usize) -> f64 {
        self.clip(axis, sample.max[axis][i]) - self.clip(axis, sample.min[axis][i])
    }

    /// The chance that two boxes begin in the same of this many columns.
    pub fn chance_to_share(&self, axis: usize, columns: f64) -> f64 {
        // Between the powers of two, and beyond the last, as if evenly spread.
        let level = ((columns as u32).ilog2() as usize).min(self.levels - 1);
        let beyond = columns / f64::from(1u32 << level);
        let finer = self.share_cell[axis][(level + 1).min(self.levels - 1)];
        greater(self.share_cell[axis][level] / beyond, finer)
    }
}

/// Moves the ends of an interval to whole multiples of a power of two, which is an eighth to a sixteenth of its
/// extent. So boxes that move little have the same interval from call to call. It holds all of the old interval but a
/// few hundredths, so boxes that reach a little beyond a round number do not move an end to the next one.
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

/// The chance that two boxes begin in the same cell, of 1, 2, 4, ... equal cells; counted from the finest up.
fn chances_to_share_a_cell(
    samples: &[&Sample],
    axis: usize,
    levels: usize,
    low: f64,
    extent: f64,
    counts: &mut [[u32; MOST_CELLS]; 2],
) -> [f64; RESOLUTIONS] {
    let finest = 1 << (levels - 1);
    let scale = if extent > 0.0 { finest as f64 / extent } else { 0.0 };
    for (counts, sample) in counts.iter_mut().zip(samples) {
        counts[..finest].fill(0);
        for at in &sample.min[axis][..sample.len] {
            let cell = ((at - low) * scale) as usize; // below and beyond: the outermost
            counts[cell.min(finest - 1)] += 1;
        }
    }
    let mut chances = [1.0; RESOLUTIONS];
    let [first, second] = counts;
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

/// The chance that two boxes begin at the same coordinate; the coordinates of each sample are sorted.
fn ties(sorted: &[[f64; MOST_SAMPLED]; 2], samples: &[&Sample]) -> f64 {
    let [first, last] = [samples[0], samples[samples.len() - 1]];
    let mut pairs = 0;
    let mut begin = 0;
    for (i, at) in sorted[0][..first.len].iter().enumerate() {
        // In one sample, those before it; of another, all.
        let others = &sorted[samples.len() - 1][..if samples.len() == 1 { i } else { last.len }];
        begin += others[begin..].iter().take_while(|&other| other < at).count();
        pairs += others[begin..].iter().take_while(|&other| other == at).count();
    }
    let all =
        if samples.len() == 1 { first.len * (first.len - 1) / 2 } else { first.len * last.len };
    pairs as f64 / all.max(1) as f64
}
