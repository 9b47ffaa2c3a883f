//! One step after another.

use sweep_and_prune::Aabb;
use sweep_and_prune_algorithms::{Counts, Error};

use crate::bodies::{Bodies, inside_walls};
use crate::broad_phase::{BroadPhase, Engine};
use crate::candidates::Candidates;
use crate::contacts::{Contacts, Surroundings};
use crate::enclosures::Ahead;
use crate::rows::Rows;
use crate::setup::{Setup, SetupError};
use crate::solver;
use crate::vector::dot;

/// What one step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// How often the broad phase ran over all balls: once at the beginning, and again whenever many balls at once left
    /// the boxes that should hold them for the step.
    pub broad_phases: u32,
    /// What the algorithm did in the first broad phase of the step; `None` is not counted: the
    /// library's finder does not report it, or counting is off.
    pub counts: Option<Counts>,
    /// Overlapping pairs of boxes in the last substep.
    pub pairs: usize,
    /// The pairs whose balls touch in the last substep.
    pub contacts: usize,
    /// Milliseconds of the broad phase in all substeps: from balls to boxes to pairs.
    pub broad_phase_ms: f64,
    /// Milliseconds of all narrow phases: which balls of the pairs touch, and in what order they
    /// are solved.
    pub narrow_phase_ms: f64,
    /// Milliseconds of the step without counting. What neither the broad nor the narrow phase took went into motion, impulses
    /// and projection.
    pub total_ms: f64,
}

/// Kinetic and potential energy per unit of mass, in units²/s².
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    /// From the velocities at the time of the positions.
    pub kinetic: f64,
    /// From the heights above the walls to which gravity points.
    pub potential: f64,
}

impl Energy {
    /// Kinetic and potential.
    pub fn total(self) -> f64 {
        self.kinetic + self.potential
    }
}

/// Balls in a box: see the [crate] for what it does and why.
#[derive(Debug)]
pub struct Simulation<const D: usize> {
    bodies: Bodies<D>,
    bounds: Aabb<D>,
    gravity: [f32; D],
    restitution: f32,
    time_step: f32,
    substeps: u32,
    collisions: bool,
    counting: bool,
    steps: u64,
    /// The lowest energy so far under these laws.
    least_energy: f64,
    engine: Engine<D>,
    contacts: Contacts,
    candidates: Candidates<D>,
    // Buffers.
    rows: Rows,
    bounced: Vec<u8>,
}

/// A simulation at one moment, to which it can return: everything that its motion depends on, except the laws.
/// Memory: O(balls + contacts).
#[derive(Clone, Debug)]
pub struct Moment<const D: usize> {
    bodies: Bodies<D>,
    contacts: Contacts,
    steps: u64,
    least_energy: f64,
}

impl<const D: usize> Simulation<D> {
    /// A simulation at time 0, its broad phase the library's.
    ///
    /// # Errors
    /// As [`Setup::validate`].
    pub fn new(setup: &Setup<D>) -> Result<Self, SetupError> {
        setup.validate()?;
        let mut simulation = Self {
            bodies: Bodies::new(&setup.balls),
            bounds: setup.bounds,
            gravity: setup.gravity,
            restitution: setup.restitution,
            time_step: setup.time_step,
            substeps: setup.substeps,
            collisions: true,
            counting: true,
            steps: 0,
            least_energy: f64::INFINITY,
            engine: Engine::new(BroadPhase::Library).expect("the library's finder takes any axis"),
            contacts: Contacts::default(),
            candidates: Candidates::default(),
            rows: Rows::default(),
            bounced: Vec::new(),
        };
        simulation.bodies.kick(simulation.half_kick());
        Ok(simulation)
    }

    /// One time step. `now` tells the time in milliseconds, from any origin; `|| 0.0` if the
    /// times of the report do not matter. The clock has no influence on the motion.
    ///
    /// # Errors
    /// Those of the broad phase, which by [`Setup::validate`] do not happen.
    pub fn step(&mut self, now: impl Fn() -> f64) -> Result<StepReport, Error> {
        let mut report = StepReport::default();
        for substep in 0..self.substeps {
            self.substep(substep, &now, &mut report)?;
        }
        self.steps += 1;
        Ok(report)
    }

    /// Saves this moment, so that [`restore`](Self::restore) can return to it.
    pub fn save(&self) -> Moment<D> {
        Moment {
            bodies: self.bodies.clone(),
            contacts: self.contacts.clone(),
            steps: self.steps,
            least_energy: self.least_energy,
        }
    }

    /// Goes back, or forward again, to a saved moment of this simulation. From there the same steps
    /// give the same bits as they did, if gravity, restitution, substeps and collisions are the
    /// same. Pairs and boxes stay as the last step left them.
    pub fn restore(&mut self, moment: &Moment<D>) {
        self.bodies.clone_from(&moment.bodies);
        self.contacts.clone_from(&moment.contacts);
        self.steps = moment.steps;
        self.least_energy = moment.least_energy;
    }

    /// Puts a ball somewhere else, with this velocity. It may overlap others; outside the walls it
    /// is put at the nearest place inside.
    ///
    /// # Errors
    /// [`SetupError::Ball`] if there is no such ball, or a number is not finite; then nothing has
    /// changed.
    pub fn place(
        &mut self,
        index: usize,
        center: [f32; D],
        velocity: [f32; D],
    ) -> Result<(), SetupError> {
        let finite = center.into_iter().chain(velocity).all(f32::is_finite);
        if index >= self.bodies.len() || !finite {
            return Err(SetupError::Ball { index });
        }
        let radius = self.bodies.radii[index];
        let half_kick = self.half_kick();
        for axis in 0..D {
            self.bodies.positions[index][axis] =
                inside_walls(center[axis], radius, &self.bounds, axis);
            self.bodies.velocities[index][axis] = velocity[axis] + half_kick[axis];
        }
        self.least_energy = f64::INFINITY;
        Ok(())
    }

    fn substep(
        &mut self,
        substep: u32,
        now: &impl Fn() -> f64,
        report: &mut StepReport,
    ) -> Result<(), Error> {
        let start = now();
        self.least_energy = self.energy().total().min(self.least_energy);
        // Leapfrog: velocities live half a substep ahead, where they carry the positions exactly.
        self.bodies.drift(self.substep_time(), &self.bounds);
        self.bodies.kick(self.half_kick());
        self.bodies.stop_at_walls(self.gravity, &self.bounds);
        let moved = now();

        let ahead = Ahead {
            kick: self.half_kick(),
            gravity: self.gravity,
            time: self.substep_time(),
            substeps: self.substeps - substep,
        };
        if substep == 0 {
            self.candidates.enclose(&self.bodies, &self.contacts, &ahead);
        } else {
            self.candidates.update(&self.bodies, &self.contacts, &ahead);
        }
        let enclosed = now();

        if substep == 0 && self.counting {
            report.counts = self.candidates.count(&self.engine)?;
        }
        let counted = now();

        report.broad_phases += u32::from(self.candidates.find(&mut self.engine)?);
        report.pairs = self.candidates.pairs.len();
        let found = now();

        let around =
            Surroundings { bounds: self.bounds, gravity: self.gravity, time: self.substep_time() };
        self.candidates.sort();
        self.rows.load(&self.bodies);
        self.contacts.find(&self.candidates.pairs, &self.bodies, &self.rows, &around);
        report.contacts = self.contacts.balls.len();
        if !self.collisions {
            self.contacts.part_balls();
        }
        let touched = now();

        self.resolve(&around);
        let resolved = now();

        report.broad_phase_ms += enclosed - moved + found - counted;
        report.narrow_phase_ms += touched - found;
        report.total_ms += enclosed - start + resolved - counted;
        Ok(())
    }

    /// Bounces change the velocities at the time of the positions, rest the velocities that move the balls next. Moving
    /// overlapping balls apart may then add as much energy as it has fallen below its lowest so far.
    fn resolve(&mut self, around: &Surroundings<D>) {
        let (threshold, half_kick) = (self.bounce_threshold(), self.half_kick());
        let Self { contacts, bodies, rows, bounced, .. } = self;
        let velocities = &mut rows.velocities[..];
        solver::bounce::<D>(contacts, velocities, self.restitution, threshold, bounced);
        rows.kick(half_kick);
        rows.store_velocities(bodies);
        solver::rest(contacts, bodies, &mut rows.velocities);
        rows.store_velocities(bodies);
        self.take_surplus();
        let allowance = self.least_energy - self.energy().total();
        let Self { contacts, bodies, rows, .. } = self;
        solver::project(contacts, bodies, rows, around, allowance);
    }

    /// Slows everything down slightly where the energy has grown: contacts turn while balls slide over each other, which
    /// the solver does not see within a substep.
    ///
    /// A ball at rest has half of gravity's change in a substep as its velocity at the time of the positions. That much
    /// is allowed.
    fn take_surplus(&mut self) {
        let half_kick = self.half_kick();
        let energy = self.energy();
        let of_rest = 0.5 * f64::from(dot(half_kick, half_kick));
        let surplus = energy.total() - (self.least_energy + of_rest);
        if surplus > 0.0 {
            let share = (1.0 - surplus / energy.kinetic).max(0.0).sqrt();
            self.bodies.slow_down(half_kick, share as f32);
        }
    }

    fn substep_time(&self) -> f32 {
        self.time_step / self.substeps as f32
    }

    /// What gravity adds to a velocity in half a substep.
    fn half_kick(&self) -> [f32; D] {
        let half = self.substep_time() * 0.5;
        self.gravity.map(|g| g * half)
    }

    /// Balls that meet slower than this do not bounce: twice the speed that a ball at rest gains
    /// in a substep on any axis, before its support is felt.
    fn bounce_threshold(&self) -> f32 {
        let kick = self.half_kick().into_iter().fold(0.0, |most: f32, kick| {
            let kick = if kick < 0.0 { -kick } else { kick };
            if kick > most { kick } else { most }
        });
        4.0 * kick
    }

    /// Chooses the broad phase from the next step on.
    ///
    /// # Errors
    /// [`Error::InvalidAxis`]; then the choice is what it was.
    pub fn set_broad_phase(&mut self, choice: BroadPhase) -> Result<(), Error> {
        self.engine = Engine::new(choice)?;
        Ok(())
    }

    /// Changes gravity, in units/s².
    ///
    /// # Errors
    /// [`SetupError::Parameter`] for NaN and beyond [`Setup::GREATEST_LENGTH`].
    pub fn set_gravity(&mut self, gravity: [f32; D]) -> Result<(), SetupError> {
        let limit = Setup::<D>::GREATEST_LENGTH;
        if !gravity.into_iter().all(|g| (-limit..=limit).contains(&g)) {
            return Err(SetupError::Parameter { name: "gravity" });
        }
        self.gravity = gravity;
        self.least_energy = f64::INFINITY;
        Ok(())
    }

    /// Changes the restitution.
    ///
    /// # Errors
    /// [`SetupError::Parameter`] if it is not within 0 and 1.
    pub fn set_restitution(&mut self, restitution: f32) -> Result<(), SetupError> {
        if !(0.0..=1.0).contains(&restitution) {
            return Err(SetupError::Parameter { name: "restitution" });
        }
        self.restitution = restitution;
        Ok(())
    }

    /// Changes the number of substeps.
    ///
    /// # Errors
    /// [`SetupError::Parameter`] if it is not within 1 and [`Setup::MOST_SUBSTEPS`].
    pub fn set_substeps(&mut self, substeps: u32) -> Result<(), SetupError> {
        if !(1..=Setup::<D>::MOST_SUBSTEPS).contains(&substeps) {
            return Err(SetupError::Parameter { name: "substeps" });
        }
        self.substeps = substeps;
        self.least_energy = f64::INFINITY;
        Ok(())
    }

    /// Whether balls meet each other, as they do at first, or only the walls. Pairs and contacts
    /// are found either way.
    pub fn set_collisions(&mut self, collisions: bool) {
        self.collisions = collisions;
    }

    /// Whether steps count what the algorithm does, as they do at first. Counting runs the first
    /// broad phase of a step once more, on a copy, outside the times of the report.
    pub fn set_counting(&mut self, counting: bool) {
        self.counting = counting;
    }

    /// Gravity, in units/s².
    pub fn gravity(&self) -> [f32; D] {
        self.gravity
    }

    /// The restitution.
    pub fn restitution(&self) -> f32 {
        self.restitution
    }

    /// The number of substeps.
    pub fn substeps(&self) -> u32 {
        self.substeps
    }

    /// Whether balls meet each other.
    pub fn collisions(&self) -> bool {
        self.collisions
    }

    /// Whether steps count.
    pub fn counting(&self) -> bool {
        self.counting
    }

    /// Steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// The box.
    pub fn bounds(&self) -> Aabb<D> {
        self.bounds
    }

    /// The centers.
    pub fn positions(&self) -> &[[f32; D]] {
        &self.bodies.positions
    }

    /// The velocities, in units a second, half a substep later than the positions.
    pub fn velocities(&self) -> &[[f32; D]] {
        &self.bodies.velocities
    }

    /// The radii.
    pub fn radii(&self) -> &[f32] {
        &self.bodies.radii
    }

    /// The boxes that were to hold the balls during the last step; none before the first.
    pub fn boxes(&self) -> &[Aabb<D>] {
        self.candidates.boxes()
    }

    /// The pairs of [`boxes`](Self::boxes) that overlap, sorted by their indices.
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.candidates.pairs
    }

    /// The energy, per unit of mass. It never grows, but for rounding and as the setters change
    /// the laws.
    pub fn energy(&self) -> Energy {
        Energy {
            kinetic: self.bodies.kinetic_energy(self.half_kick()),
            potential: self.bodies.potential_energy(self.gravity, &self.bounds),
        }
    }

    /// A hash of all positions and velocities, bit for bit: the same on every platform, in debug
    /// and in release, for every broad phase.
    pub fn hash(&self) -> u64 {
        self.bodies.hash()
    }
}
