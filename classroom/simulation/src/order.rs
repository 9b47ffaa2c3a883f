//! The order in which contacts are resolved. It must not depend on the broad phase, whose pairs
//! come in an order of its own.

use crate::vector::{greater, lesser};

/// Sorts pairs by (a, b): into one bucket for each `b` and then, keeping that order, into one for each `a`. A few pairs that
/// are added later are merged.
#[derive(Clone, Debug, Default)]
pub struct PairOrder {
    moved: Vec<[u32; 2]>,
    ends: [Vec<u32>; 2],
}

impl PairOrder {
    /// Sorts pairs of indices below `n`. The first `sorted` pairs must be sorted already.
    /// O(n + pairs); if `sorted` is not 0, O(pairs + k log k) for the k other pairs.
    pub fn sort(&mut self, pairs: &mut [[u32; 2]], sorted: usize, n: usize) {
        if sorted > 0 { self.merge(pairs, sorted) } else { self.count(pairs, n) }
    }

    fn count(&mut self, pairs: &mut [[u32; 2]], n: usize) {
        for ends in &mut self.ends {
            ends.clear();
            ends.resize(n + 1, 0);
        }
        for pair in &*pairs {
            for (ends, &index) in self.ends.iter_mut().zip(pair) {
                ends[index as usize + 1] += 1;
            }
        }
        self.moved.resize(pairs.len(), [0; 2]);
        let Self { moved, ends: [firsts, seconds] } = self;
        scatter(pairs, seconds, moved, |[_, b]| b);
        scatter(moved, firsts, pairs, |[a, _]| a);
    }

    /// From back to front, until all new pairs have their places.
    fn merge(&mut self, pairs: &mut [[u32; 2]], mut sorted: usize) {
        self.moved.clear();
        self.moved.extend_from_slice(&pairs[sorted..]);
        self.moved.sort_unstable();
        let mut to = pairs.len();
        while let Some(&greatest) = self.moved.last() {
            to -= 1;
            if sorted > 0 && pairs[sorted - 1] > greatest {
                sorted -= 1;
                pairs[to] = pairs[sorted];
            } else {
                pairs[to] = greatest;
                self.moved.pop();
            }
        }
    }
}

/// Moves pairs into the order of their keys; pairs with equal keys keep their order. `ends[k + 1]` is how many pairs have
/// key `k`.
fn scatter(
    pairs: &[[u32; 2]],
    ends: &mut [u32],
    to: &mut [[u32; 2]],
    key: impl Fn([u32; 2]) -> u32,
) {
    for k in 1..ends.len() {
        ends[k] += ends[k - 1];
    }
    // `ends[k]` is where the next pair with key `k` goes: after the loop, where they end.
    for &pair in pairs {
        let place = &mut ends[key(pair) as usize];
        to[*place as usize] = pair;
        *place += 1;
    }
}

/// How many levels heights are sorted into.
const LEVELS: usize = 1024;

/// Sorts by height, highest first, into levels: a counting sort, which leaves the members of one
/// level in the order in which they came.
#[derive(Clone, Debug, Default)]
pub struct LevelOrder {
    levels: Vec<u32>,
}

impl LevelOrder {
    /// Writes for each height its place in the order. O(heights + levels).
    pub fn sort(&mut self, heights: impl Iterator<Item = f32> + Clone, places: &mut Vec<u32>) {
        let (mut low, mut high) = (f32::INFINITY, f32::NEG_INFINITY);
        for height in heights.clone() {
            low = lesser(height, low);
            high = greater(height, high);
        }
        let scale = if high > low { (LEVELS - 1) as f32 / (high - low) } else { 0.0 };
        places.clear();
        places.extend(heights.map(|height| ((high - height) * scale) as u32));

        self.levels.clear();
        self.levels.resize(LEVELS + 1, 0);
        for &level in &*places {
            self.levels[level as usize + 1] += 1;
        }
        for level in 0..LEVELS {
            self.levels[level + 1] += self.levels[level];
        }
        for place in places {
            let next = &mut self.levels[*place as usize];
            *place = *next;
            *next += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sweep_and_prune_scenes::Random;

    #[test]
    fn pairs_are_in_order_whether_sorted_at_once_or_inserted() {
        let mut random = Random::new(1);
        let mut order = PairOrder::default();
        let mut pairs = Vec::new();
        let mut sorted = 0;
        // No pairs, many, then a few more several times; among them the smallest and the largest.
        for count in [0, 300, 1, 0, 7, 2, 40] {
            let mut draw = || random.below(60) as u32;
            pairs.extend((0..count).map(|_| [draw(), draw()]));
            pairs.extend([[59, 59], [0, 0]].iter().take(count));
            let mut expected = pairs.clone();
            expected.sort_unstable();
            order.sort(&mut pairs, sorted, 60);
            assert_eq!(pairs, expected, "{count} more");
            sorted = pairs.len();
        }
    }
}
