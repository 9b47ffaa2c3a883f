//! Reads intervals from lines of text, as the formats of genomics have them.

use std::collections::HashMap;

use pyo3::prelude::*;

use crate::arrays::{Array, numbers, pairs};
use crate::run::run;

/// More digits than this might not fit in an `i64`.
const MOST_DIGITS: usize = 18;

/// The intervals of lines of text, an entry for each line that has one.
struct Intervals<'a> {
    /// Where the line begins in the text.
    offsets: Vec<i64>,
    /// Where its interval starts and ends.
    corners: Vec<[i64; 2]>,
    /// The number of its first cell among `names`.
    codes: Vec<i32>,
    /// The first cells, in the order in which they first appear.
    names: Vec<&'a str>,
}

type Columns<'py> = (Array<'py>, Array<'py>, Array<'py>, Vec<&'py str>);

/// Reads lines of BED: a name, a start and an end, separated by tabs, and more cells that are not looked at.
///
/// Lines that are empty, begin with `#`, or are those of a browser are left out. `None` if some line has anything else
/// than digits where a number is expected, or the text is not UTF-8: the package reads such files in another way, and
/// says what is wrong with them. Returns where each line begins, `(n, 2)` starts and ends, the number of each name, and
/// the names. O(bytes).
#[pyfunction]
pub fn read_bed<'py>(py: Python<'py>, text: &'py [u8]) -> PyResult<Option<Columns<'py>>> {
    let Some(found) = run(py, text.len() / 32, 1, None, |_| intervals(text))? else {
        return Ok(None);
    };
    Ok(Some((
        numbers(py, found.offsets.into_iter())?,
        pairs(py, found.corners.into_iter())?,
        numbers(py, found.codes.into_iter())?,
        found.names,
    )))
}

fn intervals(text: &[u8]) -> Option<Intervals<'_>> {
    let text = str::from_utf8(text).ok()?;
    let lines = text.split('\n').count();
    let mut found = Intervals {
        offsets: Vec::with_capacity(lines),
        corners: Vec::with_capacity(lines),
        codes: Vec::with_capacity(lines),
        names: Vec::new(),
    };
    let mut codes = HashMap::new();
    let mut last = ("", 0);
    let mut offset = 0;
    for line in text.split_inclusive('\n') {
        let here = offset;
        offset += line.len();
        let line = line.strip_suffix('\n').unwrap_or(line);
        let line = line.strip_suffix('\r').unwrap_or(line);
        if line.is_empty() || line.starts_with('#') || is_for_browsers(line) {
            continue;
        }
        let (name, rest) = line.split_once('\t').filter(|(name, _)| !name.is_empty())?;
        let (start, rest) = number(rest)?;
        let (end, rest) = number(rest.strip_prefix('\t')?)?;
        // A carriage return alone ends a line, too.
        if !(rest.is_empty() || rest.starts_with('\t')) || line.contains('\r') {
            return None;
        }
        if name != last.0 {
            let code = *codes.entry(name).or_insert(found.names.len());
            if code == found.names.len() {
                found.names.push(name);
            }
            last = (name, i32::try_from(code).ok()?);
        }
        found.offsets.push(i64::try_from(here).ok()?);
        found.corners.push([start, end]);
        found.codes.push(last.1);
    }
    Some(found)
}

/// Whether it is a line that tells a genome browser what to show.
fn is_for_browsers(line: &str) -> bool {
    let rest = line.strip_prefix("track").or_else(|| line.strip_prefix("browser"));
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
}

/// The number at the beginning of a text, and what follows it.
fn number(text: &str) -> Option<(i64, &str)> {
    let digits = text.bytes().take_while(u8::is_ascii_digit).count();
    if !(1..=MOST_DIGITS).contains(&digits) {
        return None;
    }
    let (number, rest) = text.split_at(digits);
    let value = number.bytes().fold(0, |value, digit| 10 * value + i64::from(digit - b'0'));
    Some((value, rest))
}
