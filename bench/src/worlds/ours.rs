//! What this repository is about, kept from frame to frame.

use anyhow::Result;
use sweep_and_prune::{Aabb, BroadPhase, Filter, ProxyId};

use super::{Found, World, WorldPeer};
use crate::peers::{OURS, Origin, Peer};

/// The broad phase with its default options: pairs of the exact boxes.
pub const PEER: WorldPeer = Peer {
    name: OURS,
    origin: Origin::Here,
    how: "`BroadPhase` with its default options: `set` for each box that moved, then `update`",
    rival: false,
    two: Some(|| Box::new(Ours::<2>::default())),
    three: Some(|| Box::new(Ours::<3>::default())),
};

#[derive(Default)]
struct Ours<const D: usize> {
    world: BroadPhase<D>,
    ids: Vec<ProxyId>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

impl<const D: usize> Ours<D> {
    /// The changes, by index: nothing is ever removed, so a slot is an index.
    fn update(&mut self) -> Found<'_> {
        let changes = self.world.update();
        self.begun.clear();
        self.begun.extend_from_slice(changes.begun().slots());
        self.ended.clear();
        self.ended.extend_from_slice(changes.ended().slots());
        Found::Events { begun: &self.begun, ended: &self.ended }
    }
}

impl<const D: usize> World<D> for Ours<D> {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<Found<'a>> {
        self.ids = self.world.insert_many(boxes, Filter::default())?;
        Ok(self.update())
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>> {
        for &index in moved {
            self.world.set(self.ids[index as usize], boxes[index as usize])?;
        }
        Ok(self.update())
    }
}
