//! Queries of a broad phase of any dimensions and precision, many at once.

use alloc::vec::Vec;

use sweep_and_prune::{Cast, Error, Hit, Lists, ProxyId, Queries, Scalar};

use crate::id::Id;
use crate::rows::{aabb, point};

/// Which bodies a query finds. Each kind says which numbers a query consists of, in `D` dimensions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Query {
    /// The bodies that overlap a box. Numbers: its min corner, its max corner.
    Overlapping,
    /// The bodies that contain a point. Numbers: the point.
    Containing,
    /// The bodies near a point. Numbers: the point, the radius.
    Within,
    /// The first body that a moving box hits. Numbers: the min corner of the box, its max corner, the direction, the
    /// limit. A ray is a box whose corners are equal. Values: t, where the hit is at `start + t * direction`. A hit has
    /// a face.
    Cast,
    /// Every body that a moving box hits, nearest first. Numbers and values as in [`Query::Cast`].
    CastAll,
    /// As [`Query::Cast`], but a body that the box touches at the start and does not approach is no hit.
    CastEntering,
    /// As [`Query::CastAll`], but a body that the box touches at the start and does not approach is no hit.
    CastAllEntering,
    /// The `k` bodies nearest to a point, nearest first, at most `max_distance` away. Numbers: the point. Values: squared
    /// distances.
    Nearest {
        /// The most bodies found.
        k: usize,
        /// How far away a body may be: 0 or more.
        max_distance: f64,
    },
}

/// The names of the queries, in the order of their numbers. `js/src/world/core.ts` has the same numbers.
const NAMES: [&str; 8] = [
    "overlapping",
    "containing",
    "within",
    "cast",
    "cast_all",
    "nearest",
    "cast_entering",
    "cast_all_entering",
];

impl Query {
    /// The query of a number, which is its place in the list of names.
    ///
    /// A query for the nearest bodies looks slightly farther than `max_distance`: other languages compare distances, which
    /// are rounded roots, and not their squares.
    pub fn numbered(number: u32, k: usize, max_distance: f64) -> Option<Self> {
        Some(match number {
            0 => Query::Overlapping,
            1 => Query::Containing,
            2 => Query::Within,
            3 => Query::Cast,
            4 => Query::CastAll,
            5 => Query::Nearest { k, max_distance: max_distance.next_up() },
            6 => Query::CastEntering,
            7 => Query::CastAllEntering,
            _ => return None,
        })
    }

    /// The query of a name. See [`Query::numbered`].
    pub fn named(name: &str, k: usize, max_distance: f64) -> Option<Self> {
        let number = NAMES.iter().position(|&each| each == name)?;
        Self::numbered(number as u32, k, max_distance)
    }

    /// How many numbers one query takes.
    pub const fn width(self, dimensions: usize) -> usize {
        match self {
            Query::Overlapping => 2 * dimensions,
            Query::Containing | Query::Nearest { .. } => dimensions,
            Query::Within => dimensions + 1,
            Query::Cast | Query::CastAll | Query::CastEntering | Query::CastAllEntering => {
                3 * dimensions + 1
            }
        }
    }
}

/// What queries found, query by query.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answer<I> {
    /// The bodies.
    pub ids: Vec<I>,
    /// A value for each body, if the query has one.
    pub values: Vec<f64>,
    /// The face of each body that a cast hits: 1 and 2 are the faces at the min and the max of the first axis, 3 and 4
    /// the faces of the second axis, and so on; 0 if the cast starts inside.
    pub faces: Vec<u8>,
    /// Where the bodies of each query end in `ids`, which is where the bodies of the next query begin.
    pub ends: Vec<usize>,
    /// What the core found in regions, for its memory: single queries in a loop do not allocate.
    pub found: Lists<ProxyId>,
}

/// Longer lists are not kept: to find that many bodies takes much longer than to allocate a list.
const MOST_KEPT: usize = 1000;

impl<I: Id> Answer<I> {
    pub(crate) fn clear(&mut self) {
        self.ids.clear();
        self.values.clear();
        self.faces.clear();
        self.ends.clear();
    }

    /// Gives up what was found, and its memory.
    #[cold]
    #[inline(never)]
    fn forget(&mut self) {
        *self = Self {
            ids: Vec::new(),
            values: Vec::new(),
            faces: Vec::new(),
            ends: Vec::new(),
            found: Lists::new(),
        };
    }

    /// Reserves memory for this many ids, values, faces and ends.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    #[inline(never)]
    fn reserve(&mut self, [ids, values, faces, ends]: [usize; 4]) -> Result<(), Error> {
        let are_reserved = self.ids.try_reserve(ids).is_ok()
            && self.values.try_reserve(values).is_ok()
            && self.faces.try_reserve(faces).is_ok()
            && self.ends.try_reserve(ends).is_ok();
        if are_reserved { Ok(()) } else { Err(Error::OutOfMemory) }
    }

    #[inline(never)]
    fn push(&mut self, id: ProxyId, value: f64) {
        self.ids.push(I::from_proxy(id));
        self.values.push(value);
    }

    fn push_hit<const D: usize, T: Scalar>(&mut self, hit: &Hit<D, T>) {
        self.push(hit.id, hit.t);
        let normal = hit.normal.map(|at| at.to_f64());
        let axis = normal.iter().position(|&at| at != 0.0);
        let face = axis.map_or(0, |axis| 2 * axis + 1 + usize::from(normal[axis] > 0.0));
        self.faces.push(face as u8);
    }

    fn end(&mut self) {
        self.ends.push(self.ids.len());
    }
}

/// Answers the queries whose numbers follow each other; what is left over is not read.
///
/// # Errors
/// Those of the core; [`Error::OutOfMemory`] if the answer does not fit: then it keeps no memory.
pub(crate) fn ask<const D: usize, T: Scalar, I: Id>(
    queries: Queries<'_, D, T>,
    query: Query,
    numbers: &[f64],
    answer: &mut Answer<I>,
) -> Result<(), Error> {
    answer.clear();
    let result = try_to_ask(queries, query, numbers, answer);
    if result == Err(Error::OutOfMemory) {
        answer.forget();
    }
    result
}

fn try_to_ask<const D: usize, T: Scalar, I: Id>(
    queries: Queries<'_, D, T>,
    query: Query,
    numbers: &[f64],
    answer: &mut Answer<I>,
) -> Result<(), Error> {
    let rows = Rows { numbers, width: query.width(D) };
    let lists = &mut answer.found;
    match query {
        Query::Overlapping => queries.overlapping_many(&rows.read(aabb::<D, T, f64>), lists)?,
        Query::Containing => queries.containing_many(&rows.read(point::<D, T, f64>), lists)?,
        Query::Within => queries.within_many(&rows.read(sphere::<D, T>), lists)?,
        Query::Cast | Query::CastEntering => {
            let casts = casts(&rows, query == Query::CastEntering);
            let mut hits = Vec::new();
            queries.cast_many(&casts, &mut hits)?;
            answer.reserve([hits.len(); 4])?;
            for hit in hits {
                if let Some(hit) = hit {
                    answer.push_hit(&hit);
                }
                answer.end();
            }
            return Ok(());
        }
        Query::CastAll | Query::CastAllEntering => {
            let casts = casts(&rows, query == Query::CastAllEntering);
            let mut lists = Lists::new();
            queries.cast_all_many(&casts, &mut lists)?;
            let hits = lists.values().len();
            answer.reserve([hits, hits, hits, lists.len()])?;
            lists.values().iter().for_each(|hit| answer.push_hit(hit));
            answer.ends.extend_from_slice(lists.ends());
            return Ok(());
        }
        Query::Nearest { k, max_distance } => {
            let points = rows.read(point::<D, T, f64>);
            let mut nearest = Lists::new();
            queries.nearest_many(&points, k, max_distance, &mut nearest)?;
            let found = nearest.values().len();
            answer.reserve([found, found, 0, nearest.len()])?;
            for near in nearest.values() {
                answer.push(near.id, near.distance_squared);
            }
            answer.ends.extend_from_slice(nearest.ends());
            return Ok(());
        }
    }
    let [bodies, queries] = [lists.values().len(), lists.len()];
    answer.reserve([bodies, 0, 0, queries])?;
    answer.ids.extend(answer.found.values().iter().map(|&id| I::from_proxy(id)));
    answer.ends.extend_from_slice(answer.found.ends());
    if bodies > MOST_KEPT {
        answer.found = Lists::new();
    }
    Ok(())
}

/// The numbers of queries, `width` of them for each.
struct Rows<'a> {
    numbers: &'a [f64],
    width: usize,
}

impl Rows<'_> {
    /// Not inline, and with a function pointer: a WebAssembly file has this for each type of box.
    #[inline(never)]
    fn read<Q>(&self, make: fn(&[f64]) -> Q) -> Vec<Q> {
        let count = self.numbers.len() / self.width;
        (0..count).map(|index| make(&self.numbers[index * self.width..])).collect()
    }
}

fn sphere<const D: usize, T: Scalar>(row: &[f64]) -> ([T; D], T) {
    (point(row), T::from_f64(row[D]))
}

fn casts<const D: usize, T: Scalar>(rows: &Rows<'_>, are_entering: bool) -> Vec<Cast<D, T>> {
    let mut casts = rows.read(cast::<D, T>);
    casts.iter_mut().for_each(|cast| cast.ignores_touching = are_entering);
    casts
}

fn cast<const D: usize, T: Scalar>(row: &[f64]) -> Cast<D, T> {
    Cast::aabb(aabb(row), point(&row[2 * D..]), T::from_f64(row[3 * D]))
}
