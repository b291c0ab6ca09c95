//! Light from below the surface of the part.

use core::f64::consts::PI;
use std::sync::Arc;

use tem00_numerics::{
    Grid, Refusal,
    cast::{to_f32, to_i64, to_signed},
};
use tem00_speckle::Complex;
use tem00_translucence::{Bin, Material, Medium, MediumDescription, SpreadLine};

use super::SetupDescription;

/// Light that enters the part, is scattered below its surface and leaves it elsewhere; by default
/// none does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Subsurface {
    /// The material, whose values hold where no other is given.
    pub material: Option<&'static Material>,
    /// The transport length ℓ* = 1/µs′, in metres; 0 without a value. A part without a value and
    /// without a material lets no light in.
    pub transport_length: f64,
    /// The absorption coefficient, in 1/m; 0 without a value.
    pub absorption: f64,
    /// The refractive index; 0 without a value: that of the material, or 1.5.
    pub refractive_index: f64,
    /// The mean cosine of the scattering angle.
    pub anisotropy: f64,
    /// The root mean square slope of the facets of a matt boundary along each axis.
    pub boundary_slope: f64,
    /// The fraction of the light towards the camera that the boundary itself reflects.
    pub surface_fraction: f64,
}

impl Subsurface {
    /// Returns whether light enters the part.
    pub fn lets_light_in(&self) -> bool {
        self.transport_length > 0.0 || self.material.is_some()
    }

    /// Returns the range of a value: the given one if light enters the part and there is a value,
    /// else 0.
    pub(super) fn range(&self, value: f64, [min, max]: [f64; 2]) -> (f64, f64) {
        match self.lets_light_in() && value != 0.0 {
            true => (min, max),
            false => (0.0, 0.0),
        }
    }

    /// Returns the part below the surface in light of a wavelength, in metres; `None` if no light
    /// enters.
    ///
    /// # Errors
    ///
    /// Returns an error if a value is out of range, or if the material was not measured in such
    /// light.
    pub fn medium(&self, wavelength: f64) -> Result<Option<Medium>, Refusal> {
        if !self.lets_light_in() {
            return Ok(None);
        }
        let given = |value: f64| (value != 0.0).then_some(value);
        let description = MediumDescription {
            material: self.material,
            transport_length: given(self.transport_length),
            absorption: given(self.absorption),
            refractive_index: given(self.refractive_index),
            anisotropy: self.anisotropy,
        };
        let medium = description.medium(wavelength)?;
        medium.with_matt_boundary(self.boundary_slope).map(Some)
    }
}

/// Light of a sharp line on the part of a set-up, as its camera sees it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpreadLight {
    pub(super) line: Arc<SpreadLine>,
    /// The speckle contrast that the lengths of paths leave in the window of the detector.
    pub(super) contrast: f64,
}

impl SpreadLight {
    /// Returns the light in a set-up; `None` if no light enters the part.
    pub(super) fn new(d: &SetupDescription) -> Result<Option<Self>, Refusal> {
        let body = &d.surface.subsurface;
        let Some(medium) = body.medium(d.laser.light.wavelength)? else {
            return Ok(None);
        };
        // Both angles count towards the side of the camera, to which a laser that leans away from
        // it travels.
        let line = SpreadLine::new(&medium, d.laser.tilt, d.camera.angle);
        // The laser leans by less than the largest angle.
        let line = line.map_err(|refusal| Refusal {
            parameter: "angle",
            ..refusal
        })?;
        let line = Arc::new(line.with_boundary(body.surface_fraction)?);
        let spectrum = d.laser.light.spectrum()?;
        let contrast = match spectrum.is_monochromatic() {
            true => Some(1.0),
            false => line.contrast(&spectrum, Self::window(d)),
        };
        Ok(Some(Self {
            line,
            contrast: contrast.unwrap_or(1.0),
        }))
    }

    /// Returns the places across the line that the window of the detector sees, in metres.
    fn window(d: &SetupDescription) -> [f64; 2] {
        let across = d.camera.magnification() * d.camera.angle.cos();
        let pixel = d.sensor.pixel_pitch / across;
        let half = 0.5 * d.detector.window as f64 * pixel;
        [-half, half]
    }
}

/// Spread of a line along a column by light from below the surface, in pixels.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct PixelSpread {
    bins: Vec<Bin>,
    /// The range that holds nine tenths of the light.
    range: f64,
}

impl PixelSpread {
    /// Width of the bin of the light that the boundary reflects, in pixels.
    const SHARP: f64 = 1e-4;
    /// The largest fraction of the light that is left out.
    const DARK: f64 = 1e-7;

    pub(super) fn new(line: &SpreadLine, pixels_per_metre: f64) -> Self {
        let in_pixels = |bin: Bin| {
            let [from, to] = [bin.from, bin.to].map(|place| pixels_per_metre * place);
            Bin {
                from: from.min(to),
                to: from.max(to),
                ..bin
            }
        };
        let boundary = Bin {
            from: -0.5 * Self::SHARP,
            to: 0.5 * Self::SHARP,
            fraction: line.boundary(),
        };
        let bins = line.bins().map(in_pixels).chain([boundary]);
        let [low, high] = [0.05, 0.95].map(|fraction| line.quantile(fraction));
        Self {
            bins: bins.filter(|bin| bin.fraction > Self::DARK).collect(),
            range: pixels_per_metre.abs() * (high - low),
        }
    }

    /// Returns whether the line is sharp.
    pub(crate) const fn is_none(&self) -> bool {
        self.bins.is_empty()
    }

    /// Returns the range that holds nine tenths of the light, in pixels.
    pub(super) const fn range(&self) -> f64 {
        self.range
    }

    /// Returns the places between which the light lies, from the entry of the line.
    pub(crate) fn ends(&self) -> [f64; 2] {
        let from = self.bins.iter().map(|bin| bin.from);
        let to = self.bins.iter().map(|bin| bin.to);
        [from.fold(0.0, f64::min), to.fold(0.0, f64::max)]
    }

    /// Returns the cosine and the sine transforms at `count` multiples of a frequency, from 0, in
    /// cycles per pixel.
    pub(super) fn transforms(&self, frequency: f64, count: usize) -> Vec<[f64; 2]> {
        let mut sums = vec![[0.0; 2]; count];
        for bin in &self.bins {
            let half = PI * frequency * (bin.to - bin.from);
            let turn = Complex::cis(PI * frequency * (bin.from + bin.to));
            let widen = Complex::cis(half);
            let [mut at, mut width] = [Complex::new(1.0, 0.0); 2];
            for (index, sum) in sums.iter_mut().enumerate() {
                let angle = index as f64 * half;
                let sinc = if angle < 1e-6 { 1.0 } else { width.im / angle };
                sum[0] += bin.fraction * sinc * at.re;
                sum[1] += bin.fraction * sinc * at.im;
                (at, width) = (at * turn, width * widen);
            }
        }
        sums
    }

    /// Returns the light of an image, in parts of a pixel, where it leaves the part.
    pub(crate) fn of_light(&self, light: &Grid<f32>, parts: usize) -> Grid<f32> {
        let rows = light.height() as f64;
        let part = 1.0 / parts as f64;
        let ends = self.ends().map(|end| (end / part).round());
        let [first, last] = ends.map(|end| to_i64(end.clamp(-rows, rows)));
        let fraction = |shift: i64| {
            let [from, to] = [-0.5, 0.5].map(|half| (shift as f64 + half) * part);
            let within = |bin: &Bin| (bin.to.min(to) - bin.from.max(from)).max(0.0);
            let of_bin = |bin: &Bin| bin.fraction * within(bin) / (bin.to - bin.from);
            self.bins.iter().map(of_bin).sum::<f64>()
        };
        let kernel: Vec<_> = (first..=last)
            .map(|shift| (shift, fraction(shift)))
            .collect();
        let mut spread = Grid::filled(light.width(), light.height(), 0.0_f32);
        spread.for_each_row_mut(|row, sums| {
            for &(shift, fraction) in &kernel {
                let source = usize::try_from(to_signed(row) - shift);
                if let Some(source) = source.ok().filter(|&source| source < light.height()) {
                    let fraction = to_f32(fraction);
                    let sums = sums.iter_mut().zip(light.row(source));
                    sums.for_each(|(sum, light)| *sum += fraction * light);
                }
            }
        });
        spread
    }

    /// Returns the irradiance at a place of a Gaussian line of the light 1 and the radius at 1/e²,
    /// per pixel.
    pub(crate) fn irradiance(&self, place: f64, radius: f64) -> f64 {
        let scale = core::f64::consts::SQRT_2 / radius;
        let edge = |edge: f64| libm::erf(scale * (place - edge));
        let part = |bin: &Bin| {
            let density = 0.5 * bin.fraction / (bin.to - bin.from);
            density * (edge(bin.from) - edge(bin.to))
        };
        // Beyond four radii a Gaussian line has 10⁻¹⁴ of its light.
        let [from, to] = [place - 4.0 * radius, place + 4.0 * radius];
        let near = self
            .bins
            .iter()
            .filter(|bin| bin.to > from && bin.from < to);
        near.map(part).sum()
    }
}
