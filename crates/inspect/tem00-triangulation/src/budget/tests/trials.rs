use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use tem00_testkit::on_threads;

use super::*;

fn simulated(setup: &Setup, trials: u32) -> Simulation {
    let options = SimulationOptions { trials, seed: 7 };
    simulate(setup, options, &|_| (), &AtomicBool::new(false)).unwrap()
}

#[test]
fn trials_agree_with_first_order_term_by_term() {
    let setup = setup_of(|d| (d.average.columns, d.average.frames) = (2, 2));
    let (budget, trials) = (Budget::new(&setup).unwrap(), simulated(&setup, 40));
    for source in [
        Source::ShotNoise,
        Source::DarkNoise,
        Source::Quantisation,
        Source::Prnu,
        Source::Dsnu,
    ] {
        let (first, found) = (budget.contribution(source), trials.term(source).unwrap());
        // Four standard errors of 40 · 64 independent positions, and 1 % for what is not first
        // order.
        let apart = (found.uncertainty - first).abs();
        let allowed = 4.0 * found.standard_error + 0.01 * first;
        assert!(apart < allowed, "{source}: {found:?}, {first:e}");
        // 1/√(2n), to a third.
        let error = found.standard_error / found.uncertainty * 5120.0_f64.sqrt();
        assert!((0.66..1.5).contains(&error), "{source}: {error}");
    }
    let speckle = trials.term(Source::Speckle).unwrap();
    let ratio = speckle.uncertainty / budget.contribution(Source::Speckle);
    let chance = 4.0 * speckle.standard_error / speckle.uncertainty;
    // First order takes a pattern times the line, which is within 2 % for one of 2.8 speckles in
    // full width.
    assert!((ratio - 1.0).abs() < 0.02 + chance, "{ratio} ± {chance}");
    assert_eq!(
        trials.term(Source::Calibration),
        None,
        "nothing to simulate"
    );
}

#[test]
fn there_is_no_uncertainty_by_trials_below_half_of_the_columns() {
    let mut none = [0, 0];
    for factor in [1.0, 2.0, 3.0, 5.0] {
        let setup = setup_of(|d| d.laser.power *= factor);
        let (trials, clipped) = (simulated(&setup, 10), clipped_columns(&setup));
        // 10 · 128 columns of which six go together, and as many here: four standard errors of a
        // half.
        let chance = 4.0 * 0.5 / 213.0_f64.sqrt() * 2.0_f64.sqrt();
        assert!(
            (trials.invalid - clipped).abs() < chance,
            "{factor}: {clipped}"
        );
        let is_none = trials.total.is_none();
        assert_eq!(is_none, trials.invalid > 0.5, "{factor}: {trials:?}");
        none[usize::from(is_none)] += 1;
        // A single source alone saturates nothing.
        assert!(trials.term(Source::ShotNoise).is_some(), "{trials:?}");
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
        let (expanded, rms) = (found.expanded.unwrap(), found.total.unwrap().uncertainty);
        let case = format!("{thickness:e}, {calibration:e}");
        // Other frames; how much of the normal error of the calibration is small enough, is a
        // closed form.
        let simulator = Simulator::new(&setup, setup.line()).unwrap();
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
        assert!((fraction - 0.95).abs() < 0.015, "{case}: {fraction}");
        let factor = expanded / rms.hypot(calibration);
        assert_eq!(factor < 1.8, thickness < 1e-4, "{case}: {factor}");
    }
}

#[test]
fn trials_give_the_same_bits_for_any_number_of_threads() {
    let setup = setup_of(|d| (d.average.frames, d.average.independent_speckle) = (2, true));
    let on = |threads| on_threads(threads, || simulated(&setup, 10));
    assert_eq!(on(1), on(3), "one thread and three");
}

#[test]
fn trials_report_progress_and_can_be_cancelled() {
    let setup = setup_of(|_| ());
    let max = AtomicU64::new(0);
    let run = |trials, cancelled| {
        let progress = |done| {
            max.fetch_max(done, Ordering::Relaxed);
        };
        let options = SimulationOptions { trials, seed: 1 };
        simulate(&setup, options, &progress, &AtomicBool::new(cancelled))
    };
    run(10, false).unwrap();
    assert_eq!(max.load(Ordering::Relaxed), 10, "all trials are reported");
    assert_eq!(run(10, true), Err(TriangulationError::Cancelled));
    assert_eq!(run(9, false).unwrap_err().parameter(), Some("trials"));
}
