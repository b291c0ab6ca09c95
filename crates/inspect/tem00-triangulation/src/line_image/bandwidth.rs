//! Images of a line in light that is not of one wavelength.

use tem00_coherence::{PatternSum, PolychromaticSpeckle, Rows, SourceExtent};
use tem00_numerics::{
    Grid,
    cast::{to_c32, to_usize},
};
use tem00_speckle::Complex;

use crate::Setup;

/// The light of a laser with a linewidth or an extent on the surface of a set-up.
pub(super) struct PolychromaticLight {
    /// Fractions of independent patterns: one, or the dominant modes of heights or of directions of
    /// the source.
    pub(super) modes: Vec<f64>,
    /// The fraction of the light that has no speckle at all.
    pub(super) even: f64,
    pub(super) bandwidth: Option<Bandwidth>,
}

/// The number of equal patterns that stand for more, together with those of the surface.
const PATTERNS: f64 = 16.0;
/// The same for paths below the surface, whose line is wide and has many speckles across.
const FEW: f64 = 4.0;

/// Wave numbers that stand for a line. Each sees the pupil displaced across the line by the tilt of
/// the resolution cell, and heights of the relief in other phases.
#[derive(Clone, Debug)]
pub(super) struct Bandwidth {
    /// Displacements of the pupil in its diameters, with the differences of wave numbers, in rad/m.
    waves: Vec<[f64; 2]>,
    /// Paths by heights, in metres, with the roots of their fractions of the light. Their fields
    /// add.
    paths: Vec<[f64; 2]>,
}

/// The numbers of wave numbers that stand for a line: more for contrasts that are lower.
const WAVES: [f64; 2] = [16.0, 96.0];
const WAVES_PER_PATTERN: f64 = 8.0;

/// The largest displacement of the pupil, in its diameters: farther wings find new speckle there,
/// too.
const MAX_TILT: f64 = 6.0;

/// The amplitude in the pupil, and the light that it holds.
pub(super) type Pupil = (Grid<Complex<f32>>, f64);

impl PolychromaticLight {
    /// Returns `None` for light of one wavelength from a point.
    pub(super) fn of_setup(setup: &Setup) -> Option<Self> {
        let spectrum = setup.description().laser.light.spectrum();
        let (Ok(spectrum), Some(cell)) = (spectrum, setup.resolution_cell()) else {
            return None;
        };
        if spectrum.is_monochromatic() && cell.source_extent().is_point() {
            return None;
        }
        if setup.line().is_spread() {
            return Some(Self::of_contrast(setup));
        }
        let speckle = PolychromaticSpeckle {
            spectrum: &spectrum,
            cell: &cell,
        };
        let description = setup.description();
        let rows = f64::from(description.average.columns) / setup.line().speckle_size[0];
        let noise = |speckle: &PolychromaticSpeckle<'_>| {
            speckle.line_noise_ratio(Rows::Height(rows)).powi(2)
        };
        let PatternSum { fractions, heights } = speckle.patterns(noise);
        let is_broad = !spectrum.is_monochromatic() && !heights.is_empty();
        let from_point = PolychromaticSpeckle {
            cell: &cell.clone().with_source_extent(SourceExtent::default()),
            ..speckle
        };
        // Fields of heights still add in each mode.
        let in_mode = match heights[..] {
            [] => 1.0,
            _ => noise(&from_point),
        };
        let (modes, even) = enough(
            fractions,
            noise(&speckle) / in_mode,
            PATTERNS / f64::from(description.surface.patterns),
        );
        Some(Self {
            modes,
            even,
            bandwidth: is_broad.then(|| Bandwidth::new(&from_point, &heights)),
        })
    }

    /// Returns independent patterns that have the line noise of a set-up together, for paths below
    /// the surface, which are longer by far than those within a resolution cell.
    fn of_contrast(setup: &Setup) -> Self {
        let squared = setup.line().bandwidth.line_noise_ratio.powi(2);
        let patterns = f64::from(setup.description().surface.patterns);
        let (modes, even) = enough(fewest(squared), squared, FEW / patterns);
        Self {
            modes,
            even,
            bandwidth: None,
        }
    }
}

/// Returns the fewest modes whose squares sum to a variance: equal ones but for the first.
fn fewest(variance: f64) -> Vec<f64> {
    // Not more than are in use: see `enough`.
    let count = variance.max(1.0 / FEW).recip().ceil();
    let excess = ((variance - count.recip()).max(0.0) / (count * (count - 1.0)).max(1.0)).sqrt();
    let mut modes = vec![count.recip() - excess; to_usize(count)];
    modes[0] += count * excess;
    modes
}

/// Returns modes that have a variance, and the fraction of even light that is added to them.
///
/// If the variance v is below the variance of n equal patterns, these patterns have the fraction
/// √(v n) of the light, and the rest is even: more patterns would have the same covariance.
fn enough(modes: Vec<f64>, variance: f64, most: f64) -> (Vec<f64>, f64) {
    let count = most.max(1.0).floor();
    if variance * count >= 1.0 {
        return (modes, 0.0);
    }
    let equal = vec![count.recip(); to_usize(count)];
    (equal, 1.0 - (variance * count).sqrt())
}

impl Bandwidth {
    fn new(speckle: &PolychromaticSpeckle<'_>, heights: &[[f64; 2]]) -> Self {
        let PolychromaticSpeckle { spectrum, cell } = speckle;
        let [min, max] = WAVES;
        let count = (WAVES_PER_PATTERN / speckle.contrast().powi(2))
            .clamp(min, max)
            .ceil();
        let full = cell.tilt_wave_number();
        let waves = (0..to_usize(count)).map(|i| {
            let kappa = spectrum.draw((i as f64 + 0.5) / count);
            [(kappa / full).clamp(-MAX_TILT, MAX_TILT), kappa]
        });
        let path = |[height, root]: &[f64; 2]| [height * cell.height_factor(), *root];
        Self {
            waves: waves.collect(),
            paths: heights.iter().map(path).collect(),
        }
    }

    pub(super) fn widest_tilt(&self) -> f64 {
        self.waves
            .iter()
            .fold(0.0, |max: f64, wave| max.max(wave[0].abs()))
    }

    /// Returns the pupil of each wave number. `strip` makes one from the number of its random
    /// stream and its displacement.
    pub(super) fn pupils(&self, part: u64, strip: impl Fn(u64, f64) -> Pupil) -> Vec<Pupil> {
        let streams = part * self.paths.len() as u64..;
        let of_wave = |&[tilt, kappa]: &[f64; 2]| {
            let fields = self
                .paths
                .iter()
                .zip(streams.clone())
                .map(|([path, root], stream)| {
                    let (mut pupil, lit) = strip(stream, tilt);
                    let factor = to_c32(Complex::from_polar(*root, kappa * path));
                    pupil
                        .values_mut()
                        .iter_mut()
                        .for_each(|value| *value *= factor);
                    (pupil, lit)
                });
            let sum = fields.reduce(|(mut sum, lit), (pupil, _)| {
                let pairs = sum.values_mut().iter_mut().zip(pupil.values());
                pairs.for_each(|(sum, value)| *sum += value);
                (sum, lit)
            });
            sum.unwrap_or_else(|| strip(part, tilt))
        };
        self.waves.iter().map(of_wave).collect()
    }
}
