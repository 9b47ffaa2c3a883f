//! Balls that fall and bounce: discs in 2D, spheres in 3D, to the bit the same on every platform
//! and over every broad phase of `sweep-and-prune`.
//!
//! ```
//! use sweep_and_prune_simulation::Simulation;
//! use sweep_and_prune_simulation::scenes::{self, Population};
//!
//! let setup = scenes::falling::<3>(Population { bodies: 100, size: 0.5, spread: 1.0, seed: 1 })?;
//! let mut simulation = Simulation::new(&setup)?;
//! let start = simulation.energy();
//! for _ in 0..60 {
//!     simulation.step(|| 0.0)?; // a clock, if the times of the report matter
//! }
//! assert!(simulation.energy().kinetic > start.kinetic); // they do fall
//! assert!(simulation.energy().total() < start.total());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # A step
//! A step is split into equal substeps. Several small steps, each with little solving, beat one
//! large step with much of it (Macklin et al. 2019, "Small steps in physics simulation"). Each
//! substep does, in this order:
//!
//! 1. **Integrate** by leapfrog: velocities live half a substep ahead of positions. In constant
//!    gravity that is exact, so free fall neither gains nor loses energy (Hairer, Lubich and Wanner
//!    2003, "Geometric numerical integration illustrated by the Störmer-Verlet method").
//! 2. **Boxes**, once a step: each holds its ball to the end of the step, with a margin. A ball that
//!    a bounce sends out of its box gets a new one before it gets there.
//! 3. **Pairs** of boxes, by the broad phase, once a step; of the balls with new boxes, one by one.
//!    All are collected before any is resolved: bouncing while sweeping would invalidate the order
//!    that is being swept.
//! 4. **Contacts**: the pairs whose balls touch, or will before the substep ends. They are sorted
//!    by height and index, so the motion does not depend on the order of the pairs, and so on the
//!    algorithm that found them.
//! 5. **Bounce**: those that meet fast, pair by pair, with restitution.
//! 6. **Rest**: after that no contact may close. Sequential impulses with the impulses of the
//!    substep before as a start (Catto 2005, "Iterative dynamics with temporal coherence"), swept
//!    alternately from the bottom up and from the top down.
//! 7. **Project**: balls that overlap nevertheless are moved apart; velocities stay.
//!
//! Bouncing first and resting afterwards, and going through a heap by height, is the scheme of
//! Guendelman, Bridson and Fedkiw (2003, "Nonconvex rigid bodies with stacking"). Swept in the order
//! of their indices instead, ten thousand discs in four substeps sink into each other until centers
//! coincide; by height they stack.
//!
//! # Why energy cannot grow
//! The solver was chosen for this: each stage by itself takes energy away or leaves it.
//!
//! - A bounce with restitution at most 1 does not add energy, hence no sequence of bounces does.
//! - The resting impulses minimize kinetic energy over velocities that close no contact (Moreau
//!   1988). Every single correction of projected Gauss-Seidel descends towards that minimum, and the
//!   start is scaled to where it is least along its direction. So the energy falls however few
//!   sweeps are made.
//! - A ball that went through a wall is put back with the speed that it had at the wall.
//! - Moving balls apart about their common center of mass adds no energy. But a heap that is pressed against the floor
//!   is lifted by it: balls are moved apart only until that has taken the energy that the contacts have just lost.
//! - What remains are errors of the finite substep, where contacts turn while balls slide over each
//!   other: a few millionths, which are taken out of all velocities alike.
//!
//! So the energy stays below the least that it has been, plus rounding and (g h)²/8 per unit of
//! mass, for gravity g and substeps of h: what a ball at rest seems to have, its velocity being that
//! of half a substep later. Position-based solvers, which take velocities from corrected positions, are simpler but gain
//! energy from every overlap that they resolve.
//!
//! # What it leaves out
//! Balls do not spin and there is no friction: heaps in a box become level. Steps are discrete:
//! contacts are foreseen along straight lines within one substep, for pairs as they move before it
//! is resolved. A ball that a bounce sends off fast may pass through another that was not in its
//! way before, or sink into a dense heap, where substeps are few or gravity is strong. Small balls
//! under ones a hundred times as heavy stay overlapped by a part of their radius.
//!
//! # Determinism
//! Additions, subtractions, multiplications, divisions and square roots only, which IEEE 754
//! defines to the last bit; no fused multiply-add, no library function; every loop in a fixed
//! order. `golden.txt` holds state hashes that the native build, in debug and in release, and
//! WebAssembly, with and without vector instructions, must all reproduce.

mod bodies;
mod broad_phase;
mod candidates;
mod contacts;
mod enclosures;
mod grid;
mod order;
mod rows;
mod scatter;
pub mod scenes;
mod setup;
mod simulation;
mod solver;
mod vector;

pub use broad_phase::BroadPhase;
pub use scatter::Scatter;
pub use setup::{Ball, Setup, SetupError};
pub use simulation::{Energy, Moment, Simulation, StepReport};
