//! Shared parts of the programs of tem00: reports as one value for a terminal, JSON and a page,
//! diagrams, image files, and the conduct of a process.

#![expect(
    missing_docs,
    clippy::missing_errors_doc,
    clippy::return_self_not_must_use,
    reason = "two programs of this workspace are all that calls it"
)]

pub mod args;
pub mod atomic;
pub mod colour;
pub mod digits;
mod excerpt;
pub mod failure;
pub mod folder_lock;
pub mod image;
pub mod interrupt;
pub mod kind;
pub mod npy;
pub mod output;
pub mod plot;
pub mod program;
pub mod progress;
pub mod report;
pub mod shell;
