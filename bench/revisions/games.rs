//! Worlds as games have them: a few bodies move among many at rest, or in a heap in which each touches many others.

use old::Aabb;
use scenes::Random;

use crate::{Moving, SEED};

pub struct Kind {
    pub name: &'static str,
    /// Whether the bodies touch all that are next to them, or few do.
    is_heap: bool,
    /// How many bodies move in each frame, for each body.
    movers: f64,
    /// How far each moves at most, in sides of its box.
    speed: f64,
    /// Whether other bodies move in each frame, from where they were at first, or always the same, straight on.
    in_turn: bool,
    /// Whether those that never move are static.
    statics: bool,
}

const NONE: Kind =
    Kind { name: "", is_heap: false, movers: 0.0, speed: 0.0, in_turn: false, statics: false };

pub const ALL: &[Kind] = &[
    Kind { name: "slow-among-static", movers: 0.1, speed: 0.1, statics: true, ..NONE },
    Kind { name: "medium-among-static", movers: 0.1, speed: 0.4, statics: true, ..NONE },
    Kind { name: "fast-among-static", movers: 0.1, speed: 1.0, statics: true, ..NONE },
    Kind { name: "few-fast-among-static", movers: 0.02, speed: 1.0, statics: true, ..NONE },
    Kind { name: "slow-among-resting", movers: 0.1, speed: 0.1, ..NONE },
    Kind { name: "medium-among-resting", movers: 0.1, speed: 0.4, ..NONE },
    Kind { name: "fast-among-resting", movers: 0.1, speed: 1.0, ..NONE },
    Kind { name: "few-fast-among-resting", movers: 0.02, speed: 1.0, ..NONE },
    Kind { name: "heap-trembles", is_heap: true, movers: 0.08, speed: 0.1, in_turn: true, ..NONE },
    Kind {
        name: "heap-trembles-a-little",
        is_heap: true,
        movers: 0.02,
        speed: 0.1,
        in_turn: true,
        ..NONE
    },
    Kind { name: "heap-jumps", is_heap: true, movers: 0.03, speed: 0.8, in_turn: true, ..NONE },
    Kind {
        name: "heap-jumps-much",
        is_heap: true,
        movers: 0.06,
        speed: 0.8,
        in_turn: true,
        ..NONE
    },
    Kind { name: "heap-with-fast", is_heap: true, movers: 0.02, speed: 1.0, ..NONE },
];

pub struct Game<'a, const D: usize> {
    kind: &'a Kind,
    boxes: Vec<Aabb<D>>,
    /// Where the bodies were at first.
    places: Vec<[f64; D]>,
    velocities: Vec<[f64; D]>,
    random: Random,
    extent: f64,
}

impl<'a, const D: usize> Game<'a, D> {
    /// Unit boxes: in a heap one beside the other, so that they touch, else with nine times their own space.
    pub fn new(kind: &'a Kind, count: usize) -> Self {
        let mut random = Random::new(SEED);
        let side = (count as f64).powf(1.0 / D as f64).ceil() as usize;
        let extent =
            if kind.is_heap { side as f64 } else { (9.0 * count as f64).powf(1.0 / D as f64) };
        let mut places: Vec<[f64; D]> = (0..count)
            .map(|body| {
                if kind.is_heap {
                    std::array::from_fn(|axis| (body / side.pow(axis as u32) % side) as f64)
                } else {
                    random.point().map(|at| at * extent)
                }
            })
            .collect();
        random.shuffle(&mut places);
        let velocities =
            places.iter().map(|_| random.point().map(|at| kind.speed * (2.0 * at - 1.0))).collect();
        let boxes = places.iter().map(cube).collect();
        Self { kind, boxes, places, velocities, random, extent }
    }

    fn movers(&self) -> usize {
        (self.kind.movers * self.boxes.len() as f64) as usize
    }
}

impl<const D: usize> Moving<D> for Game<'_, D> {
    fn boxes(&self) -> &[Aabb<D>] {
        &self.boxes
    }

    fn advance(&mut self) {
        for mover in 0..self.movers() {
            if self.kind.in_turn {
                let body = self.random.below(self.boxes.len());
                let jump = self.random.point::<D>().map(|at| self.kind.speed * (at - 0.5));
                let place = std::array::from_fn(|axis| self.places[body][axis] + jump[axis]);
                self.boxes[body] = cube(&place);
                continue;
            }
            for axis in 0..D {
                let (place, velocity) =
                    (&mut self.places[mover][axis], &mut self.velocities[mover][axis]);
                *place += *velocity;
                if !(0.0..self.extent).contains(place) {
                    *velocity = -*velocity;
                    *place += 2.0 * *velocity;
                }
            }
            self.boxes[mover] = cube(&self.places[mover]);
        }
    }

    fn is_static(&self, body: usize) -> bool {
        self.kind.statics && body >= self.movers()
    }
}

fn cube<const D: usize>(place: &[f64; D]) -> Aabb<D> {
    Aabb::new(place.map(|at| at as f32), place.map(|at| (at + 1.0) as f32))
}
