//! Reads tables of text in UTF-8, a line for each row, whose cells are separated by a character.
//!
//! Only what is certain is read here: `None` says that something else is in the way. The package reads that cell by cell,
//! and says what is wrong with it.

use std::collections::HashMap;
use std::iter::repeat;
use std::ops::RangeInclusive;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::arrays::{Array, numbers};
use crate::run::run;
use crate::whole::EXACT;

/// More digits than this might not fit in an `i64`.
const MOST_DIGITS: usize = 18;
/// Python's reader of CSV refuses longer cells.
const LONGEST_LINE: usize = 131_072;

/// How a line is divided into cells.
#[derive(Clone, Copy)]
struct Form {
    separator: u8,
    /// Whether quotes around a cell and spaces before it do not belong to it.
    is_csv: bool,
}

/// The cells of a line, at the beginning of what may be more lines.
struct Cells<'a> {
    form: Form,
    rest: Option<&'a [u8]>,
    /// Whether a quote is where none is expected.
    is_odd: bool,
}

impl<'a> Cells<'a> {
    fn new(text: &'a [u8], form: Form) -> Self {
        Self { form, rest: Some(text), is_odd: false }
    }

    /// A cell in quotes, whose first one is left out.
    fn quoted(&mut self, inner: &'a [u8]) -> Option<&'a [u8]> {
        self.is_odd = true;
        let end = inner.iter().position(|byte| matches!(byte, b'"' | b'\n'))?;
        self.rest = match &inner[end..] {
            [b'"'] | [b'"', b'\n', ..] | [b'"', b'\r', ..] => None,
            [b'"', separator, after @ ..] if *separator == self.form.separator => Some(after),
            _ => return None,
        };
        self.is_odd = false;
        Some(&inner[..end])
    }
}

impl<'a> Iterator for Cells<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let mut rest = self.rest.take()?;
        if self.form.is_csv {
            while let [b' ', after @ ..] = rest {
                rest = after;
            }
            if let [b'"', inner @ ..] = rest {
                return self.quoted(inner);
            }
        }
        // (Most cells are so short that a call of a search for bytes would take longer.)
        let end = rest.iter().position(|byte| *byte == self.form.separator || *byte == b'\n');
        let (cell, after) = end.map_or((rest, &[][..]), |end| rest.split_at(end));
        if let [b'\n', ..] | [] = after {
            return Some(cell.strip_suffix(b"\r").unwrap_or(cell));
        }
        self.rest = Some(&after[1..]);
        Some(cell)
    }
}

/// A table whose rows were found by [`read_lines`].
struct Table<'a, 'b> {
    text: &'a [u8],
    offsets: &'b [i64],
    form: Form,
}

impl<'a, 'b> Table<'a, 'b> {
    fn new(
        text: &'a [u8],
        offsets: &'b PyReadonlyArray1<'_, i64>,
        separator: u8,
        is_csv: bool,
    ) -> PyResult<Self> {
        Ok(Self { text, offsets: offsets.as_slice()?, form: Form { separator, is_csv } })
    }

    /// Calls a function with the cells of a column; those that a line does not have are empty.
    fn column<R: Send>(
        &self,
        py: Python<'_>,
        place: usize,
        read: impl FnOnce(&mut dyn Iterator<Item = &'a [u8]>) -> Option<R> + Send,
    ) -> PyResult<Option<R>> {
        let Self { text, offsets, form } = *self;
        run(py, offsets.len(), 1, None, |_| {
            read(&mut offsets.iter().map(|offset| {
                let rest = usize::try_from(*offset).ok().and_then(|offset| text.get(offset..));
                Cells::new(rest.unwrap_or(b""), form).nth(place).unwrap_or(b"")
            }))
        })
    }
}

/// Where each row of a table begins, after some lines that are skipped. Each has from `least` to `most` cells, and in CSV
/// more if these are empty. Comments and empty lines are left out.
///
/// `None` if it is not text in UTF-8, if some line has fewer cells or more, a carriage return alone, a quote within a
/// quoted cell, or is followed by sequences. O(bytes).
#[pyfunction]
pub fn read_lines<'py>(
    py: Python<'py>,
    text: &'py [u8],
    skipped: usize,
    least: usize,
    most: usize,
    separator: u8,
    is_csv: bool,
) -> PyResult<Option<Array<'py>>> {
    let form = Form { separator, is_csv };
    let found = run(py, text.len() / 32, 1, None, |_| rows(text, skipped, least..=most, form))?;
    found.map(|found| numbers(py, found.into_iter())).transpose()
}

fn rows(
    text: &[u8],
    skipped: usize,
    widths: RangeInclusive<usize>,
    form: Form,
) -> Option<Vec<i64>> {
    let text = str::from_utf8(text).ok()?;
    let mut offsets = Vec::with_capacity(text.split('\n').count());
    // A carriage return alone ends a line, too. (To look for it in each short line takes longer.)
    if text.contains('\r')
        && text.as_bytes().windows(2).any(|two| two[0] == b'\r' && two[1] != b'\n')
    {
        return None;
    }
    let mut offset = 0;
    for (number, line) in text.split_inclusive('\n').enumerate() {
        let here = offset;
        offset += line.len();
        let line = line.strip_suffix('\n').unwrap_or(line);
        let line = line.strip_suffix('\r').unwrap_or(line);
        if line.len() > LONGEST_LINE || line.starts_with("##FASTA") {
            return None;
        }
        let is_comment = !form.is_csv && (line.starts_with('#') || is_for_browsers(line));
        if number < skipped || line.is_empty() || is_comment {
            continue;
        }
        if form.is_csv {
            let mut cells = Cells::new(line.as_bytes(), form);
            if cells.by_ref().take(*widths.start()).count() < *widths.start() {
                if line.starts_with('#') && !cells.is_odd {
                    continue;
                }
                return None;
            }
            if cells.any(|cell| !cell.is_empty()) || cells.is_odd {
                return None;
            }
        } else {
            let separators = line.bytes().filter(|byte| *byte == form.separator).count();
            if !widths.contains(&(separators + 1)) {
                return None;
            }
        }
        offsets.push(i64::try_from(here).ok()?);
    }
    Some(offsets)
}

/// Whether it is a line that tells a genome browser what to show.
fn is_for_browsers(line: &str) -> bool {
    let rest = line.strip_prefix("track").or_else(|| line.strip_prefix("browser"));
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(' '))
}

/// A column of integers as `int64`, or one of other numbers as `float64`, in which empty cells are NaN. `None` if it has
/// anything else, or numbers that double precision may not have. O(bytes).
#[pyfunction]
pub fn read_numbers<'py>(
    py: Python<'py>,
    text: &'py [u8],
    offsets: PyReadonlyArray1<'py, i64>,
    separator: u8,
    is_csv: bool,
    place: usize,
) -> PyResult<Option<Array<'py>>> {
    let table = Table::new(text, &offsets, separator, is_csv)?;
    if let Some(found) =
        table.column(py, place, |cells| cells.map(whole).collect::<Option<Vec<_>>>())?
    {
        return numbers(py, found.into_iter()).map(Some);
    }
    let found = table.column(py, place, |cells| cells.map(real).collect::<Option<Vec<_>>>())?;
    found.map(|found| numbers(py, found.into_iter())).transpose()
}

fn whole(cell: &[u8]) -> Option<i64> {
    let digits = if let [b'-' | b'+', digits @ ..] = cell { digits } else { cell };
    if !(1..=MOST_DIGITS).contains(&digits.len()) || !digits.iter().all(u8::is_ascii_digit) {
        return None;
    }
    let value = digits.iter().fold(0, |value, digit| 10 * value + i64::from(digit - b'0'));
    Some(if cell[0] == b'-' { -value } else { value })
}

fn real(cell: &[u8]) -> Option<f64> {
    if cell.is_empty() {
        return Some(f64::NAN);
    }
    // (Rust reads `inf` and `nan`, too.)
    let are_known = cell.iter().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(byte));
    let number: f64 =
        if are_known { str::from_utf8(cell).ok()?.parse().ok()? } else { return None };
    (number.abs() < EXACT).then_some(number)
}

/// The number of each cell of a column among its different ones, and these in the order in which they first appear.
/// O(bytes).
#[pyfunction]
pub fn read_names<'py>(
    py: Python<'py>,
    text: &'py [u8],
    offsets: PyReadonlyArray1<'py, i64>,
    separator: u8,
    is_csv: bool,
    place: usize,
) -> PyResult<Option<(Array<'py>, Vec<&'py str>)>> {
    let table = Table::new(text, &offsets, separator, is_csv)?;
    let found = table.column(py, place, |cells| {
        let (mut codes, mut names) = (Vec::new(), Vec::new());
        let mut known = HashMap::new();
        let mut last = None;
        for cell in cells {
            let code = match last {
                Some((name, code)) if name == cell => code,
                _ => *known.entry(cell).or_insert_with(|| {
                    names.push(str::from_utf8(cell));
                    names.len() - 1
                }),
            };
            last = Some((cell, code));
            codes.push(i64::try_from(code).ok()?);
        }
        Some((codes, names.into_iter().collect::<Result<Vec<_>, _>>().ok()?))
    })?;
    found.map(|(codes, names)| Ok((numbers(py, codes.into_iter())?, names))).transpose()
}

/// The cells of a column. O(bytes of the rows).
#[pyfunction]
pub fn read_cells<'py>(
    py: Python<'py>,
    text: &'py [u8],
    offsets: PyReadonlyArray1<'py, i64>,
    separator: u8,
    is_csv: bool,
    place: usize,
) -> PyResult<Option<Vec<&'py str>>> {
    let table = Table::new(text, &offsets, separator, is_csv)?;
    table.column(py, place, |cells| cells.map(|cell| str::from_utf8(cell).ok()).collect())
}

/// The end of what each variant of VCF replaces, from 0 and not included: the one that its information names, the one of
/// an allele of a length that it names, or that of its reference. `None` if some position is no number. O(bytes).
#[pyfunction]
pub fn read_ends_of_variants<'py>(
    py: Python<'py>,
    text: &'py [u8],
    offsets: PyReadonlyArray1<'py, i64>,
    separator: u8,
    is_csv: bool,
) -> PyResult<Option<Array<'py>>> {
    let table = Table::new(text, &offsets, separator, is_csv)?;
    let references = table.column(py, 3, |cells| {
        Some(cells.map(|cell| String::from_utf8_lossy(cell).chars().count()).collect::<Vec<_>>())
    })?;
    let alleles = table.column(py, 4, |cells| Some(cells.collect::<Vec<_>>()))?;
    let named = table.column(py, 7, |cells| {
        let of_rows = cells.zip(alleles.unwrap_or_default());
        of_rows.map(|(information, alleles)| named_end(alleles, information)).collect()
    })?;
    let named: Option<Vec<Named>> = named;
    let positions = table.column(py, 1, |cells| cells.map(position).collect::<Option<Vec<_>>>())?;
    let (Some(references), Some(named), Some(positions)) = (references, named, positions) else {
        return Ok(None);
    };
    let ends =
        positions.iter().zip(references).zip(named).map(
            |((position, length), named)| match named {
                Named::End(end) => Some(end),
                Named::Size(size) => position.checked_add(size),
                Named::Nothing => position.checked_sub(1)?.checked_add(i64::try_from(length).ok()?),
            },
        );
    let ends: Option<Vec<i64>> = ends.collect();
    ends.map(|ends| numbers(py, ends.into_iter())).transpose()
}

/// A position that is written as numbers are, and not as `007`.
fn position(cell: &[u8]) -> Option<i64> {
    let digits = cell.strip_prefix(b"-").unwrap_or(cell);
    let is_plain = digits == b"0" || !matches!(digits, [b'0' | b'+', ..]);
    if is_plain { whole(cell) } else { None }
}

/// What the information of a variant says about its end.
enum Named {
    End(i64),
    /// The length of what follows its position.
    Size(i64),
    Nothing,
}

/// `None` if a number is too large.
fn named_end(alleles: &[u8], information: &[u8]) -> Option<Named> {
    let values = |name: &'static [u8]| {
        information.split(|byte| *byte == b';').filter_map(move |part| part.strip_prefix(name))
    };
    let mut ends = values(b"END=").filter(|end| is_digits(end));
    if let Some(end) = ends.next() {
        return whole(end).map(Named::End);
    }
    let are_sized = || alleles.split(|byte| *byte == b',').map(is_sized);
    let Some(sizes) = values(b"SVLEN=").next().filter(|_| are_sized().any(|is_sized| is_sized))
    else {
        return Some(Named::Nothing);
    };
    let sizes = || sizes.split(|byte| *byte == b',');
    // (A length may be written for all alleles at once.)
    let is_of_each = sizes().count() == are_sized().count();
    let own = sizes()
        .zip(are_sized().chain(repeat(true)))
        .filter(|(_, is_sized)| *is_sized || !is_of_each);
    let digits =
        own.map(|(size, _)| if let [b'-' | b'+', digits @ ..] = size { digits } else { size });
    let mut greatest = None;
    for size in digits.filter(|digits| is_digits(digits)) {
        greatest = greatest.max(Some(whole(size)?));
    }
    Some(greatest.map_or(Named::Nothing, Named::Size))
}

fn is_digits(cell: &[u8]) -> bool {
    !cell.is_empty() && cell.iter().all(u8::is_ascii_digit)
}

/// Whether an allele has a length on the reference.
fn is_sized(allele: &[u8]) -> bool {
    [&b"<DEL"[..], b"<DUP", b"<INV", b"<CNV"]
        .iter()
        .any(|kind| matches!(allele.strip_prefix(*kind), Some([b':' | b'>', ..])))
}
