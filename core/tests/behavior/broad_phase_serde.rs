//! Worlds through serde, in a format without bytes: JSON.

use sweep_and_prune::{Aabb, BroadPhase, ProxyId};

#[test]
fn a_world_survives_json_and_a_cut_one_is_refused() {
    let mut world = BroadPhase::<2>::new();
    let id = world.insert(Aabb::new([0.0, 0.0], [1.0, 1.0])).unwrap();
    world.insert(Aabb::new([1.0, 1.0], [2.0, 2.0])).unwrap();
    world.update();
    let json = serde_json::to_string(&(&world, id)).unwrap();
    let (read, read_id): (BroadPhase<2>, ProxyId) = serde_json::from_str(&json).unwrap();
    assert_eq!((read.snapshot(), read_id), (world.snapshot(), id));
    assert!(read.pairs().eq(world.pairs()));
    assert!(serde_json::from_str::<BroadPhase<2>>("[83, 97, 80]").is_err());
}
