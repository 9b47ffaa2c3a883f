//! What a claim may refer to, counted without the algorithm that is measured.

use sweep_and_prune::find_pairs;
use sweep_and_prune_algorithms::Endpoint;

use crate::worlds::{Boxes, World};

/// The size of a step in every sense that matters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Facts {
    /// Boxes.
    pub n: f64,
    /// Pairs that overlap on the sweep axis, x.
    pub m: f64,
    /// The same, summed over both axes.
    pub m_all: f64,
    /// Pairs of endpoints on x whose order is not that of the step before, or, in a first step,
    /// of the list of boxes.
    pub s: f64,
    /// The same, summed over both axes.
    pub s_all: f64,
    /// The same as `s`, left endpoints alone.
    pub s_left: f64,
    /// Pairs that overlap on both axes.
    pub p: f64,
}

impl Facts {
    /// Counts them. O(n log n), and what it takes to find the pairs, where the world does not say
    /// how many there are.
    pub fn of(world: World, before: Option<&Boxes>, now: &Boxes) -> Self {
        let [x, y] = [0, 1];
        let (m_x, m_y) = (overlaps(now, x), overlaps(now, y));
        let pairs = match world {
            World::Heap => m_x,
            World::Rest | World::Tower | World::Mirror | World::QuicksortKiller => 0,
            _ => find_pairs(now).expect("valid boxes").len() as u64,
        };
        let (s_x, s_y) = (inversions(before, now, x, 2), inversions(before, now, y, 2));
        Self {
            n: now.len() as f64,
            m: m_x as f64,
            m_all: (m_x + m_y) as f64,
            s: s_x as f64,
            s_all: (s_x + s_y) as f64,
            s_left: inversions(before, now, x, 1) as f64,
            p: pairs as f64,
        }
    }
}

/// All pairs less those in which one ends before the other begins.
fn overlaps(boxes: &Boxes, axis: usize) -> u64 {
    let mut lefts: Vec<f64> = boxes.iter().map(|aabb| aabb.min[axis]).collect();
    let mut rights: Vec<f64> = boxes.iter().map(|aabb| aabb.max[axis]).collect();
    lefts.sort_by(f64::total_cmp);
    rights.sort_by(f64::total_cmp);
    let apart: usize = lefts.iter().map(|left| rights.partition_point(|right| right < left)).sum();
    let n = boxes.len() as u64;
    n * n.saturating_sub(1) / 2 - apart as u64
}

/// How many pairs of endpoints of `now` are out of order where the array still has the order of `before`. If `sides` is 1,
/// only left endpoints count.
fn inversions(before: Option<&Boxes>, now: &Boxes, axis: usize, sides: usize) -> u64 {
    let endpoints = |boxes: &Boxes| {
        let mut all = Vec::new();
        for (aabb, id) in boxes.iter().zip(0..) {
            all.push(Endpoint::left(aabb.min[axis], id));
            all.push(Endpoint::right(aabb.max[axis], id));
        }
        all.retain(|endpoint| (endpoint.edge.side as usize) < sides);
        all
    };
    let sorted = |boxes| {
        let mut all = endpoints(boxes);
        all.sort_by(Endpoint::order);
        all
    };
    let order = before.map_or_else(|| endpoints(now), sorted);
    // The place of each edge in the order of now, by 2 * id + side.
    let mut places = vec![0; 2 * now.len()];
    for (place, endpoint) in sorted(now).iter().enumerate() {
        places[2 * endpoint.edge.id as usize + endpoint.edge.side as usize] = place;
    }
    let place = |e: &Endpoint<f64>| places[2 * e.edge.id as usize + e.edge.side as usize];
    count_inversions(&mut order.iter().map(place).collect::<Vec<_>>())
}

/// Sorts by merging and counts what jumps ahead.
fn count_inversions(values: &mut [usize]) -> u64 {
    let middle = values.len() / 2;
    if middle == 0 {
        return 0;
    }
    let (left, right) = values.split_at_mut(middle);
    let mut count = count_inversions(left) + count_inversions(right);
    let (mut i, mut merged) = (0, Vec::with_capacity(values.len()));
    let (left, right) = values.split_at(middle);
    for &value in right {
        while i < left.len() && left[i] < value {
            merged.push(left[i]);
            i += 1;
        }
        count += (left.len() - i) as u64;
        merged.push(value);
    }
    merged.extend(&left[i..]);
    values.copy_from_slice(&merged);
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_worlds_have_the_known_facts() {
        let of = |world: World| {
            let (before, now) = world.steps(100);
            Facts::of(world, before.as_ref(), &now)
        };
        assert_eq!((of(World::Rest).m, of(World::Rest).s), (0.0, 0.0));
        assert_eq!((of(World::Heap).m, of(World::Heap).m_all), (4950.0, 9900.0));
        assert_eq!((of(World::Tower).m, of(World::Tower).m_all), (4950.0, 4950.0));
        let mirror = of(World::Mirror);
        assert_eq!((mirror.s, mirror.s_left, mirror.m), (2.0 * 100.0 * 99.0, 4950.0, 0.0));
    }
}
