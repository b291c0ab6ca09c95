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
    wavelength: f64,
}

impl RoughSurface {
    /// Returns the surface under a light, whose scattered field can then be computed.
    pub fn lit_by(&self, illumination: &Illumination) -> LitSurface {
        let sources = self.scatterers().iter().map(|scatterer| {
            let incident = illumination.amplitude_at(scatterer.position);
            (scatterer.position, scatterer.amplitude * incident)
        });
        LitSurface {
            sources: sources.collect(),
            wavelength: illumination.wavelength(),
        }
    }
}

impl LitSurface {
    /// Returns the wavelength λ of the light, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the complex amplitude at a point, in metres.
    pub fn field_at(&self, point: DVec3) -> Complex<f64> {
        self.sources.wave_at(point, self.wavelength)
    }

    /// Returns the complex amplitude at the samples of a plane.
    pub fn field_on(&self, plane: &SamplePlane) -> Field {
        let [width, height] = plane.samples();
        let mut amplitude = Grid::filled(width, height, Complex::new(0.0, 0.0));
        amplitude.for_each_row_mut(|y, row| {
            for x in plane.open_in_row(y) {
                row[x] = self.field_at(plane.point(x, y));
            }
        });
        Field::new(amplitude)
    }
}

#[cfg(test)]
mod tests;
