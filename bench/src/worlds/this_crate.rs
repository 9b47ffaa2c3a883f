//! What this repository is about, kept from frame to frame.

use anyhow::Result;
use sweep_and_prune::{Aabb, BroadPhase, Filter, ProxyId};

use super::world::{Found, World, WorldLibrary};
use crate::libraries::{Library, Origin, THIS_CRATE};

/// The broad phase with its default options: pairs of the exact boxes.
pub const LIBRARY: WorldLibrary = Library {
    name: THIS_CRATE,
    origin: Origin::Here,
    how: "`BroadPhase` with its default options: `set_many` of the boxes that moved, then `update`",
    alternative: false,
    two: Some(|| Box::new(Tracker::<2>::default())),
    three: Some(|| Box::new(Tracker::<3>::default())),
};

/// Boxes that never move, inserted as static bodies.
pub const STATIC: WorldLibrary = Library {
    how: "`insert_many`, static boxes with `Filter::STATIC`; then `set_many` of the boxes that moved, `update`",
    ..LIBRARY
};

/// Boxes that never move, inserted as bodies that could.
pub const RESTING: WorldLibrary = Library {
    name: "sweep-and-prune, resting",
    how: "the same, but static boxes are dynamic bodies that rest; their filter lets no two of them pair",
    two: Some(|| Box::new(Tracker::<2> { rests: true, ..Tracker::default() })),
    three: Some(|| Box::new(Tracker::<3> { rests: true, ..Tracker::default() })),
    ..LIBRARY
};

/// The category of bodies that rest.
const RESTS: u32 = 2;

#[derive(Default)]
struct Tracker<const D: usize> {
    world: BroadPhase<D>,
    /// Whether boxes that never move are dynamic bodies.
    rests: bool,
    ids: Vec<ProxyId>,
    moved_ids: Vec<ProxyId>,
    moved_boxes: Vec<Aabb<D>>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

impl<const D: usize> Tracker<D> {
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

impl<const D: usize> World<D> for Tracker<D> {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>> {
        let (movers, statics) = boxes.split_at(movers);
        self.ids = self.world.insert_many(movers, Filter::ALL)?;
        let resting = Filter::default().category(RESTS).mask(!RESTS);
        let filter = if self.rests { resting } else { Filter::STATIC };
        self.ids.extend(self.world.insert_many(statics, filter)?);
        Ok(self.update())
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>> {
        if moved.len() == boxes.len() {
            self.world.set_many(&self.ids, boxes)?;
        } else {
            self.moved_ids.clear();
            self.moved_ids.extend(moved.iter().map(|&index| self.ids[index as usize]));
            self.moved_boxes.clear();
            self.moved_boxes.extend(moved.iter().map(|&index| boxes[index as usize]));
            self.world.set_many(&self.moved_ids, &self.moved_boxes)?;
        }
        Ok(self.update())
    }
}
