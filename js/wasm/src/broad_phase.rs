//! The living world: of either precision, chosen at run time.
//!
//! Numbers go in and out through one small area of `f64`, many boxes through rows, many ids
//! through an array. As in `finder.rs` there are three types of world, and JavaScript makes boxes
//! of fewer dimensions flat on the others.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Aabb, BroadPhase, Cast, Error, Filter, Options, ProxyId, Report, Scalar};

use crate::status::{Code, tell, tell_error};

/// Bits of an id that are its slot. Each body takes more than 64 bytes, so that 4 GiB hold less.
const SLOT_BITS: u32 = 26;
/// Bits of an id that are its generation: with those of the slot, as many as an `f64` holds.
const GENERATION_MASK: u32 = (1 << 27) - 1;

/// The id as a whole number below 2^53.
fn to_number(id: ProxyId) -> f64 {
    (u64::from(id.generation() & GENERATION_MASK) << SLOT_BITS | u64::from(id.slot())) as f64
}

/// Which bodies a query asks about, and in which form it answers.
#[derive(Clone, Copy)]
enum Query {
    /// A box; ids.
    Overlapping,
    /// A point; ids.
    Containing,
    /// A centre and a radius; ids.
    Within,
    /// A box, a direction and a limit; the id and the place of the first hit.
    Cast,
    /// The same; the ids and places of all.
    CastAll,
    /// A point; the ids and squared distances of so many.
    Nearest(usize),
}

/// The numbers that go in and out: two boxes and more.
type Numbers = [f64; 16];

/// A world of any type, with what goes in and comes out.
trait World {
    fn rows(&mut self, count: usize) -> Option<*mut u8>;
    fn insert(&mut self, numbers: &Numbers) -> Result<ProxyId, Error>;
    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error>;
    fn set(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error>;
    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;
    fn set_swept(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error>;
    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error>;
    fn filter(&self, id: ProxyId) -> Result<Filter, Error>;
    fn aabb(&self, id: ProxyId, numbers: &mut Numbers) -> Result<(), Error>;
    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error>;
    /// Begun and then ended pairs; returns how many numbers the begun ones are.
    fn update(&mut self, out: &mut Vec<f64>) -> usize;
    fn pairs(&self, out: &mut Vec<f64>);
    fn pairs_of(&mut self, id: ProxyId, out: &mut Vec<f64>) -> Result<(), Error>;
    fn ids(&self, each: &mut dyn FnMut(ProxyId));
    fn len(&self) -> usize;
    fn query(
        &mut self,
        query: Query,
        filter: Filter,
        numbers: &Numbers,
        out: &mut Vec<f64>,
    ) -> Result<(), Error>;
    fn snapshot(&self) -> Vec<u8>;
    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error>;
    fn hash(&self) -> u64;
}

struct Typed<const D: usize, T: Scalar> {
    world: BroadPhase<D, T>,
    rows: Vec<Aabb<D, T>>,
}

impl<const D: usize, T: Scalar> Typed<D, T> {
    fn boxed(margin: f64, prediction: f64, report: Report) -> Option<Box<dyn World>> {
        let (margin, prediction) = (T::from_f64(margin), T::from_f64(prediction));
        let world = BroadPhase::with_options(Options { margin, prediction, report }).ok()?;
        Some(Box::new(Self { world, rows: Vec::new() }))
    }

    fn point(numbers: &Numbers, from: usize) -> [T; D] {
        core::array::from_fn(|axis| T::from_f64(numbers[from + axis]))
    }

    fn boxed_at(numbers: &Numbers, from: usize) -> Aabb<D, T> {
        Aabb::new(Self::point(numbers, from), Self::point(numbers, from + D))
    }
}

impl<const D: usize, T: Scalar> World for Typed<D, T> {
    fn rows(&mut self, count: usize) -> Option<*mut u8> {
        if let Some(more) = count.checked_sub(self.rows.len()) {
            self.rows.try_reserve(more).ok()?;
            self.rows.resize(count, Aabb::new([T::default(); D], [T::default(); D]));
        }
        Some(self.rows.as_mut_ptr().cast())
    }

    fn insert(&mut self, numbers: &Numbers) -> Result<ProxyId, Error> {
        self.world.insert(Self::boxed_at(numbers, 0))
    }

    fn insert_many(&mut self, count: usize, filter: Filter) -> Result<Vec<ProxyId>, Error> {
        self.world.insert_many(&self.rows[..count.min(self.rows.len())], filter)
    }

    fn set(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error> {
        self.world.set(id, Self::boxed_at(numbers, 0))
    }

    fn set_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.set_many(ids, &self.rows[..ids.len().min(self.rows.len())])
    }

    fn set_swept(&mut self, id: ProxyId, numbers: &Numbers) -> Result<(), Error> {
        self.world.set_swept(id, Self::boxed_at(numbers, 0), Self::boxed_at(numbers, 2 * D))
    }

    fn set_filter(&mut self, id: ProxyId, filter: Filter) -> Result<(), Error> {
        self.world.set_filter(id, filter)
    }

    fn filter(&self, id: ProxyId) -> Result<Filter, Error> {
        self.world.filter(id)
    }

    fn aabb(&self, id: ProxyId, numbers: &mut Numbers) -> Result<(), Error> {
        let aabb = self.world.aabb(id)?;
        for (number, at) in numbers.iter_mut().zip(aabb.min.into_iter().chain(aabb.max)) {
            *number = at.to_f64();
        }
        Ok(())
    }

    fn remove_many(&mut self, ids: &[ProxyId]) -> Result<(), Error> {
        self.world.remove_many(ids)
    }

    fn update(&mut self, out: &mut Vec<f64>) -> usize {
        let changes = self.world.update();
        out.extend(changes.begun().flatten().map(to_number));
        let begun = out.len();
        out.extend(changes.ended().flatten().map(to_number));
        begun
    }

    fn pairs(&self, out: &mut Vec<f64>) {
        out.extend(self.world.pairs().into_iter().flatten().map(to_number));
    }

    fn pairs_of(&mut self, id: ProxyId, out: &mut Vec<f64>) -> Result<(), Error> {
        out.extend(self.world.pairs_of(id)?.into_iter().map(to_number));
        Ok(())
    }

    fn ids(&self, each: &mut dyn FnMut(ProxyId)) {
        self.world.ids().for_each(each);
    }

    fn len(&self) -> usize {
        self.world.len()
    }

    fn query(
        &mut self,
        query: Query,
        filter: Filter,
        numbers: &Numbers,
        out: &mut Vec<f64>,
    ) -> Result<(), Error> {
        let queries = self.world.queries().with_filter(filter);
        let point = Self::point(numbers, 0);
        let ids = match query {
            Query::Overlapping => queries.overlapping(&Self::boxed_at(numbers, 0))?,
            Query::Containing => queries.containing(point)?,
            Query::Within => queries.within(point, T::from_f64(numbers[D]))?,
            Query::Cast | Query::CastAll => {
                let direction = Self::point(numbers, 2 * D);
                let limit = T::from_f64(numbers[3 * D]);
                let cast = Cast::aabb(Self::boxed_at(numbers, 0), direction, limit);
                if matches!(query, Query::Cast) {
                    out.extend(
                        queries.cast(&cast)?.iter().flat_map(|hit| [to_number(hit.id), hit.at]),
                    );
                } else {
                    let hits = queries.cast_all(&cast)?;
                    out.extend(hits.iter().flat_map(|hit| [to_number(hit.id), hit.at]));
                }
                return Ok(());
            }
            Query::Nearest(k) => {
                let nearest = queries.nearest(point, k)?;
                out.extend(
                    nearest.iter().flat_map(|near| [to_number(near.id), near.distance_squared]),
                );
                return Ok(());
            }
        };
        out.extend(ids.into_iter().map(to_number));
        Ok(())
    }

    fn snapshot(&self) -> Vec<u8> {
        self.world.snapshot()
    }

    fn restore(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.world = BroadPhase::from_snapshot(bytes)?;
        Ok(())
    }

    fn hash(&self) -> u64 {
        self.world.state_hash()
    }
}

/// What JavaScript holds a pointer to.
struct Handle {
    world: Box<dyn World>,
    numbers: Numbers,
    /// The generation of the last body of each slot: what an id from JavaScript leaves out.
    generations: Vec<u32>,
    ids_in: Vec<f64>,
    ids: Vec<ProxyId>,
    out: Vec<f64>,
    bytes: Vec<u8>,
}

impl Handle {
    /// The id that `number` stands for, if it can be one.
    fn id(&self, number: f64, index: usize) -> Result<ProxyId, Error> {
        let bits = number as u64;
        let slot = bits & ((1 << SLOT_BITS) - 1);
        match self.generations.get(slot as usize) {
            Some(&generation)
                if bits as f64 == number
                    && bits >> SLOT_BITS == u64::from(generation & GENERATION_MASK) =>
            {
                Ok(ProxyId::from_bits(u64::from(generation) << 32 | slot))
            }
            _ => Err(Error::StaleProxy { index }),
        }
    }

    /// The first `count` ids that were written, as ids.
    fn read_ids(&mut self, count: usize) -> Result<(), Error> {
        self.ids.clear();
        for index in 0..count.min(self.ids_in.len()) {
            let id = self.id(self.ids_in[index], index)?;
            self.ids.push(id);
        }
        Ok(())
    }

    fn note(&mut self, id: ProxyId) {
        note(&mut self.generations, id);
    }

    /// Tells of what is in `out`.
    fn answer(&self, result: Result<(), Error>) -> Code {
        match result {
            Ok(()) => tell(Code::Ok, [self.out.as_ptr().addr(), self.out.len()]),
            Err(error) => tell_error(error),
        }
    }
}

fn note(generations: &mut Vec<u32>, id: ProxyId) {
    let at = id.slot() as usize;
    if at >= generations.len() {
        generations.resize(at + 1, 0);
    }
    generations[at] = id.generation();
}

fn filter_of(category: u32, mask: u32, group: i32, is_static: bool) -> Filter {
    Filter { category, mask, group, is_static }
}

/// A new world, to be freed by [`world_free`]; null if there is none for such boxes, or a margin
/// is negative, infinite or NaN.
#[unsafe(no_mangle)]
extern "C" fn world_new(
    dimensions: u32,
    is_double: bool,
    margin: f64,
    prediction: f64,
    is_fat: bool,
) -> Option<Box<Handle>> {
    let report = if is_fat { Report::Fat } else { Report::Exact };
    let world = match (dimensions, is_double) {
        (2, false) => Typed::<2, f32>::boxed(margin, prediction, report),
        (3, false) => Typed::<3, f32>::boxed(margin, prediction, report),
        (3, true) => Typed::<3, f64>::boxed(margin, prediction, report),
        _ => None,
    }?;
    Some(Box::new(Handle {
        world,
        numbers: [0.0; 16],
        generations: Vec::new(),
        ids_in: Vec::new(),
        ids: Vec::new(),
        out: Vec::new(),
        bytes: Vec::new(),
    }))
}

/// Frees a world and all that it holds.
#[unsafe(no_mangle)]
extern "C" fn world_free(handle: Option<Box<Handle>>) {
    drop(handle);
}

/// Where the 16 numbers are, as long as the world lives.
#[unsafe(no_mangle)]
extern "C" fn world_numbers(handle: &mut Handle) -> *mut f64 {
    handle.numbers.as_mut_ptr()
}

/// Where to write `count` rows of boxes; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_rows(handle: &mut Handle, count: usize) -> *mut u8 {
    handle.world.rows(count).unwrap_or(core::ptr::null_mut())
}

/// Where to write `count` ids; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_ids_in(handle: &mut Handle, count: usize) -> *mut f64 {
    if let Some(more) = count.checked_sub(handle.ids_in.len()) {
        if handle.ids_in.try_reserve(more).is_err() {
            return core::ptr::null_mut();
        }
        handle.ids_in.resize(count, 0.0);
    }
    handle.ids_in.as_mut_ptr()
}

/// Where to write `count` bytes of a snapshot; null if there is no memory for them.
#[unsafe(no_mangle)]
extern "C" fn world_bytes(handle: &mut Handle, count: usize) -> *mut u8 {
    handle.bytes.clear();
    if handle.bytes.try_reserve(count).is_err() {
        return core::ptr::null_mut();
    }
    handle.bytes.resize(count, 0);
    handle.bytes.as_mut_ptr()
}

/// Adds a body whose box is in the numbers; the first of them is then its id.
#[unsafe(no_mangle)]
extern "C" fn world_insert(handle: &mut Handle) -> Code {
    match handle.world.insert(&handle.numbers) {
        Ok(id) => {
            handle.note(id);
            handle.numbers[0] = to_number(id);
            tell(Code::Ok, [0, 0])
        }
        Err(error) => tell_error(error),
    }
}

/// Adds a body for each of the first `count` rows. Details: where their ids are, how many.
#[unsafe(no_mangle)]
extern "C" fn world_insert_many(
    handle: &mut Handle,
    count: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    handle.out.clear();
    let filter = filter_of(category, mask, group, is_static);
    let result = handle.world.insert_many(count, filter).map(|ids| {
        for id in ids {
            handle.note(id);
            handle.out.push(to_number(id));
        }
    });
    handle.answer(result)
}

/// Gives a body the box in the numbers.
#[unsafe(no_mangle)]
extern "C" fn world_set(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.set(id, &handle.numbers));
    handle.answer(result)
}

/// Gives the bodies of the first `count` ids the boxes in the rows.
#[unsafe(no_mangle)]
extern "C" fn world_set_many(handle: &mut Handle, count: usize) -> Code {
    let result = handle.read_ids(count).and_then(|()| handle.world.set_many(&handle.ids));
    handle.answer(result)
}

/// Moves a body from the first box in the numbers to the second.
#[unsafe(no_mangle)]
extern "C" fn world_set_swept(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.set_swept(id, &handle.numbers));
    handle.answer(result)
}

/// Changes the filter of a body.
#[unsafe(no_mangle)]
extern "C" fn world_set_filter(
    handle: &mut Handle,
    id: f64,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    let filter = filter_of(category, mask, group, is_static);
    let result = handle.id(id, 0).and_then(|id| handle.world.set_filter(id, filter));
    handle.answer(result)
}

/// Leaves the filter of a body in the first four numbers.
#[unsafe(no_mangle)]
extern "C" fn world_filter(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.filter(id)).map(|filter| {
        handle.numbers[0] = f64::from(filter.category);
        handle.numbers[1] = f64::from(filter.mask);
        handle.numbers[2] = f64::from(filter.group);
        handle.numbers[3] = f64::from(u8::from(filter.is_static));
    });
    handle.answer(result)
}

/// Leaves the box of a body in the numbers.
#[unsafe(no_mangle)]
extern "C" fn world_box(handle: &mut Handle, id: f64) -> Code {
    let result = handle.id(id, 0).and_then(|id| handle.world.aabb(id, &mut handle.numbers));
    handle.answer(result)
}

/// Whether an id names a body.
#[unsafe(no_mangle)]
extern "C" fn world_has(handle: &mut Handle, id: f64) -> bool {
    handle.id(id, 0).and_then(|id| handle.world.filter(id)).is_ok()
}

/// Removes the bodies of the first `count` ids.
#[unsafe(no_mangle)]
extern "C" fn world_remove_many(handle: &mut Handle, count: usize) -> Code {
    let result = handle.read_ids(count).and_then(|()| handle.world.remove_many(&handle.ids));
    handle.answer(result)
}

/// Details: where the pairs are that began and then those that ended, and how many ids; the first
/// number says how many of those are of pairs that began.
#[unsafe(no_mangle)]
extern "C" fn world_update(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.numbers[0] = handle.world.update(&mut handle.out) as f64;
    handle.answer(Ok(()))
}

/// Details: where the pairs of the last update are, and how many ids.
#[unsafe(no_mangle)]
extern "C" fn world_pairs(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.world.pairs(&mut handle.out);
    handle.answer(Ok(()))
}

/// Details: where the ids are of the bodies that overlapped this one, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_pairs_of(handle: &mut Handle, id: f64) -> Code {
    handle.out.clear();
    let result = handle.id(id, 0).and_then(|id| handle.world.pairs_of(id, &mut handle.out));
    handle.answer(result)
}

/// Details: where the ids of all bodies are, and how many.
#[unsafe(no_mangle)]
extern "C" fn world_ids(handle: &mut Handle) -> Code {
    handle.out.clear();
    handle.world.ids(&mut |id| handle.out.push(to_number(id)));
    handle.answer(Ok(()))
}

/// How many bodies there are.
#[unsafe(no_mangle)]
extern "C" fn world_len(handle: &mut Handle) -> usize {
    handle.world.len()
}

/// Asks a query whose numbers are in the numbers. Details: where its answer is, and how many
/// numbers that is: ids, or ids each followed by a place or a squared distance.
#[unsafe(no_mangle)]
extern "C" fn world_query(
    handle: &mut Handle,
    query: u32,
    k: usize,
    category: u32,
    mask: u32,
    group: i32,
    is_static: bool,
) -> Code {
    let query = match query {
        0 => Query::Overlapping,
        1 => Query::Containing,
        2 => Query::Within,
        3 => Query::Cast,
        4 => Query::CastAll,
        _ => Query::Nearest(k),
    };
    let filter = filter_of(category, mask, group, is_static);
    handle.out.clear();
    let result = handle.world.query(query, filter, &handle.numbers, &mut handle.out);
    handle.answer(result)
}

/// Details: where the snapshot is, and how many bytes; until the next call.
#[unsafe(no_mangle)]
extern "C" fn world_snapshot(handle: &mut Handle) -> Code {
    handle.bytes = handle.world.snapshot();
    tell(Code::Ok, [handle.bytes.as_ptr().addr(), handle.bytes.len()])
}

/// Makes the world that of the snapshot in the bytes.
#[unsafe(no_mangle)]
extern "C" fn world_restore(handle: &mut Handle) -> Code {
    let result = handle.world.restore(&handle.bytes);
    handle.bytes = Vec::new();
    if result.is_ok() {
        let generations = &mut handle.generations;
        generations.clear();
        handle.world.ids(&mut |id| note(generations, id));
    }
    handle.answer(result)
}

/// Details: the hash of the state, the low and the high word.
#[unsafe(no_mangle)]
extern "C" fn world_hash(handle: &mut Handle) -> Code {
    let hash = handle.world.hash();
    tell(Code::Ok, [hash as u32 as usize, (hash >> 32) as usize])
}
