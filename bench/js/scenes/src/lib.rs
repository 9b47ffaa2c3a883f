//! The shared scenes for the JavaScript benchmark: the same boxes, bit for bit, in Node, in the
//! browser and in the native program they are compared with.
//!
//! The exports are plain functions over one scene at a time, for `bench/js/src/scenes.js`.
// SAFETY of the exports: each has a name that no other symbol has, and takes no pointer.
#![allow(unsafe_code)]

use std::cell::RefCell;
use std::fmt::Write;

use sweep_and_prune::Aabb;
use sweep_and_prune_scenes::{Motion, Moving, Random, Scene};

/// The seed of every scene, or of the first of several: that of `bench/` too, so that two runs measure the same boxes.
const SEED: u64 = 1;
/// Up to this many boxes, each call has another scene of the kind. A branch predictor learns the hits of one small
/// scene that is found again and again.
const MOST_VARIED: usize = 10_000;
/// The number of scenes of a kind.
const SCENES: usize = 100;

/// Boxes in one of the two numbers of dimensions that are measured.
pub enum Boxes<const D: usize> {
    /// Scenes of a kind.
    AtRest(Scenes<D>),
    /// A motion: its current frame.
    InMotion(Moving<D, f32>),
}

/// Scenes of a kind, which differ by their seeds, or one scene of many boxes in two orders. Each is drawn when it is
/// needed for the first time.
pub struct Scenes<const D: usize> {
    scene: Scene,
    n: usize,
    drawn: Vec<Vec<Aabb<D>>>,
}

impl<const D: usize> Scenes<D> {
    /// How many scenes or orders there are.
    fn turns(&self) -> usize {
        if self.n <= MOST_VARIED { SCENES } else { 2 }
    }

    fn turn(&mut self, turn: usize) -> &[Aabb<D>] {
        let turn = turn % self.turns();
        while self.drawn.len() <= turn {
            let seed = SEED + self.drawn.len() as u64;
            let varied = self.n <= MOST_VARIED;
            let boxes = self.scene.boxes(self.n, if varied { seed } else { SEED });
            let mut boxes = boxes.unwrap_or_default();
            // What was learned of one order is worth nothing for another. Some kinds have the same boxes for every seed.
            if self.drawn.first() == Some(&boxes) {
                Random::new(seed).shuffle(&mut boxes);
            }
            self.drawn.push(boxes);
        }
        &self.drawn[turn]
    }
}

impl<const D: usize> Boxes<D> {
    /// The `n` boxes of a scene or a motion; `None` if there is none of that name in `D`
    /// dimensions.
    pub fn new(name: &str, n: usize) -> Option<Self> {
        if let Some(motion) = Motion::from_name(name) {
            return Some(Self::InMotion(motion.start(n, SEED)?));
        }
        let scene = Scene::from_name(name)?;
        let first = scene.boxes(n, SEED)?;
        Some(Self::AtRest(Scenes { scene, n, drawn: vec![first] }))
    }

    /// The boxes of a call: one scene or order after another, of a motion the current frame.
    pub fn turn(&mut self, turn: usize) -> &[Aabb<D>] {
        match self {
            Self::AtRest(scenes) => scenes.turn(turn),
            Self::InMotion(moving) => moving.boxes(),
        }
    }

    /// How many turns have different boxes; 1 of a motion.
    pub fn turns(&self) -> usize {
        match self {
            Self::AtRest(scenes) => scenes.turns(),
            Self::InMotion(_) => 1,
        }
    }

    /// Moves on by one frame, if they move.
    pub fn advance(&mut self) {
        if let Self::InMotion(moving) = self {
            moving.advance();
        }
    }
}

/// Either number of dimensions.
enum Open {
    Two(Boxes<2>),
    Three(Boxes<3>),
}

/// What JavaScript reads and writes.
#[derive(Default)]
struct Shared {
    open: Option<Open>,
    text: String,
    rows: Vec<f32>,
}

thread_local! {
    static SHARED: RefCell<Shared> = RefCell::default();
}

/// Writes the table of what there is, as JSON, and returns its length in bytes.
#[unsafe(no_mangle)]
extern "C" fn table() -> usize {
    SHARED.with_borrow_mut(|shared| {
        let mut text = String::from("[");
        for scene in Scene::ALL {
            let dimensions: Vec<_> = scene.dimensions().collect();
            line(&mut text, scene.name(), "find", &dimensions, scene.description());
        }
        for motion in Motion::ALL {
            line(&mut text, motion.name(), "track", &[1, 2, 3], motion.description());
        }
        text.pop();
        shared.text = text + "]";
        shared.text.len()
    })
}

fn line(text: &mut String, name: &str, task: &str, dimensions: &[usize], description: &str) {
    // Writing to a String cannot fail.
    let _ = write!(
        text,
        r#"{{"name":"{name}","task":"{task}","dimensions":{dimensions:?},"description":"{description}"}},"#
    );
}

/// Reserves memory for a text of this many bytes.
#[unsafe(no_mangle)]
extern "C" fn reserve_text(bytes: usize) {
    SHARED.with_borrow_mut(|shared| shared.text = "\0".repeat(bytes));
}

/// Where the text is: the table, or what JavaScript wrote.
#[unsafe(no_mangle)]
extern "C" fn text() -> *const u8 {
    SHARED.with_borrow(|shared| shared.text.as_ptr())
}

/// Opens the scene whose name is the text. 0: it does not exist in these dimensions, 1: boxes at
/// rest, 2: boxes in motion.
#[unsafe(no_mangle)]
extern "C" fn open(dimensions: usize, n: usize) -> u32 {
    SHARED.with_borrow_mut(|shared| {
        shared.open = match dimensions {
            2 => Boxes::new(&shared.text, n).map(Open::Two),
            3 => Boxes::new(&shared.text, n).map(Open::Three),
            _ => None,
        };
        match &shared.open {
            None => 0,
            Some(Open::Two(Boxes::AtRest(_)) | Open::Three(Boxes::AtRest(_))) => 1,
            Some(_) => 2,
        }
    })
}

/// How many turns have different boxes.
#[unsafe(no_mangle)]
extern "C" fn turns() -> usize {
    SHARED.with_borrow(|shared| match &shared.open {
        Some(Open::Two(boxes)) => boxes.turns(),
        Some(Open::Three(boxes)) => boxes.turns(),
        None => 0,
    })
}

/// Writes the boxes of a turn as rows, the minimum corner and then the maximum corner, and returns
/// where they are.
#[unsafe(no_mangle)]
extern "C" fn rows(turn: usize) -> *const f32 {
    SHARED.with_borrow_mut(|shared| {
        let Shared { open, rows, .. } = shared;
        rows.clear();
        match open {
            Some(Open::Two(boxes)) => flatten(boxes.turn(turn), rows),
            Some(Open::Three(boxes)) => flatten(boxes.turn(turn), rows),
            None => {}
        }
        rows.as_ptr()
    })
}

fn flatten<const D: usize>(boxes: &[Aabb<D>], rows: &mut Vec<f32>) {
    rows.extend(boxes.iter().flat_map(|aabb| aabb.min.into_iter().chain(aabb.max)));
}

/// Moves on by one frame.
#[unsafe(no_mangle)]
extern "C" fn advance() {
    SHARED.with_borrow_mut(|shared| match &mut shared.open {
        Some(Open::Two(boxes)) => boxes.advance(),
        Some(Open::Three(boxes)) => boxes.advance(),
        None => {}
    });
}
