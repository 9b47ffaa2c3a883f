//! PhysX: its stand-alone broad phases, box pruning in regions that it makes itself (ABP) or that
//! it is given (MBP), by Pierre Terdiman.
#![allow(unsafe_code)]

use std::ptr;
use std::sync::Once;

use anyhow::{Result, ensure};
use physx_sys::*;
use sweep_and_prune::Aabb;

use super::library::{Finder, Library, Origin, lift};

/// The one that it recommends on average.
pub const AUTOMATIC: Library = Library {
    name: "PhysX ABP",
    origin: Origin::Crate("physx-sys"),
    how: "`PxCreateBroadPhase` (ABP) from scratch, one `update` that creates all objects, on one thread",
    alternative: true,
    two: Some(|| Box::new(PhysX::new(PxBroadPhaseType::Abp))),
    three: Some(|| Box::new(PhysX::new(PxBroadPhaseType::Abp))),
};

/// The one that may be faster with well-chosen regions.
pub const MULTIPLE: Library = Library {
    name: "PhysX MBP",
    origin: Origin::Crate("physx-sys"),
    how: "`PxCreateBroadPhase` (MBP) from scratch with 4 × 4 regions of the world's bounds, one `update` \
          that creates all objects; it rounds coordinates, so its pairs are tested once more",
    alternative: true,
    two: Some(|| Box::new(PhysX::new(PxBroadPhaseType::Mbp))),
    three: Some(|| Box::new(PhysX::new(PxBroadPhaseType::Mbp))),
};

/// Regions along each of two axes, as PhysX recommends.
const REGIONS: u32 = 4;

struct PhysX {
    kind: PxBroadPhaseType,
    bounds: Vec<PxBounds3>,
    created: Vec<u32>,
    groups: Vec<u32>,
    distances: Vec<f32>,
    pairs: Vec<[u32; 2]>,
}

impl PhysX {
    fn new(kind: PxBroadPhaseType) -> Self {
        let (bounds, created, groups) = (Vec::new(), Vec::new(), Vec::new());
        Self { kind, bounds, created, groups, distances: Vec::new(), pairs: Vec::new() }
    }
}

/// A broad phase, which the caller has to release.
pub fn broad_phase(kind: PxBroadPhaseType) -> Result<*mut PxBroadPhase> {
    static FOUNDATION: Once = Once::new();
    // SAFETY: called once in the process, before anything else of PhysX.
    FOUNDATION.call_once(|| unsafe {
        physx_create_foundation();
    });
    // SAFETY: the foundation is there; the description is valid, and used up in the call.
    let broad_phase = unsafe { phys_PxCreateBroadPhase(&PxBroadPhaseDesc_new(kind)) };
    ensure!(!broad_phase.is_null(), "PhysX makes no broad phase");
    Ok(broad_phase)
}

/// The bounds of all boxes, `margin` larger on every side, in the four by four regions.
pub fn regions(boxes: &[PxBounds3], margin: f32) -> [PxBounds3; (REGIONS * REGIONS) as usize] {
    let mut world = boxes[0];
    for bounds in boxes {
        world.minimum = per_axis(f32::min, world.minimum, bounds.minimum);
        world.maximum = per_axis(f32::max, world.maximum, bounds.maximum);
    }
    let around = PxVec3 { x: margin, y: margin, z: margin };
    world.minimum = per_axis(|at, margin| at - margin, world.minimum, around);
    world.maximum = per_axis(|at, margin| at + margin, world.maximum, around);
    let mut regions = [world; (REGIONS * REGIONS) as usize];
    const Z_IS_UP: u32 = 2;
    // SAFETY: it writes REGIONS² bounds, and the array has capacity for them.
    unsafe {
        PxBroadPhaseExt_createRegionsFromWorldBounds(
            regions.as_mut_ptr(),
            &world,
            REGIONS,
            Z_IS_UP,
        );
    }
    regions
}

/// A box as PhysX has it.
pub fn bounds<const D: usize>(aabb: &Aabb<D>) -> PxBounds3 {
    PxBounds3 { minimum: corner(aabb.min), maximum: corner(aabb.max) }
}

fn per_axis(choose: fn(f32, f32) -> f32, a: PxVec3, b: PxVec3) -> PxVec3 {
    PxVec3 { x: choose(a.x, b.x), y: choose(a.y, b.y), z: choose(a.z, b.z) }
}

fn corner<const D: usize>(corner: [f32; D]) -> PxVec3 {
    let [x, y, z] = lift(corner);
    PxVec3 { x, y, z }
}

impl<const D: usize> Finder<D> for PhysX {
    fn find<'a>(&'a mut self, boxes: &'a [Aabb<D>]) -> Result<&'a [[u32; 2]]> {
        self.pairs.clear();
        if boxes.is_empty() {
            return Ok(&self.pairs);
        }
        let count = boxes.len() as u32;
        self.bounds.clear();
        // PhysX may read past the last box.
        self.bounds.extend(boxes.iter().chain(boxes.last()).map(bounds));
        self.created.clear();
        self.created.extend(0..count);
        self.groups.clear();
        // SAFETY: it only computes a number.
        self.groups
            .extend((0..count).map(|id| unsafe { phys_PxGetBroadPhaseDynamicFilterGroup(id) }));
        self.distances.clear();
        self.distances.resize(boxes.len(), 0.0);

        // SAFETY: the broad phase lives from its creation to its release below; the arrays hold as
        // many elements as it is told, and outlive it; the pairs are copied before the release.
        unsafe {
            let broad_phase = broad_phase(self.kind)?;
            let wanted = PxBroadPhase_getRegions_mut(broad_phase);
            if !wanted.is_null() {
                for bounds in regions(&self.bounds, 0.0) {
                    let region = PxBroadPhaseRegion { mBounds: bounds, mUserData: ptr::null_mut() };
                    let (bounds, distances) = (self.bounds.as_ptr(), self.distances.as_ptr());
                    PxBroadPhaseRegions_addRegion_mut(wanted, &region, false, bounds, distances);
                }
            }
            let update = PxBroadPhaseUpdateData_new(
                self.created.as_ptr(),
                count,
                ptr::null(),
                0,
                ptr::null(),
                0,
                self.bounds.as_ptr(),
                self.groups.as_ptr(),
                self.distances.as_ptr(),
                count,
            );
            let mut results = PxBroadPhaseResults_new();
            PxBroadPhase_update_mut_1(broad_phase, &mut results, &update);
            let found = match results.mNbCreatedPairs {
                0 => &[],
                found => std::slice::from_raw_parts(results.mCreatedPairs, found as usize),
            };
            let pairs = found.iter().map(|pair| [pair.mID0, pair.mID1]);
            if self.kind == PxBroadPhaseType::Abp {
                self.pairs.extend(pairs);
            } else {
                let overlap = |&[a, b]: &[u32; 2]| boxes[a as usize].overlaps(&boxes[b as usize]);
                self.pairs.extend(pairs.filter(overlap));
            }
            PxBroadPhase_release_mut(broad_phase);
        }
        Ok(&self.pairs)
    }
}
