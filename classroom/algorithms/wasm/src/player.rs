//! A player of what a runner has recorded.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune_algorithms::{Endpoint, Player};
use sweep_and_prune_wasm_runtime::call::{self, Running, run, stack};
use sweep_and_prune_wasm_runtime::status::{Code, report};

use crate::numbers;
use crate::runner::Handle;

/// What JavaScript holds a pointer to.
#[repr(C)]
struct Playing {
    running: Running,
    player: Player,
    state: Vec<f64>,
}

impl call::Handle for Playing {
    fn running(&mut self) -> &mut Running {
        &mut self.running
    }
}

/// A player of what a runner has recorded, to be freed by [`player_free`].
#[unsafe(no_mangle)]
extern "C" fn player_new(handle: &mut Handle) -> Box<Playing> {
    stack::check(stack::LARGE);
    let player = Player::new(handle.trace().clone());
    Box::new(Playing { running: Running::default(), player, state: Vec::new() })
}

/// Frees a player and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn player_free(playing: Option<Box<Playing>>) {
    call::free(playing);
}

/// Plays or undoes until `position` events have been played, or all. Returns how many have been played.
#[unsafe(no_mangle)]
extern "C" fn player_seek(playing: &mut Playing, position: usize) -> usize {
    run(playing, stack::LARGE, |playing| {
        playing.player.seek(position);
        playing.player.position()
    })
}

/// Details: where the state is, and how many numbers. These are the axis, the axis of the current
/// array, the position and edge of the line or -1, the ten counts; and then lists, each with its
/// length in front: active boxes, overlaps, held pairs, axis overlaps (axis, a, b), and of each
/// axis the endpoints (edge, at). `classroom/demo/src/algorithms/player.ts` reads them.
#[unsafe(no_mangle)]
extern "C" fn player_state(playing: &mut Playing) -> Code {
    run(playing, stack::LARGE, write_state)
}

fn write_state(playing: &mut Playing) -> Code {
    let state = playing.player.state();
    let out = &mut playing.state;
    out.clear();
    let line = state.line.map_or([-1.0, -1.0], |(position, edge)| {
        [position as f64, numbers::edge(edge.id, edge.side)]
    });
    out.extend([state.axis as f64, state.array_axis as f64]);
    out.extend(line);
    out.extend(numbers::counts(&state.counts));
    out.push(state.active.len() as f64);
    out.extend(state.active.iter().map(|&id| f64::from(id)));
    for pairs in [&state.overlaps, &state.held] {
        out.push(2.0 * pairs.len() as f64);
        out.extend(pairs.iter().flatten().map(|&id| f64::from(id)));
    }
    out.push(3.0 * state.axis_overlaps.len() as f64);
    out.extend(
        state
            .axis_overlaps
            .iter()
            .flat_map(|&(axis, [a, b])| [axis as f64, f64::from(a), f64::from(b)]),
    );
    out.push(state.arrays.len() as f64);
    for array in &state.arrays {
        out.push(2.0 * array.len() as f64);
        out.extend(
            array.iter().flat_map(|&Endpoint { at, edge }| {
                [numbers::edge(edge.id, edge.side), f64::from(at)]
            }),
        );
    }
    report(Code::Ok, [out.as_ptr().addr(), out.len()])
}
