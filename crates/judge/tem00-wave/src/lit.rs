use core::time::Duration;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::DVec3;
use num_complex::Complex;
use tem00_numerics::Grid;

use crate::{Field, Illumination, RoughSurface, SamplePlane, sum::Sources};

/// A surface under a light: scatterers that send out spherical waves.
///
/// The field is their direct sum, with exact distances and phases in `f64`:
///
/// ```text
/// U(p) = Σ A_j U_in(x_j) exp(ik |p − x_j|) / |p − x_j|
/// ```
///
/// # Cost
///
/// The sum has one *term* for each scatterer and sample, and computes some tens of millions of
/// terms per second and core. With the feature `parallel` the threads of the current rayon pool
/// share the rows of a plane; the result has the same bits for any number of threads.
///
/// # Validity
///
/// The error of a phase is about `2π r/λ · 2⁻⁵²`: 10⁻⁹ rad at half a metre. Within one wavelength
/// of a scatterer, the amplitude equals the amplitude at one wavelength.
///
/// # Examples
///
/// ```
/// use tem00_wave::{Complex, DVec3, Illumination, RoughSurface, Scatterer};
///
/// let scatterer = Scatterer { position: DVec3::ZERO, amplitude: Complex::new(1.0, 0.0) };
/// let surface = RoughSurface::from_scatterers(vec![scatterer])?;
/// let lit = surface.lit_by(&Illumination::plane(500e-9, DVec3::NEG_Z)?);
///
/// // Two million wavelengths away: back in phase, and the inverse distance.
/// let field = lit.field_at(DVec3::Z);
/// assert!((field - 1.0).norm() < 1e-8);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LitSurface {
    sources: Sources,
    scatterers: usize,
    wavelength: f64,
}

/// Progress of a long sum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Terms summed so far.
    pub done: u64,
    /// Total number of terms.
    pub total: u64,
}

impl Progress {
    /// Returns the remaining computing time from the elapsed time: all terms cost the same.
    ///
    /// # Examples
    ///
    /// ```
    /// use core::time::Duration;
    /// use tem00_wave::Progress;
    ///
    /// let progress = Progress { done: 2_000_000, total: 10_000_000 };
    /// assert_eq!(progress.remaining(Duration::from_secs(3)), Some(Duration::from_secs(12)));
    /// ```
    pub fn remaining(&self, elapsed: Duration) -> Option<Duration> {
        let factor = self.total.saturating_sub(self.done) as f64 / self.done as f64;
        Duration::try_from_secs_f64(elapsed.as_secs_f64() * factor).ok()
    }
}

impl RoughSurface {
    /// Returns the surface under a light, whose scattered field can then be computed.
    pub fn lit_by(&self, illumination: &Illumination) -> LitSurface {
        LitSurface::new(self, illumination)
    }
}

impl LitSurface {
    fn new(surface: &RoughSurface, illumination: &Illumination) -> Self {
        let sources = surface.scatterers().iter().map(|scatterer| {
            let incident = illumination.amplitude_at(scatterer.position);
            (scatterer.position, scatterer.amplitude * incident)
        });
        Self {
            sources: sources.collect(),
            scatterers: surface.scatterers().len(),
            wavelength: illumination.wavelength(),
        }
    }

    /// Returns the wavelength λ of the light, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the complex amplitude at a point, in metres.
    pub fn field_at(&self, point: DVec3) -> Complex<f64> {
        self.sources.wave_at(point, self.wavelength)
    }

    /// Returns the number of terms in the field on a plane: scatterers times samples.
    pub fn terms_on(&self, plane: &SamplePlane) -> u64 {
        self.scatterers as u64 * plane.open_samples() as u64
    }

    /// Returns the complex amplitude at the samples of a plane.
    pub fn field_on(&self, plane: &SamplePlane) -> Field {
        self.field_with_progress(plane, |_| ())
    }

    /// Computes the field like [`field_on`](Self::field_on), and calls `report` after each row of
    /// samples.
    ///
    /// Rows are finished in any order, by several threads with the feature `parallel`.
    pub fn field_with_progress(
        &self,
        plane: &SamplePlane,
        report: impl Fn(Progress) + Sync,
    ) -> Field {
        let [width, height] = plane.samples();
        let mut amplitude = Grid::filled(width, height, Complex::new(0.0, 0.0));
        let (done, total) = (AtomicU64::new(0), self.terms_on(plane));
        amplitude.for_each_row_mut(|y, row| {
            let open = plane.open_in_row(y);
            for x in open.clone() {
                row[x] = self.field_at(plane.point(x, y));
            }
            let terms = self.scatterers as u64 * open.len() as u64;
            let done = done.fetch_add(terms, Ordering::Relaxed) + terms;
            report(Progress { done, total });
        });
        Field::new(amplitude)
    }
}

#[cfg(test)]
mod tests;
