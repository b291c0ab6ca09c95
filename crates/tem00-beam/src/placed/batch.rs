//! The laws at one point, and loops over many points that fill the vector units.
#![expect(unnameable_types, reason = "they belong to a sealed trait")]

use super::emitter::{aperture_point, direction, secant, towards_light};
use super::phase_space::PhaseSpace;
use super::record::{NextEvent, NextEventSlices};
use crate::real::Real;

/// The irradiance at a point; 0 where no light arrives.
///
/// Single calls and batches share it, and so agree to the last bit.
#[inline(always)]
pub(super) fn irradiance_at<T: Real>(light: &(impl PhaseSpace<T> + ?Sized), p: [T; 3]) -> T {
    let local = light.frame().local_from_world_point(p);
    light.flow_in_front(local).irradiance
}

/// The next event at a point; with all but the point 0 where no light arrives.
///
/// Single calls and batches share it, and so agree to the last bit.
#[inline(always)]
pub(super) fn event_at<T: Real>(light: &(impl PhaseSpace<T> + ?Sized), p: [T; 3]) -> NextEvent<T> {
    let frame = light.frame();
    let local = frame.local_from_world_point(p);
    let flow = light.flow_in_front(local);
    let lit = flow.irradiance > T::ZERO;
    let length = secant(flow.slope);
    let [x, y, z] = towards_light(frame.world_from_local_vector(direction(flow.slope)));
    NextEvent {
        point: frame.world_from_aperture(aperture_point(local, flow.slope)),
        distance: (local[2] * length).only_if(lit),
        wi: [x.only_if(lit), y.only_if(lit), z.only_if(lit)],
        e_perp: (flow.irradiance * length).only_if(lit),
    }
}

/// A query at many points `(x[i], y[i], z[i])`, with slices of equal length.
#[derive(Debug)]
pub enum Batch<'a, T> {
    Irradiance([&'a [T]; 3], &'a mut [T]),
    NextEvents([&'a [T]; 3], NextEventSlices<'a, T>),
}

impl<T: Real> Batch<'_, T> {
    /// Answers the query for one light.
    ///
    /// The loops are inlined into whatever [`vectorised`] compiles for the processor at hand.
    #[inline(always)]
    pub(super) fn over(self, light: &(impl PhaseSpace<T> + ?Sized)) {
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

/// Runs a loop with the widest vector instructions of the processor.
///
/// No step of it is contracted or reordered, so its bits do not depend on their width.
#[cfg(feature = "simd")]
#[inline(always)]
pub(super) fn vectorised(body: impl FnOnce()) {
    fearless_simd::dispatch!(fearless_simd::Level::new(), _ => body());
}

/// Runs a loop with the vector instructions that every processor of the target has.
#[cfg(not(feature = "simd"))]
#[inline(always)]
pub(super) fn vectorised(body: impl FnOnce()) {
    body();
}

/// Panics unless all slices of a batch are of equal length.
pub(super) fn check_lengths<T, const N: usize>(points: [&[T]; 3], out: [usize; N]) {
    let [x, y, z] = points.map(<[T]>::len);
    assert!(
        [y, z].iter().chain(&out).all(|&len| len == x),
        "x, y, z and out must be of equal length, got {x}, {y}, {z} and {out:?}",
    );
}
