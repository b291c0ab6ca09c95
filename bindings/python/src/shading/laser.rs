use pyo3::prelude::*;
use tem00_coherence::SourceExtent;
use tem00_shading::{self as physics, DVec3, LaserBuilder};

use super::vector;
use crate::{
    arguments::Take,
    arrays::{Array, Components, Numbers, Vectors},
    beam::{Light, LineProfile, Placed, named},
    coherence::Spectrum,
    error::{IntoPython, OrRaise, refused},
};

/// A wavelength, or a whole spectrum.
fn spectrum(wavelength: &Bound<'_, PyAny>) -> PyResult<tem00_coherence::Spectrum> {
    match wavelength.cast::<Spectrum>() {
        Ok(line) => Ok(line.get().0.clone()),
        Err(_) => tem00_coherence::Spectrum::monochromatic(f64::take(wavelength, "wavelength")?)
            .or_raise(),
    }
}

fn disc(source_half_angle: f64) -> PyResult<SourceExtent> {
    SourceExtent::disc(source_half_angle).or_raise()
}

class! {
    /// A laser in the scene: a spot or a line, placed, with its power and the spectrum of its
    /// light.
    ///
    /// Made by ``spot`` or ``line``.
    "tem00.shading" Laser(physics::Laser)
}

methods! {
    impl Laser as this: this.0;

    unmade "spot or line";

    /// Return a spot: a Gaussian beam, round or elliptic.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float or Spectrum
    ///     Vacuum wavelength, in metres, or the spectrum of the light.
    /// waist_radius : float or array_like, shape (2,)
    ///     Waist radius, in metres: of an elliptic spot that along ``line_direction`` and that
    ///     across it.
    /// origin : array_like, shape (3,)
    ///     Centre of the aperture, in metres.
    /// target : array_like, shape (3,)
    ///     A point on the axis, in metres.
    /// line_direction : array_like, shape (3,), optional
    ///     Across the axis: the first axis of an elliptic spot. Its part along the axis is ignored;
    ///     (1, 0, 0) if left out.
    /// power : float, optional
    ///     Power, in watts.
    /// focused_at : float, optional
    ///     Distance of the waist from the aperture, in metres, negative behind it; that of the
    ///     target if left out.
    /// m_squared : float, optional
    ///     Beam quality factor M².
    /// source_half_angle : float, optional
    ///     Half angle of the disc as which a surface sees the source, in radians; 0 for a point. It
    ///     acts on speckle only.
    #[staticmethod]
    #[pyo3(signature = (
        wavelength, waist_radius, *, origin, target, line_direction = None, power = 1e-3,
        focused_at = None, m_squared = 1.0, source_half_angle = 0.0,
    ))]
    build spot(_py;
        wavelength: Bound<'py, PyAny>, waist_radius: Numbers<'py>, origin: Components<'py>,
        target: Components<'py>, line_direction: Option<Components<'py>>, power: f64,
        focused_at: Option<f64>, m_squared: f64, source_half_angle: f64
    ) = {
        let radii = match waist_radius {
            Numbers::One(radius) => [radius; 2],
            radii => radii.vector("waist_radius")?,
        };
        let spectrum = spectrum(&wavelength)?;
        let builder = physics::Laser::spot(spectrum.wavelength(), radii[0]).waist_radii(radii);
        let builder = builder.power(power).m_squared(m_squared).spectrum(spectrum);
        let builder = builder.source_extent(disc(source_half_angle)?);
        Self::placed(builder, [origin, target], line_direction, focused_at, &[])
    };

    /// Return a laser line.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float or Spectrum
    ///     Vacuum wavelength, in metres, or the spectrum of the light.
    /// thickness : float
    ///     Thickness in focus (1/e², full width), in metres.
    /// fan_angle : float
    ///     Full angle between the ends of the line, in radians.
    /// origin : array_like, shape (3,)
    ///     Centre of the aperture, in metres.
    /// target : array_like, shape (3,)
    ///     A point on the axis, in metres.
    /// line_direction : array_like, shape (3,), optional
    ///     Across the axis: where the line opens. Its part along the axis is ignored; (1, 0, 0) if
    ///     left out.
    /// profile : LineProfile, optional
    ///     Distribution of the power along the line; Gaussian along the line on a plane if left
    ///     out.
    /// power : float, optional
    ///     Power, in watts.
    /// focused_at : float, optional
    ///     Distance along the axis at which the line is thinnest, in metres; that of the target if
    ///     left out.
    /// m_squared : float, optional
    ///     Beam quality factor M² across the line.
    /// source_half_angle : float, optional
    ///     Half angle of the disc as which a surface sees the source, in radians; 0 for a point. It
    ///     acts on speckle only.
    #[staticmethod]
    #[pyo3(signature = (
        wavelength, thickness, fan_angle, *, origin, target, line_direction = None, profile = None,
        power = 1e-3, focused_at = None, m_squared = 1.0, source_half_angle = 0.0,
    ))]
    build line(_py;
        wavelength: Bound<'py, PyAny>, thickness: f64, fan_angle: f64, origin: Components<'py>,
        target: Components<'py>, line_direction: Option<Components<'py>>,
        profile: Option<&LineProfile>, power: f64, focused_at: Option<f64>, m_squared: f64,
        source_half_angle: f64
    ) = {
        let spectrum = spectrum(&wavelength)?;
        let mut builder = physics::Laser::line(spectrum.wavelength(), thickness, fan_angle);
        builder = builder.power(power).m_squared(m_squared).spectrum(spectrum);
        builder = builder.source_extent(disc(source_half_angle)?);
        if let Some(profile) = profile {
            builder = builder.profile(profile.0.clone());
        }
        let names = [("waist_radius", "thickness"), ("apex_offset", "fan_angle")];
        Self::placed(
            builder,
            [origin, target],
            line_direction,
            focused_at,
            &names,
        )
    };

    /// Return the light at points as one direction each, that of the mean energy flow.
    ///
    /// Parameters
    /// ----------
    /// points : array_like, shape (..., 3)
    ///     Points, in metres.
    ///
    /// Returns
    /// -------
    /// NextEvent
    ///     All members are 0 where no light arrives, and no shadow ray is needed.
    call next_event(py; points: Vectors<'py>) -> Array<'py> = {
        let events = Placed::of(&this.0).events(py, columns!(1e30; points: 3))?;
        named(py, "NextEvent", events)
    };

    /// Wavelength in vacuum, in metres.
    get wavelength -> f64;

    /// Power, in watts.
    get power -> f64;

    /// The placed light, for all else there is to ask.
    get light -> Light = Placed::of(&this.0);

    shown wavelength, light;
}

impl Laser {
    fn placed(
        builder: LaserBuilder,
        [origin, target]: [Components<'_>; 2],
        line_direction: Option<Components<'_>>,
        focused_at: Option<f64>,
        names: &[(&str, &str)],
    ) -> PyResult<Self> {
        let builder = match focused_at {
            Some(distance) => builder.focused_at(distance),
            None => builder,
        };
        let laser = builder.placed(
            origin.vector("origin")?.into(),
            target.vector("target")?.into(),
            vector("line_direction", line_direction.as_ref(), DVec3::X.into())?.into(),
        );
        let own = |name: &str| match name {
            "waist_distance" | "focus_distance" => "focused_at",
            _ => names
                .iter()
                .find(|(from, _)| *from == name)
                .map_or("", |(_, to)| to),
        };
        laser
            .map(Self)
            .map_err(|error| match error.parameter().map(own) {
                None | Some("") => error.into_python(),
                Some(name) => refused(name, format!("{name}: {error}")),
            })
    }
}
