use core::f64::consts::TAU;

use glam::{DMat2, DVec2, DVec3};
use num_complex::Complex;
use tem00_numerics::{Fft2, Grid, Shown, cast::to_c32, check};

use crate::{
    Camera, Field, LitSurface, Refusal, SamplePlane,
    field::largest_magnitude,
    length::{checked_length, checked_wavelength},
    phasor::phasor,
};

/// A small window of a camera's picture, planned once for any number of surfaces.
///
/// The window's centre `u₀` is the image of a point `X₀` in the plane of focus. The lens turns the
/// spherical wave of `X₀` into a perfect image; a light wave from any other direction comes to a
/// focus at the image of that direction:
///
/// ```text
/// U(u₀ + Δu) = Σ_p w(p) U(p) exp(−ik |p − X₀|) exp(ik p · J Δu) / Σ_p w(p)
///     s(u) = τ / √(1 + τ²),   τ = u / pupil_to_image         direction cosines of a line of sight
///     J    = ∂s/∂u = (I − τ τᵀ / (1 + τ²)) / (pupil_to_image √(1 + τ²))        at u₀
/// ```
///
/// The samples `p` of the pupil are J⁻¹ times a square lattice, so that a fast Fourier transform
/// lands on a square lattice of the picture, on the axis and off it. A surface outside the plane of
/// focus is blurred without further steps, as its waves arrive with another curvature.
///
/// Column `x` and row `y` lie at `u₀ + ((x, y) − ⌊samples/2⌋) · step`, to the right and *upwards*
/// in the upright picture. A source in focus whose field has the magnitude 1 in the pupil has an
/// image of peak magnitude 1.
///
/// # Validity
///
/// - The picture repeats with the period `samples · step`. The image of all the light, with its
///   blur, must fit: what lies outside appears at the opposite side.
/// - Directions are linear in u about the window's centre. At a distance Δu from it and τ off the
///   axis, a point appears displaced by about `1.5 |τ| |Δu|² / pupil_to_image`.
/// - Samples at the rim of the pupil are weighted by the fraction of their cell inside it.
///
/// # Examples
///
/// A point in focus is imaged onto the centre of the window:
///
/// ```
/// use tem00_wave::{
///     Camera, Complex, DVec2, DVec3, Illumination, ImageSampling, ImageWindow, Lens, RoughSurface,
///     Scatterer,
/// };
///
/// let lens = Lens { pupil_diameter: 5e-3, focus_distance: 0.3, pupil_to_image: 0.06 };
/// let camera = Camera::look_at([DVec3::new(0.0, 0.0, 0.3), DVec3::ZERO], DVec3::Y, lens)?;
/// let window = ImageWindow::new(&camera, &ImageSampling {
///     wavelength: 632.8e-9,
///     centre: DVec2::ZERO,
///     step: 2e-6,
///     samples: 64,
/// })?;
///
/// let point = Scatterer { position: DVec3::ZERO, amplitude: Complex::new(1.0, 0.0) };
/// let light = Illumination::plane(632.8e-9, DVec3::NEG_Z)?;
/// let image = window.image(&RoughSurface::from_scatterers(vec![point])?.lit_by(&light));
/// // 1 over the distance of 0.3 m.
/// assert!((image.amplitude()[(32, 32)].norm() - 3.333).abs() < 1e-3);
/// # Ok::<(), tem00_wave::Refusal>(())
/// ```
#[derive(Clone, Debug)]
pub struct ImageWindow {
    sampling: ImageSampling,
    pupil: SamplePlane,
    pupil_radius: f64,
    /// Side of the square with the area of a cell of pupil samples, in metres.
    cell: f64,
    focus_point: DVec3,
    transform: Fft2,
}

/// Position and spacing of the samples of an [`ImageWindow`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageSampling {
    /// Wavelength λ of the light, in metres.
    pub wavelength: f64,
    /// Centre of the window on the upright picture, in metres on the sensor.
    pub centre: DVec2,
    /// Distance between neighbouring samples, in metres on the sensor.
    pub step: f64,
    /// Number of samples along each side.
    pub samples: usize,
}

impl ImageWindow {
    /// Plans a window.
    ///
    /// The step may be as long as the speckle size `h = λ · pupil_to_image / D` for amplitudes, and
    /// half as long for intensities, which contain twice the frequencies.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is not between 0.1 nm and 1 m, if the centre is not
    /// finite or more than 10 · `pupil_to_image` from the axis, if the step is not between 1 pm and
    /// the speckle size, or if the number of samples is not between 2 and 2¹³.
    pub fn new(camera: &Camera, sampling: &ImageSampling) -> Result<Self, Refusal> {
        let lens = camera.lens();
        let wavelength = checked_wavelength(sampling.wavelength)?;
        checked_length(sampling.step, "step")?;
        let tau = sampling.centre / lens.pupil_to_image;
        let (holds, off_axis) = (tau.length() <= 10.0, sampling.centre.length());
        let allowed = "within 10 pupil-to-image distances of the axis, in metres";
        check::that(holds, "centre", off_axis, "", allowed)?;
        let (holds, allowed) = (
            (2..=1 << 13).contains(&sampling.samples),
            "from 2 to 8192 along a side",
        );
        check::that(holds, "samples", sampling.samples, "", allowed)?;
        let lattice = PupilLattice::new(camera, sampling, tau);
        let [width, height] = lattice
            .samples()
            .filter(|samples| samples.iter().all(|&n| n <= sampling.samples))
            .ok_or_else(|| step_error(sampling.step, wavelength, camera))?;
        let transform = Fft2::with_aperture(sampling.samples, sampling.samples, width, height)
            .map_err(|_| step_error(sampling.step, wavelength, camera))?;
        let axes = camera.axes();
        let step = |column: DVec2| axes * column.extend(0.0);
        let steps = [step(lattice.steps.x_axis), step(lattice.steps.y_axis)];
        Ok(Self {
            sampling: *sampling,
            pupil: SamplePlane::stopped(
                camera.pupil_centre(),
                steps,
                [width, height],
                lattice.stop,
            ),
            pupil_radius: 0.5 * lens.pupil_diameter,
            cell: lattice.cell,
            focus_point: camera.focus_point(sampling.centre),
            transform,
        })
    }

    /// Returns the position and the spacing of the samples.
    pub const fn sampling(&self) -> &ImageSampling {
        &self.sampling
    }

    /// Returns the samples of the pupil whose light forms the image.
    pub const fn pupil(&self) -> &SamplePlane {
        &self.pupil
    }

    /// Returns the complex amplitude in the image of a surface.
    pub fn image(&self, lit: &LitSurface) -> Field {
        self.image_through(&lit.field_on(&self.pupil))
    }

    /// Returns the complex amplitude in the image, from the field on the [`pupil`](Self::pupil).
    ///
    /// # Panics
    ///
    /// Panics unless the field has the number of samples of the pupil.
    pub fn image_through(&self, field: &Field) -> Field {
        let [width, height] = self.pupil.samples();
        let values = field.amplitude();
        assert!(
            values.width() == width && values.height() == height,
            "field and pupil differ in their samples"
        );
        let largest = largest_magnitude(values.values());
        if largest == 0.0 {
            let dark = Complex::new(0.0, 0.0);
            return Field::new(Grid::filled(
                self.sampling.samples,
                self.sampling.samples,
                dark,
            ));
        }
        let (focused, weight) = self.focused(values, largest);
        self.transformed(&focused, largest / weight)
    }

    /// The field behind the lens relative to `largest`, and the sum of the pupil's weights.
    fn focused(&self, values: &Grid<Complex<f64>>, largest: f64) -> (Grid<Complex<f32>>, f64) {
        let mut focused = Grid::filled(values.width(), values.height(), Complex::default());
        let mut weights = 0.0;
        for y in 0..values.height() {
            for x in self.pupil.open_in_row(y) {
                let weight = self.weight(x, y);
                let distance = self.pupil.point(x, y).distance(self.focus_point);
                let lens = phasor(-distance / self.sampling.wavelength);
                let value = weight * lens * (values[(x, y)] / largest);
                focused[(x, y)] = to_c32(value);
                weights += weight;
            }
        }
        (focused, weights)
    }

    /// The fraction of the cell about sample `(x, y)` that lies inside the pupil.
    fn weight(&self, x: usize, y: usize) -> f64 {
        let inside = self.pupil_radius - self.pupil.offset(x, y).length();
        (inside / self.cell + 0.5).clamp(0.0, 1.0)
    }

    /// The image of a field behind the lens, times `scale`.
    fn transformed(&self, focused: &Grid<Complex<f32>>, scale: f64) -> Field {
        let size = self.sampling.samples;
        // The transform has its origin at the corner of the pupil, which gives a phase in the
        // image.
        let shifts = [focused.width() / 2, focused.height() / 2].map(|middle| origin(middle, size));
        let spectrum = self.transform.forward(focused, |kx, ky, value| {
            let value = Complex::new(f64::from(value.re), f64::from(value.im));
            value * shifts[0][kx] * shifts[1][ky] * scale
        });
        // A wave from the right, p · s > 0, has a negative frequency across the pupil.
        let frequency = |i: usize| (size / 2 + size - i) % size;
        Field::new(Grid::from_fn(size, size, |x, y| {
            spectrum[(frequency(x), frequency(y))]
        }))
    }
}

/// The samples of the pupil behind a window.
struct PupilLattice {
    /// Columns: the steps along the pupil's right and up, in metres.
    steps: DMat2,
    /// Side of the square with the area of a cell, in metres.
    cell: f64,
    /// Radius within which samples are used, in metres.
    stop: f64,
}

impl PupilLattice {
    fn new(camera: &Camera, sampling: &ImageSampling, tau: DVec2) -> Self {
        let lens = camera.lens();
        let tau2 = tau.length_squared();
        let extent = sampling.samples as f64 * sampling.step;
        let on_axis = sampling.wavelength * lens.pupil_to_image / extent;
        let outer = DMat2::from_cols(tau * tau.x, tau * tau.y);
        let steps = (DMat2::IDENTITY + outer) * (on_axis * (1.0 + tau2).sqrt());
        // det(I + ττᵀ) = 1 + τ².
        let cell = on_axis * (1.0 + tau2);
        Self {
            steps,
            cell,
            stop: 0.5 * (lens.pupil_diameter + cell),
        }
    }

    /// The number of samples that cover the stop, or `None` if there are far too many.
    fn samples(&self) -> Option<[usize; 2]> {
        let inverse = self.steps.inverse();
        let reach = [inverse.row(0), inverse.row(1)].map(|row| row.length() * self.stop);
        if !reach.iter().all(|reach| (0.0..1e6).contains(reach)) {
            return None;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative and below 10⁶"
        )]
        Some(reach.map(|reach| 2 * reach as usize + 1))
    }
}

/// The phases that move the origin of a transform from index 0 to index `middle`.
fn origin(middle: usize, size: usize) -> Vec<Complex<f64>> {
    let turns = |k: usize| (middle * k % size) as f64 / size as f64;
    (0..size)
        .map(|k| Complex::from_polar(1.0, TAU * turns(k)))
        .collect()
}

fn step_error(step: f64, wavelength: f64, camera: &Camera) -> Refusal {
    let lens = camera.lens();
    let speckle_size = wavelength * lens.pupil_to_image / lens.pupil_diameter;
    let allowed = format!("below the speckle size of {} m", Shown(speckle_size));
    Refusal::new("step", step, allowed)
}

#[cfg(test)]
mod tests;
