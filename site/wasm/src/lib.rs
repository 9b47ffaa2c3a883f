//! The playground runs on this: scenes in motion, and the searchers that find their pairs.
//! Plain `extern "C"` functions over linear memory, called by `src/experiment/experiment.ts`.
//!
//! # Layout
//! Numbers pass through one area of 16 `f64` at [`experiment_area`]:
//!
//! | index | in: [`experiment_begin`] | out: [`experiment_run`] | out: [`experiment_forecast`] |
//! |---|---|---|---|
//! | 0 | dimensions: 2 or 3 | ms from boxes to pairs | tests |
//! | 1 | scene, by its place in the list | pairs | overlaps to be kept |
//! | 2 | motion, likewise | fingerprint, upper 32 bits | |
//! | 3 | boxes | fingerprint, lower 32 bits | |
//! | 4 | seed | tests, or -1: not counted | |
//! | 5 | size | overlaps on the axis, or -1 | |
//! | 6 | spread | comparisons, or -1 | |
//! | 7 | | swaps, or -1 | |
//!
//! [`experiment_place`] reads the same numbers, but for the scene, the boxes, the size and the spread.
//!
//! There is one world at a time. Searchers are numbered from 0 in the order in which they came;
//! [`experiment_begin`] forgets them.
//!
//! The module imports one function, `env.now() -> f64`: milliseconds from any origin.
// SAFETY of the exports: their names begin with `experiment_` and no other symbol has them. They take
// numbers only and dereference no pointer.
#![allow(unsafe_code)]

pub mod experiment;
pub mod motion;
mod scenes;
pub mod searcher;

use std::cell::RefCell;
use std::sync::LazyLock;
use std::sync::atomic::AtomicU64;

use sweep_and_prune_algorithms::{Axis, Method, RunnerOptions, Sort};
use sweep_and_prune_exchange::{read_area, write_area};

use experiment::Experiment;
use scenes::SCENES;
use searcher::Choice;

/// Whether a call was done. What is not done has changed nothing.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Code {
    /// Done.
    Ok = 0,
    /// A number does not name anything, or there is no world.
    Invalid = 1,
}

thread_local! {
    /// The coordinates of boxes that are given.
    static ROWS: RefCell<Vec<f32>> = const { RefCell::new(Vec::new()) };
    static EXPERIMENT: RefCell<Option<Box<dyn Experiment>>> = const { RefCell::new(None) };
}

fn with<R>(run: impl FnOnce(&mut dyn Experiment) -> Option<R>) -> Option<R> {
    EXPERIMENT.with_borrow_mut(|experiment| run(experiment.as_mut()?.as_mut()))
}

fn code(done: Option<()>) -> Code {
    if done.is_some() { Code::Ok } else { Code::Invalid }
}

/// The rules that choose the sweep axis; behind them come the axes themselves.
const RULES: [Axis; 3] = [Axis::LargestVariance, Axis::LongestExtent, Axis::FewestOverlaps];

/// The items of each kind, one a line, their fields separated by tabs.
static NAMES: LazyLock<[String; 5]> = LazyLock::new(|| {
    let library = ["find pairs", "broad phase"].into_iter();
    let scenes = SCENES.iter().map(|scene| {
        let (least, most) = scene.dimensions().into_inner();
        format!("{}\t{}\t{}\t{most}", scene.name(), scene.description(), least.max(2))
    });
    let motions = motion::LAWS.iter().map(|law| format!("{}\t{}", law.name, law.description));
    [
        library.chain(Method::ALL.map(Method::name)).collect::<Vec<_>>().join("\n"),
        Sort::ALL.map(Sort::name).join("\n"),
        RULES.map(Axis::name).join("\n"),
        scenes.collect::<Vec<_>>().join("\n"),
        motions.collect::<Vec<_>>().join("\n"),
    ]
});

/// Where the area is.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_area() -> *const AtomicU64 {
    sweep_and_prune_exchange::area()
}

/// The names of searchers (0), sorts (1), axis rules (2), scenes with a sentence, their least and
/// their greatest number of dimensions (3), motions with a sentence (4), in UTF-8. How many bytes
/// there are is in the area at 0; none of a kind that does not exist.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_names(kind: u32) -> *const u8 {
    let names = NAMES.get(kind as usize).map_or("", String::as_str);
    write_area(&[names.len() as f64]);
    names.as_ptr()
}

/// Makes the world in the area, and forgets the one before and its searchers.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_begin() -> Code {
    let area = read_area();
    let made = experiment::open(&area);
    let done = made.is_some().then_some(());
    if made.is_some() {
        EXPERIMENT.set(made);
    }
    code(done)
}

/// Where to write the `count` coordinates of given boxes, rows of min corner and max corner; null if there are too many.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_rows(count: u32) -> *mut f32 {
    if f64::from(count) > 6.0 * experiment::MOST_BOXES {
        return std::ptr::null_mut();
    }
    ROWS.with_borrow_mut(|rows| {
        *rows = vec![0.0; count as usize];
        rows.as_mut_ptr()
    })
}

/// Makes a world of the given boxes, with the dimensions, motion and seed in the area. If `keep` is not 0 and there are as
/// many dimensions as before, the searchers stay, and go on from what they have kept.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_place(keep: u32) -> Code {
    let area = read_area();
    let rows = ROWS.take();
    let kept = with(|experiment| {
        let is_kept = keep != 0 && experiment.dimensions() == area[0] as usize;
        is_kept.then(|| experiment.place(&rows, &area))
    });
    code(kept.unwrap_or_else(|| {
        EXPERIMENT.set(Some(experiment::open_given(&rows, &area)?));
        Some(())
    }))
}

/// Moves the world on by one step.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_advance() -> Code {
    code(with(|experiment| {
        experiment.advance();
        Some(())
    }))
}

/// The boxes: rows of `f32`, the min corner and then the max corner; null without a world.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_boxes() -> *const f32 {
    with(|experiment| Some(experiment.boxes())).unwrap_or(std::ptr::null())
}

/// How many pairs the world has now, by the library's finder, which stores none of them; -1 without
/// a world.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_count_pairs() -> f64 {
    with(|experiment| experiment.count_pairs()).map_or(-1.0, |count| count as f64)
}

/// Adds a searcher, given by the indices of its method, sort and axis in the lists of [`experiment_names`]; an
/// index beyond the axis rules is the axis itself, counted from there. Sorts and axes of the library's two are not read.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_enter(searcher: u32, sort: u32, axis: u32, persistent: u32) -> Code {
    code(choice(searcher, sort, axis, persistent).and_then(|choice| with(|a| a.enter(choice))))
}

/// What a searcher's first run would cost, into the area, without adding it.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_forecast(searcher: u32, sort: u32, axis: u32) -> Code {
    let forecast =
        choice(searcher, sort, axis, 1).and_then(|c| with(|experiment| experiment.forecast(c)));
    code(forecast.map(|forecast| write_area(&[forecast.tests, forecast.kept])))
}

/// Lets a searcher find the current pairs of the world, and writes its report into the area. If `counting`
/// is not 0, its operations are counted on a copy.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_run(searcher: u32, counting: u32) -> Code {
    let report = with(|experiment| experiment.run(searcher as usize, counting != 0));
    code(report.map(|report| {
        let count = |read: fn(&sweep_and_prune_algorithms::Counts) -> u64| {
            report.counts.as_ref().map_or(-1.0, |counts| read(counts) as f64)
        };
        write_area(&[
            report.ms,
            report.pairs as f64,
            (report.fingerprint >> 32) as f64,
            f64::from(report.fingerprint as u32),
            count(|counts| counts.tests),
            count(|counts| counts.axis_overlaps),
            count(|counts| counts.comparisons),
            count(|counts| counts.swaps),
        ]);
    }))
}

/// The pairs of a searcher's last run, as many as it reported; null without such a searcher.
#[unsafe(no_mangle)]
pub extern "C" fn experiment_pairs(searcher: u32) -> *const u32 {
    with(|experiment| experiment.pairs(searcher as usize)).unwrap_or(std::ptr::null())
}

fn choice(searcher: u32, sort: u32, axis: u32, persistent: u32) -> Option<Choice> {
    let method = match searcher as usize {
        0 => return Some(Choice::Finder),
        1 => return Some(Choice::World),
        place => *Method::ALL.get(place - 2)?,
    };
    let sort = *Sort::ALL.get(sort as usize)?;
    let axis = axis as usize;
    let axis = RULES.get(axis).copied().unwrap_or(Axis::Fixed(axis.wrapping_sub(RULES.len())));
    Some(Choice::Algorithm(
        RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent != 0),
    ))
}
