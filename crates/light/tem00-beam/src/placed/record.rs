//! Results of the queries of a placed light.

use super::slope::only_if;

/// The light that arrives at a point, as one direction and one irradiance.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextEvent {
    /// Point of the aperture plane from which the light appears to come.
    pub point: [f64; 3],
    /// Distance to `point`, in metres.
    pub distance: f64,
    /// Unit vector towards the light, against the mean energy flow.
    pub wi: [f64; 3],
    /// Irradiance of a surface perpendicular to `wi`, in W/m².
    pub e_perp: f64,
}

/// Output slices for the next events at many points: one slice for each number.
///
/// The point of the aperture plane is left out: it is `p + distance · wi`.
#[derive(Debug)]
pub struct NextEventSlices<'a> {
    /// Coordinates x, y, z of the unit vectors towards the light.
    pub wi: [&'a mut [f64]; 3],
    /// Distances to the aperture plane along `wi`, in metres.
    pub distance: &'a mut [f64],
    /// Irradiances of a surface perpendicular to `wi`, in W/m²; 0 where no light arrives.
    pub e_perp: &'a mut [f64],
}

/// The light that arrives at a point, as a random direction and its density.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledEvent {
    /// Point of the aperture plane that the ray comes from.
    pub point: [f64; 3],
    /// Distance to `point`, in metres.
    pub distance: f64,
    /// Unit vector towards the light.
    pub wi: [f64; 3],
    /// Radiance divided by `pdf`, in W/m².
    pub value: f64,
    /// Probability density of `wi`, per steradian.
    pub pdf: f64,
}

impl SampledEvent {
    pub(super) const DARK: Self = Self {
        point: [0.0; 3],
        distance: 0.0,
        wi: [0.0; 3],
        value: 0.0,
        pdf: 0.0,
    };
}

/// The light that a ray meets on its way to the aperture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApertureHit {
    /// Point of the aperture plane.
    pub point: [f64; 3],
    /// Distance to `point`, in metres.
    pub distance: f64,
    /// Radiance that arrives along the ray, in W/(m² sr).
    pub radiance: f64,
    /// Probability density with which a sampled next event has this direction, per steradian.
    pub pdf: f64,
}

/// A ray that leaves the aperture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySample {
    /// Point of the aperture plane.
    pub origin: [f64; 3],
    /// Power of the light, in watts. Divided by the number of rays, it is the power that the ray
    /// carries.
    pub flux: f64,
    /// Unit vector along the ray.
    pub direction: [f64; 3],
    /// Cosine of the angle between the ray and the axis.
    pub cos: f64,
    /// Probability densities of the ray.
    pub pdf: RayPdf,
}

/// The probability densities of a ray, whose joint density factors in two ways:
///
/// ```text
/// position · direction_given_position = direction · position_given_direction
/// ```
///
/// Positions lie on the aperture plane. Bidirectional methods need the left side, whose factors
/// belong to the first and the second vertex of a path; rays are drawn from the right side.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayPdf {
    /// Marginal density of the position over all directions, per m² of the aperture plane.
    pub position: f64,
    /// Density of the direction at this position, per steradian.
    pub direction_given_position: f64,
    /// Marginal density of the direction over all starting points, per steradian.
    pub direction: f64,
    /// Density of the position among the rays of this direction, per m² of the aperture plane.
    pub position_given_direction: f64,
}

impl RayPdf {
    /// Returns the factorisation that begins with the position. The second factor is 0 where the
    /// first one is: far from the light, where the closed forms overflow.
    pub(super) fn from_position(position: f64, direction: impl FnOnce() -> f64) -> Self {
        let met = position > 0.0;
        Self {
            position: only_if(met, position),
            direction_given_position: if met { direction() } else { 0.0 },
            direction: 0.0,
            position_given_direction: 0.0,
        }
    }
}

/// Bounds of the light in space and direction, as a light hierarchy stores them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest corner of an axis-aligned box around the lit volume.
    pub min: [f64; 3],
    /// Largest corner of the box.
    pub max: [f64; 3],
    /// Unit vector along the axis.
    pub axis: [f64; 3],
    /// Half-angle, in radians, of the cone about `axis` that the light travels in.
    pub half_angle: f64,
}
