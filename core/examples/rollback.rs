//! Rollback: a client guesses the other player's input, learns better, and plays the frames again.
//!
//! `cargo run --example rollback`

use sweep_and_prune::{Aabb, BroadPhase, Error};

type World = BroadPhase<2>;

/// One frame with each player's step along x; returns the number of pairs that began or ended.
fn play(world: &mut World, steps: [f32; 2]) -> Result<usize, Error> {
    let players: Vec<_> = world.ids().take(2).collect();
    for (id, step) in players.into_iter().zip(steps) {
        let Aabb { mut min, mut max } = world.aabb(id)?;
        min[0] += step;
        max[0] += step;
        world.set(id, Aabb::new(min, max))?;
    }
    let changes = world.update();
    Ok(changes.begun().len() + changes.ended().len())
}

fn main() -> Result<(), Error> {
    let mut client = World::new();
    client.insert(Aabb::new([0.0, 0.0], [1.0, 1.0]))?;
    client.insert(Aabb::new([3.0, 0.0], [4.0, 1.0]))?;
    client.update();
    let mut server = World::from_snapshot(&client.snapshot())?;

    let saved = client.snapshot();
    let guessed = play(&mut client, [0.5, 0.0])? + play(&mut client, [0.5, 0.0])?;
    let real = play(&mut server, [0.5, -1.0])? + play(&mut server, [0.5, -1.0])?;
    assert_ne!(client.state_hash(), server.state_hash());
    println!("guessed {guessed} events, but there were {real}: the client rolls back");

    client = World::from_snapshot(&saved)?;
    play(&mut client, [0.5, -1.0])?;
    play(&mut client, [0.5, -1.0])?;
    assert_eq!(client.state_hash(), server.state_hash());
    Ok(())
}
