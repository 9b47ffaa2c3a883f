//! How a call is run: without the interpreter's lock if it is long, on threads if they were asked
//! for, with an eye on the keyboard, and so that a bug here or in the core becomes an exception.

use std::any::Any;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// Fewer boxes than this take less time than giving the lock back and waiting for it.
pub const FEW: usize = 1024;

/// With fewer boxes the core does not use threads.
const WORTH: usize = 4096;

/// How often it is asked whether someone wants to stop.
const PATIENCE: Duration = Duration::from_millis(20);

/// What the core tells of its progress, and what may end it.
pub type Watch<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// Runs `work` of so many boxes.
///
/// # Errors
/// What a signal's handler raised, `KeyboardInterrupt` as a rule: then the work was broken off, if
/// it uses its watch, or came to its end. `RuntimeError` if it panicked; what it worked on is in
/// pieces then.
pub fn run<R: Send>(
    py: Python<'_>,
    boxes: usize,
    threads: usize,
    work: impl FnOnce(Watch<'_>) -> R + Send,
) -> PyResult<R> {
    let work = |watch: Watch<'_>| catch_unwind(AssertUnwindSafe(|| work(watch)));
    let interrupts = Interrupts::new();
    let done = if boxes < FEW {
        work(&|_| ControlFlow::Continue(()))
    } else if let Some(pool) = (threads > 1 && boxes >= WORTH).then(pool).flatten() {
        py.detach(|| on_pool(&pool, &interrupts, work))
    } else {
        py.detach(|| work(&|_| interrupts.look()))
    };
    interrupts.raised()?;
    done.map_err(|panic| broken(&*panic))
}

/// Runs work on a pool, while the calling thread, which may be Python's main one and then is the
/// only one that signals are told to, waits and watches.
fn on_pool<R: Send>(
    pool: &ThreadPool,
    interrupts: &Interrupts,
    work: impl FnOnce(Watch<'_>) -> std::thread::Result<R> + Send,
) -> std::thread::Result<R> {
    let stop = AtomicBool::new(false);
    let asked = |_| match stop.load(Ordering::Relaxed) {
        true => ControlFlow::Break(()),
        false => ControlFlow::Continue(()),
    };
    let (done, wait) = channel();
    pool.in_place_scope(|scope| {
        scope.spawn(|_| drop(done.send(work(&asked))));
        loop {
            match wait.recv_timeout(PATIENCE) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Timeout) => {
                    if interrupts.ask().is_break() {
                        stop.store(true, Ordering::Relaxed);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(Box::new("a thread was lost")),
            }
        }
    })
}

/// The threads, one for each processor, made when first wanted; none if they cannot be had. To be
/// called with the interpreter's lock, so that nobody forks meanwhile.
fn pool() -> Option<Arc<ThreadPool>> {
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*pool {
        Some((of, pool)) if *of == process => return Some(Arc::clone(pool)),
        _ => (),
    }
    // A process that was forked has none of its parent's threads: who waited for them would wait
    // for ever, so they are forgotten.
    std::mem::forget(pool.take());
    let built = Arc::new(ThreadPoolBuilder::new().num_threads(processors()).build().ok()?);
    *pool = Some((process, Arc::clone(&built)));
    Some(built)
}

/// How many threads can be at work at once. The system takes its time to answer.
pub fn processors() -> usize {
    static PROCESSORS: OnceLock<usize> = OnceLock::new();
    *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from))
}

/// Whether a handler of signals has raised an exception.
struct Interrupts(Mutex<(Instant, Option<PyErr>)>);

impl Interrupts {
    fn new() -> Self {
        Self(Mutex::new((Instant::now(), None)))
    }

    /// Asks, if it is time for that.
    fn look(&self) -> ControlFlow<()> {
        let state = self.lock();
        if state.0.elapsed() <= PATIENCE && state.1.is_none() {
            return ControlFlow::Continue(());
        }
        drop(state);
        self.ask()
    }

    /// Has Python call the handlers of signals that came.
    fn ask(&self) -> ControlFlow<()> {
        let mut state = self.lock();
        if state.1.is_none() {
            state.1 = Python::attach(|py| py.check_signals()).err();
            state.0 = Instant::now();
        }
        if state.1.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn lock(&self) -> MutexGuard<'_, (Instant, Option<PyErr>)> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn raised(self) -> PyResult<()> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).1.map_or(Ok(()), Err)
    }
}

fn broken(panic: &(dyn Any + Send)) -> PyErr {
    let said = panic.downcast_ref::<String>().map(String::as_str);
    let said = said.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
    PyRuntimeError::new_err(format!(
        "the search broke off: an array was written to meanwhile, or this is a bug ({said})"
    ))
}
