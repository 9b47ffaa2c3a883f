//! The worlds in which the steps are counted: the easiest, the usual and the worst.

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::{Motion, Random};

/// Boxes in the plane; the sweep goes along x.
pub type Boxes = Vec<Aabb<2, f64>>;

/// A world of any size: what it was in the step before, if there was one, and what it is in the
/// step that is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum World {
    /// Disjoint boxes in order, at rest.
    Rest,
    /// A long level whose width grows with the number of boxes, all of which drift a little: the side-scroller of
    /// the usual analysis. m and s grow as n.
    Corridor,
    /// The first step of `Corridor`, where the boxes are in random order.
    CorridorStart,
    /// A square that fills with ever smaller boxes, in which all drift a little. Seen from one
    /// axis it gets crowded: m and s grow as n√n.
    Square,
    /// The first step of `Square`.
    SquareStart,
    /// All boxes in the same place, at rest: n(n-1)/2 pairs.
    Heap,
    /// A tower of plates, one above the other, at rest: n(n-1)/2 overlaps on x and not one pair.
    Tower,
    /// Disjoint boxes that all fly past one another: the mirror image of the step before.
    Mirror,
    /// Disjoint boxes, in the order in which quicksort with the median of three splits off only two endpoints at a time.
    QuicksortKiller,
}

impl World {
    /// Every world.
    pub const ALL: [World; 9] = [
        World::Rest,
        World::Corridor,
        World::CorridorStart,
        World::Square,
        World::SquareStart,
        World::Heap,
        World::Tower,
        World::Mirror,
        World::QuicksortKiller,
    ];

    /// A short name.
    pub const fn name(self) -> &'static str {
        match self {
            World::Rest => "rest",
            World::Corridor => "corridor",
            World::CorridorStart => "corridor, first step",
            World::Square => "square",
            World::SquareStart => "square, first step",
            World::Heap => "heap",
            World::Tower => "tower",
            World::Mirror => "mirror",
            World::QuicksortKiller => "quicksort's worst order",
        }
    }

    /// One line on what it is.
    pub const fn description(self) -> &'static str {
        match self {
            World::Rest => "disjoint boxes in order, at rest: m = s = 0",
            World::Corridor => {
                "a long level of constant density in which all drift a little: m and s grow as n"
            }
            World::CorridorStart => "the corridor's first step, the boxes in no order",
            World::Square => {
                "a square of constant filling in which all drift a little: m and s grow as n√n"
            }
            World::SquareStart => "the square's first step, the boxes in no order",
            World::Heap => "all boxes in one place, at rest: every pair overlaps",
            World::Tower => {
                "plates one above the other, swept from the side, at rest: m = n(n-1)/2 and no pair"
            }
            World::Mirror => {
                "disjoint boxes that become their mirror image in one step: s = 2n(n-1)"
            }
            World::QuicksortKiller => {
                "disjoint boxes in the order that is worst for the middle of three"
            }
        }
    }

    /// The worlds of n boxes of the step before, if there is one, and of the step to count.
    pub fn steps(self, n: usize) -> (Option<Boxes>, Boxes) {
        // Along the diagonal, so that they are disjoint on both axes.
        let row = |at: f64| Aabb::new([2.0 * at; 2], [2.0 * at + 1.0; 2]);
        let rest = |boxes: Boxes| (Some(boxes.clone()), boxes);
        match self {
            World::Rest => rest((0..n).map(|i| row(i as f64)).collect()),
            World::Corridor => {
                let (before, after) = corridor(n);
                (Some(before), after)
            }
            World::CorridorStart => (None, corridor(n).1),
            World::Square => {
                let (before, after) = square(n);
                (Some(before), after)
            }
            World::SquareStart => (None, square(n).1),
            World::Heap => rest(vec![Aabb::new([0.0; 2], [1.0; 2]); n]),
            World::Tower => rest((0..n).map(|i| plate(i as f64)).collect()),
            World::Mirror => {
                let before: Boxes = (0..n).map(|i| row(i as f64)).collect();
                (Some(before), (0..n).map(|i| row(-(i as f64))).collect())
            }
            World::QuicksortKiller => {
                (None, killer(n).into_iter().map(|rank| row(rank as f64)).collect())
            }
        }
    }
}

/// The drifting squares of the scenes, 1.2 pairs a box, and where a step takes them.
fn square(n: usize) -> (Boxes, Boxes) {
    let mut moving = Motion::Drift.start::<2, f64>(n, 1).expect("two dimensions");
    let before = moving.boxes().to_vec();
    moving.advance();
    (before, moving.boxes().to_vec())
}

fn plate(floor: f64) -> Aabb<2, f64> {
    Aabb::new([0.0, 2.0 * floor], [1.0, 2.0 * floor + 1.0])
}

/// Unit boxes in a corridor n long and 4 high, and where a tenth of a width takes them.
fn corridor(n: usize) -> (Boxes, Boxes) {
    let mut random = Random::new(7);
    let boxes = (0..n).map(|_| {
        let (x, y) = (random.unit() * n as f64, random.unit() * 4.0);
        let (dx, dy) = (random.unit() * 0.2 - 0.1, random.unit() * 0.2 - 0.1);
        let at = |x, y| Aabb::new([x, y], [x + 1.0, y + 1.0]);
        (at(x, y), at(x + dx, y + dy))
    });
    boxes.unzip()
}

/// The ranks of n keys in the order that is worst for the core's quicksort: Musser's idea (1997),
/// built by playing the partition backward. In each round the first key is made the least and the
/// middle one the second least, so the median of three is the middle one; the partition puts it
/// second and cuts off those two alone.
fn killer(n: usize) -> Vec<usize> {
    let mut places: Vec<usize> = (0..n).collect();
    let mut ranks = vec![0; n];
    let mut rest = &mut places[..];
    let mut rank = 0;
    while rest.len() > 8 {
        let middle = (rest.len() - 1) / 2;
        ranks[rest[0]] = rank;
        ranks[rest[middle]] = rank + 1;
        rest.swap(1, middle);
        rest = &mut rest[2..];
        rank += 2;
    }
    for &mut place in rest {
        ranks[place] = rank;
        rank += 1;
    }
    ranks
}
