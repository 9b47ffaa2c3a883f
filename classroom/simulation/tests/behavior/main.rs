//! What the simulation promises, in one program: the generic code of the core is compiled once for all of these tests.

mod energy;
mod golden;
mod motion;
mod rest;
