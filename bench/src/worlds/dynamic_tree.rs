//! Box2D and Box3D: their dynamic trees, used as their own broad phases do, which are out of reach from outside.

use anyhow::Result;
use rustc_hash::FxHashSet;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::dynamic_tree::{Box2d, Box3d, DynamicTree};
use crate::libraries::{Library, Origin};

/// In two dimensions only.
pub const BOX2D: WorldLibrary = Library {
    name: "Box2D",
    origin: Origin::Crate("boxdd-sys"),
    how: "`b2DynamicTree` with fat AABBs as `b2BroadPhase` keeps them, one tree for static boxes and one for the others: \
          `b2DynamicTree_EnlargeProxy` for each box that left its fat AABB (the margin is 1/8 of half its diagonal), \
          `b2DynamicTree_Query` for each of these, `b2DynamicTree_Rebuild`, and pairs dropped when \
          their fat AABBs part",
    alternative: true,
    two: Some(|| Box::new(Trees::<2, Box2d>::default())),
    three: None,
};

/// In three dimensions only.
pub const BOX3D: WorldLibrary = Library {
    name: "Box3D",
    origin: Origin::Crate("box3d-sys"),
    how: "the same with `b3DynamicTree`, as `b3BroadPhase` uses it",
    alternative: true,
    two: None,
    three: Some(|| Box::new(Trees::<3, Box3d>::default())),
};

/// What the constants of both say of the margin, as a fraction of half a box's diagonal.
const MARGIN: f32 = 0.125;

#[derive(Default)]
struct Trees<const D: usize, T> {
    movers: T,
    statics: T,
    /// By box that may move: its place in the tree.
    places: Vec<i32>,
    fat: Vec<Aabb<D>>,
    /// The boxes that left their fat AABBs in this frame.
    left: Vec<u32>,
    /// By box: whether it is one of these.
    has_left: Vec<bool>,
    pairs: FxHashSet<[u32; 2]>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

fn fatten<const D: usize>(aabb: &Aabb<D>) -> Aabb<D> {
    let squares = aabb.half_extents().map(|half| half * half);
    aabb.grow(MARGIN * squares.iter().sum::<f32>().sqrt())
}

impl<const D: usize, T: DynamicTree<D>> Trees<D, T> {
    /// What `b2UpdateBroadPhasePairs` does with the boxes that left, and then the contacts.
    fn update(&mut self) -> Found<'_> {
        let Self { movers, statics, fat, left, has_left, pairs, begun, ended, .. } = self;
        begun.clear();
        for &index in &*left {
            let mut meet = |other: u32| {
                // If both boxes have left their fat AABBs, the one with the larger index reports the pair.
                if other != index && !(has_left[other as usize] && index < other) {
                    let pair = [index.min(other), index.max(other)];
                    if !pairs.contains(&pair) {
                        begun.push(pair);
                    }
                }
            };
            movers.query(&fat[index as usize], &mut meet);
            statics.query(&fat[index as usize], &mut meet);
        }
        pairs.extend(&*begun);
        movers.rebuild(false);
        left.drain(..).for_each(|index| has_left[index as usize] = false);
        ended.clear();
        pairs.retain(|&[a, b]| {
            let stays = fat[a as usize].overlaps(&fat[b as usize]);
            if !stays {
                ended.push([a, b]);
            }
            stays
        });
        Found::Events { begun, ended }
    }
}

impl<const D: usize, T: DynamicTree<D>> World<D> for Trees<D, T> {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>> {
        for (index, aabb) in (0..).zip(boxes) {
            let moves = (index as usize) < movers;
            self.has_left.push(moves);
            if moves {
                self.fat.push(fatten(aabb));
                self.places.push(self.movers.insert(&self.fat[index as usize], index));
                self.left.push(index);
            } else {
                self.fat.push(*aabb);
                self.statics.insert(aabb, index);
            }
        }
        Ok(self.update())
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>> {
        for &index in moved {
            let at = index as usize;
            if !self.fat[at].contains(&boxes[at]) {
                self.fat[at] = fatten(&boxes[at]);
                self.movers.enlarge(self.places[at], &self.fat[at]);
                self.left.push(index);
                self.has_left[at] = true;
            }
        }
        Ok(self.update())
    }
}
