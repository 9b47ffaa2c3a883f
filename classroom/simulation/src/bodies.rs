//! The state: where the balls are and how fast they go.

use std::array::from_fn;

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::hash;

use crate::setup::Ball;
use crate::vector::{greater, lesser};

/// The balls, one array a property.
#[derive(Clone, Debug)]
pub struct Bodies<const D: usize> {
    pub positions: Vec<[f32; D]>,
    /// Half a substep ahead of the positions, as leapfrog keeps them.
    pub velocities: Vec<[f32; D]>,
    pub radii: Vec<f32>,
    pub masses: Vec<f32>,
    pub inverse_masses: Vec<f32>,
    total_mass: f64,
}

impl<const D: usize> Bodies<D> {
    pub fn new(balls: &[Ball<D>]) -> Self {
        let masses: Vec<f32> = balls.iter().map(|ball| mass::<D>(ball.radius)).collect();
        Self {
            positions: balls.iter().map(|ball| ball.center).collect(),
            velocities: balls.iter().map(|ball| ball.velocity).collect(),
            radii: balls.iter().map(|ball| ball.radius).collect(),
            inverse_masses: masses.iter().map(|mass| 1.0 / mass).collect(),
            total_mass: masses.iter().copied().map(f64::from).sum(),
            masses,
        }
    }

    pub fn len(&self) -> usize {
        self.radii.len()
    }

    /// Adds the same to every velocity.
    pub fn kick(&mut self, change: [f32; D]) {
        for velocity in &mut self.velocities {
            for axis in 0..D {
                velocity[axis] += change[axis];
            }
        }
    }

    /// Leaves only a share of each velocity, measured from `ahead`.
    pub fn slow_down(&mut self, ahead: [f32; D], share: f32) {
        for velocity in &mut self.velocities {
            for axis in 0..D {
                velocity[axis] = ahead[axis] + (velocity[axis] - ahead[axis]) * share;
            }
        }
    }

    /// Moves every ball along its velocity for `time`. Balls that would move further than the width of the
    /// box are slowed down, so that no coordinate ever overflows.
    pub fn drift(&mut self, time: f32, bounds: &Aabb<D>) {
        let limit: [f32; D] = from_fn(|axis| (bounds.max[axis] - bounds.min[axis]) / time);
        for (position, velocity) in self.positions.iter_mut().zip(&mut self.velocities) {
            for axis in 0..D {
                velocity[axis] = velocity[axis].clamp(-limit[axis], limit[axis]);
                position[axis] += velocity[axis] * time;
            }
        }
    }

    /// Puts balls that went through a wall back to the wall, and restores the speed across the wall that
    /// they had there, before they fell or rose further.
    ///
    /// So a ball that bounces off the floor gains no energy, however deep a step carried it.
    pub fn stop_at_walls(&mut self, gravity: [f32; D], bounds: &Aabb<D>) {
        for ((position, velocity), &radius) in
            self.positions.iter_mut().zip(&mut self.velocities).zip(&self.radii)
        {
            for axis in 0..D {
                let inside = inside_walls(position[axis], radius, bounds, axis);
                let way_back = inside - position[axis];
                if way_back != 0.0 {
                    let speed = velocity[axis];
                    let square = speed * speed + 2.0 * gravity[axis] * way_back;
                    let speed_at_wall = greater(square, 0.0).sqrt();
                    velocity[axis] = if speed < 0.0 { -speed_at_wall } else { speed_at_wall };
                    position[axis] = inside;
                }
            }
        }
    }

    /// The kinetic energy per unit of mass at the time of the positions: `ahead` is what gravity has added to the
    /// velocities since.
    pub fn kinetic_energy(&self, ahead: [f32; D]) -> f64 {
        self.mean_by_mass(|index| {
            let velocity = self.velocities[index];
            let speeds = (0..D).map(|axis| f64::from(velocity[axis] - ahead[axis]));
            speeds.map(|speed| 0.5 * speed * speed).sum()
        })
    }

    /// The potential energy per unit of mass, above the walls to which gravity points.
    pub fn potential_energy(&self, gravity: [f32; D], bounds: &Aabb<D>) -> f64 {
        self.potential_energy_at(|ball| self.positions[ball], gravity, bounds)
    }

    /// The potential energy with the balls at these places.
    pub fn potential_energy_at(
        &self,
        place: impl Fn(usize) -> [f32; D],
        gravity: [f32; D],
        bounds: &Aabb<D>,
    ) -> f64 {
        let ground: [f32; D] =
            from_fn(|axis| if gravity[axis] > 0.0 { bounds.max[axis] } else { bounds.min[axis] });
        self.mean_by_mass(|index| {
            let position = place(index);
            let heights = (0..D).map(|axis| f64::from(ground[axis]) - f64::from(position[axis]));
            heights.zip(gravity).map(|(height, g)| f64::from(g) * height).sum()
        })
    }

    /// The mean over all balls, weighted by mass; 0 if there are none.
    fn mean_by_mass(&self, value: impl Fn(usize) -> f64) -> f64 {
        let mut sum = 0.0;
        for (index, &mass) in self.masses.iter().enumerate() {
            sum += f64::from(mass) * value(index);
        }
        if self.total_mass > 0.0 { sum / self.total_mass } else { 0.0 }
    }

    /// The hash of positions and velocities, bit for bit.
    pub fn hash(&self) -> u64 {
        let state = self.positions.iter().chain(&self.velocities).flatten();
        hash(state.flat_map(|x| x.to_bits().to_le_bytes()))
    }
}

/// The coordinate nearest to `at` where a ball is inside the walls of one axis.
pub fn inside_walls<const D: usize>(at: f32, radius: f32, bounds: &Aabb<D>, axis: usize) -> f32 {
    greater(lesser(at, bounds.max[axis] - radius), bounds.min[axis] + radius)
}

/// The area or volume: the mass at density 1.
fn mass<const D: usize>(radius: f32) -> f32 {
    const PI: f32 = std::f32::consts::PI;
    match D {
        1 => 2.0 * radius,
        2 => PI * radius * radius,
        _ => 4.0 / 3.0 * PI * radius * radius * radius,
    }
}
