use approx::assert_relative_eq;
use rayon::ThreadPoolBuilder;
use tem00_statistics::laws::speckle_length;

use super::*;
use crate::{LineMethod, SetupQuantity, UncertaintySource, parse_setup};

/// A line of 0.4 mm, much wider than a speckle, seen by a lens of 25 mm with the magnification 1/11.
fn base() -> SetupDescription {
    let setup = parse_setup(
        r#"
        [laser]
        wavelength = "650 nm"
        power = "5 mW"
        line_thickness = "0.4 mm"
        line_length = "50 mm"
        [camera]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [640, 480]
        distance = "300 mm"
        angle = "30 deg"
        [sensor]
        quantum_efficiency = 0.6
        exposure = "0.05 ms"
        [surface]
        reflectance = 0.5
        [detector]
        window = 61
        "#,
    );
    setup.expect("a set-up").description().clone()
}

fn list(parameter: SetupQuantity, values: &[f64]) -> Sweep {
    Sweep::list(parameter, values.to_vec()).expect("sizes")
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
    let search = DesignSearch::new(question).expect("a search");
    search
        .run(|_| (), &AtomicBool::new(false))
        .expect("nobody cancels")
}

fn figures(description: &SetupDescription) -> DesignFigures {
    DesignFigures::evaluate(description).expect("possible")
}

fn contribution(figures: &DesignFigures, name: UncertaintySource) -> f64 {
    let mut terms = figures.contributions.iter();
    terms
        .find(|term| term.0 == name)
        .expect("the term is there")
        .1
}

/// Returns d ln y / d ln x between two points.
fn exponent(x: [f64; 2], y: [f64; 2]) -> f64 {
    (y[1] / y[0]).ln() / (x[1] / x[0]).ln()
}

#[test]
fn every_combination_is_tried_once_and_in_order() {
    let angles = [0.4, 0.6];
    let numbers = [5.6, 8.0, 11.0];
    let sweeps = vec![
        list(SetupQuantity::Angle, &angles),
        list(SetupQuantity::FNumber, &numbers),
    ];
    let found = outcome(question(sweeps, &[]));
    let tried = found.candidates().iter().map(|candidate| {
        let camera = candidate.description.camera;
        (candidate.index, camera.angle, camera.f_number)
    });
    let expected: Vec<_> = angles
        .iter()
        .flat_map(|&angle| numbers.map(|number| (angle, number)))
        .enumerate()
        .map(|(index, (angle, number))| (index, angle, number))
        .collect();
    assert_eq!(tried.collect::<Vec<_>>(), expected);
    // What is not varied stays, and the figures are those of the set-up alone.
    for candidate in found.candidates() {
        assert_eq!(candidate.description.laser, base().laser);
        assert_eq!(
            candidate.figures,
            DesignFigures::evaluate(&candidate.description)
        );
    }
}

#[test]
fn the_best_are_the_least_uncertain_that_keep_every_constraint() {
    let sweeps = vec![
        list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0]),
        list(SetupQuantity::Angle, &[0.3, 0.5, 0.7]),
    ];
    let (depth, range) = (50e-3, 3e-3);
    let constraints = [
        (DesignFigure::DepthOfField, depth),
        (DesignFigure::Range, range),
    ];
    let found = outcome(question(sweeps, &constraints));
    // By hand, candidate by candidate.
    let keeps = |f: &DesignFigures| f.depth_of_field >= depth && f.range >= range;
    let mut expected: Vec<_> = found
        .candidates()
        .iter()
        .map(|candidate| figures(&candidate.description))
        .filter(keeps)
        .map(|figures| figures.uncertainty)
        .collect();
    expected.sort_by(f64::total_cmp);
    assert!((1..9).contains(&expected.len()), "some are excluded");
    let uncertainties = |count: usize| -> Vec<f64> {
        let best = found.best(count).into_iter();
        best.map(|candidate| candidate.allowed().expect("allowed").uncertainty)
            .collect()
    };
    assert_eq!(uncertainties(100), expected);
    assert_eq!(uncertainties(1), expected[..1]);
    assert_eq!(found.counts(), (9, expected.len()));
}

/// Returns the fraction of columns with a pixel beyond the full well, in frames drawn without a detector.
fn clipped_columns(description: &SetupDescription) -> f64 {
    let setup = crate::Setup::new(description.clone()).expect("possible");
    let size = [128, 47];
    let image = crate::LineImage::of_setup(&setup, size).expect("a line");
    let full = setup.description().sensor.full_well;
    let clipped = |seed: u64| -> usize {
        let frame = image.speckled(seed, |_| 23.3).expect("a pattern");
        let is_clipped = |x: usize| (0..size[1]).any(|y| f64::from(frame[(x, y)]) > full);
        (0..size[0]).filter(|&x| is_clipped(x)).count()
    };
    let columns: usize = (0..8).map(clipped).sum();
    columns as f64 / (8 * size[0]) as f64
}

#[test]
fn a_search_allows_only_what_a_budget_finds_in_good_light() {
    // On metal, f-number by exposure: from too dark to saturated.
    let sweeps = vec![
        list(SetupQuantity::FNumber, &[4.0, 8.0, 11.0, 16.0]),
        list(
            SetupQuantity::Exposure,
            &[1e-6, 1e-5, 3e-5, 5e-5, 1e-4, 2e-4, 5e-4, 2e-3],
        ),
    ];
    let mut asked = question(sweeps, &[]);
    asked.base.laser.line_thickness = 0.2e-3;
    asked.constraints = Constraint::LIGHT.to_vec();
    let found = outcome(asked);
    let mut levels = Vec::new();
    for candidate in found.candidates() {
        let setup = crate::Setup::new(candidate.description.clone()).expect("possible");
        let measures = crate::Budget::new(&setup).is_ok();
        let level = setup.light_level();
        let good = measures && level == crate::LightLevel::Good;
        assert_eq!(
            candidate.allowed().is_some(),
            good,
            "{level:?}: {candidate:?}"
        );
        levels.push(level);
        if good {
            // Of the pixels at the crest of the line 2 % have brighter grains, and a column has some ten.
            let clipped = clipped_columns(&candidate.description);
            assert!(clipped < 0.1, "{clipped}: {candidate:?}");
        }
    }
    for level in [
        crate::LightLevel::Dark,
        crate::LightLevel::Good,
        crate::LightLevel::SaturatedGrains,
        crate::LightLevel::Saturated,
    ] {
        assert!(levels.contains(&level), "{level:?} is among them");
    }
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
    let of = |index: usize| figures(&found.candidates()[index].description);
    assert!(of(0).uncertainty < of(2).uncertainty, "by a hair");
    assert_relative_eq!(of(0).uncertainty, of(2).uncertainty, max_relative = 1e-3);
    let order: Vec<usize> = found.best(3).iter().map(|best| best.index).collect();
    assert_eq!(order, [2, 1, 0], "the darkest first");
}

#[test]
fn an_exposure_that_is_chosen_follows_what_is_varied() {
    let mut asked = question(vec![list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0])], &[]);
    asked.base.auto_exposure = true;
    asked.constraints = Constraint::LIGHT.to_vec();
    let found = outcome(asked);
    for candidate in found.candidates() {
        let figures = candidate.allowed().expect("the light is right");
        assert!(
            (0.75..=0.9).contains(&figures.grain_saturation),
            "{figures:?}"
        );
    }
    let exposure = |index: usize| {
        found.candidates()[index]
            .possible()
            .expect("possible")
            .exposure
    };
    // The light falls as F², the contrast rises, and the image of the line becomes wider.
    assert!(
        (8.0..20.0).contains(&(exposure(2) / exposure(0))),
        "{}",
        exposure(2)
    );
    let mut fixed = found.candidates()[0].description.clone();
    SetupQuantity::Exposure.set(&mut fixed, 1e-5);
    assert_relative_eq!(figures(&fixed).exposure, 1e-5);
}

#[test]
fn a_smaller_pupil_has_more_depth_of_field_and_more_speckle() {
    let numbers = [4.0, 5.6, 8.0, 11.0, 16.0];
    let found = outcome(question(vec![list(SetupQuantity::FNumber, &numbers)], &[]));
    let figures: Vec<_> = found
        .candidates()
        .iter()
        .map(|candidate| candidate.possible().expect("possible").clone())
        .collect();
    for pair in figures.windows(2) {
        let speckle = [0, 1].map(|i| contribution(&pair[i], UncertaintySource::Speckle));
        let shot = [0, 1].map(|i| contribution(&pair[i], UncertaintySource::ShotNoise));
        assert!(pair[1].depth_of_field > pair[0].depth_of_field, "{pair:?}");
        assert!(speckle[1] > speckle[0], "{pair:?}");
        assert!(shot[1] > shot[0], "{pair:?}");
    }
    // So each of them is the best at its depth of field.
    assert_eq!(found.front(DesignFigure::DepthOfField).len(), numbers.len());
}

/// Returns how a source goes with the f-number between two of them.
fn growth(base: &SetupDescription, numbers: [f64; 2], source: UncertaintySource) -> f64 {
    let terms = numbers.map(|number| {
        let mut changed = base.clone();
        SetupQuantity::FNumber.set(&mut changed, number);
        contribution(&figures(&changed), source)
    });
    exponent(numbers, terms)
}

/// Returns how √(h ℓ(p/h)) goes with the speckle size h at the pixel pitch p: the noise of a wide line.
fn law(base: &SetupDescription, numbers: [f64; 2]) -> f64 {
    let sizes = numbers.map(|number| {
        let size = base.laser.light.wavelength * number * base.camera.distance
            / (base.camera.distance - base.camera.focal_length);
        (size * speckle_length(base.sensor.pixel_pitch / size)).sqrt()
    });
    exponent(numbers, sizes)
}

#[test]
fn speckle_grows_as_the_root_of_the_f_number_for_fine_pixels() {
    // A speckle of 2 pixels, a line 31 times as wide: diffraction adds less than 1e-3 to its width,
    // and the law for wide lines is off by less than 1e-3.
    let mut description = base();
    description.laser.line_thickness = 4e-3;
    description.sensor.exposure_time = 1e-3;
    description.sensor.pixel_pitch = 4.0e-6;
    description.camera.resolution = [64, 600];
    description.detector.window = 251;
    let numbers = [10.0, 12.0];
    let speckle = growth(&description, numbers, UncertaintySource::Speckle);
    let expected = law(&description, numbers);
    assert!(
        (speckle - expected).abs() < 0.01,
        "∝ F^{speckle}, by law F^{expected}"
    );
    assert!((0.5..0.65).contains(&speckle), "∝ F^{speckle}");
}

#[test]
fn speckle_and_shot_noise_grow_as_the_f_number_for_coarse_pixels() {
    // A pixel of 11 speckles, a line of 24 pixels.
    let mut description = base();
    description.laser.line_thickness = 6e-3;
    description.sensor.exposure_time = 0.01e-3;
    description.sensor.pixel_pitch = 20e-6;
    description.camera.resolution = [64, 480];
    description.detector.window = 99;
    let numbers = [2.5, 2.8];
    let speckle = growth(&description, numbers, UncertaintySource::Speckle);
    let expected = law(&description, numbers);
    assert!(
        (speckle - expected).abs() < 0.01,
        "∝ F^{speckle}, by law F^{expected}"
    );
    assert!((0.9..1.0).contains(&speckle), "∝ F^{speckle}");
    // Light falls as 1 / F² but for the aperture's sine, and diffraction hardly widens the line.
    let shot = growth(&description, numbers, UncertaintySource::ShotNoise);
    assert!((shot - 1.0).abs() < 0.01, "shot noise ∝ F^{shot}");
}

#[test]
fn without_light_the_widest_pupil_is_best_and_shot_or_dark_noise_dominates() {
    let mut question = question(vec![list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0])], &[]);
    question.base.laser.power = 1e-6;
    question.base.sensor.exposure_time = 1e-3;
    question.base.detector.min_peak = 0.0;
    let found = outcome(question);
    let best = found.best(1)[0];
    assert_relative_eq!(best.description.camera.f_number, 4.0);
    let widest = best.allowed().expect("allowed");
    assert_ne!(widest.dominant, UncertaintySource::Speckle, "{widest:?}");
    let smallest = found.candidates()[2].possible().expect("possible");
    let ratio = smallest.uncertainty / widest.uncertainty;
    // Shot noise alone makes it (16 / 4), noise that does not fall with the light (16 / 4)².
    assert!(ratio > 4.0, "{ratio}");
}

#[test]
fn depth_of_field_is_that_of_the_lens_or_of_the_fine_line() {
    // Where D s |1/Z − 1/L| is the width of the line in the image, by the thin lens.
    let description = base();
    let camera = description.camera;
    let image_distance = 1.0 / (1.0 / camera.focal_length - 1.0 / camera.distance);
    let setup = crate::Setup::new(description.clone()).expect("possible");
    let width = setup.line().width * description.sensor.pixel_pitch;
    let vergence = width / (camera.focal_length / camera.f_number * image_distance);
    let depths = [1.0, -1.0].map(|sign| 1.0 / (1.0 / camera.distance - sign * vergence));
    let lens = (depths[0] - depths[1]) / camera.angle.cos();
    assert_relative_eq!(
        figures(&description).depth_of_field,
        lens,
        max_relative = 1e-9
    );
    // A line of 20 µm: twice its Rayleigh range of π w₀² / λ, whatever the lens does.
    let mut fine = description;
    fine.laser.line_thickness = 20e-6;
    fine.camera.scheimpflug = true;
    let twice = 2.0 * core::f64::consts::PI * 10e-6_f64.powi(2) / 650e-9;
    let found = figures(&fine);
    assert_relative_eq!(found.depth_of_field, twice, max_relative = 1e-12);
    assert_relative_eq!(found.range, twice, max_relative = 1e-12);
}

#[test]
fn where_nothing_is_allowed_the_constraint_and_the_nearest_set_up_are_told() {
    let sweeps = vec![list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0])];
    let constraints = [
        (DesignFigure::FieldWidth, 10.0),
        (DesignFigure::DepthOfField, 0.06),
    ];
    let found = outcome(question(sweeps, &constraints));
    assert!(found.best(5).is_empty(), "no field is 10 m wide");
    let exclusions = found.exclusions();
    let first = exclusions[0];
    assert_eq!(first.constraint.figure, DesignFigure::FieldWidth);
    assert_eq!(first.excluded, 3, "{exclusions:?}");
    // Where the field breaks alone, and where the depth of field does, too.
    assert_eq!(first.alone, 3 - exclusions[1].excluded, "{exclusions:?}");
    assert_eq!(exclusions[1].alone, 0, "{exclusions:?}");
    // All fields are as wide: the nearest is the best of those with the depth.
    let nearest = found.nearest().expect("all are possible");
    assert_eq!(nearest.broken.len(), 1, "{nearest:?}");
    assert!(
        !found.front(DesignFigure::DepthOfField).is_empty(),
        "a front of the possible"
    );
}

#[test]
fn set_ups_that_cannot_be_are_told_and_left_out() {
    // A lens nearer than its focal length has no image.
    let sweeps = vec![list(SetupQuantity::Distance, &[0.02, 0.3])];
    let found = outcome(question(sweeps, &[]));
    let why = found.candidates()[0].figures.as_ref().unwrap_err();
    assert!(why.to_string().contains("distance"), "{why}");
    assert_eq!(found.counts(), (1, 1));
    assert_eq!(found.best(2).len(), 1);
    assert_eq!(found.front(DesignFigure::DepthOfField)[0].index, 1);
}

#[test]
fn the_outcome_is_the_same_for_any_number_of_threads() {
    let sweeps = vec![
        list(SetupQuantity::FNumber, &[4.0, 8.0, 16.0]),
        list(SetupQuantity::Angle, &[0.3, 0.5]),
    ];
    let asked = question(sweeps, &[(DesignFigure::DepthOfField, 0.06)]);
    let with = |threads: usize| {
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads").install(|| outcome(asked.clone()))
    };
    let one = with(1);
    for threads in [2, 7] {
        assert_eq!(with(threads), one, "{threads} threads");
    }
}

#[test]
fn searches_that_ask_for_too_much_or_nothing_are_refused() {
    let sweep = |steps| {
        let ends = (4.0, 16.0);
        Sweep::between(SetupQuantity::FNumber, ends, steps, Spacing::Linear).expect("valid")
    };
    let angles = |steps| {
        Sweep::between(SetupQuantity::Angle, (0.3, 0.9), steps, Spacing::Linear).expect("valid")
    };
    let message = |sweeps, constraints: &[(DesignFigure, f64)]| {
        let search = DesignSearch::new(question(sweeps, constraints));
        search.unwrap_err().to_string()
    };
    let many = message(vec![sweep(100), angles(11)], &[]);
    assert!(
        many.contains("max_setups") && many.contains("1100"),
        "{many}"
    );
    assert!(
        message(vec![sweep(2), sweep(3)], &[]).contains("varied once"),
        "twice"
    );
    assert!(message(Vec::new(), &[]).contains("varied"), "nothing");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let bound = message(vec![sweep(2)], &[(DesignFigure::Range, bad)]);
        assert!(bound.contains("range"), "{bound}");
    }
    // The number itself must not overflow.
    let ten_thousand =
        |parameter| Sweep::between(parameter, (0.3, 0.9), 10_000, Spacing::Linear).expect("valid");
    let all = SetupQuantity::varied()
        .into_iter()
        .map(ten_thousand)
        .collect();
    assert!(message(all, &[]).contains("max_setups"), "10³⁶ set-ups");
}

#[test]
fn a_search_that_is_cancelled_ends() {
    let search = DesignSearch::new(question(vec![list(SetupQuantity::FNumber, &[8.0])], &[]));
    let ended = search.expect("valid").run(|_| (), &AtomicBool::new(true));
    assert_eq!(ended, Err(TriangulationError::Cancelled));
}

#[test]
fn neighbours_differ_in_one_parameter() {
    let description = base();
    let near = neighbours(&description, 0.1);
    // All but the linewidth and the extent of its laser, which has none.
    assert_eq!(near.len(), SetupQuantity::varied().len() - 2);
    let mut wide = description.clone();
    wide.laser.light.linewidth = 5e-9;
    let near_wide = neighbours(&wide, 0.1);
    let linewidth = near_wide
        .iter()
        .find(|near| near.parameter == SetupQuantity::Linewidth)
        .expect("it has one");
    let [less, more] = [&linewidth.less, &linewidth.more].map(|near| {
        let near = near.as_ref().expect("possible");
        contribution(near, UncertaintySource::Speckle)
    });
    assert!(more < less, "{more:e} m with more, {less:e} m with less");
    let power = near
        .iter()
        .find(|near| near.parameter == SetupQuantity::Power)
        .expect("all parameters are there");
    let more = power.more.as_ref().expect("possible");
    let shot = |figures: &DesignFigures| contribution(figures, UncertaintySource::ShotNoise);
    // Shot noise falls as the root of the power, speckle does not know of it: to the rounding of
    // columns of f32, 6e-8.
    let ratio = shot(more) / shot(&figures(&description));
    assert_relative_eq!(ratio, 1.1_f64.sqrt().recip(), max_relative = 1e-7);
    assert_relative_eq!(
        contribution(more, UncertaintySource::Speckle),
        contribution(&figures(&description), UncertaintySource::Speckle),
        max_relative = 1e-7
    );
}

#[test]
fn the_detector_of_the_base_is_the_one_that_is_judged() {
    let mut description = base();
    let wide = figures(&description).uncertainty;
    description.detector.method = LineMethod::Parabola;
    let narrow = figures(&description).uncertainty;
    assert!(narrow > 1.2 * wide, "{narrow} against {wide}");
}
