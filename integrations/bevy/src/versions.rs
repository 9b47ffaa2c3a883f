//! What differs between the versions of Bevy and Avian.

#[cfg(all(feature = "bevy-0.19", feature = "bevy-0.20"))]
compile_error!(
    "features of Bevy 0.19 and of Bevy 0.20 are on: for the older one, set `default-features = false`"
);

#[cfg(not(any(feature = "bevy-0.19", feature = "bevy-0.20")))]
compile_error!(
    "the version of Bevy is missing: one of the features `bevy-0.19` and `bevy-0.20`, or one for Avian"
);

#[cfg(not(feature = "bevy-0.20"))]
pub use bevy::math::bounding::{Aabb2d, Aabb3d};
#[cfg(feature = "bevy-0.20")]
pub use bevy::shape::{Aabb2d, Aabb3d};

/// What an observer hears of: `on!(Remove, Sensor)`, an event and the components that it happens to.
#[cfg(feature = "bevy-0.20")]
macro_rules! on {
    ($event:ident, $components:ty) => { bevy::ecs::observer::On<$event<$components>> };
}
#[cfg(not(feature = "bevy-0.20"))]
macro_rules! on {
    ($event:ident, $components:ty) => { bevy::ecs::observer::On<$event, $components> };
}
pub(crate) use on;
