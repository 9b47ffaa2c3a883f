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

/// The seed of every scene, that of `bench/` too, so that two runs measure the same boxes.
const SEED: u64 = 1;

/// Boxes in one of the two numbers of dimensions that are measured.
pub enum Boxes<const D: usize> {
    /// A scene, and the same boxes in another order: what was learnt of one is worth nothing for
    /// the other.
    AtRest([Vec<Aabb<D>>; 2]),
    /// A motion: its current frame.
    InMotion(Moving<D, f32>),
}

impl<const D: usize> Boxes<D> {
    /// The `n` boxes of a scene or a motion; `None` if there is none of that name in `D`
    /// dimensions.
    pub fn new(name: &str, n: usize) -> Option<Self> {
        if let Some(motion) = Motion::from_name(name) {
            return Some(Self::InMotion(motion.start(n, SEED)?));
        }
        let boxes = Scene::from_name(name)?.boxes::<D, f32>(n, SEED)?;
        let mut shuffled = boxes.clone();
        Random::new(SEED).shuffle(&mut shuffled);
        Some(Self::AtRest([boxes, shuffled]))
    }

    /// The boxes of a call: of a scene in either order by turns, of a motion the current frame.
    pub fn turn(&self, turn: usize) -> &[Aabb<D>] {
        match self {
            Self::AtRest(orders) => &orders[turn % 2],
            Self::InMotion(moving) => moving.boxes(),
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
