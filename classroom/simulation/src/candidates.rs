//! The pairs that may touch within a step: found once, and updated until the step ends.

use std::array::from_fn;

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::{Counts, Error};

use crate::bodies::Bodies;
use crate::broad_phase::Engine;
use crate::contacts::Contacts;
use crate::enclosures::{Ahead, Enclosures};
use crate::grid::Grid;
use crate::order::PairOrder;
use crate::vector::{bounding_box, greater};

/// If more than one in this many balls leave their boxes, the pairs of all balls are found from
/// scratch.
const MOST_LEAVING: usize = 8;

/// For each ball a box that should hold it to the end of the step, and the pairs of boxes that
/// overlap.
///
/// The broad phase runs once a step, over boxes that are large enough for all its substeps
/// (Müller et al. 2020, "Detailed rigid body simulation with extended position based dynamics",
/// §3.5). In addition, a ball that is about to leave its box in a substep, because a bounce sent it
/// elsewhere, gets a larger box, which is tested against all boxes near it. So no contact is missed, and
/// the motion is bit for bit what a broad phase in every substep would give.
#[derive(Debug, Default)]
pub struct Candidates<const D: usize> {
    enclosures: Enclosures<D>,
    /// Sorted by their indices, once [`Self::sort`] was called.
    pub pairs: Vec<[u32; 2]>,
    /// How many of them are sorted: the others were found since.
    sorted: usize,
    order: PairOrder,
    /// The balls that are about to leave their boxes, ascending.
    leaving: Vec<u32>,
    /// Whether the boxes are new, and their pairs not yet found.
    is_stale: bool,
    near: Neighborhood<D>,
}

impl<const D: usize> Candidates<D> {
    /// By ball.
    pub fn boxes(&self) -> &[Aabb<D>] {
        &self.enclosures.boxes
    }

    /// Makes the boxes for a new step. `contacts` are what the substep before found.
    pub fn enclose(&mut self, bodies: &Bodies<D>, contacts: &Contacts, ahead: &Ahead<D>) {
        self.enclosures.enclose_all(bodies, contacts, ahead);
        self.is_stale = true;
        self.near.is_stale = true;
    }

    /// Makes larger boxes for the balls that would leave theirs in this substep, and finds the
    /// pairs that this adds.
    ///
    /// A box only grows, so its pairs stay: a pair is new if it overlaps the box and did not
    /// overlap the box that it was. Where many balls leave, all boxes are made from scratch.
    pub fn update(&mut self, bodies: &Bodies<D>, contacts: &Contacts, ahead: &Ahead<D>) {
        self.enclosures.list_leaving(bodies, ahead, &mut self.leaving);
        if self.leaving.len() > bodies.len() / MOST_LEAVING {
            self.enclose(bodies, contacts, ahead);
            return;
        }
        for &ball in &self.leaving {
            self.near.refresh(&self.enclosures);
            let before = self.enclosures.enclose_too(ball, bodies, ahead);
            let boxes = &self.enclosures.boxes;
            let own = &boxes[ball as usize];
            self.near.grown(ball, own);
            for &other in self.near.overlapping(own, boxes) {
                if !overlap(&before, &boxes[other as usize]) && other != ball {
                    self.pairs.push([ball.min(other), ball.max(other)]);
                }
            }
        }
    }

    /// What the engine would do next, counted, if it is its turn; the library's finder counts nothing.
    pub fn count(&self, engine: &Engine<D>) -> Result<Option<Counts>, Error> {
        engine.count(self.boxes())
    }

    /// Has the engine find the pairs if the boxes are all new, and says whether they were.
    pub fn find(&mut self, engine: &mut Engine<D>) -> Result<bool, Error> {
        let is_stale = std::mem::take(&mut self.is_stale);
        if is_stale {
            self.pairs.clear();
            self.pairs.extend_from_slice(engine.find(&self.enclosures.boxes)?);
            self.sorted = 0;
        }
        Ok(is_stale)
    }

    /// Sorts the pairs. They last for several substeps, so this costs less than sorting the touching pairs in each
    /// substep.
    pub fn sort(&mut self) {
        self.order.sort(&mut self.pairs, self.sorted, self.enclosures.boxes.len());
        self.sorted = self.pairs.len();
    }
}

/// Which boxes may be near another: a grid of the places where they began to grow.
#[derive(Debug)]
struct Neighborhood<const D: usize> {
    grid: Grid<D>,
    /// By ball, the middle of its box when it was put into the grid.
    places: Vec<[f32; D]>,
    /// By ball, its cell.
    cells: Vec<u32>,
    /// The balls, cell by cell.
    balls: Vec<u32>,
    /// Where the balls of each cell begin, and, as a last number, where all end.
    starts: Vec<u32>,
    /// What a search finds. It holds all balls, and one more that does not count.
    found: Vec<u32>,
    /// By axis, no box reaches further than this from its place.
    reach: [f32; D],
    /// Whether the boxes have been made from scratch since.
    is_stale: bool,
}

impl<const D: usize> Default for Neighborhood<D> {
    fn default() -> Self {
        Self {
            grid: Grid::default(),
            places: Vec::new(),
            cells: Vec::new(),
            balls: Vec::new(),
            starts: Vec::new(),
            found: Vec::new(),
            reach: [0.0; D],
            is_stale: false,
        }
    }
}

impl<const D: usize> Neighborhood<D> {
    /// Puts all boxes into the grid, if that has not been done in this step. O(boxes).
    fn refresh(&mut self, enclosures: &Enclosures<D>) {
        if !std::mem::take(&mut self.is_stale) {
            return;
        }
        self.places.clear();
        self.places.extend(enclosures.middles());
        self.reach = enclosures.widest.map(|side| 0.5 * side);
        // Cells are twice as wide as boxes reach: visiting fewer rows saves more than visiting fewer balls.
        let widths = self.reach.map(|reach| 2.0 * reach);
        self.grid = Grid::new(&bounding_box(&self.places), self.places.len(), widths);

        self.cells.clear();
        self.cells.extend(self.places.iter().map(|&place| self.grid.cell(place) as u32));
        self.starts.clear();
        self.starts.resize(self.grid.len() + 1, 0);
        for &cell in &self.cells {
            self.starts[cell as usize] += 1;
        }
        let mut total = 0;
        for start in &mut self.starts {
            total += *start;
            *start = total;
        }
        self.found.resize(self.cells.len() + 1, 0);
        // Each cell is filled from its end, so that its end becomes its beginning.
        self.balls.resize(self.cells.len(), 0);
        for (ball, &cell) in (0..).zip(&self.cells) {
            let place = &mut self.starts[cell as usize];
            *place -= 1;
            self.balls[*place as usize] = ball;
        }
    }

    /// Notes that a box has become this large.
    fn grown(&mut self, ball: u32, aabb: &Aabb<D>) {
        for (axis, place) in self.places[ball as usize].into_iter().enumerate() {
            let sides = greater(place - aabb.min[axis], aabb.max[axis] - place);
            self.reach[axis] = greater(sides, self.reach[axis]);
        }
    }

    /// The balls whose boxes overlap this one.
    fn overlapping(&mut self, aabb: &Aabb<D>, boxes: &[Aabb<D>]) -> &[u32] {
        // Slightly more, because places and reaches are rounded.
        let region = Aabb::new(
            from_fn(|axis| aabb.min[axis] - 1.01 * self.reach[axis]),
            from_fn(|axis| aabb.max[axis] + 1.01 * self.reach[axis]),
        );
        let mut count = 0;
        self.grid.any_row(&region, |cells| {
            let [begin, end] = [cells.start, cells.end].map(|cell| self.starts[cell] as usize);
            // Each is written, and counts only if it overlaps: a branch would be mispredicted.
            for &ball in &self.balls[begin..end] {
                self.found[count] = ball;
                count += usize::from(overlap(aabb, &boxes[ball as usize]));
            }
            false
        });
        &self.found[..count]
    }
}

/// [`Aabb::overlaps`] without a branch, which would be mispredicted.
fn overlap<const D: usize>(a: &Aabb<D>, b: &Aabb<D>) -> bool {
    (0..D).fold(true, |all, axis| all & (a.min[axis] <= b.max[axis]) & (b.min[axis] <= a.max[axis]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broad_phase::BroadPhase;
    use crate::contacts::Surroundings;
    use crate::rows::Rows;
    use crate::scenes::{self, Population};
    use crate::setup::Setup;
    use sweep_and_prune_scenes::Random;

    /// Balls that are sent elsewhere in each substep, as by bounces: some of them, or all.
    fn assert_complete<const D: usize>(setup: &Setup<D>, share: f64, speed: f32) {
        let mut engine = Engine::new(BroadPhase::Library).unwrap();
        let mut candidates = Candidates::default();
        let mut bodies = Bodies::new(&setup.balls);
        let (mut contacts, mut rows) = (Contacts::default(), Rows::default());
        let mut random = Random::new(3);
        let around = Surroundings { bounds: setup.bounds, gravity: setup.gravity, time: 0.004 };
        let (mut followed, mut touched) = (0, 0);
        for substep in 0..24 {
            let ahead = Ahead {
                kick: setup.gravity.map(|g| g * 0.002),
                gravity: setup.gravity,
                time: 0.004,
                substeps: 8 - substep % 8,
            };
            if substep % 8 == 0 {
                candidates.enclose(&bodies, &contacts, &ahead);
            } else {
                candidates.update(&bodies, &contacts, &ahead);
            }
            followed += u32::from(!candidates.find(&mut engine).unwrap());

            let mut expected = sweep_and_prune::find_pairs(candidates.boxes()).unwrap();
            expected.sort_unstable();
            candidates.sort();
            assert_eq!(candidates.pairs, expected, "substep {substep}");
            rows.load(&bodies);
            contacts.find(&candidates.pairs, &bodies, &rows, &around);
            touched += contacts.touching().len();

            for (ball, large) in candidates.boxes().iter().enumerate() {
                let (radius, at) = (bodies.radii[ball], bodies.positions[ball]);
                for axis in 0..D {
                    let speed = bodies.velocities[ball][axis] + ahead.kick[axis];
                    for at in [at[axis], at[axis] + speed * ahead.time] {
                        assert!(large.min[axis] <= at - radius, "ball {ball}, substep {substep}");
                        assert!(large.max[axis] >= at + radius, "ball {ball}, substep {substep}");
                    }
                }
            }
            bodies.kick(ahead.kick);
            bodies.drift(ahead.time, &setup.bounds);
            for velocity in &mut bodies.velocities {
                if random.unit() < share {
                    *velocity = from_fn(|_| (random.unit() as f32 * 2.0 - 1.0) * speed);
                }
            }
        }
        assert!(touched > 0 || share == 0.0, "some were to touch");
        assert!(followed > 0 || share > 0.2, "the engine was to rest now and then");
    }

    #[test]
    fn pairs_are_those_of_the_boxes_and_the_boxes_hold_the_balls() {
        for (spread, seed) in [(1.0, 1), (20.0, 2)] {
            let population = Population { bodies: 400, size: 0.3, spread, seed };
            let flat = scenes::falling::<2>(population).unwrap();
            let solid = scenes::falling::<3>(population).unwrap();
            for (share, speed) in [(0.0, 0.0), (0.01, 8.0), (0.08, 40.0), (0.5, 8.0)] {
                assert_complete(&flat, share, speed);
                assert_complete(&solid, share, speed);
            }
        }
    }
}
