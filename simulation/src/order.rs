//! The order in which contacts are resolved. It must not depend on the broad phase, whose pairs
//! come in an order of its own.

use crate::vector::{greater, lesser};

/// Sorts pairs by (a, b): counted into one bucket an `a`, each bucket then sorted by `b`.
#[derive(Clone, Debug, Default)]
pub struct PairOrder {
    unsorted: Vec<[u32; 2]>,
    sorted: Vec<[u32; 2]>,
    ends: Vec<u32>,
}

impl PairOrder {
    /// The pairs of indices below `n`, sorted. O(n + pairs) for few pairs a body.
    pub fn sort(&mut self, pairs: impl Iterator<Item = [u32; 2]>, n: usize) -> &[[u32; 2]] {
        self.unsorted.clear();
        self.unsorted.extend(pairs);
        if self.unsorted.is_sorted() {
            return &self.unsorted;
        }
        self.ends.clear();
        self.ends.resize(n + 1, 0);
        for &[a, _] in &self.unsorted {
            self.ends[a as usize + 1] += 1;
        }
        for a in 0..n {
            self.ends[a + 1] += self.ends[a];
        }
        self.sorted.resize(self.unsorted.len(), [0; 2]);
        // While scattering, `ends[a]` is where the next of bucket `a` goes, and so ends as its end.
        for &pair in &self.unsorted {
            let place = &mut self.ends[pair[0] as usize];
            self.sorted[*place as usize] = pair;
            *place += 1;
        }
        let mut start = 0;
        for &end in &self.ends[..n] {
            self.sorted[start..end as usize].sort_unstable();
            start = end as usize;
        }
        &self.sorted
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
