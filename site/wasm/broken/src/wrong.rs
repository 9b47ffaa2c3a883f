//! Broken variants: algorithms with one common mistake each, shown on purpose, so that a demo can show
//! the effect: pairs that flicker, pairs that are missed. Never use them for anything else.
//!
//! They report to an observer and take the axis and the boxes as the correct algorithms in
//! `classroom/algorithms/` do.

use alloc::vec::Vec;
use core::mem;

use sweep_and_prune::{Aabb, validate};
use sweep_and_prune_algorithms::{Axis, Edge, Endpoint, Error, Observer, Separation, Side};

/// Which mistake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// The swap-driven sweep, whose insertion sort stops at a strict `<` of the coordinates: equal
    /// ones change places in every step, and boxes that touch begin and cease to overlap in turn.
    StrictTies,
    /// The swap-driven sweep begun on endpoints that were sorted first: what overlaps then makes
    /// no swap, so it is not seen until it has parted and met again.
    SortedStart,
    /// Sorted pairwise, but by center: the scan still breaks at the first left edge beyond, after
    /// which a larger box may come that reaches back.
    SortByCenter,
}

impl Wrong {
    const ALL: [Wrong; 3] = [Wrong::StrictTies, Wrong::SortedStart, Wrong::SortByCenter];

    /// The name by which it is chosen, which says that it is wrong.
    pub const fn name(self) -> &'static str {
        match self {
            Wrong::StrictTies => "strict ties (wrong)",
            Wrong::SortedStart => "sorted start (wrong)",
            Wrong::SortByCenter => "sort by center (wrong)",
        }
    }

    /// The one of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|wrong| wrong.name() == name)
    }
}

/// Runs a wrong algorithm over the boxes of one step after another. With another number of boxes
/// it starts from scratch.
#[derive(Clone, Debug)]
pub struct WrongRunner<const D: usize> {
    wrong: Wrong,
    axis: Axis,
    last_axis: usize,
    boxes: usize,
    /// The endpoints, or, sorted by center, the left ones.
    array: Vec<Endpoint<f64>>,
    /// What it believes to overlap on the axis, sorted.
    overlapping: Vec<[u32; 2]>,
    pairs: Vec<[u32; 2]>,
    /// The pairs of this step and of the last one, sorted.
    held: [Vec<[u32; 2]>; 2],
}

impl<const D: usize> WrongRunner<D> {
    /// A runner that has seen nothing yet.
    pub fn new(wrong: Wrong, axis: Axis) -> Self {
        Self {
            wrong,
            axis,
            last_axis: 0,
            boxes: 0,
            array: Vec::new(),
            overlapping: Vec::new(),
            pairs: Vec::new(),
            held: Default::default(),
        }
    }

    /// Finds what it takes for the pairs of these boxes. Returns the axis that it swept.
    ///
    /// # Errors
    /// As [`Runner::step`](sweep_and_prune_algorithms::Runner::step); then nothing has changed.
    pub fn step<O: Observer>(
        &mut self,
        boxes: &[Aabb<D, f64>],
        observer: &mut O,
    ) -> Result<usize, Error> {
        validate(boxes)?;
        let axis = self.axis.choose(boxes)?;
        let begins = self.boxes != boxes.len() || self.last_axis != axis;
        (self.boxes, self.last_axis) = (boxes.len(), axis);
        observer.step(axis, self.wrong != Wrong::SortByCenter);
        if begins {
            for &[a, b] in &mem::take(&mut self.overlapping) {
                observer.axis_apart(axis, a, b);
            }
            self.array = endpoints(boxes, self.wrong != Wrong::SortByCenter);
        }
        refresh(&mut self.array, boxes, axis);
        self.pairs.clear();
        if self.wrong == Wrong::SortByCenter {
            self.scan(boxes, axis, observer);
        } else {
            if begins && self.wrong == Wrong::SortedStart {
                self.array.sort_unstable_by(Endpoint::order);
            }
            observer.array(axis, &self.array);
            self.swap(axis, observer);
            for &[a, b] in &self.overlapping {
                test(boxes, axis, [a, b], observer, &mut self.pairs);
            }
        }
        self.report_changes(observer);
        Ok(axis)
    }

    /// The pairs of the last step, those that began with it and those that ended.
    pub fn found(&self) -> [Vec<[u32; 2]>; 3] {
        let [now, before] = &self.held;
        let only = |a: &[[u32; 2]], b: &[[u32; 2]]| {
            a.iter().copied().filter(|pair| b.binary_search(pair).is_err()).collect()
        };
        [self.pairs.clone(), only(now, before), only(before, now)]
    }

    /// The memory it works on, in bytes.
    pub fn bytes(&self) -> usize {
        self.array.capacity() * size_of::<Endpoint<f64>>()
            + self.overlapping.len() * size_of::<[u32; 2]>()
    }

    /// Insertion sort; each swap begins or ends an overlap.
    fn swap<O: Observer>(&mut self, axis: usize, observer: &mut O) {
        for i in 1..self.array.len() {
            for j in (0..i).rev() {
                let [first, second] = [self.array[j], self.array[j + 1]];
                observer.compare(second.edge, first.edge);
                let stays = match self.wrong {
                    Wrong::StrictTies => first.at < second.at, // the error
                    _ => first.precedes(&second),
                };
                if stays {
                    break;
                }
                observer.swap([j, j + 1], first.edge, second.edge);
                self.array.swap(j, j + 1);
                let [a, b] = pair(first.edge.id, second.edge.id);
                let place = self.overlapping.binary_search(&[a, b]);
                match (first.edge.side, second.edge.side, place) {
                    (Side::Right, Side::Left, Err(place)) => {
                        self.overlapping.insert(place, [a, b]);
                        observer.axis_overlap(axis, a, b);
                    }
                    (Side::Left, Side::Right, Ok(place)) => {
                        self.overlapping.remove(place);
                        observer.axis_apart(axis, a, b);
                    }
                    _ => {}
                }
            }
        }
    }

    /// Sorted by center, each box against those that follow until one begins after it ends.
    fn scan<O: Observer>(&mut self, boxes: &[Aabb<D, f64>], axis: usize, observer: &mut O) {
        let center = |endpoint: &Endpoint<f64>| {
            let aabb = &boxes[endpoint.edge.id as usize];
            aabb.min[axis] * 0.5 + aabb.max[axis] * 0.5
        };
        observer.array(axis, &self.array);
        for i in 1..self.array.len() {
            for j in (0..i).rev() {
                let [first, second] = [self.array[j], self.array[j + 1]];
                observer.compare(second.edge, first.edge);
                if center(&first) <= center(&second) {
                    break;
                }
                observer.swap([j, j + 1], first.edge, second.edge);
                self.array.swap(j, j + 1);
            }
        }
        for (i, left) in self.array.iter().enumerate() {
            let a = left.edge.id;
            observer.visit(i, left.edge);
            observer.enter(a);
            for next in &self.array[i + 1..] {
                let b = next.edge.id;
                // The error: what follows may begin earlier than this one.
                if next.at > boxes[a as usize].max[axis] {
                    observer.prune(Separation { axis, left: a, right: b });
                    break;
                }
                if boxes[a as usize].overlaps_on(axis, &boxes[b as usize]) {
                    let [a, b] = pair(a, b);
                    observer.axis_overlap(axis, a, b);
                }
                test(boxes, axis, [a, b], observer, &mut self.pairs);
            }
            observer.leave(a);
        }
    }

    fn report_changes<O: Observer>(&mut self, observer: &mut O) {
        self.held.swap(0, 1);
        self.held[0].clone_from(&self.pairs);
        self.held[0].sort_unstable();
        let [_, begun, ended] = self.found();
        begun.iter().for_each(|&[a, b]| observer.begin(a, b));
        ended.iter().for_each(|&[a, b]| observer.end(a, b));
    }
}

/// The box test, which is right.
fn test<const D: usize, O: Observer>(
    boxes: &[Aabb<D, f64>],
    axis: usize,
    [a, b]: [u32; 2],
    observer: &mut O,
    pairs: &mut Vec<[u32; 2]>,
) {
    let [box_a, box_b] = [&boxes[a as usize], &boxes[b as usize]];
    let separation = (axis..D).chain(0..axis).find_map(|axis| {
        if box_a.overlaps_on(axis, box_b) {
            return None;
        }
        let a_is_left = box_a.max[axis] < box_b.min[axis];
        let (left, right) = if a_is_left { (a, b) } else { (b, a) };
        Some(Separation { axis, left, right })
    });
    observer.test(a, b, separation);
    if separation.is_none() {
        let [a, b] = pair(a, b);
        observer.overlap(a, b);
        pairs.push([a, b]);
    }
}

/// The endpoints of all boxes in the order of the boxes, as if these lay one after another; or only the left ones.
fn endpoints<const D: usize>(boxes: &[Aabb<D, f64>], both: bool) -> Vec<Endpoint<f64>> {
    let ends = |id| [Endpoint::left(0.0, id), Endpoint::right(0.0, id)];
    let every = (0..boxes.len() as u32).flat_map(ends);
    every.filter(|endpoint| both || endpoint.edge.side == Side::Left).collect()
}

fn refresh<const D: usize>(array: &mut [Endpoint<f64>], boxes: &[Aabb<D, f64>], axis: usize) {
    for Endpoint { at, edge: Edge { side, id } } in array {
        let aabb = &boxes[*id as usize];
        *at = if *side == Side::Left { aabb.min[axis] } else { aabb.max[axis] };
    }
}

fn pair(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use alloc::vec;
    use sweep_and_prune::Error as BoxError;
    use sweep_and_prune_algorithms::{Counts, Player, Trace};
    use sweep_and_prune_scenes::brute_force;

    fn square(x: f64, y: f64, half: f64) -> Aabb<2, f64> {
        Aabb::new([x - half, y - half], [x + half, y + half])
    }

    fn pairs(runner: &mut WrongRunner<2>, boxes: &[Aabb<2, f64>]) -> Vec<[u32; 2]> {
        runner.step(boxes, &mut ()).unwrap();
        runner.found()[0].clone()
    }

    fn new(wrong: Wrong) -> WrongRunner<2> {
        WrongRunner::new(wrong, Axis::Fixed(0))
    }

    #[test]
    fn strict_ties_flicker_at_rest_and_are_right_without_ties() {
        let touching = [square(0.0, 0.0, 1.0), square(2.0, 0.0, 1.0)];
        let mut runner = new(Wrong::StrictTies);
        let frames: Vec<usize> = (0..6).map(|_| pairs(&mut runner, &touching).len()).collect();
        assert_eq!(frames, [1, 0, 1, 0, 1, 0]);
        let apart = [square(0.0, 0.0, 1.0), square(1.5, 0.0, 1.0), square(9.0, 0.0, 1.0)];
        let mut runner = new(Wrong::StrictTies);
        for _ in 0..3 {
            assert_eq!(pairs(&mut runner, &apart), brute_force(&apart).unwrap());
        }
    }

    #[test]
    fn a_sorted_start_loses_what_overlaps_until_it_has_parted() {
        let together = [square(0.0, 0.0, 2.0), square(1.0, 0.0, 2.0)];
        let parted = [square(0.0, 0.0, 2.0), square(9.0, 0.0, 2.0)];
        let mut runner = new(Wrong::SortedStart);
        assert_eq!(brute_force(&together).unwrap(), [[0, 1]]);
        assert_eq!(pairs(&mut runner, &together), [[0; 2]; 0]);
        assert_eq!(pairs(&mut runner, &together), [[0; 2]; 0]);
        assert_eq!(pairs(&mut runner, &parted), [[0; 2]; 0]);
        assert_eq!(pairs(&mut runner, &together), [[0, 1]]);
    }

    #[test]
    fn sorted_by_center_a_large_box_is_missed_behind_a_break() {
        let boxes = [square(0.0, 0.0, 1.0), square(3.0, 0.0, 1.0), square(4.0, 0.0, 4.0)];
        assert_eq!(brute_force(&boxes).unwrap(), [[0, 2], [1, 2]]);
        assert_eq!(pairs(&mut new(Wrong::SortByCenter), &boxes), [[1, 2]]);
        // If all boxes have one size, the order by center is the order by left edge.
        let same = [0.0, 1.5, 2.5, 9.0].map(|x| square(x, 0.0, 1.0));
        assert_eq!(pairs(&mut new(Wrong::SortByCenter), &same), brute_force(&same).unwrap());
    }

    #[test]
    fn what_they_tell_is_what_they_found() {
        let worlds = [
            vec![square(0.0, 0.0, 1.0), square(2.0, 0.0, 1.0), square(4.0, 0.0, 4.0)],
            vec![square(5.0, 0.0, 1.0), square(2.0, 0.5, 1.0), square(4.0, 0.0, 4.0)],
            vec![square(1.0, 0.0, 3.0)],
            vec![],
        ];
        for wrong in Wrong::ALL {
            assert_eq!(Wrong::from_name(wrong.name()), Some(wrong));
            let (mut runner, mut observer) = (new(wrong), (Counts::default(), Trace::new()));
            for boxes in &worlds {
                observer.0 = Counts::default();
                runner.step(boxes, &mut observer).unwrap();
                let mut player = Player::new(observer.1.clone());
                player.seek(usize::MAX);
                let mut found = runner.found()[0].clone();
                found.sort_unstable();
                let state = player.state();
                assert_eq!(Vec::from_iter(state.overlaps.iter().copied()), found, "{wrong:?}");
                assert_eq!(state.held, state.overlaps, "{wrong:?}");
                assert_eq!(state.counts.tests, observer.0.tests);
            }
            let nan = [square(0.0, f64::NAN, 1.0)];
            let refused = runner.step(&nan, &mut ());
            assert!(matches!(
                refused,
                Err(Error::Boxes(BoxError::InvalidBox { index: 0, axis: 1, .. }))
            ));
        }
    }
}
