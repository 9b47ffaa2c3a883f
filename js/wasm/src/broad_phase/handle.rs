//! The handle that JavaScript holds, and the form that ids have there: whole numbers.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Error, ProxyId};
#[cfg(feature = "broad-phase")]
use sweep_and_prune_bindings::Answer;
#[cfg(feature = "broad-phase")]
use sweep_and_prune_bindings::AnyBroadPhase as Bodies;
use sweep_and_prune_bindings::Id;
#[cfg(not(feature = "broad-phase"))]
use sweep_and_prune_bindings::TrackBodies as Bodies;

use sweep_and_prune_wasm_runtime::call::{self, Running};
use sweep_and_prune_wasm_runtime::status::{Code, report, report_error};

/// How many bits of an id are its slot. Each body takes more than 64 bytes, so the slots of 4 GiB fit.
const SLOT_BITS: u32 = 26;
/// The bits of an id that are its generation: 27, which with the 26 of the slot are all that an `f64` holds exactly.
const GENERATION_MASK: u32 = (1 << 27) - 1;

/// An id as a whole number below 2^53.
#[derive(Clone, Copy, Debug, Default)]
#[repr(transparent)]
pub(super) struct Number(pub f64);

impl Id for Number {
    fn from_proxy(id: ProxyId) -> Self {
        let generation = f64::from(id.generation() & GENERATION_MASK);
        Self(generation * (1 << SLOT_BITS) as f64 + f64::from(id.slot()))
    }
}

/// The broad phase behind a handle.
pub(super) type World = Box<dyn Bodies<Number>>;

/// What JavaScript holds a pointer to.
#[repr(C)]
pub(super) struct Handle {
    running: Running,
    pub world: World,
    /// How many dimensions the boxes have for the user; they may be stored in more.
    #[cfg_attr(not(feature = "broad-phase"), allow(dead_code))] // only snapshots need it
    pub dimensions: u32,
    /// The few numbers that go in and out: two boxes and more.
    pub numbers: [f64; 16],
    /// The generation of the last body of each slot: the bits that a number leaves out.
    pub generations: Vec<u32>,
    /// The ids that a call reports, but for those of queries.
    pub ids_out: Vec<Number>,
    pub ids_in: Vec<f64>,
    pub ids: Vec<ProxyId>,
    #[cfg(feature = "broad-phase")]
    pub answer: Answer<Number>,
    #[cfg(feature = "broad-phase")]
    pub bytes: Vec<u8>,
}

impl call::Handle for Handle {
    fn running(&mut self) -> &mut Running {
        &mut self.running
    }
}

impl Handle {
    pub fn new(world: World, dimensions: u32) -> Self {
        Self {
            running: Running::default(),
            world,
            dimensions,
            numbers: [0.0; 16],
            generations: Vec::new(),
            ids_in: Vec::new(),
            ids: Vec::new(),
            ids_out: Vec::new(),
            #[cfg(feature = "broad-phase")]
            answer: Answer::default(),
            #[cfg(feature = "broad-phase")]
            bytes: Vec::new(),
        }
    }

    /// How many numbers a box takes.
    pub fn width(&self) -> usize {
        2 * self.world.kind().dimensions
    }

    /// The id that `number` stands for, if it can be one.
    pub fn id(&self, number: f64, index: usize) -> Result<ProxyId, Error> {
        id_of(&self.generations, number).ok_or(Error::StaleProxy { index, id: number as u64 })
    }

    /// The first `count` ids that were written, as ids.
    pub fn read_ids(&mut self, count: usize) -> Result<(), Error> {
        let numbers = &self.ids_in[..count.min(self.ids_in.len())];
        self.ids.resize(numbers.len(), ProxyId::from_bits(0));
        for (index, (id, &number)) in self.ids.iter_mut().zip(numbers).enumerate() {
            *id = id_of(&self.generations, number)
                .ok_or(Error::StaleProxy { index, id: number as u64 })?;
        }
        Ok(())
    }

    /// As [`note`].
    pub fn note(&mut self, id: ProxyId) {
        note(&mut self.generations, id);
    }

    /// Reports where the ids that go out are, and how many, or an error.
    pub fn answer(&self, result: Result<(), Error>) -> Code {
        match result {
            Ok(()) => report(Code::Ok, [self.ids_out.as_ptr().addr(), self.ids_out.len()]),
            Err(error) => report_error(error),
        }
    }
}

pub(super) fn id_of(generations: &[u32], number: f64) -> Option<ProxyId> {
    // A number that is no id gives some slot, or is not whole.
    let whole = number as i64;
    let slot = whole as u32 & ((1 << SLOT_BITS) - 1);
    let generation = *generations.get(slot as usize)?;
    let is_id =
        whole as f64 == number && whole >> SLOT_BITS == i64::from(generation & GENERATION_MASK);
    is_id.then(|| ProxyId::from_bits(u64::from(generation) << 32 | u64::from(slot)))
}

/// Remembers the generation of an id, by its slot.
pub(super) fn note(generations: &mut Vec<u32>, id: ProxyId) {
    let at = id.slot() as usize;
    if at >= generations.len() {
        generations.resize(at + 1, 0);
    }
    generations[at] = id.generation();
}
