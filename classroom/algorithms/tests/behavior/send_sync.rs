//! Public types can be sent to and shared with other threads: this file compiles only if they can.

use sweep_and_prune_algorithms::{
    Axis, Counts, Edge, Endpoint, Error, Event, Method, Player, Runner, RunnerOptions, Sort, Trace,
};

fn is_send_and_sync<T: Send + Sync>() {}

#[test]
fn algorithms_and_what_they_report_are_send_and_sync() {
    is_send_and_sync::<Runner<2>>();
    is_send_and_sync::<Runner<3, f64>>();
    is_send_and_sync::<RunnerOptions>();
    is_send_and_sync::<Method>();
    is_send_and_sync::<Sort>();
    is_send_and_sync::<Axis>();
    is_send_and_sync::<Counts>();
    is_send_and_sync::<Edge>();
    is_send_and_sync::<Endpoint<f32>>();
    is_send_and_sync::<Error>();
    is_send_and_sync::<Trace>();
    is_send_and_sync::<Event<'static>>();
    is_send_and_sync::<Player>();
}
