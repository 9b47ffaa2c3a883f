//! Threads that belong to one handle.

use std::mem::take;
use std::sync::Mutex;
use std::thread::{JoinHandle, available_parallelism};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::failure::Failure;

/// A pool of threads, which end before the handle is destroyed. Without one, calls run on the calling thread.
#[derive(Default)]
pub struct Threads {
    pool: Option<ThreadPool>,
    joins: Vec<JoinHandle<()>>,
}

impl Threads {
    /// At most `wanted` threads, and no more than there are processors.
    pub fn new(wanted: u32) -> Result<Self, Failure> {
        let processors = available_parallelism().map_or(1, |count| count.get());
        let count = (wanted as usize).min(processors);
        if count <= 1 {
            return Ok(Self::default());
        }
        let started = Mutex::new(Vec::new());
        let pool = ThreadPoolBuilder::new().num_threads(count).spawn_handler(|thread| {
            let join = std::thread::Builder::new()
                .name("sweep-and-prune".into())
                .spawn(move || thread.run())?;
            started.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(join);
            Ok(())
        });
        let pool = pool.build().map_err(|error| Failure::Threads(error.to_string()))?;
        let joins = started.into_inner().unwrap_or_else(|poisoned| poisoned.into_inner());
        Ok(Self { pool: Some(pool), joins })
    }

    /// How many threads there are.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, ThreadPool::current_num_threads)
    }

    /// Runs a call, whose parts the threads share.
    pub fn run<R: Send>(&self, call: impl FnOnce() -> R + Send) -> R {
        match &self.pool {
            Some(pool) => pool.install(call),
            None => call(),
        }
    }
}

impl Drop for Threads {
    fn drop(&mut self) {
        drop(self.pool.take());
        for join in take(&mut self.joins) {
            // A thread of the pool does not panic: rayon passes a panic on to the call.
            let _ = join.join();
        }
    }
}
