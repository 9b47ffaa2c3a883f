//! Lets the interpreter exit while daemon threads search.
//!
//! Up to Python 3.13 a daemon thread must not ask for the GIL once the interpreter shuts down: Python ends it by
//! unwinding its stack, or the thread reads memory that Python has freed. So before the interpreter shuts down, `atexit`
//! calls [`stop_threads`]. It lets the threads that are in this crate go on until they hold the GIL or have come to a
//! place where they would ask for it; there they sleep until the process ends, and so does each thread that enters this
//! crate afterwards.

use std::cell::Cell;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use pyo3::prelude::*;

/// What a thread does.
#[derive(Clone, Copy, PartialEq)]
enum Place {
    Elsewhere,
    /// It is in a call of this crate, in which it may release the GIL and ask for it again.
    Here,
    /// It is in a function of the user that this crate called.
    Callback,
}

static HERE: AtomicUsize = AtomicUsize::new(0);
static CALLBACKS: AtomicUsize = AtomicUsize::new(0);
static IS_EXITING: AtomicBool = AtomicBool::new(false);
/// The process in which the threads are counted: one that is forked from it has none of them.
static PROCESS: OnceLock<u32> = OnceLock::new();

thread_local! {
    static PLACE: Cell<Place> = const { Cell::new(Place::Elsewhere) };
    static IS_EXITING_ITSELF: Cell<bool> = const { Cell::new(false) };
}

/// Threads that search check every 20 ms whether they have to stop. On a busy machine the next check may come much later.
const PATIENCE: Duration = Duration::from_secs(2);
/// A callback may wait for ever, for example until its chunk is taken.
const PATIENCE_WITH_CALLBACKS: Duration = Duration::from_millis(50);

/// When this is dropped, the thread counts again as being where it was before.
pub struct Back(Place);

impl Drop for Back {
    fn drop(&mut self) {
        go_to(self.0);
    }
}

/// Held during everything that may release the GIL.
pub fn enter(py: Python<'_>) -> Back {
    if must_stop() {
        py.detach(|| stop());
    }
    Back(go_to(Place::Here))
}

/// Held while a function of the user runs.
pub fn enter_callback() -> Back {
    Back(go_to(Place::Callback))
}

/// A thread without the GIL calls this before it asks for the GIL.
pub fn stop_if_exiting() {
    if must_stop() {
        stop();
    }
}

/// Never lets the thread go on.
pub fn stop() -> ! {
    go_to(Place::Elsewhere);
    loop {
        std::thread::sleep(Duration::from_secs(3600));
    }
}

/// Waits until no other thread is in a call of this crate in which it may ask for the GIL.
#[pyfunction]
pub fn stop_threads(py: Python<'_>) {
    IS_EXITING_ITSELF.set(true);
    IS_EXITING.store(true, Ordering::SeqCst);
    if PROCESS.get() == Some(&std::process::id()) {
        py.detach(wait_for_others);
    }
}

fn wait_for_others() {
    let begun = Instant::now();
    loop {
        let (here, callbacks) = (HERE.load(Ordering::SeqCst), CALLBACKS.load(Ordering::SeqCst));
        let patience = match (here, callbacks) {
            (0, 0) => return,
            (0, _) => PATIENCE_WITH_CALLBACKS,
            _ => PATIENCE,
        };
        if begun.elapsed() > patience {
            return;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Has `atexit` call [`stop_threads`].
pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let _ = PROCESS.set(std::process::id());
    let atexit = module.py().import("atexit")?;
    atexit.call_method1("register", (module.getattr("stop_threads")?,)).map(drop)
}

fn must_stop() -> bool {
    IS_EXITING.load(Ordering::SeqCst) && !IS_EXITING_ITSELF.get()
}

fn go_to(place: Place) -> Place {
    let before = PLACE.replace(place);
    if before != place {
        if let Some(count) = counter(place) {
            count.fetch_add(1, Ordering::SeqCst);
        }
        if let Some(count) = counter(before) {
            count.fetch_sub(1, Ordering::SeqCst);
        }
    }
    before
}

fn counter(place: Place) -> Option<&'static AtomicUsize> {
    match place {
        Place::Elsewhere => None,
        Place::Here => Some(&HERE),
        Place::Callback => Some(&CALLBACKS),
    }
}
