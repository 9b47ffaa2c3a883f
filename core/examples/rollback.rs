//! Rollback netcode: the client does not wait for the other player's input. It guesses it, and keeps the worlds of the last
//! frames. When the input arrives and is not what was guessed, the client goes back and plays the frames again.
//!
//! The worlds are kept as clones, by `clone_from`, which copies into memory that is there. A snapshot holds the same state in
//! fewer bytes and takes longer: it is for files and for other machines.
//!
//! `cargo run --example rollback`

use sweep_and_prune::{Aabb, BroadPhase, Error, ProxyId};

/// How many frames later than the own input that of the other player arrives, at most.
const DELAY: usize = 6;

/// Which way a player walks: -1, 0 or 1.
type Input = f32;

/// All that a frame changes.
#[derive(Clone, Default)]
struct Game {
    world: BroadPhase<2>,
    players: Vec<ProxyId>,
    /// How often each player has bumped into something.
    bumps: [u32; 2],
}

impl Game {
    fn new() -> Result<Self, Error> {
        let mut game = Self::default();
        for x in [0.0, 6.0] {
            game.players.push(game.world.insert(Aabb::new([x, 0.0], [x + 1.0, 2.0]))?);
        }
        for x in [-4.0, 12.0] {
            game.world.insert(Aabb::new([x, 0.0], [x + 1.0, 9.0]))?;
        }
        game.world.update();
        Ok(game)
    }

    fn play(&mut self, inputs: [Input; 2]) -> Result<(), Error> {
        for (&id, step) in self.players.iter().zip(inputs) {
            let aabb = self.world.aabb(id)?.translate([0.5 * step, 0.0]);
            self.world.set(id, aabb)?;
        }
        for pair in self.world.update().begun() {
            for (player, bumps) in self.players.iter().zip(&mut self.bumps) {
                *bumps += u32::from(pair.contains(player));
            }
        }
        Ok(())
    }

    /// Becomes a copy of another game, without allocating if it was as large before.
    fn copy_from(&mut self, other: &Self) {
        let Self { world, players, bumps } = self;
        world.clone_from(&other.world);
        players.clone_from(&other.players);
        *bumps = other.bumps;
    }
}

/// What the players do: they walk for some frames and turn.
fn inputs(frame: usize) -> [Input; 2] {
    [[1.0, 1.0, 0.0, -1.0][frame / 5 % 4], [-1.0, 0.0, 1.0][frame / 7 % 3]]
}

fn main() -> Result<(), Error> {
    let mut client = Game::new()?;
    let mut server = Game::new()?;
    // The games before the last frames, and the input that was guessed in each: by frame, modulo their number.
    let mut saved = vec![Game::new()?; DELAY];
    let mut guesses = [0.0; DELAY];
    // The guess is that the other player goes on as in the last frame that is known.
    let mut guess = 0.0;
    let mut rollbacks = 0;

    for frame in 0..120_usize {
        // The input of an earlier frame arrives.
        if let Some(arrived) = frame.checked_sub(DELAY) {
            guess = inputs(arrived)[1];
            server.play(inputs(arrived))?;
            if guesses[arrived % DELAY] != guess {
                rollbacks += 1;
                client.copy_from(&saved[arrived % DELAY]);
                for again in arrived..frame {
                    saved[again % DELAY].copy_from(&client);
                    guesses[again % DELAY] = guess;
                    client.play([inputs(again)[0], guess])?;
                }
            }
            // Up to the frame that is known, client and server agree.
            let agreed = &saved[(arrived + 1) % DELAY];
            assert_eq!(agreed.world.state_hash(), server.world.state_hash());
            assert_eq!(agreed.bumps, server.bumps);
        }
        saved[frame % DELAY].copy_from(&client);
        guesses[frame % DELAY] = guess;
        client.play([inputs(frame)[0], guess])?;
    }
    println!("{rollbacks} rollbacks in 120 frames, bumps: {:?}", server.bumps);
    assert!(rollbacks > 10 && server.bumps[0] > 1);
    Ok(())
}
