//! The tests with avian3d.

#[cfg(feature = "avian3d-0.8")]
use ::avian3d as avian;
#[cfg(feature = "avian3d-0.7")]
use ::avian3d_0_7 as avian;
#[cfg(feature = "avian3d-0.7")]
use avian::math::{Scalar, Vector};
use avian::prelude::Collider;
use bevy_sweep_and_prune::avian3d as plugin;

#[cfg(feature = "avian3d-0.8")]
type Scalar = f32;
#[cfg(feature = "avian3d-0.8")]
type Vector = bevy::math::Vec3;

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
#[path = "dimensions/sizes.rs"]
mod sizes;
