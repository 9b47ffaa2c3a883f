//! Jolt Physics: whole steps of bodies that collide with nothing. Its C interface neither updates the broad phase alone
//! nor tells which pairs it found.
#![allow(unsafe_code)]

use std::collections::HashMap;
use std::ffi::c_void;
use std::ptr;
use std::sync::Once;

use anyhow::{Context, Result};
use joltc_sys::*;
use sweep_and_prune::Aabb;

use super::world::{Found, World, WorldLibrary};
use crate::libraries::{Library, Origin};

/// In three dimensions only.
pub const LIBRARY: WorldLibrary = Library {
    name: "Jolt, whole steps, pairs not checked",
    origin: Origin::Crate("joltc-sys"),
    how: "bodies added by `AddBodiesPrepare` and `AddBodiesFinalize`, those that move in a broad phase layer of their own, \
          then `OptimizeBroadPhase`; one `Update` a frame without worker threads. The bodies fly by themselves, without \
          gravity; the filter of object layers rejects each pair that the broad phase offers, so nothing follows it. JoltC \
          has no function that updates only the broad phase, and none that tells the pairs",
    alternative: true,
    two: None,
    three: Some(|| Box::new(Jolt::default())),
};

/// The layers, of objects as of the broad phase.
const STATIC: u16 = 0;
const MOVING: u16 = 1;
/// The time of a step, in seconds.
const STEP: f32 = 1.0 / 60.0;
/// What a step may use, in bytes: more than enough for steps without contacts.
const SCRATCH: u32 = 64 << 20;
/// Pairs in a step, at most. Each one is rejected before it takes a place.
const PAIRS: u32 = 1 << 16;

/// All null before the start.
struct Jolt {
    system: *mut JPC_PhysicsSystem,
    layers: *mut JPC_BroadPhaseLayerInterface,
    between_layers: *mut JPC_ObjectVsBroadPhaseLayerFilter,
    between_objects: *mut JPC_ObjectLayerPairFilter,
    scratch: *mut JPC_TempAllocatorImpl,
    jobs: *mut JPC_JobSystemThreadPool,
    shapes: HashMap<[u32; 3], *mut JPC_Shape>,
    bodies: Vec<JPC_BodyID>,
    /// By body that may move: where its center was in the last frame, and its velocity.
    flights: Vec<[[f32; 3]; 2]>,
}

impl Default for Jolt {
    fn default() -> Self {
        Self {
            system: ptr::null_mut(),
            layers: ptr::null_mut(),
            between_layers: ptr::null_mut(),
            between_objects: ptr::null_mut(),
            scratch: ptr::null_mut(),
            jobs: ptr::null_mut(),
            shapes: HashMap::new(),
            bodies: Vec::new(),
            flights: Vec::new(),
        }
    }
}

unsafe extern "C" fn count_layers(_: *const c_void) -> u32 {
    2
}

unsafe extern "C" fn layer_of(_: *const c_void, object: u16) -> u8 {
    object as u8
}

/// Bodies that move are looked up among all, static ones never.
unsafe extern "C" fn may_meet_layer(_: *const c_void, object: u16, layer: u8) -> bool {
    object == MOVING || layer == MOVING as u8
}

unsafe extern "C" fn may_meet_object(_: *const c_void, _: u16, _: u16) -> bool {
    false
}

fn vector([x, y, z]: [f32; 3]) -> JPC_Vec3 {
    JPC_Vec3 { x, y, z, _w: z }
}

impl Jolt {
    /// An empty system for this many bodies.
    fn set_up(&mut self, bodies: usize) {
        static REGISTERED: Once = Once::new();
        // SAFETY: called once in the process, before anything else of Jolt.
        REGISTERED.call_once(|| unsafe {
            JPC_RegisterDefaultAllocator();
            JPC_FactoryInit();
            JPC_RegisterTypes();
        });
        // SAFETY: the functions use nothing that they are passed, so `self` may be null. What is made here is deleted in
        // `drop`, the system before what it points to.
        unsafe {
            self.scratch = JPC_TempAllocatorImpl_new(SCRATCH);
            let (most_jobs, barriers) = (JPC_MAX_PHYSICS_JOBS, JPC_MAX_PHYSICS_BARRIERS);
            self.jobs = JPC_JobSystemThreadPool_new3(most_jobs as u32, barriers as u32, 0);
            self.layers = JPC_BroadPhaseLayerInterface_new(
                ptr::null(),
                JPC_BroadPhaseLayerInterfaceFns {
                    GetNumBroadPhaseLayers: Some(count_layers),
                    GetBroadPhaseLayer: Some(layer_of),
                },
            );
            self.between_layers = JPC_ObjectVsBroadPhaseLayerFilter_new(
                ptr::null(),
                JPC_ObjectVsBroadPhaseLayerFilterFns { ShouldCollide: Some(may_meet_layer) },
            );
            self.between_objects = JPC_ObjectLayerPairFilter_new(
                ptr::null(),
                JPC_ObjectLayerPairFilterFns { ShouldCollide: Some(may_meet_object) },
            );
            self.system = JPC_PhysicsSystem_new();
            JPC_PhysicsSystem_Init(
                self.system,
                bodies as u32,
                0,
                PAIRS,
                PAIRS,
                self.layers,
                self.between_layers,
                self.between_objects,
            );
        }
    }

    /// The shape of these half extents, one for all boxes of a size.
    fn shape(&mut self, half: [f32; 3]) -> Result<*mut JPC_Shape> {
        let key = half.map(f32::to_bits);
        if let Some(&shape) = self.shapes.get(&key) {
            return Ok(shape);
        }
        let settings = JPC_BoxShapeSettings { HalfExtent: vector(half), ..Default::default() };
        let (mut shape, mut error) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: the pointers are valid for the call. The shape is one that we hold, and released in `drop`.
        let made = unsafe { JPC_BoxShapeSettings_Create(&settings, &mut shape, &mut error) };
        anyhow::ensure!(made, "Jolt makes no box of {half:?}");
        self.shapes.insert(key, shape);
        Ok(shape)
    }
}

impl Drop for Jolt {
    fn drop(&mut self) {
        if self.system.is_null() {
            return;
        }
        // SAFETY: all were made in `set_up` or `shape` and are deleted only here, each after those that use it. The bodies
        // belong to the system, which destroys them.
        unsafe {
            JPC_PhysicsSystem_delete(self.system);
            JPC_BroadPhaseLayerInterface_delete(self.layers);
            JPC_ObjectVsBroadPhaseLayerFilter_delete(self.between_layers);
            JPC_ObjectLayerPairFilter_delete(self.between_objects);
            JPC_JobSystemThreadPool_delete(self.jobs);
            JPC_TempAllocatorImpl_delete(self.scratch);
            self.shapes.values().for_each(|&shape| JPC_Shape_Release(shape));
        }
    }
}

impl World<3> for Jolt {
    fn start<'a>(&'a mut self, boxes: &'a [Aabb<3>], movers: usize) -> Result<Found<'a>> {
        self.set_up(boxes.len());
        for (index, aabb) in boxes.iter().enumerate() {
            let moves = index < movers;
            let settings = JPC_BodyCreationSettings {
                Position: vector(aabb.center()),
                MotionType: if moves { JPC_MOTION_TYPE_DYNAMIC } else { JPC_MOTION_TYPE_STATIC },
                ObjectLayer: if moves { MOVING } else { STATIC },
                AllowSleeping: false,
                LinearDamping: 0.0,
                GravityFactor: 0.0,
                Shape: self.shape(aabb.half_extents())?,
                ..Default::default()
            };
            // SAFETY: the system lives, and the settings are valid for the call. The body is null if there is no space.
            let id = unsafe {
                let interface = JPC_PhysicsSystem_GetBodyInterface(self.system);
                let body = JPC_BodyInterface_CreateBody(interface, &settings);
                body.as_ref().map(|body| JPC_Body_GetID(body))
            };
            self.bodies.push(id.context("Jolt has no space for a body")?);
        }
        self.flights = boxes[..movers].iter().map(|aabb| [aabb.center(), [0.0; 3]]).collect();
        // Adding a batch reorders its ids.
        let mut ids = self.bodies.clone();
        let (moving, resting) = ids.split_at_mut(movers);
        let batches = [(moving, JPC_ACTIVATION_ACTIVATE), (resting, JPC_ACTIVATION_DONT_ACTIVATE)];
        for (batch, activation) in batches {
            if batch.is_empty() {
                continue;
            }
            // SAFETY: the system lives; the ids of a batch are distinct bodies that it has not added yet.
            unsafe {
                let interface = JPC_PhysicsSystem_GetBodyInterface(self.system);
                let (at, count) = (batch.as_mut_ptr(), batch.len() as i32);
                let state = JPC_BodyInterface_AddBodiesPrepare(interface, at, count);
                JPC_BodyInterface_AddBodiesFinalize(interface, at, count, state, activation);
            }
        }
        // SAFETY: the system lives.
        unsafe { JPC_PhysicsSystem_OptimizeBroadPhase(self.system) };
        Ok(Found::Unknown)
    }

    fn step<'a>(&'a mut self, boxes: &'a [Aabb<3>], moved: &[u32]) -> Result<Found<'a>> {
        // A body that flies on as it did needs no call.
        for &index in moved {
            let [last, velocity] = &mut self.flights[index as usize];
            let center = boxes[index as usize].center();
            let now: [f32; 3] = std::array::from_fn(|axis| (center[axis] - last[axis]) / STEP);
            *last = center;
            if now.iter().zip(&*velocity).any(|(a, b)| (a - b).abs() > 0.01) {
                *velocity = now;
                let body = self.bodies[index as usize];
                // SAFETY: the system lives, and the body in it.
                unsafe {
                    let interface = JPC_PhysicsSystem_GetBodyInterface(self.system);
                    JPC_BodyInterface_SetLinearVelocity(interface, body, vector(now));
                }
            }
        }
        // SAFETY: the system lives, as do its allocator and its jobs.
        let error =
            unsafe { JPC_PhysicsSystem_Update(self.system, STEP, 1, self.scratch, self.jobs) };
        anyhow::ensure!(error == JPC_PHYSICS_UPDATE_ERROR_NONE, "Jolt's update failed: {error}");
        Ok(Found::Unknown)
    }
}
