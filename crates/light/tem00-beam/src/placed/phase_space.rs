//! Laws by which the lights differ. The module is private, which seals the trait `Emitter`.
#![expect(unnameable_types, reason = "the trait is sealed")]

use tem00_numerics::vectorised;

use super::frame::Frame;
use super::power_bound::LocalBox;
use super::record::{NextEvent, NextEventSlices, RayPdf};
use super::slope::{aperture_point, direction, only_if, secant, towards_light};

/// The laws of a light in its own frame: +z travel, z = 0 the aperture plane.
pub trait PhaseSpace {
    fn frame(&self) -> Frame;

    /// Returns the energy flow, with an irradiance of 0 outside the cut-off.
    ///
    /// All points take the same code path, so that a loop over points fills the vector units.
    fn flow(&self, local: [f64; 3]) -> Flow;

    /// Draws a slope from the conditional density at a point.
    fn sample_slope(&self, local: [f64; 3], u: [f64; 2]) -> SlopeSample;

    /// Returns the density of [`sample_slope`](Self::sample_slope), per steradian.
    fn slope_pdf(&self, local: [f64; 3], slope: [f64; 2]) -> f64;

    /// Draws a point of the aperture plane and a slope.
    fn draw(&self, u: [f64; 4]) -> ([f64; 2], [f64; 2]);

    /// Returns the densities of [`draw`](Self::draw).
    fn densities(&self, position: [f64; 2], slope: [f64; 2]) -> RayPdf;

    /// Returns how far the light reaches up to the distance `l`.
    fn reach(&self, l: f64) -> Reach;

    /// Returns a bound of the fraction of the power, within the cut-off, that reaches a box.
    fn fraction_bound(&self, target: &LocalBox) -> f64;

    /// Answers a query at many points.
    fn run(&self, batch: Batch<'_>) {
        vectorised(
            #[inline(always)]
            || batch.over(self),
        );
    }

    /// Returns the energy flow, with an irradiance of 0 outside the cut-off and behind the
    /// aperture.
    #[inline(always)]
    fn flow_in_front(&self, local: [f64; 3]) -> Flow {
        let flow = self.flow(local);
        Flow {
            irradiance: only_if(local[2] >= 0.0, flow.irradiance),
            ..flow
        }
    }

    /// Returns the energy flow, or `None` if the point is not lit.
    fn lit_flow(&self, local: [f64; 3]) -> Option<Flow> {
        Some(self.flow_in_front(local)).filter(|flow| flow.irradiance > 0.0)
    }
}

/// The energy flow `irradiance · (slope, 1)`.
#[derive(Clone, Copy, Debug)]
pub struct Flow {
    pub(crate) irradiance: f64,
    pub(crate) slope: [f64; 2],
}

/// A slope, its density per steradian, and the radiance divided by that density.
#[derive(Clone, Copy, Debug)]
pub struct SlopeSample {
    pub(crate) slope: [f64; 2],
    pub(crate) pdf: f64,
    pub(crate) value: f64,
}

/// The largest half-widths along x and y, and the largest slope.
#[derive(Clone, Copy, Debug)]
pub struct Reach {
    pub(crate) half_width: [f64; 2],
    pub(crate) slope: f64,
}

/// The irradiance at a point; 0 where no light arrives.
///
/// Single calls and batches share it, and so agree to the last bit.
#[inline(always)]
pub(super) fn irradiance_at(light: &(impl PhaseSpace + ?Sized), p: [f64; 3]) -> f64 {
    let local = light.frame().local_from_world_point(p);
    light.flow_in_front(local).irradiance
}

/// The next event at a point. Where no light arrives, all its fields other than the point are 0.
///
/// Single calls and batches share it, and so agree to the last bit.
#[inline(always)]
pub(super) fn event_at(light: &(impl PhaseSpace + ?Sized), p: [f64; 3]) -> NextEvent {
    let frame = light.frame();
    let local = frame.local_from_world_point(p);
    let flow = light.flow_in_front(local);
    let lit = flow.irradiance > 0.0;
    let length = secant(flow.slope);
    let [x, y, z] = towards_light(frame.world_from_local_vector(direction(flow.slope)));
    NextEvent {
        point: frame.world_from_aperture(aperture_point(local, flow.slope)),
        distance: only_if(lit, local[2] * length),
        wi: [x, y, z].map(|component| only_if(lit, component)),
        e_perp: only_if(lit, flow.irradiance * length),
    }
}

/// A query at many points `(x[i], y[i], z[i])`, with slices of equal length.
#[derive(Debug)]
pub enum Batch<'a> {
    Irradiance([&'a [f64]; 3], &'a mut [f64]),
    NextEvents([&'a [f64]; 3], NextEventSlices<'a>),
}

impl Batch<'_> {
    /// Answers the query for one light.
    ///
    /// The loops are inlined into the function that [`vectorised`] compiles for the processor in
    /// use.
    #[inline(always)]
    pub(super) fn over(self, light: &(impl PhaseSpace + ?Sized)) {
        match self {
            Self::Irradiance([x, y, z], out) => {
                for (((&x, &y), &z), out) in x.iter().zip(y).zip(z).zip(out) {
                    *out = irradiance_at(light, [x, y, z]);
                }
            }
            Self::NextEvents([x, y, z], out) => {
                let [wi_x, wi_y, wi_z] = out.wi;
                let points = x.iter().zip(y).zip(z);
                let towards = wi_x.iter_mut().zip(wi_y).zip(wi_z);
                let scalars = out.distance.iter_mut().zip(out.e_perp);
                for ((((&x, &y), &z), wi), scalars) in points.zip(towards).zip(scalars) {
                    let event = event_at(light, [x, y, z]);
                    [*wi.0.0, *wi.0.1, *wi.1] = event.wi;
                    [*scalars.0, *scalars.1] = [event.distance, event.e_perp];
                }
            }
        }
    }
}
