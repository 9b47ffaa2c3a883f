//! Balls.

mod bodies;
mod broad_phase;
mod contacts;
mod scatter;
pub mod scenes;
mod setup;
mod simulation;
mod solver;
mod vector;

pub use broad_phase::BroadPhase;
pub use scatter::Scatter;
pub use setup::{Ball, Setup, SetupError};
pub use simulation::{Energy, Simulation, StepReport};
