//! What a simulation starts from, and what is refused.

use std::fmt;

use sweep_and_prune::Aabb;

/// A disc (`D = 2`) or a sphere (`D = 3`) of density 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<const D: usize> {
    /// The center.
    pub center: [f32; D],
    /// The radius, [`Setup::LEAST_LENGTH`] to [`Setup::GREATEST_LENGTH`].
    pub radius: f32,
    /// The velocity, in units a second.
    pub velocity: [f32; D],
}

impl<const D: usize> Ball<D> {
    /// A ball at rest.
    pub fn at_rest(center: [f32; D], radius: f32) -> Self {
        Self { center, radius, velocity: [0.0; D] }
    }
}

/// The balls, the box that holds them and the laws that move them. [`scenes`](crate::scenes) makes the
/// usual ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Setup<const D: usize> {
    /// The balls, which may overlap each other, inside `bounds`.
    pub balls: Vec<Ball<D>>,
    /// The box whose walls no ball leaves.
    pub bounds: Aabb<D>,
    /// Acceleration, in units/s².
    pub gravity: [f32; D],
    /// How much of its speed a bounce leaves, 0 to 1, between balls and at walls alike.
    pub restitution: f32,
    /// Seconds a step.
    pub time_step: f32,
    /// Equal parts of a step, 1 to [`Setup::MOST_SUBSTEPS`].
    pub substeps: u32,
}

impl<const D: usize> Setup<D> {
    /// The least radius.
    pub const LEAST_LENGTH: f32 = 1e-6;
    /// The greatest radius, coordinate of a wall, or gravity on one axis.
    pub const GREATEST_LENGTH: f32 = 1e6;
    /// The shortest time step; the longest is a second.
    pub const LEAST_TIME_STEP: f32 = 1e-5;
    /// The most substeps.
    pub const MOST_SUBSTEPS: u32 = 32;

    /// Whether a simulation can start from this.
    ///
    /// Within these limits no sum or product of the simulation overflows, so its state stays
    /// finite for ever.
    ///
    /// # Errors
    /// [`SetupError::Parameter`] or [`SetupError::Ball`], the first at fault.
    pub fn validate(&self) -> Result<(), SetupError> {
        let within = |x: f32| (-Self::GREATEST_LENGTH..=Self::GREATEST_LENGTH).contains(&x);
        let Aabb { min, max } = self.bounds;
        if !(0..D).all(|axis| within(min[axis]) && within(max[axis]) && min[axis] < max[axis]) {
            return Err(SetupError::Parameter { name: "bounds" });
        }
        if !self.gravity.into_iter().all(within) {
            return Err(SetupError::Parameter { name: "gravity" });
        }
        if !(0.0..=1.0).contains(&self.restitution) {
            return Err(SetupError::Parameter { name: "restitution" });
        }
        if !(Self::LEAST_TIME_STEP..=1.0).contains(&self.time_step) {
            return Err(SetupError::Parameter { name: "time_step" });
        }
        if !(1..=Self::MOST_SUBSTEPS).contains(&self.substeps) {
            return Err(SetupError::Parameter { name: "substeps" });
        }
        if u32::try_from(self.balls.len()).is_err() {
            return Err(SetupError::Parameter { name: "balls" });
        }
        match self.balls.iter().position(|ball| !self.admits(ball)) {
            Some(index) => Err(SetupError::Ball { index }),
            None => Ok(()),
        }
    }

    /// Whether a ball is well formed and inside the walls.
    fn admits(&self, ball: &Ball<D>) -> bool {
        let Ball { center, radius, velocity } = *ball;
        (Self::LEAST_LENGTH..=Self::GREATEST_LENGTH).contains(&radius)
            && velocity.into_iter().all(f32::is_finite)
            && (0..D).all(|axis| {
                let (low, high) = (self.bounds.min[axis] + radius, self.bounds.max[axis] - radius);
                (low..=high).contains(&center[axis])
            })
    }
}

/// Why a simulation cannot start, or a setting is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetupError {
    /// A parameter is NaN or out of its range.
    Parameter {
        /// Its name.
        name: &'static str,
    },
    /// A ball is malformed (a NaN, an infinity, a bad radius) or not inside the walls.
    Ball {
        /// The first at fault.
        index: usize,
    },
    /// No place was found for a ball that overlaps no other.
    TooCrowded {
        /// How many had been placed.
        placed: usize,
    },
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SetupError::Parameter { name } => write!(f, "{name} is NaN or out of its range"),
            SetupError::Ball { index } => {
                write!(f, "ball {index} is malformed or not inside the walls")
            }
            SetupError::TooCrowded { placed } => {
                write!(f, "only {placed} balls fit without an overlap: use fewer or smaller balls")
            }
        }
    }
}

impl std::error::Error for SetupError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Simulation;
    use crate::scenes::canvas;

    #[test]
    fn errors_name_the_parameter_or_ball_at_fault() {
        let setup = canvas(vec![Ball::at_rest([50.0, 50.0], 10.0)], [100.0, 100.0]);
        assert_eq!(setup.validate(), Ok(()));
        let nan = f32::NAN;
        for (bad, name) in [
            (Setup { bounds: Aabb::new([0.0; 2], [0.0, 100.0]), ..setup.clone() }, "bounds"),
            (Setup { bounds: Aabb::new([0.0; 2], [2e6, 100.0]), ..setup.clone() }, "bounds"),
            (Setup { gravity: [0.0, nan], ..setup.clone() }, "gravity"),
            (Setup { restitution: 1.1, ..setup.clone() }, "restitution"),
            (Setup { restitution: nan, ..setup.clone() }, "restitution"),
            (Setup { time_step: 0.0, ..setup.clone() }, "time_step"),
            (Setup { substeps: 0, ..setup.clone() }, "substeps"),
            (Setup { substeps: 33, ..setup.clone() }, "substeps"),
        ] {
            assert_eq!(Simulation::new(&bad).err(), Some(SetupError::Parameter { name }));
        }
        let good = setup.balls[0];
        for bad in [
            Ball { radius: 0.0, ..good },
            Ball { radius: nan, ..good },
            Ball { center: [nan, 50.0], ..good },
            Ball { center: [50.0, 90.5], ..good },
            Ball { radius: 50.5, ..good },
            Ball { velocity: [f32::INFINITY, 0.0], ..good },
        ] {
            let balls = vec![good, bad, bad];
            let error = Setup { balls, ..setup.clone() }.validate();
            assert_eq!(error, Err(SetupError::Ball { index: 1 }));
        }
    }

    #[test]
    fn settings_out_of_range_change_nothing() {
        let setup = canvas(vec![Ball::at_rest([50.0, 50.0], 10.0)], [100.0, 100.0]);
        let mut simulation = Simulation::new(&setup).unwrap();
        assert!(simulation.set_gravity([f32::NAN, 0.0]).is_err());
        assert!(simulation.set_restitution(-0.1).is_err());
        assert!(simulation.set_substeps(0).is_err());
        assert_eq!(simulation.gravity(), setup.gravity);
        assert_eq!(simulation.restitution(), setup.restitution);
        assert_eq!(simulation.substeps(), setup.substeps);
    }
}
