//! Runs a call of the core: without the GIL if the call is long, on several threads if the user asked
//! for them, interruptible by signals, and with panics turned into exceptions. Also calls Python
//! functions so that a thread can survive the end of the interpreter.

use std::any::Any;
use std::hint::black_box;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

use pyo3::exceptions::PyRuntimeError;
use pyo3::ffi::{PyObject, PyObject_CallObject};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::exit;

/// Fewer boxes than this take less time than releasing the GIL and waiting to acquire it again.
const FEW: usize = 1024;

/// Time between two checks for signals, and between two reports of progress.
const INTERVAL: Duration = Duration::from_millis(20);

/// A progress callback of the core; it may cancel the search.
pub type Progress<'a> = &'a (dyn Fn(f64) -> ControlFlow<()> + Sync);

/// Runs `work`, which looks at about `boxes` boxes and may use this many threads. Unless there are few, it calls `report` now
/// and then with the share of the work that is done, from 0 to 1.
///
/// # Errors
/// What `report` raised, or a signal handler, usually `KeyboardInterrupt`: then the work was cancelled
/// if it uses its progress callback, or ran to its end. `RuntimeError` if the work panicked: then the object
/// that it worked on is unusable.
pub fn run<R: Send>(
    py: Python<'_>,
    boxes: usize,
    threads: usize,
    report: Option<&Py<PyAny>>,
    work: impl FnOnce(Progress<'_>) -> R + Send,
) -> PyResult<R> {
    let _back = exit::enter(py);
    let work = |progress: Progress<'_>| catch_unwind(AssertUnwindSafe(|| work(progress)));
    let watch = Watch::new(report);
    let done = if boxes < FEW {
        work(&|_| ControlFlow::Continue(()))
    } else if let Some(pool) = (threads > 1).then(pool).flatten() {
        py.detach(|| on_pool(&pool, &watch, work))
    } else {
        py.detach(|| work(&|done| watch.check_now_and_then(done)))
    };
    watch.raised()?;
    done.map_err(|panic| panicked(&*panic))
}

/// A tuple of arguments.
pub trait Arguments<'py>:
    IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error: Into<PyErr>>
{
}

impl<'py, T> Arguments<'py> for T where
    T: IntoPyObject<'py, Target = PyTuple, Output = Bound<'py, PyTuple>, Error: Into<PyErr>>
{
}

/// Calls a Python function that is not the user's. This crate calls Python functions in this way and by [`call_back`].
///
/// # Errors
/// What the function raises.
pub fn call<'py>(
    function: &Bound<'py, PyAny>,
    arguments: impl Arguments<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let _back = exit::enter(function.py());
    call_object(function, arguments)
}

/// Calls a Python function of the user, which may take long.
///
/// # Errors
/// What the function raises.
pub fn call_back<'py>(
    function: &Bound<'py, PyAny>,
    arguments: impl Arguments<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    let _back = exit::enter_callback();
    call_object(function, arguments)
}

/// Calls a Python function in a way that lets Python end the thread during the call.
///
/// While the interpreter shuts down, Python up to 3.13 ends other threads by `pthread_exit` when they
/// run Python code. That unwinds the stack, which aborts the process if Rust frames without cleanup
/// are on it. This function catches the unwinding and lets the thread sleep until the process ends,
/// as Python 3.14 does.
#[allow(unsafe_code)]
fn call_object<'py>(
    function: &Bound<'py, PyAny>,
    arguments: impl Arguments<'py>,
) -> PyResult<Bound<'py, PyAny>> {
    type Plain = unsafe extern "C" fn(*mut PyObject, *mut PyObject) -> *mut PyObject;
    type Unwinding = unsafe extern "C-unwind" fn(*mut PyObject, *mut PyObject) -> *mut PyObject;
    let py = function.py();
    let arguments = arguments.into_pyobject(py).map_err(Into::into)?;
    // SAFETY: the two types differ only in that the second tells the compiler that the call may
    // unwind, so that it runs `guard`'s destructor then. The black box keeps the compiler from
    // recognizing the function, which is declared as one that never unwinds.
    let unwinding: Unwinding =
        black_box(unsafe { std::mem::transmute::<Plain, Unwinding>(PyObject_CallObject) });
    let guard = SleepForever;
    // SAFETY: both are live objects, the second is a tuple, and the GIL is held.
    let result = unsafe { unwinding(function.as_ptr(), arguments.as_ptr()) };
    std::mem::forget(guard);
    // SAFETY: the call returned a new reference, or null with an exception set.
    unsafe { Bound::from_owned_ptr_or_err(py, result) }
}

/// Never lets the thread that drops it go on.
struct SleepForever;

impl Drop for SleepForever {
    fn drop(&mut self) {
        exit::stop()
    }
}

/// Acquires the GIL. If the interpreter has shut down, the thread sleeps until the process ends.
pub fn attach<R>(work: impl FnOnce(Python<'_>) -> R) -> R {
    exit::stop_if_exiting();
    Python::try_attach(work).unwrap_or_else(|| exit::stop())
}

/// Runs work on a pool while the calling thread watches: Python delivers signals only to its main
/// thread, which this may be.
fn on_pool<R: Send>(
    pool: &ThreadPool,
    watch: &Watch<'_>,
    work: impl FnOnce(Progress<'_>) -> std::thread::Result<R> + Send,
) -> std::thread::Result<R> {
    let cancelled = AtomicBool::new(false);
    let most_done = AtomicU64::new(0); // bits of a number that is not negative: in the same order
    let progress = |done: f64| {
        most_done.fetch_max(done.to_bits(), Ordering::Relaxed);
        match cancelled.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    };
    let (sender, receiver) = channel();
    pool.in_place_scope(|scope| {
        scope.spawn(|_| drop(sender.send(work(&progress))));
        loop {
            match receiver.recv_timeout(INTERVAL) {
                Ok(result) => return result,
                Err(RecvTimeoutError::Timeout) => {
                    if watch.check(f64::from_bits(most_done.load(Ordering::Relaxed))).is_break() {
                        cancelled.store(true, Ordering::Relaxed);
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(Box::new("a thread was lost")),
            }
        }
    })
}

/// The thread pool, with one thread for each processor, created when first used; `None` if the
/// system gives no threads. Call it with the GIL held, so that no other thread forks meanwhile.
fn pool() -> Option<Arc<ThreadPool>> {
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    let process = std::process::id();
    match &*pool {
        Some((owner, pool)) if *owner == process => return Some(Arc::clone(pool)),
        _ => (),
    }
    // A forked process has none of its parent's threads. Dropping the pool would wait for them
    // forever, so it is forgotten.
    std::mem::forget(pool.take());
    let built = Arc::new(ThreadPoolBuilder::new().num_threads(processors()).build().ok()?);
    *pool = Some((process, Arc::clone(&built)));
    Some(built)
}

/// The number of threads that can run at once. Cached, because the system call is slow.
#[pyfunction]
pub fn processors() -> usize {
    static PROCESSORS: OnceLock<usize> = OnceLock::new();
    *PROCESSORS.get_or_init(|| available_parallelism().map_or(1, usize::from))
}

/// Lets Python handle signals during a search, and reports progress.
struct Watch<'a> {
    /// The time of the last check, and the exception that it raised.
    state: Mutex<(Instant, Option<PyErr>)>,
    report: Option<&'a Py<PyAny>>,
}

impl<'a> Watch<'a> {
    fn new(report: Option<&'a Py<PyAny>>) -> Self {
        Self { state: Mutex::new((Instant::now(), None)), report }
    }

    /// Checks if the last check was long ago.
    fn check_now_and_then(&self, done: f64) -> ControlFlow<()> {
        let state = self.lock();
        if state.0.elapsed() <= INTERVAL && state.1.is_none() {
            return ControlFlow::Continue(());
        }
        drop(state);
        self.check(done)
    }

    /// Runs Python's handlers of the signals that have arrived, and reports how much is done.
    fn check(&self, done: f64) -> ControlFlow<()> {
        let mut state = self.lock();
        if state.1.is_none() {
            let checked = attach(|py| {
                py.check_signals()?;
                self.report.map_or(Ok(()), |report| call_back(report.bind(py), (done,)).map(drop))
            });
            *state = (Instant::now(), checked.err());
        }
        if state.1.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn lock(&self) -> MutexGuard<'_, (Instant, Option<PyErr>)> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn raised(self) -> PyResult<()> {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).1.map_or(Ok(()), Err)
    }
}

fn panicked(panic: &(dyn Any + Send)) -> PyErr {
    let message = panic.downcast_ref::<String>().map(String::as_str);
    let message = message.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("unknown");
    PyRuntimeError::new_err(format!(
        "the search failed; this is a bug, please report it ({message})"
    ))
}
