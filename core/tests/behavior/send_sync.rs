//! Public types can be sent to and shared with other threads: this file compiles only if they can.

use sweep_and_prune::{
    Aabb, BroadPhase, Cast, Changes, Error, Filter, Hit, Kernel, Lists, Neighbor, Options,
    PairFinder, Pairs, ProxyId, Queries, Report, SnapshotFault,
};

fn is_send_and_sync<T: Send + Sync>() {}

#[test]
fn boxes_errors_and_finders_are_send_and_sync() {
    is_send_and_sync::<Aabb<1>>();
    is_send_and_sync::<Aabb<3, f64>>();
    is_send_and_sync::<Error>();
    is_send_and_sync::<SnapshotFault>();
    is_send_and_sync::<Kernel>();
    is_send_and_sync::<PairFinder<2>>();
    is_send_and_sync::<PairFinder<3, f64>>();
}

#[test]
fn worlds_and_what_they_return_are_send_and_sync() {
    is_send_and_sync::<BroadPhase<2>>();
    is_send_and_sync::<BroadPhase<3, f64>>();
    is_send_and_sync::<Options<f64>>();
    is_send_and_sync::<ProxyId>();
    is_send_and_sync::<Filter>();
    is_send_and_sync::<Changes<'static>>();
    is_send_and_sync::<Pairs<'static>>();
    is_send_and_sync::<Queries<'static, 2>>();
    is_send_and_sync::<Lists<ProxyId>>();
    is_send_and_sync::<Cast<2>>();
    is_send_and_sync::<Hit<3, f64>>();
    is_send_and_sync::<Neighbor>();
    is_send_and_sync::<Report>();
}
