//! What the algorithms promise, in one program: their generic code is compiled once for all of these tests.

mod corrections;
mod observed;
mod oracle;
mod send_sync;
mod steps;
mod trace;
