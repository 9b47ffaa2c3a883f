//! The boxes of a world's bodies, sorted for many queries at once.
//!
//! ```text
//! if most bodies have the boxes that were sorted
//!     pairs with these, but for the bodies that changed, and pairs with the boxes of those
//! else a miss: the caller finds all pairs from scratch
//! after some misses, before the next query: sort the boxes of all bodies
//! ```
//!
//! Each call compares the sorted boxes with those that bodies have, so that nothing has to tell of changes, and no answer is of
//! an old box. Where all bodies move, sorted boxes are of no use: each time that they were sorted in vain, twice as many misses
//! have to come before they are again.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::sync::atomic::{AtomicU32, Ordering};

use crate::pairs::{PairFinder, SortedSet};
use crate::{Aabb, Scalar};

/// Boxes are sorted after this many misses, and after twice as many for each time in a row that they were sorted in vain.
const MISSES: u32 = 2;
/// No more often than this that number is doubled.
const MOST_DOUBLINGS: u32 = 9;
/// Sorted boxes are of use while at most one in this many has changed.
const CHANGED_ONE_IN: usize = 16;

/// The sorted boxes, and whether that is of use. It follows from the calls, and changes only how long they take.
#[derive(Debug, Default)]
pub struct SortedBodies<const D: usize, T> {
    sorted: Option<Box<Sorted<D, T>>>,
    misses: AtomicU32,
    doublings: u32,
    /// How many calls used the sorted boxes, and how many had when it was last asked to give them back.
    uses: AtomicU32,
    known_uses: u32,
}

/// The boxes of all slots, and the same sorted.
#[derive(Debug)]
struct Sorted<const D: usize, T> {
    boxes: Vec<Aabb<D, T>>,
    set: SortedSet<D, T>,
}

impl<const D: usize, T: Scalar> SortedBodies<D, T> {
    /// Gives up boxes that were of no use, and sorts those of now if there were enough misses.
    #[inline]
    pub fn prepare(&mut self, shapes: &[Aabb<D, T>]) {
        if *self.misses.get_mut() > 0 {
            self.prepare_after(shapes);
        }
    }

    #[inline(never)]
    fn prepare_after(&mut self, shapes: &[Aabb<D, T>]) {
        if self.sorted.take().is_some() {
            self.doublings = if *self.uses.get_mut() == 0 { self.doublings + 1 } else { 0 };
        }
        if *self.misses.get_mut() >= MISSES << self.doublings.min(MOST_DOUBLINGS) {
            self.sorted = sort(shapes);
            self.doublings += u32::from(self.sorted.is_none());
            [self.misses, self.uses] = Default::default();
            self.known_uses = 0;
        }
    }

    /// Gives up the sorted boxes if no call used them since it was last asked to.
    pub fn give_back(&mut self) {
        let known_uses = core::mem::replace(&mut self.known_uses, *self.uses.get_mut());
        if self.known_uses == known_uses {
            self.sorted = None;
        }
    }

    /// The pairs of boxes, which are valid, and bodies, whose boxes these are by index, in no particular order. None if there
    /// are no sorted boxes, or they are of no use, or there are many more pairs than `most`, or not enough memory.
    pub fn pairs_with(
        &self,
        areas: &[Aabb<D, T>],
        shapes: &[Aabb<D, T>],
        most: usize,
        finder: &mut PairFinder<D, T>,
    ) -> Option<Vec<[u32; 2]>> {
        let pairs = self.sorted.as_ref().and_then(|sorted| {
            let changes = Changes::between(&sorted.boxes, shapes)?;
            sorted.set.pairs_with(areas, most, finder).ok()??;
            changes.replace(finder, areas, shapes, most)
        });
        let counter = if pairs.is_some() { &self.uses } else { &self.misses };
        counter.fetch_add(1, Ordering::Relaxed);
        pairs
    }
}

impl<const D: usize, T: Scalar> Clone for SortedBodies<D, T> {
    /// Without sorted boxes.
    fn clone(&self) -> Self {
        Self::default()
    }

    /// Keeps its own: of no use for other bodies, but never wrong.
    fn clone_from(&mut self, _source: &Self) {}
}

fn sort<const D: usize, T: Scalar>(shapes: &[Aabb<D, T>]) -> Option<Box<Sorted<D, T>>> {
    let mut boxes = Vec::new();
    boxes.try_reserve_exact(shapes.len()).ok()?;
    boxes.extend_from_slice(shapes);
    Some(Box::new(Sorted { boxes, set: SortedSet::new(shapes, &mut PairFinder::new())? }))
}

/// Which bodies do not have the boxes that were sorted.
struct Changes {
    listed: Vec<u32>,
    /// By index, a bit for each box that was sorted.
    bits: Vec<u64>,
}

impl Changes {
    /// None if there are too many, or not enough memory.
    fn between<const D: usize, T: Scalar>(old: &[Aabb<D, T>], new: &[Aabb<D, T>]) -> Option<Self> {
        let most = old.len() / CHANGED_ONE_IN;
        if !(old.len()..=old.len() + most).contains(&new.len()) {
            return None;
        }
        let (mut listed, mut bits) = (Vec::new(), Vec::new());
        // There may be a word of bits more before it shows that there are too many.
        listed.try_reserve_exact(most + 64).ok()?;
        listed.extend(old.len() as u32..new.len() as u32);
        bits.try_reserve_exact(old.len().div_ceil(64)).ok()?;
        for (start, (old, new)) in (0..).step_by(64).zip(old.chunks(64).zip(new.chunks(64))) {
            let each = (0..).zip(old.iter().zip(new));
            let mut left =
                each.fold(0, |word, (at, (old, new))| word | u64::from(differ(old, new)) << at);
            bits.push(left);
            while left != 0 {
                listed.push(start + left.trailing_zeros());
                left &= left - 1;
            }
            if listed.len() > most {
                return None;
            }
        }
        Some(Self { listed, bits })
    }

    /// Drops the pairs with old boxes.
    #[inline(never)]
    fn drop_from(&self, pairs: &mut Vec<[u32; 2]>) {
        pairs.retain(|&[_, index]| self.bits[index as usize / 64] >> (index % 64) & 1 == 0);
    }

    /// Replaces the pairs with old boxes by those with new ones. None if there are too many, or not enough memory.
    fn replace<const D: usize, T: Scalar>(
        &self,
        finder: &mut PairFinder<D, T>,
        areas: &[Aabb<D, T>],
        shapes: &[Aabb<D, T>],
        most: usize,
    ) -> Option<Vec<[u32; 2]>> {
        let mut pairs = finder.take_pairs();
        if !self.listed.is_empty() {
            self.drop_from(&mut pairs);
            let mut changed = Vec::new();
            changed.try_reserve_exact(self.listed.len()).ok()?;
            changed.extend(self.listed.iter().map(|&index| shapes[index as usize]));
            let more = finder.search(areas).against(&changed).pairs_up_to(most).ok()??;
            more.iter_mut().for_each(|[_, at]| *at = self.listed[*at as usize]);
            pairs.try_reserve(more.len()).ok()?;
            pairs.extend_from_slice(more);
        }
        Some(pairs)
    }
}

/// Whether two boxes differ, without a branch.
#[inline(always)]
fn differ<const D: usize, T: Scalar>(a: &Aabb<D, T>, b: &Aabb<D, T>) -> bool {
    (0..D).fold(false, |differ, axis| {
        differ | (a.min[axis] != b.min[axis]) | (a.max[axis] != b.max[axis])
    })
}

#[cfg(test)]
mod tests {
    use alloc::vec;

    use super::*;
    use crate::{BroadPhase, Filter, Lists, Options, ProxyId, Report};

    /// Unit boxes 2 apart, of which each overlaps one of the same place.
    fn boxes(count: u16, y: f32) -> Vec<Aabb<2>> {
        let at = |x: u16| [f32::from(x % 128) * 2.0, f32::from(x / 128) * 2.0 + y];
        (0..count).map(|x| Aabb::new(at(x), at(x).map(|at| at + 1.0))).collect()
    }

    /// Asks once, as a world does between two changes. Returns whether sorted boxes were used; if so, the answer is checked.
    fn ask(sorted: &mut SortedBodies<2, f32>, bodies: &[Aabb<2>]) -> bool {
        sorted.prepare(bodies);
        let (areas, mut finder) = (boxes(4096, 0.5), PairFinder::new());
        let Some(mut pairs) = sorted.pairs_with(&areas, bodies, usize::MAX, &mut finder) else {
            return false;
        };
        let mut expected = finder.find_between(&areas, bodies).unwrap().to_vec();
        pairs.sort_unstable();
        expected.sort_unstable();
        assert!(pairs == expected);
        true
    }

    fn asked(sorted: &mut SortedBodies<2, f32>, bodies: &[Aabb<2>], times: usize) -> Vec<bool> {
        (0..times).map(|_| ask(sorted, bodies)).collect()
    }

    #[test]
    fn boxes_are_sorted_after_two_misses_and_used_while_few_change() {
        let (mut sorted, mut bodies) = (SortedBodies::default(), boxes(8192, 0.0));
        assert_eq!(asked(&mut sorted, &bodies, 4), [false, false, true, true]);
        // One in sixteen may change: moved, or new.
        for at in 0..312 {
            bodies[at * 26] = Aabb::new([0.0; 2], [70.0, 7.0]);
        }
        bodies.extend(boxes(200, 0.25));
        assert!(ask(&mut sorted, &bodies));
        bodies[1] = bodies[0];
        assert_eq!(asked(&mut sorted, &bodies, 4), [false, false, true, true]);
        // A world that lost bodies, as when it was cleared.
        bodies.truncate(8000);
        assert_eq!(asked(&mut sorted, &bodies, 3), [false, false, true]);
    }

    #[test]
    fn each_time_that_boxes_were_sorted_in_vain_twice_as_many_misses_are_waited_for() {
        let mut sorted = SortedBodies::default();
        let mut calls_until_sorted = vec![0];
        for frame in 0..70u16 {
            assert!(!ask(&mut sorted, &boxes(8192, f32::from(frame) * 0.01)));
            sorted.prepare(&boxes(8192, f32::from(frame) * 0.01));
            *calls_until_sorted.last_mut().unwrap() += 1;
            if sorted.sorted.is_some() {
                calls_until_sorted.push(0);
            }
        }
        assert_eq!(calls_until_sorted, [2, 4, 8, 16, 32, 8]);
        // Once they are used, two misses suffice again.
        let still = boxes(8192, 9.0);
        let first = asked(&mut sorted, &still, 100).iter().position(|&is_used| is_used);
        assert_eq!(first, Some(64 - 8));
        assert_eq!(asked(&mut sorted, &boxes(8192, 0.0), 3), [false, false, true]);
    }

    #[test]
    fn boxes_that_no_call_used_for_long_are_given_up_and_clones_have_none() {
        let (mut sorted, bodies) = (SortedBodies::default(), boxes(8192, 0.0));
        asked(&mut sorted, &bodies, 3);
        assert!(sorted.clone().sorted.is_none());
        sorted.give_back();
        assert!(ask(&mut sorted, &bodies));
        sorted.give_back();
        assert!(sorted.sorted.is_some());
        sorted.give_back();
        assert!(sorted.sorted.is_none());
    }

    #[test]
    fn boxes_that_no_grid_divides_are_not_sorted_again_and_again() {
        let mut sorted = SortedBodies::default();
        // Unit boxes in space, 2 apart, of which one in ten is as large as all.
        let at = |x: u16| [x % 27, x / 27 % 27, x / 729].map(|at| 2.0 * f32::from(at));
        let bodies = (0..27 * 27 * 27).map(|x| Aabb::new(at(x), at(x).map(|at| at + 1.0)));
        let mut bodies: Vec<_> = bodies.collect();
        bodies.iter_mut().step_by(10).for_each(|each| *each = Aabb::new([0.0; 3], [53.0; 3]));
        let areas = [Aabb::new([5.0; 3], [6.0; 3])];
        let mut tries = 0;
        for _ in 0..100 {
            assert!(
                sorted.pairs_with(&areas, &bodies, usize::MAX, &mut PairFinder::new()).is_none()
            );
            let misses = *sorted.misses.get_mut();
            sorted.prepare(&bodies);
            tries += usize::from(*sorted.misses.get_mut() < misses);
        }
        assert_eq!(tries, 5); // after 2, 4, 8, 16 and 32 misses
    }

    /// Asks a world, and checks what it answers.
    fn ask_world(world: &mut BroadPhase<2>) {
        let (areas, mut lists) = (boxes(8192, 0.5), Lists::new());
        world.queries().overlapping_many(&areas, &mut lists).unwrap();
        let ids: Vec<ProxyId> = world.ids().collect();
        let bodies: Vec<_> = ids.iter().map(|&id| world.aabb(id).unwrap()).collect();
        let mut expected = vec![Vec::new(); areas.len()];
        for &[area, body] in PairFinder::new().find_between(&areas, &bodies).unwrap() {
            expected[area as usize].push(ids[body as usize]);
        }
        expected.iter_mut().for_each(|ids| ids.sort_unstable());
        assert!(lists.iter().eq(&expected));
    }

    #[test]
    fn boxes_that_change_in_any_way_after_they_were_sorted_are_found() {
        // Each edit changes what is found.
        let near = |y: f32| Aabb::new([60.5, y], [60.75, y + 9.0]);
        let fat = Report::Fat { margin: 0.1, prediction: 2.0 };
        for report in [Report::Exact, fat] {
            let options = Options { report, ..Options::default() };
            let mut world = BroadPhase::<2>::with_options(options).unwrap();
            let ids = world.insert_many(&boxes(8192, 0.0), Filter::default()).unwrap();
            world.update();
            let other = world.clone();
            let edits: [&dyn Fn(&mut BroadPhase<2>); 11] = [
                &|world| world.set(ids[5], near(-0.48)).unwrap(),
                // A fat AABB stays the same.
                &|world| {
                    world.update();
                    let reported = world.reported_aabb(ids[5]).unwrap();
                    assert_eq!(reported.contains(&near(-0.52)), report.is_fat());
                    world.set(ids[5], near(-0.52)).unwrap();
                },
                &|world| world.set_many(&ids, &boxes(8192, 1.75)).unwrap(),
                &|world| world.teleport(ids[6], near(1.0)).unwrap(),
                &|world| world.set_swept(ids[7], near(2.0), near(30.0)).unwrap(),
                &|world| _ = world.update(),
                &|world| _ = world.insert(near(3.0)).unwrap(),
                &|world| {
                    world.remove(ids[8]).unwrap();
                    world.update();
                    world.insert(near(4.0)).unwrap();
                },
                &|world| world.shift([1.25, 0.0]).unwrap(),
                &|world| world.clone_from(&other),
                &|world| {
                    world.set_many(&ids[..99], &boxes(99, 1.75)).unwrap();
                    world.update();
                },
            ];
            for edit in edits {
                for _ in 0..9 {
                    ask_world(&mut world);
                }
                assert!(world.tracking.sorted.sorted.is_some());
                edit(&mut world);
                ask_world(&mut world);
            }
        }
    }
}
