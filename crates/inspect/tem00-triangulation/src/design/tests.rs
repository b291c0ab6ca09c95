use tem00_statistics::laws::speckle_length;
use tem00_testkit::{assert_absolute, assert_relative, on_threads};

use super::*;
use crate::{
    Budget, LightLevel, LineMethod, Setup, SetupQuantity, UncertaintySource,
    budget::tests::clipped_columns,
};

/// A line of 0.4 mm, much wider than a speckle, seen by a lens of 25 mm with the magnification
/// 1/11.
fn base() -> SetupDescription {
    let mut base = SetupDescription::default();
    base.laser.line_thickness = 0.4e-3;
    base.sensor.quantum_efficiency = 0.6;
    base.sensor.exposure_time = 0.05e-3;
    base.detector.window = 61;
    base
}

fn list(parameter: SetupQuantity, values: &[f64]) -> Sweep {
    Sweep::list(parameter, values.to_vec()).unwrap()
}

fn question(sweeps: Vec<Sweep>, constraints: &[(DesignFigure, f64)]) -> DesignQuestion {
    let constraint = |&(figure, bound)| Constraint { figure, bound };
    DesignQuestion {
        base: base(),
        sweeps,
        constraints: constraints.iter().map(constraint).collect(),
        objective: Objective::Uncertainty,
        max_setups: 1_000,
    }
}

fn outcome(question: DesignQuestion) -> DesignOutcome {
    let search = DesignSearch::new(question).unwrap();
    search.run(&|_| (), &AtomicBool::new(false)).unwrap()
}

/// Returns the search over three f-numbers, with constraints.
fn pupils(constraints: &[(DesignFigure, f64)]) -> DesignQuestion {
    question(
        vec![list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0])],
        constraints,
    )
}

fn figures(description: &SetupDescription) -> DesignFigures {
    DesignFigures::evaluate(description).unwrap()
}

/// Returns the figures of a set-up of a search.
fn tried(outcome: &DesignOutcome, index: usize) -> &DesignFigures {
    outcome.candidates()[index].possible().unwrap()
}

fn contribution(figures: &DesignFigures, source: UncertaintySource) -> f64 {
    let term = figures.contributions.iter().find(|term| term.0 == source);
    term.unwrap().1
}

#[test]
fn every_combination_is_tried_once_and_in_order() {
    let sweeps = vec![
        list(SetupQuantity::Angle, &[0.4, 0.6]),
        list(SetupQuantity::FNumber, &[5.6, 8.0, 11.0]),
    ];
    let found = outcome(question(sweeps, &[]));
    let expected = [0.4, 0.6].map(|angle| [5.6, 8.0, 11.0].map(|number| (angle, number)));
    assert_eq!(found.candidates().len(), 6);
    for (index, (candidate, expected)) in
        found.candidates().iter().zip(expected.concat()).enumerate()
    {
        let Candidate { description, .. } = candidate;
        let camera = description.camera;
        assert_eq!(
            (candidate.index, (camera.angle, camera.f_number)),
            (index, expected)
        );
        // Quantities that are not varied stay, and the figures are the figures of the set-up alone.
        assert_eq!(description.laser, base().laser);
        assert_eq!(candidate.figures, DesignFigures::evaluate(description));
    }
}

#[test]
fn the_best_are_the_least_uncertain_that_keep_every_constraint() {
    let (depth, range) = (50e-3, 3e-3);
    let mut asked = pupils(&[
        (DesignFigure::DepthOfField, depth),
        (DesignFigure::Range, range),
    ]);
    asked
        .sweeps
        .push(list(SetupQuantity::Angle, &[0.3, 0.5, 0.7]));
    let found = outcome(asked);
    // By hand, candidate by candidate.
    let keeps = |f: &DesignFigures| f.depth_of_field >= depth && f.range >= range;
    let all = found
        .candidates()
        .iter()
        .map(|candidate| figures(&candidate.description));
    let mut expected: Vec<_> = all
        .filter(keeps)
        .map(|figures| figures.uncertainty)
        .collect();
    expected.sort_by(f64::total_cmp);
    assert!((1..9).contains(&expected.len()), "some are excluded");
    let best = |count: usize| -> Vec<f64> {
        let best = found.best(count).into_iter();
        best.map(|candidate| candidate.allowed().unwrap().uncertainty)
            .collect()
    };
    assert_eq!(best(100), expected);
    assert_eq!(best(1), expected[..1]);
    assert_eq!(found.counts(), (9, expected.len()));
}

#[test]
fn a_search_allows_only_what_a_budget_finds_in_good_light() {
    // On metal, f-number by exposure: from too dark to saturated.
    let exposures = [1e-6, 1e-5, 3e-5, 5e-5, 1e-4, 2e-4, 5e-4, 2e-3];
    let sweeps = vec![
        list(SetupQuantity::FNumber, &[4.0, 8.0, 11.0, 16.0]),
        list(SetupQuantity::Exposure, &exposures),
    ];
    let mut asked = question(sweeps, &[]);
    asked.base.laser.line_thickness = 0.2e-3;
    asked.constraints = Constraint::LIGHT.to_vec();
    let mut levels = Vec::new();
    for candidate in outcome(asked).candidates() {
        let setup = Setup::new(candidate.description.clone()).unwrap();
        let level = setup.light_level();
        let good = Budget::new(&setup).is_ok() && level == LightLevel::Good;
        assert_eq!(
            candidate.allowed().is_some(),
            good,
            "{level:?}: {candidate:?}"
        );
        levels.push(level);
        if good {
            // Of the pixels at the crest of the line 2 % have brighter grains, and a column has
            // some ten.
            let clipped = clipped_columns(&setup);
            assert!(clipped < 0.1, "{clipped}: {candidate:?}");
        }
    }
    let is_among = |level| levels.contains(&level);
    assert!(LightLevel::ALL.into_iter().all(is_among), "{levels:?}");
}

#[test]
fn of_equals_the_one_with_more_room_for_bright_grains_is_best() {
    // Speckle alone: light hardly counts, and the most would win by a hair.
    let exposures = [40e-6, 20e-6, 10e-6];
    let mut asked = question(vec![list(SetupQuantity::Exposure, &exposures)], &[]);
    asked.base.sensor.dark_noise = 0.0;
    asked.base.sensor.dsnu = 0.0;
    asked.base.calibration_uncertainty = 1e-3;
    let found = outcome(asked);
    let [bright, dark] = [0, 2].map(|index| tried(&found, index).uncertainty);
    assert!(bright < dark, "by a hair");
    assert_relative(bright, dark, 1e-3);
    let order: Vec<usize> = found.best(3).iter().map(|best| best.index).collect();
    assert_eq!(order, [2, 1, 0], "the darkest first");
}

#[test]
fn an_exposure_that_is_chosen_follows_what_is_varied() {
    let mut asked = pupils(&[]);
    asked.base.auto_exposure = true;
    asked.constraints = Constraint::LIGHT.to_vec();
    let found = outcome(asked);
    for candidate in found.candidates() {
        let grains = candidate.allowed().unwrap().grain_saturation;
        assert!((0.75..=0.9).contains(&grains), "{grains}");
    }
    // The light falls as F², the contrast rises, and the image of the line becomes wider.
    let longer = tried(&found, 2).exposure / tried(&found, 0).exposure;
    assert!((8.0..20.0).contains(&longer), "{longer}");
    let mut fixed = found.candidates()[0].description.clone();
    SetupQuantity::Exposure.set(&mut fixed, 1e-5);
    assert_relative(figures(&fixed).exposure, 1e-5, 0.0);
}

#[test]
fn a_smaller_pupil_has_more_depth_of_field_and_more_speckle() {
    let found = outcome(pupils(&[]));
    for index in 1..3 {
        let [before, after] = [index - 1, index].map(|index| tried(&found, index));
        assert!(after.depth_of_field > before.depth_of_field, "{after:?}");
        for source in [UncertaintySource::Speckle, UncertaintySource::ShotNoise] {
            assert!(
                contribution(after, source) > contribution(before, source),
                "{after:?}"
            );
        }
    }
    // So each of them is the best at its depth of field.
    assert_eq!(found.front(DesignFigure::DepthOfField).len(), 3);
}

#[test]
fn speckle_grows_as_the_root_of_the_f_number_for_fine_pixels_and_as_it_for_coarse_ones() {
    // A speckle of 2 pixels, a line 31 times as wide: diffraction adds less than 1e-3 to its width,
    // and the law for wide lines is off by less than 1e-3. Then a pixel of 11 speckles, a line of
    // 24 pixels.
    let fine = (4e-3, 1e-3, 4e-6, 600, 251, [10.0, 12.0], 0.5..0.65);
    let coarse = (6e-3, 0.01e-3, 20e-6, 480, 99, [2.5, 2.8], 0.9..1.0);
    for (thickness, exposure, pitch, rows, window, numbers, exponents) in [fine, coarse] {
        let with = |number| {
            let mut changed = base();
            changed.laser.line_thickness = thickness;
            changed.sensor.exposure_time = exposure;
            changed.sensor.pixel_pitch = pitch;
            changed.camera.resolution = [64, rows];
            changed.detector.window = window;
            SetupQuantity::FNumber.set(&mut changed, number);
            figures(&changed)
        };
        let both = numbers.map(with);
        let exponent = |y: [f64; 2]| (y[1] / y[0]).ln() / (numbers[1] / numbers[0]).ln();
        let growth =
            |source| exponent([0, 1].map(|index: usize| contribution(&both[index], source)));
        // The law of wide lines, at the image distance of 3/11 focal lengths more.
        let law = exponent(numbers.map(|number| {
            let size = 650e-9 * number * 12.0 / 11.0;
            (size * speckle_length(pitch / size)).sqrt()
        }));
        let found = growth(UncertaintySource::Speckle);
        assert_absolute(found, law, 0.01);
        assert!(exponents.contains(&found), "∝ F^{found}");
        // Light falls as 1 / F² except for the aperture's sine; diffraction widens the line of fine
        // pixels.
        let widening = if pitch < 10e-6 { 0.04 } else { 0.01 };
        assert_absolute(growth(UncertaintySource::ShotNoise), 1.0, widening);
    }
}

#[test]
fn without_light_the_widest_pupil_is_best_and_shot_or_dark_noise_dominates() {
    let mut asked = pupils(&[]);
    asked.base.laser.power = 1e-6;
    asked.base.sensor.exposure_time = 1e-3;
    asked.base.detector.min_peak = 0.0;
    let found = outcome(asked);
    assert_eq!(found.best(1)[0].index, 0, "f/4");
    let widest = tried(&found, 0);
    assert_ne!(widest.dominant, UncertaintySource::Speckle, "{widest:?}");
    let ratio = tried(&found, 2).uncertainty / widest.uncertainty;
    // Shot noise alone makes it (16 / 4), noise that does not fall with the light (16 / 4)².
    assert!(ratio > 4.0, "{ratio}");
}

#[test]
fn depth_of_field_is_that_of_the_lens_or_of_the_fine_line() {
    // Where D s |1/Z − 1/L| is the width of the line in the image, by the thin lens.
    let mut description = base();
    let camera = description.camera;
    let image_distance = 1.0 / (1.0 / camera.focal_length - 1.0 / camera.distance);
    let setup = Setup::new(description.clone()).unwrap();
    let width = setup.line().width * description.sensor.pixel_pitch;
    let vergence = width / (camera.focal_length / camera.f_number * image_distance);
    let depths = [1.0, -1.0].map(|sign| 1.0 / (1.0 / camera.distance - sign * vergence));
    let lens = (depths[0] - depths[1]) / camera.angle.cos();
    assert_relative(figures(&description).depth_of_field, lens, 1e-9);
    // A line of 20 µm: twice its Rayleigh range of π w₀² / λ, independent of the lens.
    description.laser.line_thickness = 20e-6;
    description.camera.scheimpflug = true;
    let twice = 2.0 * core::f64::consts::PI * 10e-6_f64.powi(2) / 650e-9;
    let found = figures(&description);
    assert_relative(found.depth_of_field, twice, 1e-12);
    assert_relative(found.range, twice, 1e-12);
}

#[test]
fn where_nothing_is_allowed_the_constraint_and_the_nearest_set_up_are_told() {
    let bounds = [
        (DesignFigure::FieldWidth, 10.0),
        (DesignFigure::DepthOfField, 0.06),
    ];
    let found = outcome(pupils(&bounds));
    assert!(found.best(5).is_empty(), "no field is 10 m wide");
    let exclusions = found.exclusions();
    let [field, depth] = exclusions[..] else {
        panic!("{exclusions:?}");
    };
    assert_eq!(
        (field.constraint.figure, field.excluded),
        (DesignFigure::FieldWidth, 3)
    );
    // Where the field breaks alone, and where the depth of field does, too.
    assert_eq!(
        (field.alone, depth.alone),
        (3 - depth.excluded, 0),
        "{exclusions:?}"
    );
    // All fields are as wide: the nearest is the best of those with the depth.
    let nearest = found.nearest().unwrap();
    assert_eq!(nearest.broken.len(), 1, "{nearest:?}");
    let front = found.front(DesignFigure::DepthOfField);
    assert!(!front.is_empty(), "a front of the possible");
}

#[test]
fn set_ups_that_cannot_be_are_told_and_left_out() {
    // A lens nearer than its focal length has no image.
    let sweeps = vec![list(SetupQuantity::Distance, &[0.02, 0.3])];
    let found = outcome(question(sweeps, &[]));
    let why = found.candidates()[0].figures.as_ref().unwrap_err();
    assert_eq!(why.parameter(), Some("distance"), "{why}");
    assert_eq!(found.counts(), (1, 1));
    assert_eq!(found.best(2).len(), 1);
    assert_eq!(found.front(DesignFigure::DepthOfField)[0].index, 1);
}

#[test]
fn the_outcome_is_the_same_for_any_number_of_threads_that_are_not_cancelled() {
    let asked = pupils(&[(DesignFigure::DepthOfField, 0.06)]);
    let search = DesignSearch::new(asked.clone()).unwrap();
    let ended = search.run(&|_| (), &AtomicBool::new(true));
    assert_eq!(ended, Err(TriangulationError::Cancelled));
    let with = |threads| on_threads(threads, || outcome(asked.clone()));
    assert_eq!(with(1), with(7));
}

#[test]
fn searches_that_ask_for_too_much_or_nothing_are_refused() {
    let sweep =
        |parameter, steps| Sweep::between(parameter, (0.3, 0.9), steps, Spacing::Linear).unwrap();
    let told = |sweeps, constraints: &[(DesignFigure, f64)]| {
        let search = DesignSearch::new(question(sweeps, constraints));
        search.unwrap_err().to_string()
    };
    let [number, angle] = [SetupQuantity::FNumber, SetupQuantity::Angle];
    let many = told(vec![sweep(number, 100), sweep(angle, 11)], &[]);
    let twice = told(vec![sweep(number, 2), sweep(number, 3)], &[]);
    let nothing = told(Vec::new(), &[]);
    // The number itself must not overflow.
    let all = SetupQuantity::varied().into_iter();
    let all = told(all.map(|parameter| sweep(parameter, 10_000)).collect(), &[]);
    let words = ["got 1100", "varied once", "at least 1", "e43"];
    for (found, words) in [many, twice, nothing, all].iter().zip(words) {
        assert!(found.contains(words), "{found}");
    }
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bound = told(vec![sweep(number, 2)], &[(DesignFigure::Range, bad)]);
        assert!(bound.contains("range"), "{bound}");
    }
}

#[test]
fn neighbours_differ_in_one_parameter() {
    let (description, mut wide) = (base(), base());
    let near = neighbours(&description, 0.1);
    // All but the linewidth and the extent of its laser, which has none.
    assert_eq!(near.len(), SetupQuantity::varied().len() - 2);
    wide.laser.light.linewidth = 5e-9;
    let of = |near: &[Neighbours], parameter| {
        let found = near.iter().find(|near| near.parameter == parameter);
        let Neighbours { less, more, .. } = found.unwrap();
        [less.clone().unwrap(), more.clone().unwrap()]
    };
    let linewidths = of(&neighbours(&wide, 0.1), SetupQuantity::Linewidth);
    let [less, more] = linewidths.map(|near| contribution(&near, UncertaintySource::Speckle));
    assert!(more < less, "{more:e} m with more, {less:e} m with less");
    let [_, more] = of(&near, SetupQuantity::Power);
    let (exact, root) = (figures(&description), 1.1_f64.sqrt());
    // Shot noise falls as the root of the power, speckle does not depend on it: to the rounding of
    // columns of f32, 6e-8.
    for (source, falls) in [
        (UncertaintySource::ShotNoise, root),
        (UncertaintySource::Speckle, 1.0),
    ] {
        assert_relative(
            falls * contribution(&more, source),
            contribution(&exact, source),
            1e-7,
        );
    }
}

#[test]
fn the_detector_of_the_base_is_the_one_that_is_judged() {
    let mut description = base();
    let wide = figures(&description).uncertainty;
    description.detector.method = LineMethod::Parabola;
    let narrow = figures(&description).uncertainty;
    assert!(narrow > 1.2 * wide, "{narrow} against {wide}");
}
