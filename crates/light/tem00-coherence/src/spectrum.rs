use crate::{LineShape, Refusal, SourceExtent, SpectralLine};

/// The light of a laser as a data sheet or a file states it, with the numbers as they were given.
/// Lengths are in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLight {
    /// The vacuum wavelength of the middle of the line.
    pub wavelength: f64,
    /// The linewidth, full width at half maximum; 0 for light of one wavelength.
    pub linewidth: f64,
    /// Distribution within the linewidth.
    pub spectrum: Spectrum,
    /// The half-angle in radians of the disc from which the light reaches the surface, seen from
    /// the surface; 0 for a point. Light from its parts does not interfere, as with a multimode
    /// fibre, a diffuser that moves during an exposure, or a lamp.
    pub source_half_angle: f64,
}

/// The form of a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// Single peak, as wide as the linewidth.
    Peak(LineShape),
    /// Comb of equal lines without width, with one linewidth between the first and the last: the
    /// longitudinal modes of a cavity.
    Comb(u32),
    /// Pairs of a wavelength, in metres, and a power, in any unit. Each pair is a Gaussian peak as
    /// wide as the linewidth.
    Peaks(Vec<[f64; 2]>),
}

impl Default for Spectrum {
    fn default() -> Self {
        Self::Peak(LineShape::Gaussian)
    }
}

impl LaserLight {
    /// Creates light of one wavelength, in metres.
    pub fn monochromatic(wavelength: f64) -> Self {
        Self {
            wavelength,
            linewidth: 0.0,
            spectrum: Spectrum::default(),
            source_half_angle: 0.0,
        }
    }

    /// Creates light from peaks, see [`Spectrum::Peaks`], about the wavelength of their mean wave
    /// number.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`SpectralLine::from_peaks`].
    pub fn of_peaks(peaks: Vec<[f64; 2]>, linewidth: f64) -> Result<Self, Refusal> {
        Ok(Self {
            wavelength: SpectralLine::from_peaks(&peaks)?.wavelength(),
            linewidth,
            spectrum: Spectrum::Peaks(peaks),
            source_half_angle: 0.0,
        })
    }

    /// Returns the directions from which the light comes.
    ///
    /// # Errors
    ///
    /// Returns the error of [`SourceExtent::disc`].
    pub fn extent(&self) -> Result<SourceExtent, Refusal> {
        SourceExtent::disc(self.source_half_angle)
    }

    /// Returns the spectral line.
    ///
    /// # Errors
    ///
    /// Returns the errors of the constructors of [`SpectralLine`], and an error if the wavelength
    /// differs from the wavelength of the [`Peaks`](Spectrum::Peaks).
    pub fn line(&self) -> Result<SpectralLine, Refusal> {
        let &Self {
            wavelength,
            linewidth,
            ref spectrum,
            ..
        } = self;
        match spectrum {
            &Spectrum::Peak(shape) => SpectralLine::new(wavelength, linewidth, shape),
            &Spectrum::Comb(lines) => SpectralLine::comb(wavelength, linewidth, lines as usize)
                .map_err(|refusal| match refusal.parameter {
                    "span" => refusal.named("linewidth"),
                    "peaks" => refusal.named("lines"),
                    _ => refusal,
                }),
            Spectrum::Peaks(peaks) => {
                let line = SpectralLine::from_peaks(peaks)?;
                // The mean of the same numbers has the same bits.
                if line.wavelength().to_bits() == wavelength.to_bits() {
                    line.with_linewidth(linewidth, LineShape::Gaussian)
                } else {
                    let allowed = "that of the mean wave number of the peaks";
                    Err(Refusal::new("wavelength", wavelength, allowed).in_unit("m"))
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_that_of_its_light() {
        let light = |spectrum| LaserLight {
            wavelength: 450e-9,
            linewidth: 4e-9,
            spectrum,
            source_half_angle: 0.0,
        };
        for shape in [
            LineShape::Gaussian,
            LineShape::Lorentzian,
            LineShape::Rectangular,
        ] {
            let line = SpectralLine::new(450e-9, 4e-9, shape);
            assert_eq!(light(Spectrum::Peak(shape)).line(), line);
        }
        assert_eq!(
            light(Spectrum::Comb(5)).line(),
            SpectralLine::comb(450e-9, 4e-9, 5)
        );
        let single = SpectralLine::monochromatic(450e-9);
        assert_eq!(LaserLight::monochromatic(450e-9).line(), single);
        let peaks = vec![[448e-9, 1.0], [453e-9, 3.0]];
        let listed = LaserLight::of_peaks(peaks.clone(), 1e-9).unwrap();
        let line = SpectralLine::from_peaks(&peaks).unwrap();
        assert_eq!(
            listed.line(),
            line.with_linewidth(1e-9, LineShape::Gaussian)
        );
    }
}
