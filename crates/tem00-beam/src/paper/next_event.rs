use core::f64::consts::FRAC_2_PI;

use glam::DVec3;

use crate::GaussianBeam;
use crate::placed::phase_space::PhaseSpace;
use crate::placed::{LineLight, SpotLight};

/// The printed next-event estimation: a point of the aperture and a radiance from there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrintedEvent {
    /// Point `s` of the aperture, by the ratio of beam radii.
    pub point: [f64; 3],
    /// Distance to `point`, in metres.
    pub distance: f64,
    /// Unit vector towards `point`.
    pub wi: [f64; 3],
    /// `E / cos θ_s`, in W/m²: the coefficient of a delta distribution over directions.
    pub radiance: f64,
}

/// Returns the radiance of eq. (3), `L = E / cos θ_s`, in the unit of `irradiance`; `None` unless
/// the cosine is positive.
///
/// E is the irradiance of a plane across the beam, eq. (2), and `θ_s` the angle between the normal of
/// the surface and the light.
///
/// # Validity
///
/// L has the unit W/m², not W/(m² sr): it stands before a delta distribution over directions. The
/// division makes a surface as bright as if it faced the beam whatever its tilt, so that it
/// receives `P / cos θ_s`: 1.15, 2.00 and 3.86 times the power at 30°, 60° and 75°, without bound at
/// grazing incidence. [`Emitter::next_event`](crate::Emitter::next_event) does not divide.
///
/// # Examples
///
/// ```
/// use tem00_beam::paper;
///
/// let tilted = paper::radiance(100.0, 60f64.to_radians().cos());
/// assert!(tilted.is_some_and(|radiance| (radiance - 200.0).abs() < 1e-9));
/// assert_eq!(paper::radiance(100.0, -0.1), None);
/// ```
pub fn radiance(irradiance: f64, cos_surface: f64) -> Option<f64> {
    (cos_surface > 0.0).then(|| irradiance / cos_surface)
}

/// Returns the point of the aperture that belongs to `receiver`, by the ratio of beam radii
/// (section 4, step 3); both in the frame of the beam with the waist at z = 0.
///
/// ```text
/// (x w_A / w_R, y w_A / w_R, z_A)
/// ```
///
/// # Validity
///
/// It follows the streamline of energy, a hyperbola, exactly. The straight line between the two
/// points is not the direction of the flow: with a waist between them, or at the receiver, it is off
/// by up to the whole divergence. That matters to shadows, and hardly to reflection.
pub fn streamline_point(beam: &GaussianBeam, receiver: DVec3, aperture_z: f64) -> DVec3 {
    let ratio = beam.radius_at(aperture_z) / beam.radius_at(receiver.z);
    DVec3::new(receiver.x * ratio, receiver.y * ratio, aperture_z)
}

/// Returns the printed next-event estimation of a laser spot at `p`, a point of a surface with the
/// unit normal `n`; `None` outside the cut-off, behind the aperture, or on the unlit side.
///
/// See [`radiance`] and [`streamline_point`] for what is wrong with it.
pub fn spot_next_event(light: &SpotLight<f64>, p: [f64; 3], n: [f64; 3]) -> Option<PrintedEvent> {
    let [x, y, z] = light.frame().local_from_world_point(p);
    if z < 0.0 {
        return None;
    }
    let flow = light.flow([x, y, z])?;
    let ratio = |axis: &crate::Axis<f64>| (axis.radius_sq_at(0.0) / axis.radius_sq_at(z)).sqrt();
    let aperture = [x * ratio(&light.x), y * ratio(&light.y)];
    printed_event(light, aperture, p, n, flow.irradiance)
}

/// Returns the printed next-event estimation of a laser line at `p`, a point of a surface with the
/// unit normal `n`; `None` outside the cut-off, at or behind the lens, or on the unlit side.
///
/// The fan is that of [`PrintedFan`](super::PrintedFan), which knows only the Gaussian profile, and
/// the scaled x′ is the coordinate that the ratio of beam radii is applied to: the unscaled one
/// would end outside the aperture. See [`radiance`] for what else is wrong with it.
pub fn line_next_event(light: &LineLight<f64>, p: [f64; 3], n: [f64; 3]) -> Option<PrintedEvent> {
    let [x, y, z] = light.frame().local_from_world_point(p);
    if z <= 0.0 {
        return None;
    }
    let w_sq = light.y.radius_sq_at(z + light.apex_offset);
    let x = x * w_sq.sqrt() / (light.half_slope() * z);
    let rho_sq = (x * x + y * y) / w_sq;
    if rho_sq > light.cutoff * light.cutoff {
        return None;
    }
    let irradiance = FRAC_2_PI * light.power / w_sq * (-2.0 * rho_sq).exp();
    let ratio = (light.y.radius_sq_at(light.apex_offset) / w_sq).sqrt();
    printed_event(light, [x * ratio, y * ratio], p, n, irradiance)
}

fn printed_event(
    light: &impl PhaseSpace<f64>,
    aperture: [f64; 2],
    p: [f64; 3],
    n: [f64; 3],
    irradiance: f64,
) -> Option<PrintedEvent> {
    let point = light.frame().world_from_aperture(aperture);
    let towards = DVec3::from(point) - DVec3::from(p);
    let wi = towards.try_normalize()?;
    Some(PrintedEvent {
        point,
        distance: towards.length(),
        wi: wi.to_array(),
        radiance: radiance(irradiance, wi.dot(DVec3::from(n)))?,
    })
}
