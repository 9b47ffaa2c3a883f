//! What a good developer writes in an hour, and what takes five minutes.

use anyhow::Result;
use sweep_and_prune::{Aabb, validate};

use super::library::{Finder, Library, Origin};

/// One standard sort and one loop.
pub const SWEEP: Library = Library {
    name: "plain sweep",
    origin: Origin::Here,
    how: "boxes sorted by their left edge on the axis of largest variance, then one loop",
    alternative: true,
    two: Some(|| Box::new(Sweep::default())),
    three: Some(|| Box::new(Sweep::default())),
};

/// Every box against every other.
pub const BRUTE_FORCE: Library = Library {
    name: "brute force",
    origin: Origin::Here,
    how: "two loops, once all boxes are found valid",
    alternative: true,
    two: Some(|| Box::new(BruteForce::default())),
    three: Some(|| Box::new(BruteForce::default())),
};

#[derive(Default)]
struct Sweep<const D: usize> {
    sorted: Vec<(Aabb<D>, u32)>,
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize> Finder<D> for Sweep<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let axis = axis_of_largest_variance(boxes);
        self.sorted.clear();
        self.sorted.extend(boxes.iter().copied().zip(0..));
        self.sorted.sort_unstable_by(|(a, _), (b, _)| a.min[axis].total_cmp(&b.min[axis]));

        self.pairs.clear();
        for (at, (a, id_a)) in self.sorted.iter().enumerate() {
            let ahead = self.sorted[at + 1..].iter();
            for (b, id_b) in ahead.take_while(|(b, _)| b.min[axis] <= a.max[axis]) {
                if a.overlaps(b) {
                    self.pairs.push([*id_a, *id_b]);
                }
            }
        }
        Ok(&self.pairs)
    }
}

fn axis_of_largest_variance<const D: usize>(boxes: &[Aabb<D>]) -> usize {
    let variance = |axis: usize| {
        let middle = |aabb: &Aabb<D>| f64::from(aabb.min[axis]) + f64::from(aabb.max[axis]);
        let count = boxes.len() as f64;
        let mean = boxes.iter().map(middle).sum::<f64>() / count;
        boxes.iter().map(|aabb| (middle(aabb) - mean).powi(2)).sum::<f64>() / count
    };
    (0..D).max_by(|&a, &b| variance(a).total_cmp(&variance(b))).unwrap_or(0)
}

#[derive(Default)]
struct BruteForce {
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize> Finder<D> for BruteForce {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        validate(boxes)?;
        self.pairs.clear();
        for (a, first) in boxes.iter().enumerate() {
            for (b, second) in boxes.iter().enumerate().skip(a + 1) {
                if first.overlaps(second) {
                    self.pairs.push([a as u32, b as u32]);
                }
            }
        }
        Ok(&self.pairs)
    }
}
