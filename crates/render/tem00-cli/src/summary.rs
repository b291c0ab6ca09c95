//! The parts of the summary of a render.

use std::borrow::Cow;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use tem00_engine::{PatternPlan, SpecklePlan, mean_over_sample_displacements};
use tem00_numerics::cast::to_f32;
use tem00_statistics::{Contrast, StatisticsError, airy_autocovariance};
use tem00_tracer::{Laser, LaserLayers, Scene};

/// The brightness of the previews.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub(crate) struct Exposure {
    /// The radiance shown as white, in W/(m² sr).
    pub(crate) white_level: f32,
    /// The rule by which it was chosen.
    pub(crate) chosen_by: Cow<'static, str>,
}

impl Exposure {
    /// The white level that the user asked for.
    pub(crate) fn asked(level: f64) -> Self {
        // A level beyond the range of f32 shows everything as black or white anyway.
        let white_level = to_f32(level).clamp(f32::MIN_POSITIVE, f32::MAX);
        Self::chosen(white_level, "as asked")
    }

    /// The white level that the lasers' light in the first frame suggests.
    pub(crate) const fn for_laser_light(white_level: f32) -> Self {
        let rule =
            "so that 95 % of the pixels that laser light reaches in the first frame are darker";
        Self::chosen(white_level, rule)
    }

    /// The white level that all light in the first frame suggests.
    pub(crate) const fn for_all_light(white_level: f32) -> Self {
        let rule = "so that 95 % of the lit pixels of the first frame are darker";
        Self::chosen(white_level, rule)
    }

    const fn chosen(white_level: f32, rule: &'static str) -> Self {
        Self {
            white_level,
            chosen_by: Cow::Borrowed(rule),
        }
    }
}

/// Summary of a frame.
#[derive(Debug, Deserialize, Serialize)]
pub(crate) struct FrameSummary {
    pub(crate) number: u32,
    pub(crate) preview: String,
    pub(crate) layers: String,
    /// The hashes of both files, which identify them as the files of this record.
    pub(crate) preview_fnv1a: String,
    pub(crate) layers_fnv1a: String,
    pub(crate) lasers: Vec<FrameLaser>,
    /// The camera samples, the rays followed from the camera and towards light, and the time that
    /// they took.
    pub(crate) samples: u64,
    pub(crate) rays: u64,
    pub(crate) seconds: f64,
}

/// Summary of a laser in a frame.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
pub(crate) struct FrameLaser {
    /// The power that reaches the surfaces seen in the image, in watts.
    pub(crate) power_on_target: f64,
    /// Power on the target relative to the power of the laser: 1 if the whole footprint is in the
    /// image.
    pub(crate) power_ratio: f64,
    /// The standard error of the power ratio; `None` with one sample per pixel.
    pub(crate) power_ratio_error: Option<f64>,
    /// The contrast of the speckle in the lit pixels; `None` without speckle, without light, or
    /// where the expected contrast is not known.
    pub(crate) contrast: Option<ContrastSummary>,
}

/// The contrast of speckle, measured and expected.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub(crate) struct ContrastSummary {
    pub(crate) measured: f64,
    pub(crate) expected: f64,
    pub(crate) standard_error: f64,
}

/// Returns the lasers of a scene with the patterns planned for them, as JSON; `null` stands for a
/// pattern that was left out.
pub(crate) fn lasers(scene: &Scene, plan: Option<&SpecklePlan>) -> Vec<Value> {
    let lasers = scene.lasers.iter().enumerate();
    let laser = |(index, laser): (usize, &Laser)| {
        let pattern = plan.and_then(|plan| plan.patterns().get(index));
        json!({
            "wavelength": laser.wavelength(),
            "power": laser.power(),
            "pattern": pattern.map(|plan| json!({
                "speckle_size_pixels": plan.speckle_size_in_pixels(),
                "size": plan.stack().size(),
                "diameter": plan.stack().diameter(),
                "slices": plan.stack().path().slice_count(),
                "memory_bytes": plan.stack().memory_bytes(),
                "why": plan.to_string(),
            })),
        })
    };
    lasers.map(laser).collect()
}

impl FrameLaser {
    /// Measures the layers of a laser of `power` watts.
    pub(crate) fn measure(
        layers: &LaserLayers,
        power: f64,
        plan: Option<&PatternPlan>,
        samples_per_pixel: u32,
    ) -> Self {
        let size = plan.map(PatternPlan::speckle_size_in_pixels);
        // Fewer than two lit pixels, or an even factor: there is no contrast to measure.
        let contrast = size.and_then(|size| contrast(layers, size, samples_per_pixel).ok());
        Self {
            power_on_target: layers.power_on_target,
            power_ratio: layers.power_on_target / power,
            power_ratio_error: Some(layers.power_error / power).filter(|error| error.is_finite()),
            contrast,
        }
    }
}

/// Measures the contrast of the speckle factor over the pixels that the laser lights directly.
fn contrast(
    layers: &LaserLayers,
    speckle_size: f64,
    samples_per_pixel: u32,
) -> Result<ContrastSummary, StatisticsError> {
    let pixels = layers.speckle.values().iter().zip(layers.single.values());
    let lit: Vec<f32> = pixels
        .filter(|&(_, &radiance)| radiance > 0.0)
        .map(|(&factor, _)| factor)
        .collect();
    let contrast = Contrast::from_samples(&lit)?.with_speckle_size(speckle_size)?;
    Ok(ContrastSummary {
        measured: contrast.value(),
        expected: expected_contrast(speckle_size, samples_per_pixel),
        standard_error: contrast.standard_error(),
    })
}

/// Returns the contrast of fully developed speckle in square pixels, each the mean of n samples
/// that lie in it as in a render.
///
/// ```text
/// C² = ⟨c(d / h)⟩        h in pixels, d from sample to sample, c the autocovariance
/// ```
fn expected_contrast(speckle_size: f64, samples_per_pixel: u32) -> f64 {
    let autocovariance = |[x, y]: [f64; 2]| airy_autocovariance(x.hypot(y) / speckle_size);
    mean_over_sample_displacements(samples_per_pixel, autocovariance).sqrt()
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use tem00_numerics::Grid;
    use tem00_speckle::PupilField;
    use tem00_statistics::pixel_contrast;

    use super::*;

    #[test]
    fn one_sample_per_pixel_has_contrast_one() {
        // Whatever the size of the speckle, a single sample is exponentially distributed.
        for size in [0.3, 1.0, 4.0] {
            assert_abs_diff_eq!(expected_contrast(size, 1), 1.0, epsilon = 1e-9);
        }
    }

    #[test]
    fn many_samples_average_over_the_pixel() {
        for size in [0.2, 1.0] {
            // 2^12 samples are 1/64 apart, which the spectrum of speckle does not reach.
            let contrast = expected_contrast(size, 4096);
            assert_abs_diff_eq!(contrast, pixel_contrast(1.0 / size), epsilon = 1e-4);
        }
    }

    #[test]
    fn only_lit_pixels_count() {
        let pattern = PupilField::new(256, 64, 9).expect("valid").pattern();
        let lit = |x: usize| x < 200;
        let layers = LaserLayers {
            wavelength: 650e-9,
            single: Grid::from_fn(256, 256, |x, _| if lit(x) { 2.0 } else { 0.0 }),
            speckle: Grid::from_fn(256, 256, |x, y| {
                if lit(x) {
                    pattern.values()[(x, y)]
                } else {
                    1.0
                }
            }),
            radiance: Grid::filled(256, 256, 0.0),
            multiple: Grid::filled(256, 256, 0.0),
            variance: Grid::filled(256, 256, 0.0),
            power_on_target: 1e-3,
            power_error: 0.0,
        };
        let found = contrast(&layers, 4.0, 1).expect("it varies");
        assert!(
            (found.measured - found.expected).abs() < 4.0 * found.standard_error,
            "{found:?}"
        );
        // With the even pixels it would be lower by √(200/256), 12 %.
        assert!(found.standard_error < 0.02, "{found:?}");
    }

    #[test]
    fn darkness_has_no_contrast() {
        let dark = || Grid::filled(4, 4, 0.0);
        let layers = LaserLayers {
            wavelength: 650e-9,
            single: dark(),
            speckle: Grid::filled(4, 4, 1.0),
            radiance: dark(),
            multiple: dark(),
            variance: dark(),
            power_on_target: 0.0,
            power_error: 0.0,
        };
        assert!(contrast(&layers, 4.0, 1).is_err(), "nothing is lit");
        let found = FrameLaser::measure(&layers, 1e-3, None, 1);
        assert!(
            found.contrast.is_none() && found.power_ratio.abs() < 1e-300,
            "{found:?}"
        );
    }
}
