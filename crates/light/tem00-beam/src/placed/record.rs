//! Results of the queries of a placed light.

use crate::real::Real;

/// The light that arrives at a point, as one direction and one irradiance.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextEvent<T> {
    /// Point of the aperture plane that the light seems to come from.
    pub point: [T; 3],
    /// Distance to `point`, in metres.
    pub distance: T,
    /// Unit vector towards the light, against the mean energy flow.
    pub wi: [T; 3],
    /// Irradiance of a surface square to `wi`, in W/m².
    pub e_perp: T,
}

/// Output slices for the next events at many points: one for each number.
///
/// The point of the aperture plane is left out: it is `p + distance · wi`.
#[derive(Debug)]
pub struct NextEventSlices<'a, T> {
    /// Coordinates x, y, z of the unit vectors towards the light.
    pub wi: [&'a mut [T]; 3],
    /// Distances to the aperture plane along `wi`, in metres.
    pub distance: &'a mut [T],
    /// Irradiances of a surface square to `wi`, in W/m²; 0 where no light arrives.
    pub e_perp: &'a mut [T],
}

/// The light that arrives at a point, as a random direction and its density.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledEvent<T> {
    /// Point of the aperture plane that the ray comes from.
    pub point: [T; 3],
    /// Distance to `point`, in metres.
    pub distance: T,
    /// Unit vector towards the light.
    pub wi: [T; 3],
    /// Radiance divided by `pdf`, in W/m².
    pub value: T,
    /// Probability density of `wi`, per steradian.
    pub pdf: T,
}

impl<T: Real> SampledEvent<T> {
    pub(super) const DARK: Self = Self {
        point: [T::ZERO; 3],
        distance: T::ZERO,
        wi: [T::ZERO; 3],
        value: T::ZERO,
        pdf: T::ZERO,
    };
}

/// The light that a ray meets on its way to the aperture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ApertureHit<T> {
    /// Point of the aperture plane.
    pub point: [T; 3],
    /// Distance to `point`, in metres.
    pub distance: T,
    /// Radiance that arrives along the ray, in W/(m² sr).
    pub radiance: T,
    /// Probability density with which a sampled next event has this direction, per steradian.
    pub pdf: T,
}

/// A ray that leaves the aperture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RaySample<T> {
    /// Point of the aperture plane.
    pub origin: [T; 3],
    /// Power the ray stands for, in watts: that of the light, to be divided by the number of rays.
    pub flux: T,
    /// Unit vector along the ray.
    pub direction: [T; 3],
    /// Cosine of the angle between the ray and the axis.
    pub cos: T,
    /// Probability densities of the ray.
    pub pdf: RayPdf<T>,
}

/// The probability densities of a ray, whose joint density factors in two ways:
///
/// ```text
/// position · direction_given_position = direction · position_given_direction
/// ```
///
/// Positions are those on the aperture plane. Bidirectional methods want the left side, whose factors
/// are those of the first and of the second vertex of a path; the right side is what a ray is drawn
/// from.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayPdf<T> {
    /// Density of the position, whatever the direction, per m² of the aperture plane.
    pub position: T,
    /// Density of the direction at this position, per steradian.
    pub direction_given_position: T,
    /// Density of the direction, wherever the ray starts, per steradian.
    pub direction: T,
    /// Density of the position among the rays of this direction, per m² of the aperture plane.
    pub position_given_direction: T,
}

impl<T: Real> RayPdf<T> {
    /// Returns the factors that begin with the position, the second of them 0 where the first is: far
    /// from the light, where the closed forms meet infinities.
    pub(super) fn from_position(position: T, direction: impl FnOnce() -> T) -> Self {
        let met = position > T::ZERO;
        Self {
            position: position.only_if(met),
            direction_given_position: if met { direction() } else { T::ZERO },
            direction: T::ZERO,
            position_given_direction: T::ZERO,
        }
    }
}

/// Bounds of the light in space and direction, as a light hierarchy stores them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<T> {
    /// Smallest corner of an axis-aligned box around the lit volume.
    pub min: [T; 3],
    /// Largest corner of the box.
    pub max: [T; 3],
    /// Unit vector along the axis.
    pub axis: [T; 3],
    /// Half-angle, in radians, of the cone about `axis` that the light travels in.
    pub half_angle: T,
}
