//! A sweep along one axis with vectors, written from the published description of Pierre Terdiman's box pruning.
//!
//! Coordinates become integers that keep their order. A radix sort orders the boxes by their lower bound on one axis,
//! or repairs the order of the last call. Each coordinate has an array of its own, which ends in sentinels that lie
//! above every box. The sweep compares one box with a vector of boxes ahead of it on all axes. It writes pairs without
//! a branch for each hit.
//!
//! It measures how far one axis goes for small scenes and for scenes along a line.

mod order;
mod sorted;
#[cfg(target_arch = "x86_64")]
mod vectors;

use anyhow::Result;
use sweep_and_prune::Aabb;

use self::order::Order;
use self::sorted::{SENTINELS, Sorted};
use super::library::{Finder, Library, Origin};

/// The name of this method in results.
pub const NAME: &str = "one-axis sweep, vectorized";

/// The widest vector that the processor has.
pub const LIBRARY: Library = Library {
    name: NAME,
    origin: Origin::Here,
    how: "written for this benchmark after the published description of box pruning: integer keys, a radix sort that \
          repairs the order of the last call, one array for each coordinate, AVX-512 or AVX2",
    alternative: true,
    two: Some(|| Box::new(OneAxis::default())),
    three: Some(|| Box::new(OneAxis::default())),
};

struct OneAxis<const D: usize> {
    order: Order,
    sorted: Sorted<D>,
    /// A buffer that is at least as long as the pairs found last.
    pairs: Vec<[u32; 2]>,
}

impl<const D: usize> Default for OneAxis<D> {
    fn default() -> Self {
        Self { order: Order::default(), sorted: Sorted::new(), pairs: Vec::new() }
    }
}

impl<const D: usize> Finder<D> for OneAxis<D> {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        let axis = self.order.sort(boxes);
        self.sorted.fill(boxes, self.order.items(), axis);
        let found = sweep(&self.sorted, boxes.len(), &mut self.pairs);
        Ok(&self.pairs[..found])
    }

    // The order of the last call would be the right one already.
    fn forget(&mut self, shuffled: &[Aabb<D>]) -> Result<()> {
        self.find(shuffled)?;
        Ok(())
    }
}

/// Writes the pairs of the first `count` sorted boxes to the front of `pairs`, which grows if needed, and returns how
/// many there are.
fn sweep<const D: usize>(sorted: &Sorted<D>, count: usize, pairs: &mut Vec<[u32; 2]>) -> usize {
    #[cfg(target_arch = "x86_64")]
    if let Some(found) = vectors::sweep(sorted, count, pairs) {
        return found;
    }
    sweep_scalar(sorted, count, pairs)
}

/// The definition of the sweep, for processors without such vectors.
fn sweep_scalar<const D: usize>(
    sorted: &Sorted<D>,
    count: usize,
    pairs: &mut Vec<[u32; 2]>,
) -> usize {
    let mut found = 0;
    for a in 0..count {
        let limit = sorted.max[0][a];
        let mut b = a + 1;
        while sorted.min[0][b] <= limit {
            if found == pairs.len() {
                pairs.resize(2 * found + SENTINELS, [0; 2]);
            }
            pairs[found] = [sorted.ids[a], sorted.ids[b]];
            let overlaps = |axis: usize| {
                sorted.min[axis][b] <= sorted.max[axis][a]
                    && sorted.min[axis][a] <= sorted.max[axis][b]
            };
            found += usize::from((1..D).all(overlaps));
            b += 1;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use sweep_and_prune_scenes::{Motion, Random, Scene, brute_force};

    use super::*;

    fn sorted_pairs(pairs: &[[u32; 2]]) -> Vec<[u32; 2]> {
        let mut pairs: Vec<_> = pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        pairs.sort_unstable();
        pairs
    }

    /// The pairs of every sweep that this processor can run.
    fn check<const D: usize>(method: &mut OneAxis<D>, boxes: &[Aabb<D>]) {
        let right = sorted_pairs(&brute_force(boxes).unwrap());
        assert_eq!(sorted_pairs(method.find(boxes).unwrap()), right);
        let mut pairs = Vec::new();
        let found = sweep_scalar(&method.sorted, boxes.len(), &mut pairs);
        assert_eq!(sorted_pairs(&pairs[..found]), right);
        #[cfg(target_arch = "x86_64")]
        for sweep in vectors::available() {
            let mut pairs = Vec::new();
            let found = sweep(&method.sorted, boxes.len(), &mut pairs);
            assert_eq!(sorted_pairs(&pairs[..found]), right);
        }
    }

    /// Boxes on a small lattice, so that most bounds are tied, some of them zeros of either sign or infinite.
    fn ties<const D: usize>(random: &mut Random, count: usize) -> Vec<Aabb<D>> {
        let steps = [f32::NEG_INFINITY, -3.0, -1.0, -0.0, 0.0, 1.0, 2.0, 1e30, f32::INFINITY];
        let mut step = || steps[random.below(steps.len())];
        let aabb = |_| {
            let corners: [[f32; 2]; D] = std::array::from_fn(|_| [step(), step()]);
            Aabb::new(corners.map(|[a, b]| a.min(b)), corners.map(|[a, b]| a.max(b)))
        };
        (0..count).map(aabb).collect()
    }

    fn all_in<const D: usize>() {
        let mut method = OneAxis::<D>::default();
        let mut random = Random::new(7);
        for count in [0, 1, 2, 3, 15, 16, 17, 31, 32, 33, 70, 150, 149, 20] {
            for _ in 0..6 {
                check(&mut method, &ties(&mut random, count));
            }
        }
        for scene in Scene::ALL.iter().filter(|scene| scene.dimensions().contains(&D)) {
            for count in [300, 700] {
                let boxes = scene.boxes(count, 3).unwrap();
                check(&mut method, &boxes);
            }
        }
        for motion in Motion::ALL {
            let mut moving = motion.start::<D, f32>(400, 5).unwrap();
            for _ in 0..4 {
                check(&mut method, moving.boxes());
                moving.advance();
            }
        }
    }

    #[test]
    fn a_scene_at_rest_is_sorted_in_each_call() {
        let boxes = Scene::Uniform.boxes::<2, f32>(500, 3).unwrap();
        let mut shuffled = boxes.clone();
        Random::new(7).shuffle(&mut shuffled);
        let mut method = OneAxis::default();
        let mut order_after = |boxes: &[Aabb<2>]| {
            method.find(boxes).unwrap();
            method.forget(&shuffled).unwrap();
            method.order.items().to_vec()
        };
        assert_eq!(order_after(&boxes), order_after(&shuffled));
    }

    #[test]
    fn pairs_equal_brute_force_with_ties_on_all_scenes_and_on_motions() {
        all_in::<2>();
        all_in::<3>();
    }
}
