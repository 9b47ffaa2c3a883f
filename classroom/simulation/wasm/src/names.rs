//! The broad phases by name and by number.

use std::sync::LazyLock;

use sweep_and_prune_algorithms::{Axis, Method, RunnerOptions, Sort};
use sweep_and_prune_simulation::BroadPhase;

use crate::code::Code;

/// The rules that choose the sweep axis, with their names.
const AXES: [(Axis, &str); 2] =
    [(Axis::LargestVariance, "largest variance"), (Axis::LongestExtent, "longest extent")];

static NAMES: LazyLock<[String; 3]> = LazyLock::new(|| {
    let algorithms = std::iter::once("find pairs").chain(Method::ALL.map(Method::name));
    [
        algorithms.collect::<Vec<_>>().join("\n"),
        Sort::ALL.map(Sort::name).join("\n"),
        AXES.map(|(_, name)| name).join("\n"),
    ]
});

/// The names of one kind, one a line; none of a kind that does not exist.
pub fn list(kind: u32) -> &'static str {
    NAMES.get(kind as usize).map_or("", String::as_str)
}

/// The choice that has these numbers in the lists.
pub fn broad_phase(
    algorithm: u32,
    sort: u32,
    axis: u32,
    persistent: bool,
) -> Result<BroadPhase, Code> {
    let Some(method) = (algorithm as usize).checked_sub(1) else { return Ok(BroadPhase::Library) };
    let axis = match AXES.get(axis as usize) {
        Some(&(rule, _)) => rule,
        None => Axis::Fixed(axis as usize - AXES.len()),
    };
    let method = *Method::ALL.get(method).ok_or(Code::InvalidOption)?;
    let sort = *Sort::ALL.get(sort as usize).ok_or(Code::InvalidOption)?;
    Ok(BroadPhase::Algorithm(
        RunnerOptions::new(method).sort(sort).axis(axis).persistent(persistent),
    ))
}
