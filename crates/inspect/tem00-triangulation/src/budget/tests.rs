use core::f64::consts::PI;

use tem00_numerics::jinc;
use tem00_statistics::laws::{SpeckledLine, line_centroid_deviation};
use tem00_testkit::{assert_absolute, assert_relative};

use super::*;
use crate::{
    LineImage, LineMethod, SetupDescription, TriangulationError, UncertaintySource as Source,
    setup::tests::setup_of,
};

mod subsurface;
mod trials;

fn budget_of(change: impl Fn(&mut SetupDescription)) -> Budget {
    Budget::new(&setup_of(change)).unwrap()
}

/// The contribution of one source to the position of the line, in pixels.
fn position(budget: &Budget, source: Source) -> f64 {
    budget.term(source).unwrap().uncertainty
}

/// The mean over the position of the line in a pixel of Σ (yᵢ − ŷ)² over a window of 2 n + 1 pixels
/// about the pixel of the line: its own second moment, and the mean square of the position.
fn squares_of_window(n: f64) -> f64 {
    n * (n + 1.0) * (2.0 * n + 1.0) / 3.0 + (2.0 * n + 1.0) / 12.0
}

/// The second moment along one axis of the part of an Airy pattern within `reach` of its middle,
/// all in units of the speckle size: ∫ A(r) r³ k(r) dr, where k is the part of ∫ sin² dφ over the
/// angles.
fn second_moment_of_airy(reach: f64) -> f64 {
    const STEP: f64 = 0.02;
    let term = |i: u32| {
        let r = (f64::from(i) + 0.5) * STEP;
        let angles = if r < reach {
            PI
        } else {
            let widest = (reach / r).asin();
            2.0 * widest - (2.0 * widest).sin()
        };
        0.25 * PI * jinc(PI * r).powi(2) * r.powi(3) * angles * STEP
    };
    (0..50_000).map(term).sum()
}

/// The fraction of the light of a column that a detector with a window of 31 pixels counts, above a
/// background that it takes from pixels some 25 away.
fn counted_light(setup: &Setup) -> f64 {
    let line = setup.line();
    let fraction = |y: f64| line.pixel_electrons(y - 0.5, 0.0) / line.column_electrons;
    let counted = (-15..=15).map(|y| fraction(y.into()) - fraction(25.0));
    counted.sum()
}

#[test]
fn shot_noise_of_a_centre_of_gravity_is_the_bound_and_that_of_the_wings() {
    let setup = setup_of(|_| ());
    let (line, budget) = (setup.line(), Budget::new(&setup).unwrap());
    // σ² = (W²/16 + 1/12 + σ_A²)/N: a pixel widens a line of the variance W²/16 by its own 1/12,
    // and the lens by what is in the window of the Airy pattern.
    let h = line.speckle_size[1];
    let lens = h * h * second_moment_of_airy(15.5 / h);
    let variance = line.projected_thickness.powi(2) / 16.0 + 1.0 / 12.0 + lens;
    let bound = (variance / line.column_electrons).sqrt() / counted_light(&setup);
    // The background is that of 25 pixels away to a fifth, 1e−3 of the light in the window; the
    // window that follows the noise adds the ends' 1 % of a motion that is no larger than the
    // motion of the position.
    assert_relative(position(&budget, Source::ShotNoise), bound, 1.5e-2);
}

#[test]
fn noise_of_pixels_counts_by_their_distance_to_the_line() {
    let setup = setup_of(|_| ());
    let (d, line) = (setup.description().sensor, setup.line());
    let budget = Budget::new(&setup).unwrap();
    // g = (y − ŷ)/(K N) for pixels that are equal and independent, N the electrons that count.
    let counted = counted_light(&setup) * line.column_electrons;
    let arm = squares_of_window(15.0).sqrt() / counted;
    let dark = (d.dark_noise.powi(2) + d.dark_current * d.exposure_time).sqrt();
    let quantisation = 1.0 / 12.0_f64.sqrt() / d.gain;
    for (source, electrons) in [
        (Source::DarkNoise, dark),
        (Source::Dsnu, d.dsnu),
        (Source::Quantisation, quantisation),
    ] {
        // The background, found from 47 pixels, adds (31²/12)(31²/47)/(31 · 31²/12) · … ≤ 2 · 10⁻³.
        assert_relative(position(&budget, source), electrons * arm, 3e-3);
    }
    // s² Σ n² y²/N² = s² σ/(4 √π) for a Gaussian of the standard deviation σ, here of a line that
    // is wide enough for its pixels to be points, of which the wings take 1 % of the light.
    let wide = setup_of(|d| {
        d.laser.line_thickness = 0.6e-3;
        d.detector.window = 61;
    });
    let sigma = wide.line().width / 4.0;
    let expected = d.prnu * (sigma / (4.0 * PI.sqrt())).sqrt();
    let found = position(&Budget::new(&wide).unwrap(), Source::Prnu);
    // Pixels widen σ² = 11 by 1/12.
    assert_relative(found, expected, 1.5e-2);
}

#[test]
fn speckle_of_a_wide_centre_of_gravity_is_that_of_all_light_of_a_line_that_a_lens_images() {
    for (f_number, line_thickness) in [(22.0, 0.3e-3), (16.0, 0.6e-3)] {
        let setup = setup_of(|d| {
            d.camera.f_number = f_number;
            d.laser.line_thickness = line_thickness;
            d.laser.power *= 4.0;
            d.detector.window = 101;
        });
        for height in [0.0, 6e-3] {
            let budget = Budget::at_height(&setup, height).unwrap();
            let found = budget.contribution(Source::Speckle);
            // Eleven speckles to each side leave 1 % of the light and a fifth of the moments of
            // what is farther out; the window follows the crest, by another per cent.
            assert_relative(found, budget.line_law(), 2.5e-2);
        }
    }
}

#[test]
fn depolarised_light_and_sums_of_patterns_have_less_speckle() {
    let one = budget_of(|_| ());
    let many = budget_of(|d| (d.surface.patterns, d.surface.polarisation) = (3, 0.5));
    let ratio = ((1.0 + 0.25) / 6.0_f64).sqrt();
    for speckle in [
        |b: &Budget| b.contribution(Source::Speckle),
        Budget::line_law,
        Budget::dorsch,
    ] {
        assert_relative(speckle(&many), ratio * speckle(&one), 1e-12);
    }
}

#[test]
fn averages_lower_what_is_independent() {
    let one = budget_of(|_| ());
    let still = budget_of(|d| (d.average.columns, d.average.frames) = (4, 9));
    let moving = budget_of(|d| {
        d.average.frames = 9;
        d.average.independent_speckle = true;
    });
    for (source, of_still, of_moving) in [
        (Source::ShotNoise, 6.0, 3.0),
        (Source::DarkNoise, 6.0, 3.0),
        (Source::Quantisation, 6.0, 3.0),
        (Source::Prnu, 2.0, 1.0),
        (Source::Dsnu, 2.0, 1.0),
        (Source::DetectorBias, 1.0, 1.0),
        (Source::Calibration, 1.0, 1.0),
    ] {
        let before = one.contribution(source);
        assert_relative(still.contribution(source), before / of_still, 1e-12);
        assert_relative(moving.contribution(source), before / of_moving, 1e-12);
    }
    let speckle = |budget: &Budget| budget.contribution(Source::Speckle);
    assert_relative(speckle(&moving), speckle(&one) / 3.0, 1e-12);
    // Four columns are 2.4 speckles: less than independent, more than one, as rows of that height.
    let ratio = speckle(&still) / speckle(&one);
    let h = 1.644;
    let law = |columns: f64| {
        let line = SpeckledLine::new(0.5 * 5.44 / h, columns / h).unwrap();
        line.centroid_deviation()
    };
    // Pixels of the height 0.6 h reduce both equally, to within half a per cent.
    assert_relative(ratio, law(4.0) / law(1.0), 0.02);
    assert!(ratio > 0.5 && ratio < 0.8, "{ratio}");
}

#[test]
fn rounding_without_noise_to_dither_it_does_not_average_over_frames() {
    let quantisation = |frames| {
        let budget = budget_of(|d| {
            (d.sensor.dark_noise, d.sensor.dark_current) = (0.01, 0.0);
            d.average.frames = frames;
        });
        budget.contribution(Source::Quantisation)
    };
    assert_relative(quantisation(100), quantisation(1), 1e-12);
}

#[test]
fn the_bias_of_a_parabola_is_that_of_its_three_pixels() {
    let setup = setup_of(|d| d.detector.method = LineMethod::Parabola);
    let pixel = |y: f64, centre: f64| setup.line().pixel_electrons(y - 0.5, centre);
    let squares = (0..1000).map(|i| {
        let centre = (f64::from(i) + 0.5) / 1000.0 - 0.5;
        let [left, middle, right] = [-1.0, 0.0, 1.0].map(|y| pixel(y, centre));
        let vertex = 0.5 * (right - left) / (2.0 * middle - left - right);
        (vertex - centre).powi(2)
    });
    let expected = (squares.sum::<f64>() / 1000.0).sqrt();
    let found = position(&Budget::new(&setup).unwrap(), Source::DetectorBias);
    // A smooth periodic error is averaged exactly by 32 positions; images are f32.
    assert_relative(found, expected, 2e-3);
}

#[test]
fn a_budget_adds_up() {
    let budget = budget_of(|_| ());
    let fractions = budget
        .terms()
        .iter()
        .map(|term| budget.variance_fraction(term));
    let fractions: f64 = fractions.sum();
    assert_relative(fractions, 1.0, 1e-12);
    let squares = Source::ALL.map(|source| budget.contribution(source).powi(2));
    let combined = squares.iter().sum::<f64>().sqrt();
    assert_relative(budget.combined(), combined, 1e-12);
    assert_eq!(budget.dominant().source, Source::Speckle, "{budget:?}");
    // All terms are known, so k is the factor of a normal distribution.
    assert_relative(budget.expanded(), 1.959_964 * combined, 1e-6);
    let setup = setup_of(|_| ());
    let per_pixel = setup.line().height_per_pixel;
    let shot = position(&budget, Source::ShotNoise) * per_pixel;
    let contribution = budget.contribution(Source::ShotNoise);
    assert_relative(contribution, shot, 1e-12);
}

#[test]
fn closed_forms_stand_beside_the_budget() {
    let (setup, budget) = (setup_of(|_| ()), budget_of(|_| ()));
    // sin u = D/2L = 1/192 and sin θ = 1/2.
    let dorsch = 650e-9 / (2.0 * PI / 192.0 * 0.5);
    assert_relative(budget.dorsch(), dorsch, 1e-12);
    // A tilted laser scales the height of a pixel, and with it that of the noise of an image.
    for [angle, tilt] in [[30.0_f64, 10.0_f64], [60.0, 40.0], [30.0, -35.0]] {
        let at = |tilt: f64| {
            let of = |d: &mut SetupDescription| {
                (d.camera.angle, d.laser.tilt) = (angle.to_radians(), tilt.to_radians());
            };
            budget_of(of).dorsch() / setup_of(of).line().height_per_pixel.abs()
        };
        assert_relative(at(tilt), at(0.0), 1e-9);
    }
    // The line law at 4.56 pixels of full width on speckle of 1.644 pixels, as high as a pixel.
    let h = setup.line().speckle_size[1];
    let radius = 0.5 * setup.line().projected_thickness / h;
    let wide = line_centroid_deviation(radius, 1.0 / h);
    let law = wide * h * setup.line().height_per_pixel;
    // Waves are within 1 % of the limit of wide lines at w = 1.4 h.
    assert_relative(budget.line_law(), law, 0.01);
}

/// Returns the fraction of columns in which a pixel is saturated, in frames that are drawn without
/// a detector: speckle, and no noise.
pub(crate) fn clipped_columns(setup: &Setup) -> f64 {
    let size = [128, 47];
    let image = LineImage::of_setup(setup, size).unwrap();
    let full = setup.description().sensor.full_well;
    let clipped = |seed: u64| -> usize {
        let frame = image.speckled(seed, |_| 23.3).unwrap();
        let column = |x: usize| (0..size[1]).any(|y| f64::from(frame[(x, y)]) >= full);
        (0..size[0]).filter(|&x| column(x)).count()
    };
    (0..8).map(clipped).sum::<usize>() as f64 / (8 * size[0]) as f64
}

#[test]
fn a_line_that_saturates_has_no_budget() {
    // The crest of a Gaussian line of N electrons and the full width W is N √(8/π)/W.
    let setup = setup_of(|_| ());
    let (line, full) = (setup.line(), setup.description().sensor.full_well);
    let crest = line.column_electrons * (8.0 / PI).sqrt() / line.width;
    let budget = |light: f64| Budget::new(&setup_of(|d| d.laser.power *= light * full / crest));
    assert!(budget(0.9).unwrap().combined() > 0.0, "it measures");
    let TriangulationError::NothingMeasured { why, .. } = budget(1.2).unwrap_err() else {
        panic!("the crest is beyond the full well");
    };
    assert_eq!(why, "the line saturates the sensor");
}

#[test]
fn a_line_that_is_not_found_has_no_budget() {
    let dark = setup_of(|d| {
        d.laser.power = 1e-9;
        d.detector.min_peak = 10.0;
    });
    assert_eq!(dark.light_level(), LightLevel::Dark);
    let trials = simulate(&dark, SimulationOptions::default(), &|_| (), &false.into());
    let errors = [
        Budget::new(&dark).unwrap_err(),
        trials.unwrap_err(),
        Budget::at_height(&setup_of(|_| ()), 1e3).unwrap_err(),
    ];
    for (error, part) in errors
        .iter()
        .zip(["raise the exposure", "lines", "does not see"])
    {
        assert!(error.to_string().contains(part), "{error}");
    }
}

#[test]
fn a_linewidth_scales_speckle_by_the_noise_of_the_line_and_nothing_else() {
    let single = setup_of(|_| ());
    let wide = setup_of(|d| {
        d.laser.light.linewidth = 20e-9;
        d.surface.relief.rms_height = 0.4e-6;
    });
    let [before, after] = [&single, &wide].map(|setup| Budget::new(setup).unwrap());
    let effect = wide.line().bandwidth;
    assert!(effect.contrast < effect.line_noise_ratio, "{effect:?}");
    for (a, b) in before.terms().iter().zip(after.terms()) {
        let expected = match a.source {
            Source::Speckle => effect.line_noise_ratio,
            _ => 1.0,
        };
        assert_absolute(b.contribution() / a.contribution(), expected, 1e-12);
    }
    let ratio = after.line_law() / before.line_law();
    assert_absolute(ratio, effect.line_noise_ratio, 1e-12);
    assert_absolute(wide.contrast() / single.contrast(), effect.contrast, 1e-12);
}

#[test]
fn the_uncertainty_grows_out_of_focus() {
    let setup = setup_of(|_| ());
    let far = Budget::at_height(&setup, setup.depth_of_field().low).unwrap();
    assert!(far.combined() > 1.1 * Budget::new(&setup).unwrap().combined());
}
