//! Box2D: its dynamic tree, used as its own broad phase does, which is out of reach from outside.
#![allow(unsafe_code)]

use std::ffi::c_void;

use anyhow::Result;
use boxdd_sys::ffi::*;
use rustc_hash::FxHashSet;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::{Library, Origin};

/// In two dimensions only.
pub const LIBRARY: WorldLibrary = Library {
    name: "Box2D",
    origin: Origin::Crate("boxdd-sys"),
    how: "`b2DynamicTree` with fat AABBs as `b2BroadPhase` keeps them: `b2DynamicTree_EnlargeProxy` \
          for each box that left its own (the margin is 1/8 of half its diagonal), \
          `b2DynamicTree_Query` for each of these, `b2DynamicTree_Rebuild`, and pairs dropped when \
          their fat AABBs part",
    alternative: true,
    two: Some(|| Box::new(Box2d::default())),
    three: None,
};

/// What Box2D's constants say of the margin, as a fraction of half a box's diagonal.
const MARGIN: f32 = 0.125;

struct Box2d {
    tree: b2DynamicTree,
    /// By box: its number in the tree.
    proxies: Vec<i32>,
    fat: Vec<b2AABB>,
    /// The boxes that left their fat AABBs in this frame.
    left: Vec<u32>,
    /// By box: whether it is one of these.
    has_left: Vec<bool>,
    pairs: FxHashSet<[u32; 2]>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

impl Default for Box2d {
    fn default() -> Self {
        Self {
            // SAFETY: it takes a number; the tree is destroyed in `drop`.
            tree: unsafe { b2DynamicTree_Create(16) },
            proxies: Vec::new(),
            fat: Vec::new(),
            left: Vec::new(),
            has_left: Vec::new(),
            pairs: FxHashSet::default(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }
}

impl Drop for Box2d {
    fn drop(&mut self) {
        // SAFETY: made by `b2DynamicTree_Create` and destroyed only here.
        unsafe { b2DynamicTree_Destroy(&mut self.tree) }
    }
}

fn fatten(aabb: &Aabb<2>) -> b2AABB {
    let [width, height] = [0, 1].map(|axis| aabb.max[axis] - aabb.min[axis]);
    let margin = MARGIN * 0.5 * width.hypot(height);
    b2AABB {
        lowerBound: b2Vec2 { x: aabb.min[0] - margin, y: aabb.min[1] - margin },
        upperBound: b2Vec2 { x: aabb.max[0] + margin, y: aabb.max[1] + margin },
    }
}

fn contains(fat: &b2AABB, aabb: &Aabb<2>) -> bool {
    fat.lowerBound.x <= aabb.min[0]
        && fat.lowerBound.y <= aabb.min[1]
        && aabb.max[0] <= fat.upperBound.x
        && aabb.max[1] <= fat.upperBound.y
}

fn overlap(a: &b2AABB, b: &b2AABB) -> bool {
    a.lowerBound.x <= b.upperBound.x
        && a.lowerBound.y <= b.upperBound.y
        && b.lowerBound.x <= a.upperBound.x
        && b.lowerBound.y <= a.upperBound.y
}

/// A query for the pairs of a box that left its fat AABB.
struct Query<'a> {
    index: u32,
    has_left: &'a [bool],
    pairs: &'a FxHashSet<[u32; 2]>,
    begun: &'a mut Vec<[u32; 2]>,
}

/// Called by Box2D for each box of the tree that overlaps the one asked for.
unsafe extern "C" fn meet(_proxy: i32, other: u64, context: *mut c_void) -> bool {
    // SAFETY: the context is the query that `update` passes, which nothing else uses meanwhile.
    let query = unsafe { &mut *context.cast::<Query>() };
    let (index, other) = (query.index, other as u32);
    // If both boxes have left their fat AABBs, the one with the larger index reports the pair.
    if other != index && !(query.has_left[other as usize] && index < other) {
        let pair = [index.min(other), index.max(other)];
        if !query.pairs.contains(&pair) {
            query.begun.push(pair);
        }
    }
    true
}

impl Box2d {
    /// What `b2UpdateBroadPhasePairs` does with the boxes that left, and then the contacts.
    fn update(&mut self) -> Found<'_> {
        self.begun.clear();
        for &index in &self.left {
            let (has_left, pairs) = (&self.has_left[..], &self.pairs);
            let mut query = Query { index, has_left, pairs, begun: &mut self.begun };
            let context = (&raw mut query).cast();
            // SAFETY: the tree lives; `meet` gets back the query.
            unsafe {
                let all = u64::MAX;
                b2DynamicTree_Query(&self.tree, self.fat[index as usize], all, Some(meet), context);
            }
        }
        self.pairs.extend(&self.begun);
        // SAFETY: the tree lives.
        unsafe { b2DynamicTree_Rebuild(&mut self.tree, false) };
        self.left.drain(..).for_each(|index| self.has_left[index as usize] = false);
        self.ended.clear();
        let (fat, ended) = (&self.fat, &mut self.ended);
        self.pairs.retain(|&[a, b]| {
            let stays = overlap(&fat[a as usize], &fat[b as usize]);
            if !stays {
                ended.push([a, b]);
            }
            stays
        });
        Found::Events { begun: &self.begun, ended: &self.ended }
    }
}

impl World<2> for Box2d {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<2>]) -> Result<Found<'a>> {
        for (index, aabb) in (0..).zip(boxes) {
            let fat = fatten(aabb);
            // SAFETY: the tree lives.
            let proxy = unsafe { b2DynamicTree_CreateProxy(&mut self.tree, fat, u64::MAX, index) };
            self.proxies.push(proxy);
            self.fat.push(fat);
            self.left.push(index as u32);
            self.has_left.push(true);
        }
        Ok(self.update())
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<2>], moved: &[u32]) -> Result<Found<'a>> {
        for &index in moved {
            let at = index as usize;
            if !contains(&self.fat[at], &boxes[at]) {
                self.fat[at] = fatten(&boxes[at]);
                // SAFETY: the tree lives, and the proxy in it.
                unsafe {
                    let (proxy, fat) = (self.proxies[at], self.fat[at]);
                    b2DynamicTree_EnlargeProxy(&mut self.tree, proxy, fat);
                }
                self.left.push(index);
                self.has_left[at] = true;
            }
        }
        Ok(self.update())
    }
}
