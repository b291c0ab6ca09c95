use glam::DVec3;
use tem00_beam::{FanGeometry, FocusCurve, GaussianBeam, LineProfile};
use tem00_coherence::{SourceExtent, Spectrum};
use tem00_numerics::check;

use crate::{BeamShape, Laser, LaserDescription, ShadingError};

/// Builder of a laser. By default it has 1 mW, a focus at the target, and M² = 1.
#[derive(Clone, Debug, PartialEq)]
#[must_use]
pub struct LaserBuilder {
    wavelength: f64,
    spectrum: Option<Spectrum>,
    source_extent: SourceExtent,
    power: f64,
    waist_radius: [f64; 2],
    m_squared: f64,
    focus: Option<f64>,
    /// The opening angle and the profile of a line.
    line: Option<(f64, LineProfile)>,
}

impl Laser {
    /// Begins the description of a round spot: a Gaussian beam with a vacuum wavelength and a waist
    /// radius, both in metres.
    ///
    /// # Examples
    ///
    /// A spot that is 0.4 mm wide half a metre in front of the laser:
    ///
    /// ```
    /// use tem00_shading::{DVec3, Laser};
    ///
    /// let laser = Laser::spot(650e-9, 0.2e-3)
    ///     .focused_at(0.5)
    ///     .power(5e-3)
    ///     .placed(DVec3::new(0.0, 0.0, 0.5), DVec3::ZERO, DVec3::X)?;
    /// let event = laser.next_event(DVec3::ZERO).expect("the spot is lit");
    /// assert!((event.wi - DVec3::Z).length() < 1e-12);
    /// # Ok::<(), tem00_shading::ShadingError>(())
    /// ```
    pub fn spot(wavelength: f64, waist_radius: f64) -> LaserBuilder {
        LaserBuilder {
            wavelength,
            spectrum: None,
            source_extent: SourceExtent::default(),
            power: 1e-3,
            waist_radius: [waist_radius; 2],
            m_squared: 1.0,
            focus: None,
            line: None,
        }
    }

    /// Begins the description of a laser line with a vacuum wavelength and a thickness in focus
    /// (1/e², full width), both in metres, and a full fan angle, in radians.
    pub fn line(wavelength: f64, thickness: f64, fan_angle: f64) -> LaserBuilder {
        LaserBuilder {
            line: Some((fan_angle, LineProfile::GaussianTan)),
            ..Self::spot(wavelength, 0.5 * thickness)
        }
    }
}

impl LaserBuilder {
    /// Sets the power of the beam, in watts.
    pub const fn power(mut self, power: f64) -> Self {
        self.power = power;
        self
    }

    /// Sets the distance of the waist from the aperture, in metres; for a spot it may be negative,
    /// with the waist behind the aperture.
    pub const fn focused_at(mut self, distance: f64) -> Self {
        self.focus = Some(distance);
        self
    }

    /// Sets the beam quality factor M²; for a line, M² across the line.
    pub const fn m_squared(mut self, m_squared: f64) -> Self {
        self.m_squared = m_squared;
        self
    }

    /// Makes a spot elliptic, with a waist radius along the line direction and one across it, in
    /// metres.
    ///
    /// A line uses only the second radius.
    pub const fn waist_radii(mut self, radii: [f64; 2]) -> Self {
        self.waist_radius = radii;
        self
    }

    /// Sets the distribution of the power along a line: Powell, tabulated or another. Spots have
    /// none.
    pub fn profile(mut self, profile: LineProfile) -> Self {
        if let Some((_, of_line)) = &mut self.line {
            *of_line = profile;
        }
        self
    }

    /// Sets the spectrum of the light, whose middle replaces the wavelength.
    pub fn spectrum(mut self, spectrum: Spectrum) -> Self {
        self.spectrum = Some(spectrum);
        self
    }

    /// Sets the directions from which the light of an extended source reaches a surface. They
    /// affect the speckle only.
    pub fn source_extent(mut self, extent: SourceExtent) -> Self {
        self.source_extent = extent;
        self
    }

    /// Places the laser at `origin`, aimed at `target`, with `line_direction` across the axis: the
    /// direction in which a line opens, and the first axis of an elliptic spot. Its component along
    /// the axis is ignored.
    ///
    /// # Errors
    ///
    /// Returns an error if the beam is invalid, if the target equals the origin, or if the line
    /// direction is parallel to the axis.
    pub fn placed(
        self,
        origin: DVec3,
        target: DVec3,
        line_direction: DVec3,
    ) -> Result<Laser, ShadingError> {
        for (name, point) in [("origin", origin), ("target", target)] {
            check::each(&point.to_array(), |x| check::coordinate(name, x))?;
        }
        let allowed = "another point than the origin";
        check::that(target != origin, "target", target.to_array(), "m", allowed)?;
        let spectrum = match self.spectrum {
            Some(spectrum) => spectrum,
            None => Spectrum::monochromatic(self.wavelength)?,
        };
        let focus = self.focus.unwrap_or_else(|| origin.distance(target));
        let shape = match self.line {
            None => BeamShape::Spot {
                waist_radius: self.waist_radius,
                waist_distance: [focus; 2],
                m_squared: [self.m_squared; 2],
            },
            Some((fan_angle, profile)) => {
                check::length("thickness", 2.0 * self.waist_radius[1])?;
                let beam = GaussianBeam::from_waist(spectrum.wavelength(), self.waist_radius[1])?;
                let on_lens = beam.with_m_squared(self.m_squared)?.radius_at(focus);
                BeamShape::Line {
                    waist_radius: self.waist_radius[1],
                    m_squared: self.m_squared,
                    fan: FanGeometry {
                        fan_angle,
                        // The beam is round on the lens.
                        apex_offset: on_lens / (0.5 * fan_angle).tan(),
                        focus_distance: focus,
                        focus_curve: FocusCurve::EqualPlane,
                    },
                    profile,
                }
            }
        };
        let laser = Laser::new(LaserDescription {
            spectrum,
            power: self.power,
            position: origin,
            look_at: target,
            line_direction,
            shape,
        })?;
        Ok(laser.with_source_extent(self.source_extent))
    }
}
