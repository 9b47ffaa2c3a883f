//! The tests with avian2d.

#[cfg(feature = "avian2d-0.8")]
use ::avian2d as avian;
#[cfg(feature = "avian2d-0.7")]
use ::avian2d_0_7 as avian;
#[cfg(feature = "avian2d-0.7")]
use avian::math::{Scalar, Vector};
use avian::prelude::Collider;
use bevy_sweep_and_prune::avian2d as plugin;

#[cfg(feature = "avian2d-0.8")]
type Scalar = f32;
#[cfg(feature = "avian2d-0.8")]
type Vector = bevy::math::Vec2;

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
#[path = "dimensions/sizes.rs"]
mod sizes;
