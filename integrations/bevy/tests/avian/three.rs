//! The tests with avian3d.

use ::avian3d as avian;
use avian::math::Scalar;
use avian::prelude::Collider;
use bevy_sweep_and_prune::avian3d as plugin;

fn cuboid([width, height, depth]: [f32; 3]) -> Collider {
    Collider::cuboid(Scalar::from(width), Scalar::from(height), Scalar::from(depth))
}

/// How deep scenes are, as a part of their width.
const DEPTH: f32 = 1.0;

#[path = "dimensions/determinism.rs"]
mod determinism;
#[path = "dimensions/oracle.rs"]
mod oracle;
#[path = "dimensions/scenes.rs"]
mod scenes;
