//! PhysX: its stand-alone broad phases, which keep their boxes and report the pairs that were
//! created and those that were deleted.
#![allow(unsafe_code)]

use std::{ptr, slice};

use anyhow::Result;
use physx_sys::*;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::physx::{bounds, broad_phase, regions};
use crate::libraries::{Library, Origin};

/// Declares a broad phase of PhysX.
macro_rules! physx {
    ($name:literal, $kind:ident, $how:literal) => {
        Library {
            name: $name,
            origin: Origin::Crate("physx-sys"),
            how: $how,
            alternative: true,
            two: Some(|| Box::new(PhysX::new(PxBroadPhaseType::$kind))),
            three: Some(|| Box::new(PhysX::new(PxBroadPhaseType::$kind))),
        }
    };
}

/// All of them that run on a processor; PABP is ABP on threads.
pub const LIBRARIES: [WorldLibrary; 3] = [
    physx!(
        "PhysX ABP",
        Abp,
        "`PxCreateBroadPhase` (ABP) once, one `update` a frame with the boxes that moved, on one \
         thread"
    ),
    physx!(
        "PhysX MBP",
        Mbp,
        "the same with MBP and 4 × 4 regions of the world's bounds; it rounds coordinates"
    ),
    physx!("PhysX SAP", Sap, "the same with SAP; it rounds coordinates"),
];

struct PhysX {
    kind: PxBroadPhaseType,
    /// Null before the start.
    broad_phase: *mut PxBroadPhase,
    bounds: Vec<PxBounds3>,
    groups: Vec<u32>,
    distances: Vec<f32>,
    begun: Vec<[u32; 2]>,
    ended: Vec<[u32; 2]>,
}

impl PhysX {
    fn new(kind: PxBroadPhaseType) -> Self {
        Self {
            kind,
            broad_phase: ptr::null_mut(),
            bounds: Vec::new(),
            groups: Vec::new(),
            distances: Vec::new(),
            begun: Vec::new(),
            ended: Vec::new(),
        }
    }

    fn update(&mut self, created: &[u32], moved: &[u32]) -> Found<'_> {
        // SAFETY: `self` owns the broad phase and releases it only in `drop`. Each array holds the number of elements that is
        // passed with it, and the bounds one more, which PhysX may read. The pairs that it points to stay until the next
        // update, which needs `self` exclusively; they are copied before.
        unsafe {
            let update = PxBroadPhaseUpdateData_new(
                created.as_ptr(),
                created.len() as u32,
                moved.as_ptr(),
                moved.len() as u32,
                ptr::null(),
                0,
                self.bounds.as_ptr(),
                self.groups.as_ptr(),
                self.distances.as_ptr(),
                self.groups.len() as u32,
            );
            let mut results = PxBroadPhaseResults_new();
            PxBroadPhase_update_mut_1(self.broad_phase, &mut results, &update);
            copy(results.mCreatedPairs, results.mNbCreatedPairs, &mut self.begun);
            copy(results.mDeletedPairs, results.mNbDeletedPairs, &mut self.ended);
        }
        Found::Events { begun: &self.begun, ended: &self.ended }
    }
}

/// # Safety
/// `from` points to `count` pairs unless that is 0.
unsafe fn copy(from: *const PxBroadPhasePair, count: u32, to: &mut Vec<[u32; 2]>) {
    to.clear();
    if count > 0 {
        // SAFETY: `from` points to `count` pairs, which PhysX keeps until the next update. The slice is dropped before.
        let pairs = unsafe { slice::from_raw_parts(from, count as usize) };
        to.extend(pairs.iter().map(|pair| [pair.mID0, pair.mID1]));
    }
}

impl Drop for PhysX {
    fn drop(&mut self) {
        if !self.broad_phase.is_null() {
            // SAFETY: made in `start` and released only here.
            unsafe { PxBroadPhase_release_mut(self.broad_phase) }
        }
    }
}

impl<const D: usize> World<D> for PhysX {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<D>], movers: usize) -> Result<Found<'a>> {
        let created: Vec<u32> = (0..boxes.len() as u32).collect();
        // PhysX may read past the last box.
        self.bounds = boxes.iter().chain(boxes.last()).map(bounds).collect();
        // SAFETY: each only computes a number.
        let group = |&id: &u32| unsafe {
            if (id as usize) < movers {
                phys_PxGetBroadPhaseDynamicFilterGroup(id)
            } else {
                phys_PxGetBroadPhaseStaticFilterGroup()
            }
        };
        self.groups = created.iter().map(group).collect();
        self.distances = vec![0.0; boxes.len()];
        self.broad_phase = broad_phase(self.kind)?;
        // SAFETY: the broad phase lives; the arrays hold the boxes that it knows, which are none.
        unsafe {
            let wanted = PxBroadPhase_getRegions_mut(self.broad_phase);
            if !wanted.is_null() && !boxes.is_empty() {
                // Boxes that move stay within these.
                let margin = boxes[0].max[0] - boxes[0].min[0];
                for bounds in regions(&self.bounds, margin) {
                    let region = PxBroadPhaseRegion { mBounds: bounds, mUserData: ptr::null_mut() };
                    let (bounds, distances) = (self.bounds.as_ptr(), self.distances.as_ptr());
                    PxBroadPhaseRegions_addRegion_mut(wanted, &region, false, bounds, distances);
                }
            }
        }
        Ok(self.update(&created, &[]))
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<D>], moved: &[u32]) -> Result<Found<'a>> {
        for &index in moved {
            self.bounds[index as usize] = bounds(&boxes[index as usize]);
        }
        Ok(self.update(&[], moved))
    }
}
