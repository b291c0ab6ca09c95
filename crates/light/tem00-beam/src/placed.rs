//! The renderer face: placed lights as plain structs.

mod axis;
mod emitter;
mod fan;
mod frame;
mod line;
mod phase_space;
mod power_bound;
mod record;
mod rows;
mod slope;
mod spot;
mod tabulated;

pub use axis::Axis;
pub use emitter::Emitter;
pub use frame::Placement;
pub use line::LineLight;
pub use record::{
    ApertureHit, Bounds, NextEvent, NextEventSlices, RayPdf, RaySample, SampledEvent,
};
pub(crate) use slope::secant;
pub use spot::SpotLight;
pub use tabulated::TabulatedLineLight;

#[cfg(test)]
mod tests;
