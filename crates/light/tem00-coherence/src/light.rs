use crate::{PeakShape, Refusal, SourceExtent, Spectrum};

/// The light of a laser as a data sheet or a file states it, with the numbers as they were given.
/// Lengths are in metres.
#[derive(Clone, Debug, PartialEq)]
pub struct LaserLight {
    /// The vacuum wavelength of the middle of the line.
    pub wavelength: f64,
    /// The linewidth, full width at half maximum; 0 for light of one wavelength.
    pub linewidth: f64,
    /// Distribution within the linewidth.
    pub form: SpectrumForm,
    /// The half-angle in radians of the disc from which the light reaches the surface, seen from
    /// the surface; 0 for a point. Light from its parts does not interfere, as with a multimode
    /// fibre, a diffuser that moves during an exposure, or a lamp.
    pub source_half_angle: f64,
}

/// The form of a spectrum.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumForm {
    /// Single peak, as wide as the linewidth.
    Peak(PeakShape),
    /// Comb of equal lines without width, with one linewidth between the first and the last: the
    /// longitudinal modes of a cavity.
    Comb(u32),
    /// Pairs of a wavelength, in metres, and a power, in any unit. Each pair is a Gaussian peak as
    /// wide as the linewidth.
    Peaks(Vec<[f64; 2]>),
}

impl Default for SpectrumForm {
    fn default() -> Self {
        Self::Peak(PeakShape::Gaussian)
    }
}

impl LaserLight {
    /// Creates light of one wavelength, in metres.
    pub fn monochromatic(wavelength: f64) -> Self {
        Self {
            wavelength,
            linewidth: 0.0,
            form: SpectrumForm::default(),
            source_half_angle: 0.0,
        }
    }

    /// Creates light from peaks, see [`SpectrumForm::Peaks`], about the wavelength of their mean
    /// wave number.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Spectrum::from_peaks`].
    pub fn of_peaks(peaks: Vec<[f64; 2]>, linewidth: f64) -> Result<Self, Refusal> {
        Ok(Self {
            wavelength: Spectrum::from_peaks(&peaks)?.wavelength(),
            linewidth,
            form: SpectrumForm::Peaks(peaks),
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

    /// Returns the spectrum.
    ///
    /// # Errors
    ///
    /// Returns the errors of the constructors of [`Spectrum`], and an error if the wavelength
    /// differs from the wavelength of the [`Peaks`](SpectrumForm::Peaks).
    pub fn spectrum(&self) -> Result<Spectrum, Refusal> {
        let &Self {
            wavelength,
            linewidth,
            ref form,
            ..
        } = self;
        match form {
            &SpectrumForm::Peak(shape) => Spectrum::new(wavelength, linewidth, shape),
            &SpectrumForm::Comb(lines) => Spectrum::comb(wavelength, linewidth, lines as usize)
                .map_err(|refusal| match refusal.parameter {
                    "span" => refusal.named("linewidth"),
                    "peaks" => refusal.named("lines"),
                    _ => refusal,
                }),
            SpectrumForm::Peaks(peaks) => {
                let spectrum = Spectrum::from_peaks(peaks)?;
                // The mean of the same numbers has the same bits.
                if spectrum.wavelength().to_bits() == wavelength.to_bits() {
                    spectrum.with_linewidth(linewidth, PeakShape::Gaussian)
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
    fn a_description_has_the_spectrum_that_it_states() {
        let light = |form| LaserLight {
            wavelength: 450e-9,
            linewidth: 4e-9,
            form,
            source_half_angle: 0.0,
        };
        for shape in [
            PeakShape::Gaussian,
            PeakShape::Lorentzian,
            PeakShape::Rectangular,
        ] {
            let spectrum = Spectrum::new(450e-9, 4e-9, shape);
            assert_eq!(light(SpectrumForm::Peak(shape)).spectrum(), spectrum);
        }
        assert_eq!(
            light(SpectrumForm::Comb(5)).spectrum(),
            Spectrum::comb(450e-9, 4e-9, 5)
        );
        let single = Spectrum::monochromatic(450e-9);
        assert_eq!(LaserLight::monochromatic(450e-9).spectrum(), single);
        let peaks = vec![[448e-9, 1.0], [453e-9, 3.0]];
        let listed = LaserLight::of_peaks(peaks.clone(), 1e-9).unwrap();
        let spectrum = Spectrum::from_peaks(&peaks).unwrap();
        assert_eq!(
            listed.spectrum(),
            spectrum.with_linewidth(1e-9, PeakShape::Gaussian)
        );
    }
}
