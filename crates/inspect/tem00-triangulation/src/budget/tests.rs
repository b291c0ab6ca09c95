use core::f64::consts::PI;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use approx::assert_relative_eq;
use tem00_numerics::jinc;
use tem00_statistics::laws::SpeckledLine;

use super::*;
use crate::{LineMethod, SetupDescription, TriangulationError, setup::tests::description};

fn setup_of(change: impl Fn(&mut SetupDescription)) -> Setup {
    let mut description = description();
    change(&mut description);
    Setup::new(description).unwrap()
}

fn budget_of(change: impl Fn(&mut SetupDescription)) -> Budget {
    Budget::new(&setup_of(change)).unwrap()
}

/// The contribution of one source to the position of the line, in pixels.
fn position(budget: &Budget, source: UncertaintySource) -> f64 {
    let terms = budget.terms().iter();
    terms
        .filter(|term| term.source == source)
        .map(|term| term.uncertainty)
        .sum()
}

/// The mean over the position of the line in a pixel of Σ (yᵢ − ŷ)² over a window of 2 n + 1 pixels about
/// the pixel of the line: its own second moment, and the mean square of the position.
fn squares_of_window(n: f64) -> f64 {
    n * (n + 1.0) * (2.0 * n + 1.0) / 3.0 + (2.0 * n + 1.0) / 12.0
}

/// The second moment along one axis of the part of an Airy pattern within `reach` of its middle, all in
/// units of the speckle size: ∫ A(r) r³ k(r) dr, k being what the angles leave of ∫ sin² dφ.
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

/// The part of the light of a column that a detector with a window of 31 pixels counts, beside a
/// background that it takes from pixels some 25 away.
fn counted_light(setup: &Setup) -> f64 {
    let line = setup.line();
    let fraction = |y: f64| line.pixel_electrons(y - 0.5, 0.0) / line.column_electrons;
    (-15..=15)
        .map(|y| fraction(y.into()) - fraction(25.0))
        .sum()
}

#[test]
fn shot_noise_of_a_centre_of_gravity_is_the_bound_and_that_of_the_wings() {
    let setup = setup_of(|_| ());
    let (line, budget) = (setup.line(), Budget::new(&setup).unwrap());
    // σ² = (W²/16 + 1/12 + σ_A²)/N: a pixel widens a line of the variance W²/16 by its own 1/12, and the lens
    // by what is in the window of the Airy pattern.
    let h = line.speckle_size[1];
    let lens = h * h * second_moment_of_airy(15.5 / h);
    let variance = line.projected_thickness.powi(2) / 16.0 + 1.0 / 12.0 + lens;
    let bound = (variance / line.column_electrons).sqrt() / counted_light(&setup);
    // The background is that of 25 pixels away to a fifth, 1e−3 of the light in the window; the window that
    // follows the noise adds the ends' 1 % of a motion that is no larger than that of the position.
    assert_relative_eq!(
        position(&budget, UncertaintySource::ShotNoise),
        bound,
        max_relative = 1.5e-2
    );
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
    for (source, electrons) in [
        (UncertaintySource::DarkNoise, dark),
        (UncertaintySource::Dsnu, d.dsnu),
        (
            UncertaintySource::Quantisation,
            1.0 / 12.0_f64.sqrt() / d.gain,
        ),
    ] {
        // The background, found from 47 pixels, adds (31²/12)(31²/47)/(31 · 31²/12) · … ≤ 2 · 10⁻³.
        assert_relative_eq!(
            position(&budget, source),
            electrons * arm,
            max_relative = 3e-3
        );
    }
    // s² Σ n² y²/N² = s² σ/(4 √π) for a Gaussian of the standard deviation σ, here of a line that is
    // wide enough for its pixels to be points, of which the wings take 1 % of the light.
    let wide = setup_of(|d| {
        d.laser.line_thickness = 0.6e-3;
        d.detector.window = 61;
    });
    let sigma = wide.line().width / 4.0;
    let expected = d.prnu * (sigma / (4.0 * PI.sqrt())).sqrt();
    let found = position(&Budget::new(&wide).unwrap(), UncertaintySource::Prnu);
    // Pixels widen σ² = 11 by 1/12.
    assert_relative_eq!(found, expected, max_relative = 1.5e-2);
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
            let found = budget.contribution(UncertaintySource::Speckle);
            // Eleven speckles to each side leave 1 % of the light and a fifth of the moments of what is farther
            // out; the window follows the crest, by another per cent.
            assert_relative_eq!(found, budget.line_law(), max_relative = 2.5e-2);
        }
    }
}

#[test]
fn depolarised_light_and_sums_of_patterns_have_less_speckle() {
    let one = budget_of(|_| ());
    let many = budget_of(|d| (d.surface.patterns, d.surface.polarisation) = (3, 0.5));
    let ratio = ((1.0 + 0.25) / 6.0_f64).sqrt();
    for speckle in [
        |b: &Budget| b.contribution(UncertaintySource::Speckle),
        Budget::line_law,
        Budget::dorsch,
    ] {
        assert_relative_eq!(speckle(&many), ratio * speckle(&one), max_relative = 1e-12);
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
        (UncertaintySource::ShotNoise, 6.0, 3.0),
        (UncertaintySource::DarkNoise, 6.0, 3.0),
        (UncertaintySource::Quantisation, 6.0, 3.0),
        (UncertaintySource::Prnu, 2.0, 1.0),
        (UncertaintySource::Dsnu, 2.0, 1.0),
        (UncertaintySource::DetectorBias, 1.0, 1.0),
        (UncertaintySource::Calibration, 1.0, 1.0),
    ] {
        let before = one.contribution(source);
        assert_relative_eq!(
            still.contribution(source),
            before / of_still,
            max_relative = 1e-12
        );
        assert_relative_eq!(
            moving.contribution(source),
            before / of_moving,
            max_relative = 1e-12
        );
    }
    let speckle = |budget: &Budget| budget.contribution(UncertaintySource::Speckle);
    assert_relative_eq!(speckle(&moving), speckle(&one) / 3.0, max_relative = 1e-12);
    // Four columns are 2.4 speckles: less than independent, more than one, as rows of that height.
    let ratio = speckle(&still) / speckle(&one);
    let h = 1.644;
    let law = |columns: f64| {
        let line = SpeckledLine::new(0.5 * 5.44 / h, columns / h).unwrap();
        line.centroid_deviation()
    };
    // Pixels of the height 0.6 h take as much of both to half a per cent.
    assert_relative_eq!(ratio, law(4.0) / law(1.0), max_relative = 0.02);
    assert!(ratio > 0.5 && ratio < 0.8, "{ratio}");
}

#[test]
fn rounding_without_noise_to_dither_it_does_not_average_over_frames() {
    let quiet = |frames| {
        budget_of(|d| {
            d.sensor.dark_noise = 0.01;
            d.sensor.dark_current = 0.0;
            d.average.frames = frames;
        })
    };
    let quantisation = |frames| quiet(frames).contribution(UncertaintySource::Quantisation);
    assert_relative_eq!(quantisation(100), quantisation(1), max_relative = 1e-12);
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
    let found = position(
        &Budget::new(&setup).unwrap(),
        UncertaintySource::DetectorBias,
    );
    // A smooth periodic error is averaged exactly by 32 positions; images are f32.
    assert_relative_eq!(found, expected, max_relative = 2e-3);
}

#[test]
fn a_budget_adds_up() {
    let budget = budget_of(|_| ());
    let fractions: f64 = budget
        .terms()
        .iter()
        .map(|term| budget.variance_fraction(term))
        .sum();
    assert_relative_eq!(fractions, 1.0, max_relative = 1e-12);
    let squares = UncertaintySource::ALL.map(|source| budget.contribution(source).powi(2));
    let combined = squares.iter().sum::<f64>().sqrt();
    assert_relative_eq!(budget.combined(), combined, max_relative = 1e-12);
    assert_eq!(
        budget.dominant().source,
        UncertaintySource::Speckle,
        "{budget:?}"
    );
    // All terms are known, so k is that of a normal distribution.
    assert_relative_eq!(budget.expanded(), 1.959_964 * combined, max_relative = 1e-6);
    let setup = setup_of(|_| ());
    let per_pixel = setup.line().height_per_pixel;
    let shot = position(&budget, UncertaintySource::ShotNoise) * per_pixel;
    let contribution = budget.contribution(UncertaintySource::ShotNoise);
    assert_relative_eq!(contribution, shot, max_relative = 1e-12);
}

#[test]
fn closed_forms_stand_beside_the_budget() {
    let (setup, budget) = (setup_of(|_| ()), budget_of(|_| ()));
    // sin u = D/2L = 1/192 and sin θ = 1/2.
    let dorsch = 650e-9 / (2.0 * PI / 192.0 * 0.5);
    assert_relative_eq!(budget.dorsch(), dorsch, max_relative = 1e-12);
    // The line law at 4.56 pixels of full width on speckle of 1.644 pixels, as high as a pixel.
    let h = setup.line().speckle_size[1];
    let wide = tem00_statistics::laws::line_centroid_deviation(
        0.5 * setup.line().projected_thickness / h,
        1.0 / h,
    );
    let law = wide * h * setup.line().height_per_pixel;
    // Waves are within 1 % of the limit of wide lines at w = 1.4 h.
    assert_relative_eq!(budget.line_law(), law, max_relative = 0.01);
}

#[test]
fn the_uncertainty_grows_out_of_focus() {
    let setup = setup_of(|_| ());
    let far = setup.depth_of_field().low;
    let (near, far) = (
        Budget::new(&setup).unwrap(),
        Budget::at_height(&setup, far).unwrap(),
    );
    assert!(far.combined() > 1.1 * near.combined(), "{far:?}");
}

fn simulated(setup: &Setup, trials: u32) -> Simulation {
    let options = SimulationOptions { trials, seed: 7 };
    simulate(setup, options, |_| (), &AtomicBool::new(false)).unwrap()
}

#[test]
fn trials_agree_with_first_order_term_by_term() {
    let setup = setup_of(|d| (d.average.columns, d.average.frames) = (2, 2));
    let (budget, trials) = (Budget::new(&setup).unwrap(), simulated(&setup, 40));
    for source in [
        UncertaintySource::ShotNoise,
        UncertaintySource::DarkNoise,
        UncertaintySource::Quantisation,
        UncertaintySource::Prnu,
        UncertaintySource::Dsnu,
    ] {
        let (first, found) = (budget.contribution(source), trials.term(source).unwrap());
        // Four standard errors of 40 · 64 independent positions, and 1 % for what is not first order.
        let apart = (found.uncertainty - first).abs();
        let allowed = 4.0 * found.standard_error + 0.01 * first;
        assert!(apart < allowed, "{source}: {found:?}, {first:e}");
        // 1/√(2n), to a third.
        let error = found.standard_error / found.uncertainty * 5120.0_f64.sqrt();
        assert!((0.66..1.5).contains(&error), "{source}: {error}");
    }
    let speckle = trials.term(UncertaintySource::Speckle).unwrap();
    let ratio = speckle.uncertainty / budget.contribution(UncertaintySource::Speckle);
    let chance = 4.0 * speckle.standard_error / speckle.uncertainty;
    // First order takes a pattern times the line, which is within 2 % for one of 2.8 speckles in full width.
    assert!((ratio - 1.0).abs() < 0.02 + chance, "{ratio} ± {chance}");
    assert!(
        trials.term(UncertaintySource::Calibration).is_none(),
        "nothing to simulate"
    );
}

/// Returns the fraction of columns in which a pixel is saturated, in frames that are drawn without a
/// detector: speckle, and no noise.
fn clipped_columns(setup: &Setup) -> f64 {
    let size = [128, 47];
    let image = crate::LineImage::of_setup(setup, size).unwrap();
    let sensor = setup.description().sensor;
    let full = sensor
        .full_well
        .min((4095.0 - sensor.black_level) / sensor.gain);
    let frames = 0..8_u32;
    let clipped = |seed: u32| -> usize {
        let frame = image.speckled(seed.into(), |_| 23.3).unwrap();
        let column = |x: usize| (0..size[1]).any(|y| f64::from(frame[(x, y)]) >= full);
        (0..size[0]).filter(|&x| column(x)).count()
    };
    frames.clone().map(clipped).sum::<usize>() as f64 / (frames.len() * size[0]) as f64
}

#[test]
fn there_is_no_uncertainty_by_trials_below_half_of_the_columns() {
    let mut none = [0, 0];
    for factor in [1.0, 2.0, 3.0, 5.0] {
        let setup = setup_of(|d| d.laser.power *= factor);
        let (trials, clipped) = (simulated(&setup, 10), clipped_columns(&setup));
        // 10 · 128 columns of which six go together, and as many here: four standard errors of a half.
        let apart = (trials.invalid() - clipped).abs();
        assert!(
            apart < 4.0 * 0.5 / 213.0_f64.sqrt() * 2.0_f64.sqrt(),
            "{factor}: {clipped}"
        );
        let is_none = trials.total().is_none();
        assert_eq!(is_none, trials.invalid() > 0.5, "{factor}: {trials:?}");
        none[usize::from(is_none)] += 1;
        // A single source alone saturates nothing.
        assert!(
            trials.term(UncertaintySource::ShotNoise).is_some(),
            "{trials:?}"
        );
    }
    assert!(none[0] > 0 && none[1] > 0, "both kinds are there: {none:?}");
}

#[test]
fn an_expanded_uncertainty_by_trials_holds_as_much_as_it_says() {
    // Lines of 0.03 speckles, whose errors have long tails, and of four.
    for (thickness, calibration) in [(5e-6, 0.0), (5e-6, 50e-6), (0.6e-3, 0.0)] {
        let setup = setup_of(|d| {
            d.laser.line_thickness = thickness;
            d.camera.f_number = 16.0;
            d.detector.window = 31;
            d.sensor.exposure_time *= 0.2;
            d.average.columns = 4;
            d.calibration_uncertainty = calibration;
        });
        let found = simulated(&setup, 100);
        let (expanded, rms) = (
            found.expanded().unwrap(),
            found.total().unwrap().uncertainty,
        );
        // Other frames; how much of the normal error of the calibration is small enough, is a closed form.
        let simulator = Simulator::new(&setup, *setup.line()).unwrap();
        let errors = (1000..1100).flat_map(|seed| simulator.deviations(seed).unwrap().0);
        let held = errors.map(|deviation| {
            let error = setup.line().height_per_pixel * deviation;
            let below = |end: f64| {
                let scale = calibration.max(1e-12) * 2_f64.sqrt();
                0.5 * libm::erfc((error - end) / scale)
            };
            below(expanded) - below(-expanded)
        });
        let held: Vec<f64> = held.collect();
        let fraction = held.iter().sum::<f64>() / held.len() as f64;
        // 3200 means of four columns in each, nearly independent: 2.7 standard errors.
        assert!(
            (fraction - 0.95).abs() < 0.015,
            "{thickness:e}, {calibration:e}: {fraction}"
        );
        let factor = expanded / rms.hypot(calibration);
        assert_eq!(
            factor < 1.8,
            thickness < 1e-4,
            "{thickness:e}, {calibration:e}: {factor}"
        );
    }
}

#[test]
fn a_line_that_saturates_has_no_budget() {
    // The crest of a Gaussian line of N electrons and the full width W is N √(8/π)/W.
    let setup = setup_of(|_| ());
    let (line, full) = (setup.line(), setup.description().sensor.full_well);
    let crest = line.column_electrons * (8.0 / PI).sqrt() / line.width;
    for (factor, measures) in [(0.9 * full / crest, true), (1.2 * full / crest, false)] {
        let setup = setup_of(|d| d.laser.power *= factor);
        match Budget::new(&setup) {
            Ok(budget) => assert!(measures && budget.combined() > 0.0, "{factor}: {budget:?}"),
            Err(error) => {
                assert!(!measures, "{factor}: {error}");
                let why = matches!(error, TriangulationError::NothingMeasured { .. });
                assert!(why && error.to_string().contains("saturates"), "{error}");
            }
        }
    }
}

#[test]
fn trials_give_the_same_bits_for_any_number_of_threads() {
    let setup = setup_of(|d| (d.average.frames, d.average.independent_speckle) = (2, true));
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.unwrap().install(|| simulated(&setup, 10))
    };
    assert_eq!(on(1), on(3), "one thread and three");
}

#[test]
fn trials_report_progress_and_can_be_cancelled() {
    let setup = setup_of(|_| ());
    let most = AtomicU64::new(0);
    let cancel = AtomicBool::new(false);
    let options = SimulationOptions {
        trials: 10,
        seed: 1,
    };
    let progress = |done| {
        most.fetch_max(done, Ordering::Relaxed);
    };
    simulate(&setup, options, progress, &cancel).unwrap();
    assert_eq!(most.load(Ordering::Relaxed), 10, "all trials are reported");
    cancel.store(true, Ordering::Relaxed);
    let error = simulate(&setup, options, |_| (), &cancel).unwrap_err();
    assert_eq!(error, TriangulationError::Cancelled, "{error}");
    let few = SimulationOptions { trials: 9, seed: 1 };
    let error = simulate(&setup, few, |_| (), &AtomicBool::new(false)).unwrap_err();
    assert!(error.to_string().contains("trials"), "{error}");
}

#[test]
fn a_line_that_is_not_found_has_no_budget() {
    let dark = setup_of(|d| {
        d.laser.power = 1e-9;
        d.detector.min_peak = 10.0;
    });
    assert_eq!(
        dark.light_level(),
        LightLevel::Dark,
        "{}",
        dark.saturation()
    );
    let error = Budget::new(&dark).unwrap_err();
    assert!(error.to_string().contains("raise the exposure"), "{error}");
    let options = SimulationOptions::default();
    let error = simulate(&dark, options, |_| (), &AtomicBool::new(false)).unwrap_err();
    assert!(error.to_string().contains("lines"), "{error}");
    let error = Budget::at_height(&setup_of(|_| ()), 1e3).unwrap_err();
    assert!(
        error.to_string().contains("does not see"),
        "behind the camera: {error}"
    );
}

#[test]
fn a_linewidth_scales_speckle_by_the_noise_of_the_line_and_nothing_else() {
    let mut wide = description();
    let single = Setup::new(wide.clone()).unwrap();
    wide.laser.light.linewidth = 20e-9;
    wide.surface.relief.rms_height = 0.4e-6;
    let wide = Setup::new(wide).unwrap();
    let [before, after] = [&single, &wide].map(|setup| Budget::new(setup).unwrap());
    let effect = wide.line().bandwidth;
    assert!(effect.contrast < effect.line_noise_ratio, "{effect:?}");
    for (a, b) in before.terms().iter().zip(after.terms()) {
        let ratio = b.contribution() / a.contribution();
        let expected = match a.source {
            UncertaintySource::Speckle => effect.line_noise_ratio,
            _ => 1.0,
        };
        assert!((ratio - expected).abs() < 1e-12, "{}: {ratio}", a.source);
    }
    let ratio = after.line_law() / before.line_law();
    assert!((ratio - effect.line_noise_ratio).abs() < 1e-12, "{ratio}");
    let ratio = wide.contrast() / single.contrast();
    assert!((ratio - effect.contrast).abs() < 1e-12, "{ratio}");
}
