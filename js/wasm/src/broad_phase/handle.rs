//! What stands between a world and JavaScript: ids as whole numbers, and what goes in and out.

use alloc::boxed::Box;
use alloc::vec::Vec;

use sweep_and_prune::{Error, ProxyId};

use super::typed::{Numbers, World};
use crate::status::{Code, tell, tell_error};

/// Bits of an id that are its slot. Each body takes more than 64 bytes, so that 4 GiB hold less.
const SLOT_BITS: u32 = 26;
/// Bits of an id that are its generation: with those of the slot, as many as an `f64` holds.
const GENERATION_MASK: u32 = (1 << 27) - 1;

/// The id as a whole number below 2^53.
pub(super) fn to_number(id: ProxyId) -> f64 {
    f64::from(id.generation() & GENERATION_MASK) * (1 << SLOT_BITS) as f64 + f64::from(id.slot())
}

/// What JavaScript holds a pointer to.
pub(super) struct Handle {
    pub world: Box<dyn World>,
    pub numbers: Numbers,
    /// The generation of the last body of each slot: what an id from JavaScript leaves out.
    pub generations: Vec<u32>,
    pub ids_in: Vec<f64>,
    pub ids: Vec<ProxyId>,
    pub out: Vec<f64>,
    pub bytes: Vec<u8>,
}

impl Handle {
    pub fn new(world: Box<dyn World>) -> Self {
        Self {
            world,
            numbers: [0.0; 16],
            generations: Vec::new(),
            ids_in: Vec::new(),
            ids: Vec::new(),
            out: Vec::new(),
            bytes: Vec::new(),
        }
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

    /// Tells of what is in `out`.
    pub fn answer(&self, result: Result<(), Error>) -> Code {
        match result {
            Ok(()) => tell(Code::Ok, [self.out.as_ptr().addr(), self.out.len()]),
            Err(error) => tell_error(error),
        }
    }
}

fn id_of(generations: &[u32], number: f64) -> Option<ProxyId> {
    // Of a number that is none, some slot: to compare numbers afterwards is enough.
    let slot = number as i64 as u32 & ((1 << SLOT_BITS) - 1);
    let generation = *generations.get(slot as usize)?;
    let id = ProxyId::from_bits(u64::from(generation) << 32 | u64::from(slot));
    (to_number(id) == number).then_some(id)
}

/// Remembers the generation of an id, by its slot.
pub(super) fn note(generations: &mut Vec<u32>, id: ProxyId) {
    let at = id.slot() as usize;
    if at >= generations.len() {
        generations.resize(at + 1, 0);
    }
    generations[at] = id.generation();
}
