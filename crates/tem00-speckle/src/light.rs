//! Light that is more than one wave, and what a sensor makes of it.

mod background;

pub use background::CoherentBackground;
