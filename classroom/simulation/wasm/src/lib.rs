//! The balls as plain `extern "C"` functions over linear memory, called by
//! `simulation.js` beside this crate, which hides all of it behind a class.
//!
//! # Layout
//! Numbers pass through one area of 16 `f64` at [`sim_area`]:
//!
//! | index | in: [`sim_new`] | out: [`sim_step`] | out: [`sim_describe`] |
//! |---|---|---|---|
//! | 0 | scene: 0 falling, 1 bouncing, 2 given balls | broad phases | dimensions |
//! | 1 | dimensions: 2 or 3 | tests, or -1: not counted | bodies |
//! | 2 | bodies | overlaps on the axis, or -1 | steps |
//! | 3 | size | comparisons, or -1 | bounds: min x |
//! | 4 | spread | swaps, or -1 | min y |
//! | 5 | seed | pairs | min z |
//! | 6 | width | contacts | max x |
//! | 7 | height | ms of broad phases | max y |
//! | 8 | | ms of narrow phases | max z |
//! | 9 | | ms of the step | gravity, downwards |
//! | 10 | | | restitution |
//! | 11 | | | substeps |
//! | 12 | | | collisions: 0 or 1 |
//! | 13 | | | counting: 0 or 1 |
//!
//! Given balls lie at [`sim_balls`], five `f32` a ball: x, y, radius, velocity x, velocity y.
//! Positions and velocities are rows of as many `f32` as there are dimensions, pairs rows of two
//! `u32`. Every pointer holds until the next call.
//!
//! Functions that can fail return a [`Code`]. A handle that is not, or no longer, one that
//! [`sim_new`] gave is refused.
//!
//! The module imports one function, `env.now() -> f64`: milliseconds from any origin.
// SAFETY of the exports: their names begin with `sim_` and no other symbol has them. They take
// numbers only and dereference no pointer.
#![allow(unsafe_code)]

mod code;
mod dynamic;
mod names;

use std::cell::RefCell;
use std::sync::atomic::AtomicU64;

use sweep_and_prune_exchange::{read_area, write_area};

use dynamic::{DynSimulation, Start};

pub use code::Code;

#[derive(Default)]
struct State {
    /// A handle is an index into these; places of freed simulations are used again.
    simulations: Vec<Option<Box<dyn DynSimulation>>>,
    balls: Vec<f32>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

/// Runs a function on a simulation.
fn with<R>(handle: u32, run: impl FnOnce(&mut dyn DynSimulation) -> R) -> Result<R, Code> {
    STATE.with_borrow_mut(|state| match state.simulations.get_mut(handle as usize) {
        Some(Some(simulation)) => Ok(run(simulation.as_mut())),
        _ => Err(Code::NoSuchSimulation),
    })
}

fn code(result: Result<(), Code>) -> Code {
    result.err().unwrap_or(Code::Ok)
}

/// Where the area is.
#[unsafe(no_mangle)]
pub extern "C" fn sim_area() -> *const AtomicU64 {
    sweep_and_prune_exchange::area()
}

/// Where to write `count` given balls, at most 4,096; null if there are more.
#[unsafe(no_mangle)]
pub extern "C" fn sim_balls(count: u32) -> *mut f32 {
    if count > dynamic::MOST_GIVEN {
        return std::ptr::null_mut();
    }
    STATE.with_borrow_mut(|state| {
        state.balls = vec![0.0; count as usize * 5];
        state.balls.as_mut_ptr()
    })
}

/// Makes a simulation from the options in the area. The handle is then at index 0.
#[unsafe(no_mangle)]
pub extern "C" fn sim_new() -> Code {
    let area = read_area();
    STATE.with_borrow_mut(|state| {
        let start = Start::read(&area, &state.balls);
        let simulation = match start.and_then(|start| dynamic::open(&start)) {
            Ok(simulation) => simulation,
            Err(code) => return code,
        };
        let free = state.simulations.iter().position(Option::is_none);
        let handle = free.unwrap_or(state.simulations.len());
        if handle == state.simulations.len() {
            state.simulations.push(None);
        }
        state.simulations[handle] = Some(simulation);
        write_area(&[handle as f64]);
        Code::Ok
    })
}

/// Forgets a simulation.
#[unsafe(no_mangle)]
pub extern "C" fn sim_free(handle: u32) -> Code {
    STATE.with_borrow_mut(|state| match state.simulations.get_mut(handle as usize) {
        Some(place @ Some(_)) => {
            *place = None;
            Code::Ok
        }
        _ => Code::NoSuchSimulation,
    })
}

/// One step of 1/60 s; what it did is in the area.
#[unsafe(no_mangle)]
pub extern "C" fn sim_step(handle: u32) -> Code {
    code(with(handle, |simulation| simulation.step()).flatten().map(|report| write_area(&report)))
}

/// What the simulation is, into the area.
#[unsafe(no_mangle)]
pub extern "C" fn sim_describe(handle: u32) -> Code {
    code(with(handle, |simulation| write_area(&simulation.describe())))
}

/// Changes a setting: 0 gravity downwards, 1 restitution, 2 substeps, 3 collisions, 4 counting.
/// Numbers out of range are clamped.
#[unsafe(no_mangle)]
pub extern "C" fn sim_set(handle: u32, setting: u32, value: f64) -> Code {
    code(with(handle, |simulation| simulation.set(setting, value)).flatten())
}

/// Chooses the broad phase: the indices of an algorithm, a sort and an axis rule in the lists of
/// [`sim_names`]; an axis rule beyond the list is that axis, counted from there.
#[unsafe(no_mangle)]
pub extern "C" fn sim_set_broad_phase(
    handle: u32,
    algorithm: u32,
    sort: u32,
    axis: u32,
    persistent: u32,
) -> Code {
    let choice = names::broad_phase(algorithm, sort, axis, persistent != 0);
    code(
        choice.and_then(|choice| {
            with(handle, |simulation| simulation.set_broad_phase(choice)).flatten()
        }),
    )
}

/// The names of algorithms (0), sorts (1) or axis rules (2), in UTF-8, one a line. How many bytes
/// there are is in the area at 0.
#[unsafe(no_mangle)]
pub extern "C" fn sim_names(kind: u32) -> *const u8 {
    let names = names::list(kind);
    write_area(&[names.len() as f64]);
    names.as_ptr()
}

/// The centers; null without such a simulation.
#[unsafe(no_mangle)]
pub extern "C" fn sim_positions(handle: u32) -> *const f32 {
    with(handle, |simulation| simulation.positions().as_ptr()).unwrap_or(std::ptr::null())
}

/// The velocities; null without such a simulation.
#[unsafe(no_mangle)]
pub extern "C" fn sim_velocities(handle: u32) -> *const f32 {
    with(handle, |simulation| simulation.velocities().as_ptr()).unwrap_or(std::ptr::null())
}

/// The radii; null without such a simulation.
#[unsafe(no_mangle)]
pub extern "C" fn sim_radii(handle: u32) -> *const f32 {
    with(handle, |simulation| simulation.radii().as_ptr()).unwrap_or(std::ptr::null())
}

/// The pairs of the boxes of the last step; null without such a simulation. How many is in the area
/// at 0.
#[unsafe(no_mangle)]
pub extern "C" fn sim_pairs(handle: u32) -> *const u32 {
    let pairs = with(handle, |simulation| {
        let pairs = simulation.pairs();
        write_area(&[(pairs.len() / 2) as f64]);
        pairs.as_ptr()
    });
    pairs.unwrap_or(std::ptr::null())
}

/// Saves the moment; its number is then at index 0.
#[unsafe(no_mangle)]
pub extern "C" fn sim_save(handle: u32) -> Code {
    code(with(handle, |simulation| write_area(&[simulation.save() as f64])))
}

/// Goes back to a saved moment.
#[unsafe(no_mangle)]
pub extern "C" fn sim_restore(handle: u32, moment: u32) -> Code {
    code(with(handle, |simulation| simulation.restore(moment as usize)).flatten())
}

/// Forgets a saved moment, if there is such a one.
#[unsafe(no_mangle)]
pub extern "C" fn sim_forget(handle: u32, moment: u32) -> Code {
    code(with(handle, |simulation| simulation.forget(moment as usize)))
}

/// Puts a ball at x, y, with this velocity.
#[unsafe(no_mangle)]
pub extern "C" fn sim_place(handle: u32, ball: u32, x: f32, y: f32, vx: f32, vy: f32) -> Code {
    let place =
        |simulation: &mut dyn DynSimulation| simulation.place(ball as usize, [x, y], [vx, vy]);
    code(with(handle, place).flatten())
}

/// Kinetic and potential energy per unit of mass; 0 without such a simulation.
#[unsafe(no_mangle)]
pub extern "C" fn sim_energy(handle: u32) -> f64 {
    with(handle, |simulation| simulation.energy()).unwrap_or(0.0)
}

/// Half of the hash of the state: the upper 32 bits, or the lower.
#[unsafe(no_mangle)]
pub extern "C" fn sim_hash(handle: u32, upper: u32) -> u32 {
    let hash = with(handle, |simulation| simulation.hash()).unwrap_or(0);
    if upper != 0 { (hash >> 32) as u32 } else { hash as u32 }
}
