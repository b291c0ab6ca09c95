use tem00_beam::{
    AngularProfile, AstigmaticBeam, DVec3, FanGeometry, GaussianBeam, LaserLine, LineLight,
    LocatedBeam, SpotLight, TabulatedLineLight,
};
use tem00_shading::BeamShape;

use super::Light;
use crate::{
    numbers::code,
    pointers::{borrow, columns},
    status::{Failure, Status},
};

/// Position and directions of a light, in world coordinates.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Centre of the aperture (the lens of a laser line), in metres.
    pub origin: [f64; 3],
    /// Direction of travel, of any length.
    pub direction: [f64; 3],
    /// Any vector that is not parallel to `direction`. Its part at right angles to `direction` is
    /// the x axis of the light, along which a fan opens.
    pub fan_axis: [f64; 3],
}

/// A round Gaussian beam.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SpotDescription {
    /// Position and directions of the light.
    pub placement: Placement,
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
    /// Power, in watts.
    pub power: f64,
    /// Waist radius to 1/e² of the irradiance, in metres.
    pub waist_radius: f64,
    /// Signed distance from the aperture to the waist, in metres.
    pub waist_distance: f64,
    /// Beam quality factor M², at least 1, which is that of an ideal beam.
    pub m_squared: f64,
}

/// An elliptic Gaussian beam with two principal axes, as of a laser diode. Its arrays hold the
/// value of the first axis, then that of the second; a refusal names one as "`waist_radius[1]`".
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct EllipticDescription {
    /// Position and directions of the light.
    pub placement: Placement,
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
    /// Power, in watts.
    pub power: f64,
    /// Waist radii to 1/e² of the irradiance, in metres.
    pub waist_radius: [f64; 2],
    /// Signed distances from the aperture to the waists, in metres.
    pub waist_distance: [f64; 2],
    /// Beam quality factors M², at least 1.
    pub m_squared: [f64; 2],
    /// Angle from the x axis of the light to the first axis of the beam, towards y, in radians.
    pub rotation: f64,
}

/// Surface on which a laser line is thinnest off its axis.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FocusCurve {
    /// On the circle about the virtual apex of the fan.
    EqualDistance = 0,
    /// On the plane square to the axis.
    EqualPlane = 1,
}

/// Distribution of the power of a laser line along the fan.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineProfile {
    /// Gaussian in the tangent of the fan angle, and so along the line on a flat screen.
    GaussianTan = 0,
    /// Gaussian in the fan angle.
    GaussianAngle = 1,
    /// Gaussian in the sine of the fan angle.
    GaussianSin = 2,
    /// Uniform in the tangent of the fan angle between the edges of the fan.
    UniformTan = 3,
    /// Uniform in the fan angle between the edges of the fan.
    UniformAngle = 4,
    /// Uniform in the tangent of the fan angle with a Gaussian roll-off, as behind a Powell lens.
    Powell = 5,
    /// A table of the power per angle.
    Tabulated = 6,
}

/// A laser line behind a cylinder lens or a Powell lens.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct LineDescription {
    /// Position and directions of the light; the fan opens along its fan axis.
    pub placement: Placement,
    /// Wavelength in the medium, in metres.
    pub wavelength: f64,
    /// Power, in watts.
    pub power: f64,
    /// Half-thickness of the line where it is thinnest, to 1/e² of the irradiance, in metres.
    pub waist_radius: f64,
    /// Beam quality factor M² across the fan, at least 1.
    pub m_squared: f64,
    /// Full fan angle between the edges of the line, in radians.
    pub fan_angle: f64,
    /// Distance of the virtual apex of the fan behind the lens, in metres.
    pub apex_offset: f64,
    /// Signed distance from the lens to where the line is thinnest on the axis, in metres.
    pub focus_distance: f64,
    /// Surface on which the line is thinnest off the axis: a `tem00_focus_curve`.
    pub focus_curve: u32,
    /// The profile along the line: a `tem00_line_profile`.
    pub profile: u32,
    /// Standard deviation of the roll-off relative to the half-length of the line, from 1e-6 to 1;
    /// read for the Powell profile alone.
    pub edge: f64,
    /// Ascending angles from the axis, in radians; read for the tabulated profile alone, as are the
    /// next two. The light keeps a copy.
    pub angles: *const f64,
    /// Power per angle at each of the angles, in any unit.
    pub powers: *const f64,
    /// Number of angles and powers, at least 2.
    pub knot_count: usize,
}

impl Placement {
    fn placed(&self) -> tem00_beam::Placement {
        tem00_beam::Placement {
            origin: DVec3::from_array(self.origin),
            direction: DVec3::from_array(self.direction),
            fan_axis: DVec3::from_array(self.fan_axis),
        }
    }
}

impl SpotDescription {
    fn light(&self) -> Result<Light, Failure> {
        let beam = GaussianBeam::from_waist(self.wavelength, self.waist_radius)?;
        let beam = beam.with_m_squared(self.m_squared)?;
        let placement = self.placement.placed();
        let light = SpotLight::place(&beam, self.waist_distance, &placement, self.power)?;
        let shape = BeamShape::Spot {
            waist_radius: [self.waist_radius; 2],
            waist_distance: [self.waist_distance; 2],
            m_squared: [self.m_squared; 2],
        };
        Ok(Light::spot(light, shape))
    }
}

impl EllipticDescription {
    fn light(&self) -> Result<Light, Failure> {
        let beam = AstigmaticBeam::new(self.axis(0)?, self.axis(1)?)?;
        let beam = beam.with_rotation(self.rotation)?;
        let light = SpotLight::place_astigmatic(&beam, &self.placement.placed(), self.power)?;
        let shape = BeamShape::Spot {
            waist_radius: self.waist_radius,
            waist_distance: self.waist_distance,
            m_squared: self.m_squared,
        };
        Ok(Light::spot(light, shape))
    }

    /// Returns the beam along one axis; a refusal names the axis.
    fn axis(&self, i: usize) -> Result<LocatedBeam, Failure> {
        let beam = GaussianBeam::from_waist(self.wavelength, self.waist_radius[i]);
        let beam = beam.and_then(|beam| beam.with_m_squared(self.m_squared[i]));
        let located = beam.and_then(|beam| LocatedBeam::new(beam, self.waist_distance[i]));
        located.map_err(|error| match error.parameter() {
            "wavelength" => error.into(),
            _ => Failure::argument(
                &format!("{}[{i}]", error.parameter()),
                format!("axis {i}: {error}"),
            ),
        })
    }
}

impl LineDescription {
    /// # Safety
    ///
    /// If the profile is tabulated, `angles` and `powers` are null or point to `knot_count`
    /// numbers.
    unsafe fn light(&self) -> Result<Light, Failure> {
        // SAFETY: by the contract of this function.
        let profile = unsafe { self.line_profile() }?;
        let beam = GaussianBeam::from_waist(self.wavelength, self.waist_radius)?;
        let beam = beam.with_m_squared(self.m_squared)?;
        let line = LaserLine::new(beam, self.fan()?, profile)?;
        let placement = self.placement.placed();
        let shape = BeamShape::Line {
            waist_radius: self.waist_radius,
            m_squared: self.m_squared,
            fan: *line.fan(),
            profile: line.profile().clone(),
        };
        if let tem00_beam::LineProfile::Tabulated(_) = line.profile() {
            let light = TabulatedLineLight::place(&line, &placement, self.power)?;
            return Ok(Light::tabulated(light, shape));
        }
        let light = LineLight::place(&line, &placement, self.power)?;
        Ok(Light::line(light, shape))
    }

    fn fan(&self) -> Result<FanGeometry, Failure> {
        use tem00_beam::FocusCurve::{EqualDistance, EqualPlane};
        Ok(FanGeometry {
            fan_angle: self.fan_angle,
            apex_offset: self.apex_offset,
            focus_distance: self.focus_distance,
            focus_curve: code(
                "focus_curve",
                self.focus_curve,
                &[EqualDistance, EqualPlane],
            )?,
        })
    }

    /// # Safety
    ///
    /// As [`light`](Self::light).
    unsafe fn line_profile(&self) -> Result<tem00_beam::LineProfile, Failure> {
        use tem00_beam::LineProfile as P;
        const PROFILES: [LineProfile; 7] = [
            LineProfile::GaussianTan,
            LineProfile::GaussianAngle,
            LineProfile::GaussianSin,
            LineProfile::UniformTan,
            LineProfile::UniformAngle,
            LineProfile::Powell,
            LineProfile::Tabulated,
        ];
        Ok(match code("profile", self.profile, &PROFILES)? {
            LineProfile::GaussianTan => P::GaussianTan,
            LineProfile::GaussianAngle => P::GaussianAngle,
            LineProfile::GaussianSin => P::GaussianSin,
            LineProfile::UniformTan => P::UniformTan,
            LineProfile::UniformAngle => P::UniformAngle,
            LineProfile::Powell => P::Powell { edge: self.edge },
            LineProfile::Tabulated => {
                let pointers = [("angles", self.angles), ("powers", self.powers)];
                // SAFETY: by the contract of this function.
                let ([angles, powers], []) = unsafe { columns(self.knot_count, pointers, []) }?;
                P::Tabulated(AngularProfile::new(angles, powers)?)
            }
        })
    }
}

/// Creates a round Gaussian beam.
///
/// On failure `*light` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_create_spot(
    description: *const SpotDescription,
    light: *mut *mut Light,
) -> Status {
    create!(description: borrow => light: description.light())
}

/// Creates an elliptic Gaussian beam.
///
/// On failure `*light` is null.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_create_elliptic(
    description: *const EllipticDescription,
    light: *mut *mut Light,
) -> Status {
    create!(description: borrow => light: description.light())
}

/// Creates a laser line.
///
/// On failure `*light` is null.
///
/// # Safety
///
/// The pointers are null or valid, those of a table for `knot_count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_create_line(
    description: *const LineDescription,
    light: *mut *mut Light,
) -> Status {
    create!(description: borrow => light: description.light())
}
