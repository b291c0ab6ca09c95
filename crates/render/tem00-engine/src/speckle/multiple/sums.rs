use glam::DVec3;
use tem00_coherence::{DelayedLight, PathPairs, Spectrum};
use tem00_decorrelation::pupil_overlap_correlation;

use super::{super::SpecklePoint, light::MultipleLight};

/// Sums over pairs of light paths to a place of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MultipleSums {
    pub(super) samples: f64,
    radiance: f64,
    /// Σ E².
    squares: f64,
    single: f64,
    polarised: f64,
    paths: PathPairs,
    /// Σ E E' cos k(δ − δ') and Σ E E' over pairs of paths whose lengths have changed by δ.
    kept: [f64; 2],
    /// Σ E cos k(δ − δ₁), with the change δ₁ of the single light.
    kept_with_single: f64,
    /// Σ E E' chat² of the displacement of the pupil between the directions of two paths.
    cascade: f64,
    pub(super) point: SpecklePoint,
}

/// A path over several rough surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MultiplePath {
    /// In W/(m² sr).
    pub radiance: f64,
    /// The optical path beyond the path of the single light, in metres, and what motion has added
    /// to it.
    pub delay: f64,
    pub added: f64,
    pub polarisation: f64,
    /// Displacement of the field in the pupil, in diameters, per change of the direction of
    /// incidence.
    pub pupil: DVec3,
}

impl MultipleSums {
    pub(super) fn new(point: SpecklePoint) -> Self {
        Self {
            samples: 0.0,
            radiance: 0.0,
            squares: 0.0,
            single: 0.0,
            polarised: 0.0,
            paths: PathPairs::default(),
            kept: [0.0; 2],
            kept_with_single: 0.0,
            cascade: 0.0,
            point,
        }
    }

    /// Sums over the pairs of two independent groups, of `paths` paths each, to a point; `single`
    /// is the radiance there of light that has met only its surface.
    pub(crate) fn of_groups(
        spectrum: &Spectrum,
        (point, single): (SpecklePoint, f64),
        groups: [&[MultiplePath]; 2],
        paths: usize,
    ) -> Self {
        let samples = 2.0 * paths as f64;
        let mut sums = Self {
            samples,
            single: samples * single,
            ..Self::new(point)
        };
        let delayed = groups.map(|group| -> Vec<_> {
            let delayed = |path: &MultiplePath| DelayedLight {
                weight: path.radiance,
                delay: path.delay,
            };
            group.iter().map(delayed).collect()
        });
        let [first, second] = &delayed;
        sums.paths.add(spectrum, first, second);
        sums.paths.add(spectrum, second, first);
        let phase = |path: f64| (spectrum.wave_number() * path).cos();
        for path in groups.into_iter().flatten() {
            sums.radiance += path.radiance;
            sums.squares += path.radiance * path.radiance;
            sums.polarised += path.radiance * path.polarisation;
            sums.kept_with_single += path.radiance * phase(path.added);
        }
        for path in groups[0] {
            for other in groups[1] {
                let energy = path.radiance * other.radiance;
                sums.kept[0] += energy * phase(path.added - other.added);
                sums.kept[1] += energy;
                let shift = path.pupil.distance(other.pupil);
                sums.cascade += energy * pupil_overlap_correlation(shift);
            }
        }
        sums
    }

    /// Returns the effective number of paths: as many paths of equal light would give the same
    /// information.
    pub(crate) fn effective_paths(&self) -> f64 {
        if self.squares > 0.0 {
            self.radiance * self.radiance / self.squares
        } else {
            0.0
        }
    }

    pub(super) fn add_scaled(&mut self, other: &Self, factor: f64) {
        self.samples += factor * other.samples;
        self.radiance += factor * other.radiance;
        self.single += factor * other.single;
        self.polarised += factor * other.polarised;
        self.paths.add_scaled(&other.paths, factor);
        for (sum, value) in self.kept.iter_mut().zip(other.kept) {
            *sum += factor * value;
        }
        self.kept_with_single += factor * other.kept_with_single;
        self.cascade += factor * other.cascade;
    }

    /// Returns the light that the sums describe, if there is any.
    pub(super) fn light(&self) -> Option<MultipleLight> {
        let ratio = |part: f64, whole: f64| (whole > 0.0).then(|| part / whole);
        Some(MultipleLight {
            radiance: ratio(self.radiance, self.samples)?,
            single: ratio(self.single, self.samples)?,
            within: self.paths.self_coherence()?.clamp(0.0, 1.0),
            with_single: self.paths.coherence_with_single()?.clamp(0.0, 1.0),
            // The means of few pairs may lie outside the range.
            kept: ratio(self.kept[0], self.kept[1])?.clamp(0.0, 1.0),
            kept_with_single: ratio(self.kept_with_single, self.radiance)?.clamp(-1.0, 1.0),
            polarisation: ratio(self.polarised, self.radiance)?.clamp(0.0, 1.0),
            cascade: ratio(self.cascade, self.kept[1])?,
            point: self.point,
        })
    }
}
