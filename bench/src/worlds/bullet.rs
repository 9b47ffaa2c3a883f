//! Bullet: its two broad phases, behind the functions of `cpp/bullet.cpp`.
#![allow(unsafe_code)]

use std::ffi::c_void;

use anyhow::Result;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::cpp::{Boxes, Pairs};
use crate::libraries::{Library, Origin};

unsafe extern "C" {
    fn bench_bullet_world_new(boxes: *const Boxes, movers: usize, sweep: bool) -> *mut c_void;
    fn bench_bullet_world_delete(world: *mut c_void);
    fn bench_bullet_world_step(
        world: *mut c_void,
        boxes: *const Boxes,
        moved: *const u32,
        count: usize,
    );
    fn bench_bullet_world_pairs(world: *const c_void, pairs: *mut c_void);
}

/// Both.
pub const LIBRARIES: [WorldLibrary; 2] = [
    Library {
        name: "Bullet tree",
        origin: Origin::Debian("libbullet-dev"),
        how: "`btDbvtBroadphase`: `setAabb` for each box that moved, `calculateOverlappingPairs`; \
              the margin of its boxes is 0.05 of the mean width, as 0.05 m is of its usual 1 m",
        alternative: true,
        two: Some(|| Box::new(Bullet::new(false))),
        three: Some(|| Box::new(Bullet::new(false))),
    },
    Library {
        name: "Bullet sweep",
        origin: Origin::Debian("libbullet-dev"),
        how: "the same with `btAxisSweep3` (32 bits from 16,384 boxes); it rounds coordinates",
        alternative: true,
        two: Some(|| Box::new(Bullet::new(true))),
        three: Some(|| Box::new(Bullet::new(true))),
    },
];

struct Bullet {
    sweep: bool,
    /// Null before the start.
    world: *mut c_void,
    pairs: Pairs,
}

impl Bullet {
    fn new(sweep: bool) -> Self {
        Self { sweep, world: std::ptr::null_mut(), pairs: Pairs::default() }
    }
}

impl Drop for Bullet {
    fn drop(&mut self) {
        // SAFETY: made by `bench_bullet_world_new`, or null, and deleted only here.
        unsafe { bench_bullet_world_delete(self.world) }
    }
}

impl<const D: usize> World<D> for Bullet {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>> {
        // SAFETY: the boxes are valid for the call.
        self.world = unsafe { bench_bullet_world_new(&Boxes::from(boxes), movers, self.sweep) };
        Ok(Found::Kept)
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>> {
        let boxes = Boxes::from(boxes);
        // SAFETY: the world was made in `start`; boxes and indices are valid for the call.
        unsafe { bench_bullet_world_step(self.world, &boxes, moved.as_ptr(), moved.len()) };
        Ok(Found::Kept)
    }

    fn kept(&mut self) -> &[[u32; 2]] {
        // SAFETY: the world was made in `start`, and nothing else has the vector.
        self.pairs.fill(|pairs| unsafe { bench_bullet_world_pairs(self.world, pairs) })
    }
}
