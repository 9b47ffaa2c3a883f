//! Simulations of two and of three dimensions behind one trait, and what they start from.

use sweep_and_prune_algorithms::Counts;
use sweep_and_prune_exchange::clock;
use sweep_and_prune_simulation::scenes::{self, Population};
use sweep_and_prune_simulation::{Ball, BroadPhase, Moment, Setup, SetupError, Simulation};

use crate::code::Code;

/// The most balls of a random start.
pub const MOST_BODIES: f64 = 100_000.0;
/// The most balls that can be given. They may all overlap each other, and the pairs must fit in
/// memory.
pub const MOST_GIVEN: u32 = 4_096;

/// What the exports do with a simulation, whatever its dimensions.
pub trait DynSimulation {
    fn step(&mut self) -> Result<[f64; 10], Code>;
    fn describe(&self) -> [f64; 14];
    fn set(&mut self, setting: u32, value: f64) -> Result<(), Code>;
    fn set_broad_phase(&mut self, choice: BroadPhase) -> Result<(), Code>;
    fn positions(&self) -> &[f32];
    fn velocities(&self) -> &[f32];
    fn radii(&self) -> &[f32];
    fn pairs(&self) -> &[u32];
    fn energy(&self) -> f64;
    fn hash(&self) -> u64;
    fn save(&mut self) -> usize;
    fn restore(&mut self, moment: usize) -> Result<(), Code>;
    fn forget(&mut self, moment: usize);
    fn place(&mut self, ball: usize, center: [f32; 2], velocity: [f32; 2]) -> Result<(), Code>;
}

/// A simulation, and which way down is.
struct Inside<const D: usize> {
    simulation: Simulation<D>,
    /// The sign of gravity downwards on the second axis.
    down: f32,
    /// A saved moment is an index into these; places of forgotten ones are used again.
    moments: Vec<Option<Moment<D>>>,
    free_moments: Vec<usize>,
}

impl<const D: usize> DynSimulation for Inside<D> {
    fn step(&mut self) -> Result<[f64; 10], Code> {
        let report = self.simulation.step(clock).map_err(|_| Code::Internal)?;
        let counted = |count: fn(&Counts) -> u64| {
            report.counts.as_ref().map_or(-1.0, |counts| count(counts) as f64)
        };
        Ok([
            f64::from(report.broad_phases),
            counted(|counts| counts.tests),
            counted(|counts| counts.axis_overlaps),
            counted(|counts| counts.comparisons),
            counted(|counts| counts.swaps),
            report.pairs as f64,
            report.contacts as f64,
            report.broad_phase_ms,
            report.narrow_phase_ms,
            report.total_ms,
        ])
    }

    fn describe(&self) -> [f64; 14] {
        let simulation = &self.simulation;
        let bounds = simulation.bounds();
        let corner = |at: [f32; D]| {
            std::array::from_fn::<f64, 3, _>(|axis| at.get(axis).map_or(0.0, |&x| f64::from(x)))
        };
        let (min, max) = (corner(bounds.min), corner(bounds.max));
        [
            D as f64,
            simulation.radii().len() as f64,
            simulation.steps() as f64,
            min[0],
            min[1],
            min[2],
            max[0],
            max[1],
            max[2],
            f64::from(simulation.gravity()[1] * self.down),
            f64::from(simulation.restitution()),
            f64::from(simulation.substeps()),
            f64::from(u8::from(simulation.collisions())),
            f64::from(u8::from(simulation.counting())),
        ]
    }

    fn set(&mut self, setting: u32, value: f64) -> Result<(), Code> {
        if value.is_nan() {
            return Err(Code::InvalidOption);
        }
        let simulation = &mut self.simulation;
        let done = match setting {
            0 => {
                let limit = f64::from(Setup::<D>::GREATEST_LENGTH);
                let mut gravity = [0.0; D];
                gravity[1] = value.clamp(-limit, limit) as f32 * self.down;
                simulation.set_gravity(gravity)
            }
            1 => simulation.set_restitution(value.clamp(0.0, 1.0) as f32),
            2 => simulation
                .set_substeps(value.clamp(1.0, f64::from(Setup::<D>::MOST_SUBSTEPS)) as u32),
            3 => {
                simulation.set_collisions(value != 0.0);
                Ok(())
            }
            4 => {
                simulation.set_counting(value != 0.0);
                Ok(())
            }
            _ => return Err(Code::InvalidOption),
        };
        done.map_err(refusal)
    }

    fn set_broad_phase(&mut self, choice: BroadPhase) -> Result<(), Code> {
        self.simulation.set_broad_phase(choice).map_err(|_| Code::InvalidOption)
    }

    fn positions(&self) -> &[f32] {
        self.simulation.positions().as_flattened()
    }

    fn velocities(&self) -> &[f32] {
        self.simulation.velocities().as_flattened()
    }

    fn radii(&self) -> &[f32] {
        self.simulation.radii()
    }

    fn pairs(&self) -> &[u32] {
        self.simulation.pairs().as_flattened()
    }

    fn energy(&self) -> f64 {
        self.simulation.energy().total()
    }

    fn hash(&self) -> u64 {
        self.simulation.hash()
    }

    fn save(&mut self) -> usize {
        let index = self.free_moments.pop().unwrap_or(self.moments.len());
        if index == self.moments.len() {
            self.moments.push(None);
        }
        self.moments[index] = Some(self.simulation.save());
        index
    }

    fn restore(&mut self, moment: usize) -> Result<(), Code> {
        let Some(Some(moment)) = self.moments.get(moment) else {
            return Err(Code::InvalidOption);
        };
        self.simulation.restore(moment);
        Ok(())
    }

    fn forget(&mut self, moment: usize) {
        if self.moments.get_mut(moment).and_then(Option::take).is_some() {
            self.free_moments.push(moment);
        }
    }

    fn place(&mut self, ball: usize, center: [f32; 2], velocity: [f32; 2]) -> Result<(), Code> {
        // Further axes keep their coordinate and come to rest.
        let Some(&(mut at)) = self.simulation.positions().get(ball) else {
            return Err(Code::InvalidOption);
        };
        let mut speed = [0.0; D];
        at[..2].copy_from_slice(&center);
        speed[..2].copy_from_slice(&velocity);
        self.simulation.place(ball, at, speed).map_err(refusal)
    }
}

/// Which scene.
pub enum Start {
    Falling2(Population),
    Falling3(Population),
    Bouncing(Population, [f32; 2]),
    Given(Vec<Ball<2>>, [f32; 2]),
}

impl Start {
    /// Reads the area and the given balls; clamps what is out of range, refuses NaN.
    pub fn read(area: &[f64; 16], balls: &[f32]) -> Result<Self, Code> {
        if area[..8].iter().any(|number| number.is_nan()) {
            return Err(Code::InvalidOption);
        }
        let spread = area[4].clamp(1.0, 100.0);
        let canvas = [area[6], area[7]].map(|side| side.clamp(1.0, 1e5) as f32);
        let population = |largest: f64| Population {
            bodies: area[2].clamp(1.0, MOST_BODIES) as u32,
            size: area[3].clamp(1e-3, largest / spread.sqrt()) as f32,
            spread: spread as f32,
            seed: area[5].clamp(0.0, (1u64 << 53) as f64) as u64,
        };
        match (area[0] as u32, area[1] as u32) {
            (0, 2) => Ok(Start::Falling2(population(f64::from(scenes::LARGEST_FALLING)))),
            (0, 3) => Ok(Start::Falling3(population(f64::from(scenes::LARGEST_FALLING)))),
            (1, 2) => {
                Ok(Start::Bouncing(population(0.49 * f64::from(canvas[0].min(canvas[1]))), canvas))
            }
            (2, 2) => {
                let (rows, _) = balls.as_chunks::<5>();
                let ball = |&[x, y, radius, vx, vy]: &[f32; 5]| Ball {
                    center: [x, y],
                    radius,
                    velocity: [vx, vy],
                };
                Ok(Start::Given(rows.iter().map(ball).collect(), canvas))
            }
            _ => Err(Code::InvalidOption),
        }
    }
}

/// Makes the simulation.
pub fn open(start: &Start) -> Result<Box<dyn DynSimulation>, Code> {
    Ok(match start {
        Start::Falling2(population) => inside(scenes::falling::<2>(*population), -1.0)?,
        Start::Falling3(population) => inside(scenes::falling::<3>(*population), -1.0)?,
        Start::Bouncing(population, canvas) => inside(scenes::bouncing(*population, *canvas), 1.0)?,
        Start::Given(balls, canvas) => inside(Ok(scenes::canvas(balls.clone(), *canvas)), 1.0)?,
    })
}

fn inside<const D: usize>(
    setup: Result<Setup<D>, SetupError>,
    down: f32,
) -> Result<Box<dyn DynSimulation>, Code> {
    let simulation = setup.and_then(|setup| Simulation::new(&setup)).map_err(refusal)?;
    Ok(Box::new(Inside { simulation, down, moments: Vec::new(), free_moments: Vec::new() }))
}

fn refusal(error: SetupError) -> Code {
    match error {
        SetupError::TooCrowded { .. } => Code::TooCrowded,
        _ => Code::InvalidOption,
    }
}
