//! rapier: its broad phase, parry's tree with leaves that move.

use anyhow::Result;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::{Library, Origin};

/// The broad phase without the rest of the simulation.
pub const LIBRARY: WorldLibrary = Library {
    name: "rapier",
    origin: Origin::Crate("rapier3d"),
    how: "`BroadPhaseBvh::set_aabb` for each box that moved, `update`, rapier2d or rapier3d; the \
          length unit is the mean width of a box, of which its boxes are 0.04 larger on every side",
    alternative: true,
    two: Some(|| Box::new(two::Rapier::default())),
    three: Some(|| Box::new(three::Rapier::default())),
};

/// rapier is two crates with one interface, so its world is one text with two meanings.
macro_rules! rapier {
    ($module:ident, $rapier:ident, $dimensions:literal) => {
        mod $module {
            use $rapier::parry::bounding_volume::Aabb as Bounds;
            use $rapier::prelude::*;

            use super::{Aabb, Found, Result, World};

            #[derive(Default)]
            pub struct Rapier {
                parameters: IntegrationParameters,
                bodies: RigidBodySet,
                colliders: ColliderSet,
                handles: Vec<ColliderHandle>,
                broad_phase: BroadPhaseBvh,
                events: Vec<BroadPhasePairEvent>,
                begun: Vec<[u32; 2]>,
                ended: Vec<[u32; 2]>,
            }

            impl Rapier {
                fn place(&mut self, index: u32, aabb: &Aabb<$dimensions>) {
                    let bounds = Bounds::new(aabb.min.into(), aabb.max.into());
                    let handle = self.handles[index as usize];
                    self.broad_phase.set_aabb(&self.parameters, handle, bounds);
                }

                fn update(&mut self) -> Found<'_> {
                    let Self { parameters, colliders, bodies, events, .. } = self;
                    events.clear();
                    self.broad_phase.update(parameters, colliders, bodies, &[], &[], events);
                    self.begun.clear();
                    self.ended.clear();
                    let indices = |pair: &ColliderPair| {
                        [pair.collider1, pair.collider2].map(|one| one.into_raw_parts().0)
                    };
                    for event in &*events {
                        match event {
                            BroadPhasePairEvent::AddPair(pair) => self.begun.push(indices(pair)),
                            BroadPhasePairEvent::DeletePair(pair) => self.ended.push(indices(pair)),
                        }
                    }
                    Found::Events { begun: &self.begun, ended: &self.ended }
                }
            }

            impl World<$dimensions> for Rapier {
                fn start<'a>(
                    &'a mut self,
                    boxes: &'a [Aabb<$dimensions>],
                    movers: usize,
                ) -> Result<Found<'a>> {
                    let widths = boxes.iter().map(|aabb| aabb.max[0] - aabb.min[0]);
                    self.parameters.length_unit = widths.sum::<f32>() / boxes.len().max(1) as f32;
                    for (index, aabb) in (0..).zip(boxes) {
                        // A collider without a body is static, and makes no pair with another static one unless its types
                        // say so. Only `set_aabb` says where it is.
                        let types = if (index as usize) < movers {
                            ActiveCollisionTypes::all()
                        } else {
                            ActiveCollisionTypes::default()
                        };
                        let collider = ColliderBuilder::ball(0.0).active_collision_types(types);
                        self.handles.push(self.colliders.insert(collider));
                        self.place(index, aabb);
                    }
                    Ok(self.update())
                }

                fn step<'a>(
                    &'a mut self,
                    boxes: &'a [Aabb<$dimensions>],
                    moved: &[u32],
                ) -> Result<Found<'a>> {
                    for &index in moved {
                        self.place(index, &boxes[index as usize]);
                    }
                    Ok(self.update())
                }
            }
        }
    };
}

rapier!(two, rapier2d, 2);
rapier!(three, rapier3d, 3);
