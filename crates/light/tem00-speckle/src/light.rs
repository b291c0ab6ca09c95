//! Light that is more than one wave, and what a sensor makes of it.

mod background;
mod exposure;
mod pixels;
mod sum;
mod transform;

pub use exposure::Exposure;
pub use pixels::PixelArray;
pub use sum::incoherent_fractions;
