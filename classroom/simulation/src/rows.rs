//! The balls as the narrow phase and the solver look at them: what they need of one lies together
//! and is read by one instruction.

use crate::bodies::Bodies;
use crate::vector::Row;

/// One row a ball and property.
#[derive(Debug, Default)]
pub struct Rows {
    /// The center, and last the radius.
    pub places: Vec<Row>,
    /// The velocity, and last 0.
    pub velocities: Vec<Row>,
}

impl Rows {
    /// Takes over where the balls are and how fast they go. O(balls).
    pub fn load<const D: usize>(&mut self, bodies: &Bodies<D>) {
        self.places.clear();
        let places = bodies.positions.iter().zip(&bodies.radii);
        self.places.extend(places.map(|(&position, &radius)| Row::new(position, radius)));
        self.velocities.clear();
        self.velocities.extend(bodies.velocities.iter().map(|&velocity| Row::new(velocity, 0.0)));
    }

    /// Gives the velocities to the balls. O(balls).
    pub fn store_velocities<const D: usize>(&self, bodies: &mut Bodies<D>) {
        for (velocity, row) in bodies.velocities.iter_mut().zip(&self.velocities) {
            *velocity = row.vector();
        }
    }

    /// Adds the same to every velocity.
    pub fn kick<const D: usize>(&mut self, change: [f32; D]) {
        let change = Row::new(change, 0.0);
        self.velocities.iter_mut().for_each(|velocity| velocity.add_scaled(&change, 1.0));
    }
}
