use tem00_coherence::{CellGeometry, DVec3, Relief, ResolutionCell, SourceExtent, Spectrum};

use crate::{
    numbers::{check_relief, code},
    pointers::columns,
    status::Failure,
};

/// The shape of a spectral peak.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PeakShape {
    /// A normal distribution: many modes, or a filter.
    Gaussian = 0,
    /// A Cauchy distribution, of long wings: a single mode.
    Lorentzian = 1,
    /// Constant between two ends: a wavelength that is swept during the exposure.
    Rectangular = 2,
}

/// The light of a laser, and how a camera sees the surface that it lights, in focus. Directions
/// lead away from the surface, of any length; lengths in metres.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct BandwidthDescription {
    /// Wavelength of the peak; not read if there are `peaks`.
    pub wavelength: f64,
    /// Full width of each peak at half maximum, from 0 to a tenth of the wavelength.
    pub linewidth: f64,
    /// Shape of each peak: a `tem00_peak_shape`.
    pub shape: u32,
    /// Wavelength and power, in any unit, of each of several peaks.
    pub peaks: *const f64,
    /// Number of peaks, at most 256; 0 for a single one at `wavelength`.
    pub peak_count: usize,
    /// To the source.
    pub to_source: [f64; 3],
    /// Half-angle of the disc from which light reaches the surface, seen from there, at most 0.3
    /// rad; 0 for a point. Light of its parts does not interfere.
    pub source_half_angle: f64,
    /// To the centre of the pupil.
    pub to_pupil: [f64; 3],
    /// Normal of the surface, on the side of both.
    pub normal: [f64; 3],
    /// Half the pupil's diameter over its distance, at most 1.
    pub sin_aperture: f64,
    /// Root mean square height of the relief that is finer than a speckle, at most 1 mm.
    pub rms_height: f64,
    /// Distance at which the correlation of the heights falls to 1/e, at most 1 mm; 0 if they
    /// differ as soon as scatterers do.
    pub correlation_length: f64,
}

impl BandwidthDescription {
    /// # Safety
    ///
    /// The peaks are null or valid.
    pub(super) unsafe fn spectrum(&self) -> Result<Spectrum, Failure> {
        use tem00_coherence::PeakShape::{Gaussian, Lorentzian, Rectangular};
        let shape = code("shape", self.shape, &[Gaussian, Lorentzian, Rectangular])?;
        if self.peak_count == 0 {
            return Ok(Spectrum::new(self.wavelength, self.linewidth, shape)?);
        }
        let count = self.peak_count.saturating_mul(2);
        // SAFETY: by the contract of this function.
        let ([peaks], []) = unsafe { columns(count, [("peaks", self.peaks)], []) }?;
        let (peaks, _) = peaks.as_chunks::<2>();
        Ok(Spectrum::from_peaks(peaks)?.with_linewidth(self.linewidth, shape)?)
    }

    pub(super) fn cell(&self, wavelength: f64) -> Result<ResolutionCell, Failure> {
        for (name, length) in [
            ("rms_height", self.rms_height),
            ("correlation_length", self.correlation_length),
        ] {
            check_relief(name, length)?;
        }
        let [to_source, to_pupil, normal] =
            [self.to_source, self.to_pupil, self.normal].map(DVec3::from_array);
        let cell = ResolutionCell::new(CellGeometry {
            to_source,
            to_pupil,
            normal,
            sin_aperture: self.sin_aperture,
            wavelength,
        })?;
        let relief = Relief {
            rms_height: self.rms_height,
            correlation_length: self.correlation_length,
        };
        let extent = SourceExtent::disc(self.source_half_angle)?;
        Ok(cell.with_relief(relief)?.with_source_extent(extent))
    }
}
