//! Generated speckle of any seed, size, pupil, law of phasors, displacement and defocus against the
//! theory of fully developed speckle.
//!
//! The tests are statistical but not flaky: all seeds are fixed. Each says with which probability a
//! correct generator fails; for no test it exceeds 1e−4.

mod first_order;
mod lattice;
mod paper;
mod second_order;
mod slices;
mod spectrum;
