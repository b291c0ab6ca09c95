//! Under construction.

mod atomic;
mod colour;
mod failure;
mod image;
mod interrupt;
mod preview;
mod progress;
mod table;

fn main() {}
