#![doc = include_str!("../README.md")]
//!
//! # Conventions
//!
//! - Lengths, angles, powers, radiances, durations and amounts of memory are numbers in SI units,
//!   or strings with a unit, such as `"0.25 mm"`: see [`Dimension`].
//! - A file that another includes lies below its folder, unless [`FileAccess::Anywhere`] is given.
//! - An unknown key is an error, which names the nearest known one.
//! - Text of a file is escaped before it is shown, so that it cannot control a terminal: see
//!   [`printable`].
//!
//! # Main types
//!
//! [`read_document`] opens a file of a [`Format`] as a [`Document`] of [`Section`]s, whose
//! [`Value`]s are read one by one; [`read_laser_light`] and [`read_relief`] read keys that scenes
//! and set-ups have in common. An error is a [`Problem`], which becomes a [`ConfigError`] once its
//! file is known.
//!
//! # Scope and non-goals
//!
//! There is no derived deserialisation: it loses the location of a value inside tagged tables. The
//! crate only reads files.

mod change;
mod coherence;
mod document;
mod error;
mod folder;
mod format;
mod input_file;
mod printable;
mod quantity;
mod reader;
mod section;
mod source;
mod sources;
mod value;

pub use change::{Change, Reading};
pub use coherence::{Wavelengths, read_laser_light, read_relief};
pub use document::Document;
pub use error::{ConfigError, Problem};
pub use folder::Folder;
pub use format::{DocumentKind, Format, kind_of_document};
pub use input_file::{
    FileAccess, MAX_ASSET_BYTES, MAX_TEXT_BYTES, is_standard_input, open_input, read_input,
    without_byte_order_mark,
};
pub use printable::{is_hazard, printable, printable_line};
pub use quantity::{
    ANGLE, DIMENSIONS, DURATION, Dimension, LENGTH, MEMORY, NUMBER, POWER, RADIANCE,
};
pub use reader::{parse_document, read_document};
pub use section::{Choice, Section, UNCERTAIN, rejected};
pub use value::{Value, nearest};
