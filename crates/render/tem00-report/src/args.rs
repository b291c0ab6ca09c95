//! The options and values that several commands share.

mod files;
mod range;
mod shell;
mod values;

pub use self::{
    files::FileArgs,
    range::IndexRange,
    shell::{CompletionsArgs, ManArgs},
    values::{black_level, crop, length, positive},
};
