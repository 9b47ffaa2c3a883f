//! The tests with avian2d.

use ::avian2d as avian;
use avian::math::Scalar;
use avian::prelude::Collider;
use bevy_sweep_and_prune::avian2d as plugin;

fn cuboid(side: [f32; 3]) -> Collider {
    Collider::rectangle(Scalar::from(side[0]), Scalar::from(side[1]))
}

/// How deep scenes are, as a part of their width.
const DEPTH: f32 = 0.0;

#[path = "dimensions/determinism.rs"]
mod determinism;
#[path = "dimensions/oracle.rs"]
mod oracle;
#[path = "dimensions/scenes.rs"]
mod scenes;
