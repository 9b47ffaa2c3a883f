//! Work on several threads of rayon's current pool.

use alloc::vec::Vec;
use core::hint::spin_loop;
use core::sync::atomic::{AtomicUsize, Ordering};
use std::thread::yield_now;

use rayon::iter::{IntoParallelIterator, ParallelIterator};

/// With fewer pairs threads do not pay to copy them (two busy cores of a virtual machine).
const MIN_PAIRS_TO_COPY_ON_THREADS: usize = 1 << 18;
/// How often the calling thread checks whether the others have finished, and then how often more
/// while it lets others run, before it goes to sleep: some hundred microseconds in all. (Two threads at
/// 100,000 boxes take 0.93 to 0.95 of the time that they take if it sleeps at once; 11 scenes.)
const SPINS: u32 = 10_000;
const YIELDS: u32 = 200;

/// Does `own` on the calling thread, and the work of each of the others on another thread.
///
/// The calling thread waits awake for the others, which are seldom far behind: to sleep and be woken
/// takes as long. But it does not wait awake for ever: the others may not even have begun, if the
/// pool is busy. A thread of the pool does not wait at all, but does other work of the pool.
pub fn on_threads<W: Send>(
    own: impl FnOnce(),
    others: impl Iterator<Item = W>,
    work: impl Fn(W) + Sync,
) {
    let busy = AtomicUsize::new(0);
    rayon::in_place_scope(|scope| {
        let work = &work;
        for other in others {
            busy.fetch_add(1, Ordering::Relaxed);
            let busy = Busy(&busy);
            scope.spawn(move |_| {
                let _busy = busy;
                work(other);
            });
        }
        own();
        let patience = if rayon::current_thread_index().is_some() { 0 } else { SPINS + YIELDS };
        for turn in 0..patience {
            if busy.load(Ordering::Acquire) == 0 {
                break;
            }
            if turn < SPINS { spin_loop() } else { yield_now() }
        }
        // The scope learns of it a moment later.
        (0..50).for_each(|_| spin_loop());
    });
}

/// Does the work of each item on a thread of its own; the calling thread takes the first item.
pub fn for_each_on_threads<W: Send>(mut items: impl Iterator<Item = W>, work: impl Fn(W) + Sync) {
    let first = items.next();
    on_threads(|| first.into_iter().for_each(&work), items, &work);
}

/// A thread counts as busy until this is dropped.
struct Busy<'a>(&'a AtomicUsize);

impl Drop for Busy<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Release);
    }
}

/// The place of a chunk of pairs, and the pairs.
pub type Placed<'a> = (&'a mut [[u32; 2]], &'a [[u32; 2]]);

/// Copies chunks of pairs to their places, on threads if they are many.
pub fn copy(chunks: Vec<Placed<'_>>) {
    let pairs: usize = chunks.iter().map(|(_, from)| from.len()).sum();
    if pairs < MIN_PAIRS_TO_COPY_ON_THREADS {
        chunks.into_iter().for_each(|(to, from)| to.copy_from_slice(from));
    } else {
        chunks.into_par_iter().for_each(|(to, from)| to.copy_from_slice(from));
    }
}
