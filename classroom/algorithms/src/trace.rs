//! A recording of an algorithm at work, in one flat buffer of 32-bit words, so that it can be
//! handed to another language as one typed array and stepped through in both directions.

use alloc::vec::Vec;

use crate::endpoint::{Edge, Endpoint, Side};
use crate::observer::{Observer, Separation};
use sweep_and_prune::Scalar;

const NONE: u32 = u32::MAX;

/// Records everything it sees, in a layout that other languages can read.
///
/// In Rust, iterate over [`events`](Self::events), or hand it to a [`Player`](crate::Player).
///
/// # Layout
/// The buffer is a row of records and nothing else. A record is
/// ```text
/// header, words ..., header        header = kind | length << 8
/// ```
/// with `length` the number of words of the whole record, both headers included. The same header
/// stands at both ends, so that the records can be walked forward and backward.
///
/// | kind | words | event |
/// |---|---|---|
/// | 1 step | axis, keeps | a step begins along `axis`; `keeps` is 1 if earlier axis overlaps still stand |
/// | 2 array | axis, then edge and at for each endpoint | the array of `axis`; what follows is of its positions |
/// | 3 compare | edge, edge | the sort compared two endpoints |
/// | 4 swap | i, j, edge, edge | the sort exchanged positions i and j; the edges stood there in this order |
/// | 5 visit | position, edge | the sweep line or the scan reached this endpoint |
/// | 6 enter | id | the sweep reached a box |
/// | 7 leave | id | the sweep left a box behind |
/// | 8 prune | axis, left, right | `left` ends before `right` begins, so the scan from `left` ends here |
/// | 9 test | a, b, axis, left | a box test; `axis` is the one that separates and `left` the box that ends first there, or both are 2^32 - 1 if the two overlap |
/// | 10 axis overlap | axis, a, b | a pair overlaps, or begins to overlap, on a swept axis |
/// | 11 axis apart | axis, a, b | a pair no longer does |
/// | 12 overlap | a, b | a pair overlaps on every axis |
/// | 13 begin | a, b | a pair that the last step did not have |
/// | 14 end | a, b | a pair of the last step that no longer overlaps |
///
/// `edge` is `2 * id` for the left endpoint of a box and `2 * id + 1` for the right one; `at` is
/// the coordinate as the bits of an `f32` (rounded, if the boxes are `f64`: it is for drawing).
#[derive(Clone, Debug, PartialEq)]
pub struct Trace {
    words: Vec<u32>,
    events: usize,
    limit: usize,
    truncated: bool,
}

impl Trace {
    /// How many words a trace holds unless told otherwise: 2^24, 64 MiB.
    pub const DEFAULT_LIMIT: usize = 1 << 24;

    /// An empty trace that holds at most [`DEFAULT_LIMIT`](Self::DEFAULT_LIMIT) words.
    pub fn new() -> Self {
        Self::with_limit(Self::DEFAULT_LIMIT)
    }

    /// An empty trace that holds at most this many words. The first event that does not fit, and
    /// all that follow, are not recorded.
    pub fn with_limit(limit: usize) -> Self {
        Self { words: Vec::new(), events: 0, limit, truncated: false }
    }

    /// The recorded words.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// How many events are recorded.
    pub fn len(&self) -> usize {
        self.events
    }

    /// Whether nothing is recorded.
    pub fn is_empty(&self) -> bool {
        self.events == 0
    }

    /// Whether something was not recorded: it was beyond the limit, or named a box beyond 2^31.
    pub fn is_truncated(&self) -> bool {
        self.truncated
    }

    /// Forgets everything and keeps the memory.
    pub fn clear(&mut self) {
        self.words.clear();
        self.events = 0;
        self.truncated = false;
    }

    /// The recorded events, in order.
    pub fn events(&self) -> impl Iterator<Item = Event<'_>> {
        let mut rest = &self.words[..];
        core::iter::from_fn(move || {
            let (event, length) = Event::first_of(rest)?;
            rest = &rest[length..];
            Some(event)
        })
    }

    /// Writes one record, or gives up for good.
    fn record(&mut self, kind: Kind, payload: impl IntoIterator<Item = Option<u32>>) {
        if self.truncated {
            return;
        }
        let start = self.words.len();
        self.words.push(0);
        for word in payload {
            let Some(word) = word.filter(|_| self.words.len() < self.limit) else {
                return self.give_up(start);
            };
            self.words.push(word);
        }
        let length = self.words.len() + 1 - start;
        if length >= 1 << 24 || start + length > self.limit {
            return self.give_up(start);
        }
        let header = kind as u32 | (length as u32) << 8;
        self.words[start] = header;
        self.words.push(header);
        self.events += 1;
    }

    fn give_up(&mut self, start: usize) {
        self.words.truncate(start);
        self.truncated = true;
    }
}

impl Default for Trace {
    fn default() -> Self {
        Self::new()
    }
}

macro_rules! kinds {
    ($($kind:ident = $number:literal,)*) => {
        /// What a record is, the low byte of its header: the numbers of the table of [`Trace`].
        #[derive(Clone, Copy)]
        enum Kind {
            $($kind = $number,)*
        }

        impl Kind {
            fn of(header: u32) -> Option<Self> {
                match header & 0xff {
                    $($number => Some(Self::$kind),)*
                    _ => None,
                }
            }
        }
    };
}

kinds! {
    Step = 1, Array = 2, Compare = 3, Swap = 4, Visit = 5, Enter = 6, Leave = 7,
    Prune = 8, Test = 9, AxisOverlap = 10, AxisApart = 11, Overlap = 12,
    Begin = 13, End = 14,
}

/// Methods that record their event: its kind and its words.
macro_rules! recorded {
    ($($method:ident($($argument:ident: $type:ty),*) = $kind:ident $words:expr;)*) => {$(
        fn $method(&mut self, $($argument: $type),*) {
            self.record(Kind::$kind, $words);
        }
    )*};
}

impl Observer for Trace {
    fn array<T: Scalar>(&mut self, axis: usize, endpoints: &[Endpoint<T>]) {
        let entry = |endpoint: &Endpoint<T>| {
            [edge_word(endpoint.edge), Some((endpoint.at.to_f64() as f32).to_bits())]
        };
        let axis = core::iter::once(word(axis));
        self.record(Kind::Array, axis.chain(endpoints.iter().flat_map(entry)));
    }

    fn test(&mut self, a: u32, b: u32, separation: Option<Separation>) {
        let (axis, left) = match separation {
            Some(found) => (word(found.axis), Some(found.left)),
            None => (Some(NONE), Some(NONE)),
        };
        self.record(Kind::Test, [Some(a), Some(b), axis, left]);
    }

    recorded! {
        step(axis: usize, keeps: bool) = Step [word(axis), Some(u32::from(keeps))];
        compare(a: Edge, b: Edge) = Compare [edge_word(a), edge_word(b)];
        swap(at: [usize; 2], a: Edge, b: Edge) =
            Swap [word(at[0]), word(at[1]), edge_word(a), edge_word(b)];
        visit(position: usize, edge: Edge) = Visit [word(position), edge_word(edge)];
        enter(id: u32) = Enter [Some(id)];
        leave(id: u32) = Leave [Some(id)];
        prune(apart: Separation) = Prune [word(apart.axis), Some(apart.left), Some(apart.right)];
        axis_overlap(axis: usize, a: u32, b: u32) = AxisOverlap [word(axis), Some(a), Some(b)];
        axis_apart(axis: usize, a: u32, b: u32) = AxisApart [word(axis), Some(a), Some(b)];
        overlap(a: u32, b: u32) = Overlap [Some(a), Some(b)];
        begin(a: u32, b: u32) = Begin [Some(a), Some(b)];
        end(a: u32, b: u32) = End [Some(a), Some(b)];
    }
}

fn word(value: usize) -> Option<u32> {
    u32::try_from(value).ok()
}

fn edge_word(edge: Edge) -> Option<u32> {
    edge.id.checked_mul(2).map(|word| word + edge.side as u32)
}

fn edge_of(word: u32) -> Edge {
    Edge { side: if word & 1 == 0 { Side::Left } else { Side::Right }, id: word / 2 }
}

/// One recorded event: a call of the [`Observer`] method of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)] // The fields are the parameters of those methods.
#[non_exhaustive]
pub enum Event<'a> {
    Step { axis: usize, keeps_axis_overlaps: bool },
    Array { axis: usize, endpoints: TracedArray<'a> },
    Compare { a: Edge, b: Edge },
    Swap { positions: [usize; 2], a: Edge, b: Edge },
    Visit { position: usize, edge: Edge },
    Enter { id: u32 },
    Leave { id: u32 },
    Prune { separation: Separation },
    Test { a: u32, b: u32, separation: Option<Separation> },
    AxisOverlap { axis: usize, a: u32, b: u32 },
    AxisApart { axis: usize, a: u32, b: u32 },
    Overlap { a: u32, b: u32 },
    Begin { a: u32, b: u32 },
    End { a: u32, b: u32 },
}

/// The endpoints of an [`Event::Array`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TracedArray<'a>(&'a [u32]);

impl<'a> TracedArray<'a> {
    /// The endpoints in the order in which they stand, their coordinates rounded to `f32`.
    pub fn iter(self) -> impl Iterator<Item = Endpoint<f32>> + 'a {
        self.0
            .chunks_exact(2)
            .map(|entry| Endpoint { edge: edge_of(entry[0]), at: f32::from_bits(entry[1]) })
    }
}

impl<'a> Event<'a> {
    /// The event that `words` begin with, and the length of its record.
    pub(crate) fn first_of(words: &'a [u32]) -> Option<(Self, usize)> {
        let length = (words.first()? >> 8) as usize;
        Some((Self::decode(words.get(..length)?)?, length))
    }

    /// The event that `words` end with, and the length of its record.
    pub(crate) fn last_of(words: &'a [u32]) -> Option<(Self, usize)> {
        let length = (words.last()? >> 8) as usize;
        let start = words.len().checked_sub(length)?;
        Some((Self::decode(&words[start..])?, length))
    }

    fn decode(record: &'a [u32]) -> Option<Self> {
        let (&header, words) = record.split_first()?;
        let (_, words) = words.split_last()?;
        Some(match (Kind::of(header)?, words) {
            (Kind::Step, &[axis, keeps]) => {
                Event::Step { axis: axis as usize, keeps_axis_overlaps: keeps != 0 }
            }
            (Kind::Array, [axis, entries @ ..]) => {
                Event::Array { axis: *axis as usize, endpoints: TracedArray(entries) }
            }
            (Kind::Compare, &[a, b]) => Event::Compare { a: edge_of(a), b: edge_of(b) },
            (Kind::Swap, &[i, j, a, b]) => {
                Event::Swap { positions: [i as usize, j as usize], a: edge_of(a), b: edge_of(b) }
            }
            (Kind::Visit, &[position, edge]) => {
                Event::Visit { position: position as usize, edge: edge_of(edge) }
            }
            (Kind::Enter, &[id]) => Event::Enter { id },
            (Kind::Leave, &[id]) => Event::Leave { id },
            (Kind::Prune, &[axis, left, right]) => {
                Event::Prune { separation: Separation { axis: axis as usize, left, right } }
            }
            (Kind::Test, &[a, b, NONE, NONE]) => Event::Test { a, b, separation: None },
            (Kind::Test, &[a, b, axis, left]) => {
                let right = if left == a { b } else { a };
                let separation = Some(Separation { axis: axis as usize, left, right });
                Event::Test { a, b, separation }
            }
            (Kind::AxisOverlap, &[axis, a, b]) => Event::AxisOverlap { axis: axis as usize, a, b },
            (Kind::AxisApart, &[axis, a, b]) => Event::AxisApart { axis: axis as usize, a, b },
            (Kind::Overlap, &[a, b]) => Event::Overlap { a, b },
            (Kind::Begin, &[a, b]) => Event::Begin { a, b },
            (Kind::End, &[a, b]) => Event::End { a, b },
            _ => return None,
        })
    }
}
