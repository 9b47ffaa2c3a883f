//! A broad phase with its threads, and what it has reported.

use std::mem::take;
use std::ptr::null;

use sweep_and_prune::{BroadPhase, Error, Options, Queries, Report, Scalar};

use crate::common::{Wanted, id_pair, sap_changes, sap_id_pair};
use crate::failure::Failure;
use crate::handle::{Handle, read, write};
use crate::threads::Threads;

/// What the handle of a world holds.
pub struct World<const D: usize, T: Scalar> {
    pub bodies: BroadPhase<D, T>,
    threads: Threads,
    /// The pairs that the last update reported: first those that began.
    changes: Vec<sap_id_pair>,
    /// Whether the last update found changes for which there was no memory. The next one reports these.
    is_due: bool,
    /// The last snapshot.
    bytes: Vec<u8>,
}

impl<const D: usize, T: Scalar> World<D, T> {
    /// An empty world.
    pub fn new(report: Report<T>, threads: u32) -> Result<Self, Failure> {
        let bodies = BroadPhase::with_options(Options::default().report(report))?;
        Ok(Self::of(bodies, Threads::new(threads)?))
    }

    fn of(bodies: BroadPhase<D, T>, threads: Threads) -> Self {
        let bodies = bodies.threads(threads.count());
        Self { bodies, threads, changes: Vec::new(), is_due: false, bytes: Vec::new() }
    }

    /// The same world once more.
    pub fn copy(&self) -> Result<Self, Failure> {
        let threads = Threads::new(self.threads.count() as u32)?;
        Ok(Self { is_due: self.is_due, ..Self::of(self.bodies.clone(), threads) })
    }

    /// Becomes equal to another world, with its own threads. The pairs that it reported stay: the user may still read them.
    pub fn assign(&mut self, from: &Self) {
        self.bodies.clone_from(&from.bodies);
        let count = self.threads.count();
        if from.threads.count() != count {
            self.bodies = take(&mut self.bodies).threads(count);
        }
        self.is_due = from.is_due;
    }

    /// Updates, and says what changed. If there is no memory to say it, the next call says it.
    pub fn update(&mut self) -> Result<sap_changes, Failure> {
        let Self { bodies, threads, changes, is_due, .. } = self;
        if !*is_due {
            threads.run(|| bodies.try_update().map(|_| ()))?;
        }
        let (begun, ended) = (bodies.changes().begun(), bodies.changes().ended());
        // Where it has to grow, without the old ones beside it.
        if changes.capacity() < begun.len() + ended.len() {
            *changes = Vec::new();
        }
        changes.clear();
        *is_due = changes.try_reserve(begun.len() + ended.len()).is_err();
        if *is_due {
            return Err(Error::OutOfMemory.into());
        }
        changes.extend(begun.map(id_pair));
        changes.extend(ended.map(id_pair));
        let (begun, ended) = self.changes.split_at(self.bodies.changes().begun().len());
        let start = |pairs: &[sap_id_pair]| if pairs.is_empty() { null() } else { pairs.as_ptr() };
        Ok(sap_changes {
            begun: start(begun),
            begun_count: begun.len(),
            ended: start(ended),
            ended_count: ended.len(),
        })
    }

    /// The state as bytes, which are kept.
    pub fn snapshot(&mut self) -> &[u8] {
        self.bodies.snapshot_into(&mut self.bytes);
        &self.bytes
    }

    /// Becomes the world of a snapshot.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        self.bodies = BroadPhase::from_snapshot(bytes)?.threads(self.threads.count());
        self.changes.clear();
        self.is_due = false;
        Ok(())
    }
}

/// Answers a query, beside other queries if the world is prepared.
///
/// # Safety As [`read`].
pub unsafe fn ask<const D: usize, T: Scalar, H: Handle<State = World<D, T>>, R>(
    world: *mut H,
    wanted: &Wanted,
    answer: impl FnOnce(Queries<'_, D, T>) -> Result<R, Failure>,
) -> Result<R, Failure> {
    let mut answer = Some(answer);
    let mut try_to_answer = || {
        let ask = |state: &World<D, T>| {
            let Some(queries) = state.bodies.prepared_queries() else { return Ok(None) };
            let Some(answer) = answer.take() else { return Ok(None) };
            let is_wanted = |id| !wanted.excluded.contains(&id);
            let queries = match wanted.excluded.is_empty() {
                true => queries,
                false => queries.with_predicate(&is_wanted),
            };
            let queries = wanted.filter.map_or(queries, |filter| queries.with_filter(filter));
            answer(if wanted.unsorted { queries.unsorted() } else { queries }).map(Some)
        };
        // SAFETY: as promised above.
        unsafe { read(world, ask) }
    };
    if let Some(answer) = try_to_answer()? {
        return Ok(answer);
    }
    // SAFETY: as promised above.
    unsafe {
        write(world, |state| {
            state.bodies.prepare_queries();
            Ok(())
        })?
    };
    // Only a call of another thread changes the world between these lines.
    try_to_answer()?.ok_or(Failure::Busy)
}
