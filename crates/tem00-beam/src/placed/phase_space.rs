//! What tells one light from another. The module is private, which seals the trait `Emitter`.
#![expect(unnameable_types, reason = "the trait is sealed")]

use super::batch::{Batch, vectorised};
use super::frame::Frame;
use super::record::RayPdf;
use crate::real::Real;

/// The laws of a light in its own frame: +z travel, z = 0 the aperture plane.
pub trait PhaseSpace<T: Real> {
    fn frame(&self) -> Frame<T>;
    fn power(&self) -> T;

    /// Returns the energy flow, with an irradiance of 0 outside the cut-off.
    ///
    /// One path for all points, so that a loop over points fills the vector units.
    fn flow(&self, local: [T; 3]) -> Flow<T>;

    /// Draws a slope from the conditional density at a point.
    fn sample_slope(&self, local: [T; 3], u: [T; 2]) -> SlopeSample<T>;

    /// Returns the density of [`sample_slope`](Self::sample_slope), per steradian.
    fn slope_pdf(&self, local: [T; 3], slope: [T; 2]) -> T;

    /// Draws a point of the aperture plane and a slope.
    fn draw(&self, u: [T; 4]) -> ([T; 2], [T; 2]);

    /// Returns the densities of [`draw`](Self::draw).
    fn densities(&self, position: [T; 2], slope: [T; 2]) -> RayPdf<T>;

    /// Returns how far the light reaches up to the distance `l`.
    fn reach(&self, l: T) -> Reach<T>;

    /// Answers a query at many points.
    fn run(&self, batch: Batch<'_, T>) {
        vectorised(
            #[inline(always)]
            || batch.over(self),
        );
    }

    /// Returns the energy flow, with an irradiance of 0 where the point is behind the aperture too.
    #[inline(always)]
    fn flow_in_front(&self, local: [T; 3]) -> Flow<T> {
        let flow = self.flow(local);
        Flow {
            irradiance: flow.irradiance.only_if(local[2] >= T::ZERO),
            ..flow
        }
    }

    /// Returns the energy flow, unless the point is not lit.
    fn lit_flow(&self, local: [T; 3]) -> Option<Flow<T>> {
        Some(self.flow_in_front(local)).filter(|flow| flow.irradiance > T::ZERO)
    }
}

/// The energy flow `irradiance · (slope, 1)`.
#[derive(Clone, Copy, Debug)]
pub struct Flow<T> {
    pub(crate) irradiance: T,
    pub(crate) slope: [T; 2],
}

/// A slope, its density per steradian, and the radiance divided by that density.
#[derive(Clone, Copy, Debug)]
pub struct SlopeSample<T> {
    pub(crate) slope: [T; 2],
    pub(crate) pdf: T,
    pub(crate) value: T,
}

/// The largest half-widths along x and y, and the largest slope.
#[derive(Clone, Copy, Debug)]
pub struct Reach<T> {
    pub(crate) half_width: [T; 2],
    pub(crate) slope: T,
}
