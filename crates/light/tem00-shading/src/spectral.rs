//! Speckle of a surface under light of finite linewidth or from an extended source.

use core::f64::consts::TAU;

use glam::DVec2;
use tem00_coherence::{
    CellGeometry, PatternSum, PolychromaticSpeckle, Relief, ResolutionCell, Spectrum,
};
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, ImagingGeometry, SpeckleMotion,
    pupil_overlap_correlation,
};
use tem00_speckle::{Complex, SlicePath};

use crate::{Laser, Perspective, SeenPoint};

/// The law by which the speckle of points changes with the wave number of the light of one laser.
#[derive(Clone, Copy, Debug)]
pub struct SpectralLaw<'a> {
    /// The laser in the current frame.
    pub laser: &'a Laser,
    /// The image in the current frame.
    pub perspective: &'a Perspective,
    /// The camera's imaging geometry on the axis, at the mean wavelength of the laser.
    pub geometry: &'a ImagingGeometry,
}

/// The change of the speckle of a point with the wave number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpectralShift {
    /// The displacement of the speckle in the image in perspective, in pixels with y down; zero in
    /// focus.
    pub displacement: DVec2,
    /// The displacement of the pupil over the speckle to the right and up, in pupil diameters.
    pub pupil: DVec2,
    /// The change of the phase with the height, in radians per metre.
    pub phase_per_height: f64,
}

/// The light of a laser on a surface: fractions of patterns whose intensities add, and the look-up
/// for its bandwidth.
#[derive(Clone, Debug)]
pub struct SurfaceLight {
    /// Fractions of independent patterns: one pattern, or the dominant modes of heights or of
    /// source directions.
    pub modes: Vec<f64>,
    /// Parameters for drawing a wave number from the linewidth for each look-up, unless all wave
    /// numbers have the same speckle.
    pub bandwidth: Option<Bandwidth>,
}

/// Look-up of a surface's speckle under a laser with a linewidth.
#[derive(Clone, Debug, PartialEq)]
pub struct Bandwidth {
    /// Heights that represent the relief, in metres, with the square roots of their fractions of
    /// the light. Their fields add.
    pub heights: Vec<[f64; 2]>,
    /// The unit vector in the image, with y up, along which another wavelength displaces the pupil,
    /// pointing to the side of the largest displacement.
    pub axis: DVec2,
    /// The largest displacement along the axis that the slices hold to either side, in pupil
    /// diameters.
    pub reach: f64,
    /// The displacement in pupil diameters over the difference of wave numbers.
    pub tilt: f64,
    /// The factor by which look-ups stretch this displacement, see [`on_slices`](Self::on_slices).
    pub stretch: f64,
    /// The change of the phase with the height, in radians per metre, over the difference of wave
    /// numbers.
    pub phase_per_height: f64,
}

/// The spread of the wave number, divided by the change that displaces the pupil by its diameter,
/// below which the contrast is above 0.999.
const NEGLIGIBLE_TILT: f64 = 5e-4;

/// The fraction of the line to either side that the slices need not hold, and the largest
/// displacement that they hold, in pupil diameters. On a closed path the rest of the line gets
/// speckle that is new to nearly all of the line.
const LEFT_OUT: f64 = 5e-4;
const MAX_REACH: f64 = 1.5;

/// The number of wave numbers whose pairs stand for a line on slices, and the largest stretch of
/// their displacements: a line narrower than a slice needs the most.
const SAMPLED_WAVES: usize = 64;
const MAX_STRETCH: f64 = 16.0;

impl SpectralLaw<'_> {
    /// Returns the change of the speckle at a point in light whose wave number differs by `kappa`,
    /// in rad/m, from the mean wave number, or `None` where the theory has no value.
    pub fn shift(&self, point: &SeenPoint, kappa: f64) -> Option<SpectralShift> {
        let mean = self.configuration(point)?;
        let other = mean
            .with_wavelength(TAU / (TAU / mean.wavelength() + kappa))
            .ok()?;
        let on_axis = self.geometry;
        let pixels_per_tangent = on_axis.principal_distance() / on_axis.pixel_pitch();
        let geometry = &self.perspective.geometry(on_axis, point.pixel);
        let speckle = SpeckleMotion::between(geometry, &mean, &other);
        let tangents = speckle.speckle_displacement() / geometry.principal_distance();
        let upright = tangents * pixels_per_tangent;
        Some(SpectralShift {
            displacement: DVec2::new(upright.x, -upright.y),
            pupil: speckle.pupil_displacement? / geometry.pupil_diameter(),
            phase_per_height: mean.height_phase_change(&other)?,
        })
        .filter(SpectralShift::is_finite)
    }

    /// Returns the resolution cell at a point, if there is one.
    pub fn resolution_cell(&self, point: &SeenPoint) -> Option<ResolutionCell> {
        let now = self.configuration(point)?;
        let to_pupil = self.perspective.camera().position() - point.position;
        let radius = 0.5 * self.geometry.pupil_diameter();
        ResolutionCell::new(CellGeometry {
            to_source: now.direction_to_source(),
            to_pupil,
            normal: point.normal,
            sin_aperture: (radius / to_pupil.length()).min(1.0),
            wavelength: now.wavelength(),
        })
        .ok()
    }

    /// Returns the light on a surface with a relief, of which these points are seen, or `None` if
    /// the theory has no value at any of them.
    ///
    /// The point at which wavelengths displace the pupil most represents all points.
    pub fn light(
        &self,
        points: impl Iterator<Item = SeenPoint>,
        relief: Relief,
    ) -> Option<SurfaceLight> {
        let spectrum = self.laser.spectrum();
        if self.laser.is_coherent() {
            return Some(SurfaceLight::single());
        }
        let responses = points.filter_map(|point| Some((self.response(&point)?, point)));
        let tilt = |response: &SpectralShift| response.pupil.length();
        let farthest = responses.max_by(|a, b| tilt(&a.0).total_cmp(&tilt(&b.0)));
        let (response, point) = farthest?;
        let tilt = tilt(&response);
        let cell = self.resolution_cell(&point);
        let Some(cell) = cell.and_then(|cell| cell.with_relief(relief).ok()) else {
            return Some(SurfaceLight::single());
        };
        let cell = cell.with_source_extent(self.laser.source_extent().clone());
        let speckle = PolychromaticSpeckle {
            spectrum,
            cell: &cell,
        };
        let PatternSum { fractions, heights } =
            speckle.patterns(|speckle| speckle.contrast().powi(2));
        let is_flat = spectrum.effective_spread() * tilt < NEGLIGIBLE_TILT && heights.len() == 1;
        let farthest = spectrum.draw(1.0 - LEFT_OUT).max(-spectrum.draw(LEFT_OUT));
        let bandwidth = (!heights.is_empty() && !is_flat).then(|| Bandwidth {
            heights,
            axis: response.pupil.try_normalize().unwrap_or(DVec2::X),
            reach: (tilt * farthest).min(MAX_REACH),
            tilt,
            stretch: 1.0,
            phase_per_height: response.phase_per_height,
        });
        Some(SurfaceLight {
            modes: fractions,
            bandwidth,
        })
    }

    /// Returns the change of the speckle of a point per difference of wave numbers.
    fn response(&self, point: &SeenPoint) -> Option<SpectralShift> {
        // Small compared with every linewidth that matters, and large compared with rounding.
        let kappa = 1e-6 * self.laser.spectrum().wave_number();
        let shift = self.shift(point, kappa)?;
        Some(SpectralShift {
            displacement: shift.displacement / kappa,
            pupil: shift.pupil / kappa,
            phase_per_height: shift.phase_per_height / kappa,
        })
    }

    /// The point with its light: the phase follows from the direction of the light alone, so that
    /// the shape of the wave is not needed.
    fn configuration(&self, point: &SeenPoint) -> Option<Configuration> {
        let camera = self.perspective.camera();
        let to_source = self.laser.wave_direction_at(point.position);
        Configuration::new(ConfigurationData {
            wavelength: self.laser.wavelength(),
            point: point.position,
            normal: point.normal,
            illumination: Illumination::collimated(to_source).ok()?,
            camera: CameraFrame::from_axes(camera.axes()).ok()?,
            pupil: camera.position(),
        })
        .ok()
    }
}

impl SpectralShift {
    fn is_finite(&self) -> bool {
        self.displacement.is_finite() && self.pupil.is_finite() && self.phase_per_height.is_finite()
    }

    /// Returns the displacement of the pupil with its full length and the sign of its component
    /// along an axis.
    pub fn along(&self, axis: DVec2) -> f64 {
        self.pupil.length() * self.pupil.dot(axis).signum()
    }
}

impl SurfaceLight {
    /// Returns the light of one wavelength from a point source.
    pub fn single() -> Self {
        Self {
            modes: vec![1.0],
            bandwidth: None,
        }
    }
}

impl Bandwidth {
    /// Returns the same bandwidth with the axis on the side of a path of the pupil over the
    /// speckle, to the right and up.
    #[must_use]
    pub fn beside(&self, path: DVec2) -> Self {
        let axis = self.axis;
        self.along(if path.dot(axis) < 0.0 { -axis } else { axis })
    }

    /// Returns the same bandwidth with another axis, along which a motion is followed.
    #[must_use]
    pub fn along(&self, axis: DVec2) -> Self {
        Self {
            axis,
            ..self.clone()
        }
    }

    /// Returns the same bandwidth with the stretch at which look-ups on slices show the contrast of
    /// the law.
    ///
    /// The speckle between two slices is a blend of both, and more like both than the law says.
    /// Without a stretch the contrast of a line of 10 nm would be too high by 5 % with 8 slices per
    /// diameter of the pupil, and by 1.3 % with 32. Motions within a slice change the contrast of
    /// a line by up to 1 % with 4 slices per diameter.
    #[must_use]
    pub fn on_slices(mut self, spectrum: &Spectrum, path: SlicePath) -> Self {
        self.stretch = 1.0;
        if path.slice_count() == 1 {
            return self;
        }
        let waves = medians(spectrum, SAMPLED_WAVES);
        let covariance = |of_pair: &dyn Fn(f64, f64) -> f64| -> f64 {
            // Every pair once: a wave number agrees with itself in both.
            let pairs = waves.iter().enumerate();
            let pairs = pairs.flat_map(|(i, &a)| waves[..i].iter().map(move |&b| (a, b)));
            pairs
                .map(|(a, b)| self.kept_by_heights(a - b) * of_pair(a, b))
                .sum()
        };
        let law = covariance(&|a, b| pupil_overlap_correlation(self.tilt * (a - b).abs()));
        let is_too_alike = |stretch: f64| {
            let scale = path.slices_per_diameter() * self.tilt * stretch;
            covariance(&|a, b| path.correlation_between(scale * a, scale * b)) > law
        };
        let mut range = [1.0, MAX_STRETCH];
        for _ in 0..12 {
            let middle = f64::midpoint(range[0], range[1]);
            range[usize::from(!is_too_alike(middle))] = middle;
        }
        self.stretch = range[0];
        self
    }

    /// Returns the covariance of two intensities in the light of a line, between which the pupil
    /// has moved by `shift`, in pupil diameters; other wave numbers displace the pupil along
    /// `axis`.
    pub fn covariance(&self, spectrum: &Spectrum, shift: DVec2, axis: DVec2) -> f64 {
        spectrum.mean_over_pairs(self.scale(), |kappa| self.kept_of(kappa, shift, axis))
    }

    /// Returns the number of equal parts, at most 64, into which a line must be split, each with
    /// its median wave number, for a contrast within 1 % of the contrast of the whole line.
    pub(crate) fn waves(&self, spectrum: &Spectrum) -> usize {
        let law = self.covariance(spectrum, DVec2::ZERO, self.axis);
        let of_parts = |count: usize| {
            let waves = medians(spectrum, count);
            let pairs = waves.iter().flat_map(|a| waves.iter().map(move |b| a - b));
            let kept = pairs.map(|kappa| self.kept_of(kappa, DVec2::ZERO, self.axis));
            kept.sum::<f64>() / (count * count) as f64
        };
        // The contrast is the root of the covariance.
        let is_enough = |&count: &usize| (of_parts(count) / law - 1.0).abs() < 0.02;
        (1..=5)
            .map(|power| 1 << power)
            .find(is_enough)
            .unwrap_or(64)
    }

    /// Returns the covariance that remains after a difference of wave numbers and a displacement of
    /// the pupil.
    fn kept_of(&self, kappa: f64, shift: DVec2, axis: DVec2) -> f64 {
        let shift = shift + kappa * self.tilt * axis;
        self.kept_by_heights(kappa) * pupil_overlap_correlation(shift.length())
    }

    /// Returns the difference of wave numbers over which the speckle changes.
    fn scale(&self) -> f64 {
        let largest = self.heights.iter().map(|[height, _]| height.abs());
        let phases = self.phase_per_height.abs() * largest.fold(0.0, f64::max);
        self.tilt.max(phases).recip()
    }

    /// Returns the squared correlation that the heights leave for a difference of wave numbers.
    fn kept_by_heights(&self, kappa: f64) -> f64 {
        let phase = |height: f64| Complex::cis(self.phase_per_height * kappa * height);
        let fields = self.heights.iter();
        let field: Complex<f64> = fields
            .map(|[height, root]| phase(*height) * root * root)
            .sum();
        field.norm_sqr()
    }
}

/// The median wave numbers of the equal parts of a line.
fn medians(spectrum: &Spectrum, count: usize) -> Vec<f64> {
    let median = |part: usize| spectrum.draw((part as f64 + 0.5) / count as f64);
    (0..count).map(median).collect()
}

#[cfg(test)]
mod tests;
