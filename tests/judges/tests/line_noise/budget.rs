//! The budget of a set-up against images of a rough surface that are summed wave by wave.

use core::sync::atomic::AtomicBool;

use tem00::{
    numerics::Grid,
    scan::SetupSensor,
    topography::{Artefact, ProfileSensor, Shape},
    triangulation::{
        Budget, BudgetTerm, ImagedLine, LineImage, LineImageData, Setup, UncertaintySource,
        parse_setup,
    },
    wave::DVec3,
};

use tem00_testkit::assert_absolute;

use super::line_by_waves::{Judged, PIXELS, Waves};

/// A set-up, and the heights at which it is judged.
struct Case {
    laser: &'static str,
    camera: &'static str,
    /// The full width of the line on the part.
    thickness: &'static str,
    windows: &'static [usize],
    columns: usize,
    /// In millimetres.
    heights: [f64; 5],
    images: u64,
}

impl Case {
    fn setup(&self, window: usize, columns: usize) -> Setup {
        let Self {
            laser,
            camera,
            thickness,
            ..
        } = self;
        let text = format!(
            r#"
            laser = {{ {laser}, power = "10 mW", line_thickness = "{thickness}", line_length = "70 mm" }}
            camera = {{ {camera}, resolution = [640, 480] }}
            surface = {{ reflectance = 0.4 }}
            sensor = {{ quantum_efficiency = 0.6, exposure = "auto" }}
            detector = {{ method = "centre_of_gravity", window = {window} }}
            average = {{ columns = {columns} }}
            "#
        );
        parse_setup(&text).expect("a set-up")
    }
}

/// The root of the mean of squares of deviations, averaged over neighbouring columns, and its
/// standard error.
fn root_mean(deviations: &[Vec<f64>], columns: usize) -> [f64; 2] {
    let squares: Vec<f64> = deviations
        .iter()
        .map(|of_image| {
            let groups = of_image.chunks_exact(columns);
            let count = groups.len() as f64;
            let squares = groups.map(|group| (group.iter().sum::<f64>() / columns as f64).powi(2));
            squares.sum::<f64>() / count
        })
        .collect();
    let count = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / count;
    let scatter: f64 = squares.iter().map(|s| (s - mean).powi(2)).sum();
    let error = (scatter / (count * (count - 1.0))).sqrt();
    [mean.sqrt(), 0.5 * error / mean.sqrt()]
}

/// Holds trials and formula to waves at all heights, in all windows, for single columns and for
/// means of some; `formula` says how far below and above waves it may be.
///
/// Returns the deviation of single columns in the middle by waves, and its standard error.
fn judge(case: &Case, formula: [f64; 2]) -> [f64; 2] {
    let (mut wrong, mut at_heights) = (Vec::new(), Vec::new());
    for height in case.heights {
        let judged = |window| Judged::new(&case.setup(window, 1), 1e-3 * height);
        let lines = judged(case.windows[0]);
        let images = [
            Waves::images(&lines, case.images),
            trials(&lines.line, case.images),
        ];
        at_heights.push(root_mean(&lines.deviations(&images[0]), 1));
        for &window in case.windows {
            let judged = judged(window);
            let deviations = images.each_ref().map(|images| judged.deviations(images));
            for columns in [1, case.columns] {
                let [[by_waves, error], [tried, error_of_trials]] =
                    deviations.each_ref().map(|all| root_mean(all, columns));
                let setup = case.setup(window, columns);
                let budget = Budget::at_height(&setup, 1e-3 * height).expect("a line");
                let law = budget.contribution(UncertaintySource::Speckle);
                let law = law / judged.line.height_per_pixel.abs();
                let found = format!(
                    "{height} mm, window {window}, {columns} columns, blur {:.1} px: waves \
                     {by_waves:.4} ± {error:.4}, trials {tried:.4} ± {error_of_trials:.4}, formula \
                     {law:.4} px",
                    judged.line.blur
                );
                let chance = 3.3 * error.hypot(error_of_trials) / by_waves;
                let far = (tried / by_waves - 1.0).abs() > 0.03 + chance;
                let [below, above] = formula;
                let allowed = 1.0 - below - chance..1.0 + above + chance;
                if far || !allowed.contains(&(law / by_waves)) {
                    wrong.push(found);
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    at_heights[2]
}

/// Holds the heights of a level flat on the reference plane, as `characterise` measures it, to
/// waves and the noise of the sensor.
fn judge_characteristics(case: &Case, [speckle, error]: [f64; 2]) {
    let setup = case.setup(case.windows[0], 1);
    let judged = Judged::new(&setup, 0.0);
    let budget = Budget::new(&setup).expect("a line");
    let of_sensor = |term: &&BudgetTerm| term.source != UncertaintySource::Speckle;
    let of_sensor = budget.terms().iter().filter(of_sensor);
    let squares = of_sensor.map(|term| term.uncertainty.powi(2));
    let expected = (speckle * speckle + squares.sum::<f64>()).sqrt();
    let cancel = AtomicBool::new(false);
    let mut sensor = SetupSensor::new(&setup, 8, 1, &|_| (), &cancel);
    let flat = Artefact {
        name: "flat",
        shape: Shape::Flat { slope: [0.0; 2] },
        size: [PIXELS as f64 * sensor.field().column, 0.2],
    };
    let count = u32::try_from(case.images).expect("a small number");
    let places: Vec<_> = (0..count)
        .map(|i| DVec3::new(0.0, 1e-3 * f64::from(i), 0.0))
        .collect();
    let profiles = sensor.measure(&flat, &places).expect("profiles");
    let per_pixel = judged.line.height_per_pixel;
    let heights = profiles.iter().map(|profile| {
        // The ends of the flat are edges.
        let inside = &profile[judged.ends()..profile.len() - judged.ends()];
        inside
            .iter()
            .map(|point| point.position.z / per_pixel)
            .collect()
    });
    let [measured, error_of_measured] = root_mean(&heights.collect::<Vec<_>>(), 1);
    let chance = 3.3 * error.hypot(error_of_measured);
    assert_absolute(measured, expected, 0.03 * expected + chance);
}

/// Returns images that are drawn as trials draw them, each with the place of its line.
fn trials(line: &ImagedLine, images: u64) -> Vec<(Grid<f32>, f64)> {
    let image = LineImage::new(LineImageData {
        size: [PIXELS, PIXELS],
        width: line.projected_thickness,
        blur: line.blur,
        column_electrons: 1e6,
        speckle_size: line.speckle_size,
        sensitive_side: line.sensitive_height,
        patterns: 1,
        polarisation: 1.0,
    });
    let image = image.expect("a line");
    let of_image = |seed: u64| {
        let middle = 0.5 * PIXELS as f64 + (0.618 * seed as f64).fract();
        (image.speckled(seed, |_| middle).expect("a pattern"), middle)
    };
    (0..images).map(of_image).collect()
}

/// Red light on a lens at f/8, 0.3 m away: speckle of 1.67 pixels. The narrow window holds half of
/// the blurred line's width on either side, and a little.
const RED: Case = Case {
    laser: r#"wavelength = "660 nm""#,
    camera: r#"focal_length = "25 mm", f_number = 8, pixel_pitch = "3.45 um", distance = "300 mm", angle = "30 deg""#,
    thickness: "0.2 mm",
    windows: &[21, 15],
    columns: 4,
    heights: [-14.0, -7.0, 0.0, 7.0, 14.0],
    images: 100,
};

/// Green light on a lens at f/5.6, 0.11 m away: speckle of 0.71 pixels, blurred over up to nine of
/// them.
const GREEN: Case = Case {
    laser: r#"wavelength = "520 nm""#,
    camera: r#"focal_length = "16 mm", f_number = 5.6, pixel_pitch = "4.8 um", distance = "110 mm", angle = "32 deg""#,
    thickness: "0.15 mm",
    windows: &[25],
    columns: 4,
    heights: [-6.0, -3.0, 0.0, 3.0, 8.0],
    images: 60,
};

/// Blue light on a small pupil: speckle of 2.2 pixels.
const BLUE: Case = Case {
    laser: r#"wavelength = "405 nm""#,
    camera: r#"focal_length = "35 mm", f_number = 16, pixel_pitch = "3.45 um", distance = "220 mm", angle = "25 deg""#,
    thickness: "0.1 mm",
    windows: &[25],
    columns: 6,
    heights: [-12.0, -6.0, 0.0, 6.0, 12.0],
    images: 100,
};

#[test]
fn the_budget_of_a_line_of_a_speckle_is_that_of_waves() {
    let middle = judge(&RED, [0.05; 2]);
    judge_characteristics(&RED, middle);
}

#[test]
fn the_budget_of_a_wide_line_is_that_of_waves() {
    // w = 4.1 h
    let wide = Case {
        thickness: "0.6 mm",
        windows: &[31],
        ..RED
    };
    judge(&wide, [0.05; 2]);
}

#[test]
fn the_budget_of_a_line_far_out_of_focus_is_that_of_waves() {
    let middle = judge(&GREEN, [0.05; 2]);
    judge_characteristics(&GREEN, middle);
}

#[test]
fn the_budget_of_a_line_a_speckle_wide_in_front_of_a_fast_lens_is_that_of_waves() {
    // w = 1.3 h
    let thin = Case {
        thickness: "0.06 mm",
        heights: [-4.0, -2.0, 0.0, 2.0, 4.0],
        ..GREEN
    };
    judge(&thin, [0.05; 2]);
}

#[test]
fn the_budget_of_a_line_in_blue_light_is_that_of_waves() {
    let middle = judge(&BLUE, [0.05; 2]);
    judge_characteristics(&BLUE, middle);
}

#[test]
fn trials_of_a_thin_line_are_those_of_waves_and_its_formula_says_too_little() {
    // w = 0.41 h: weak columns, whose position is nearly free, are not of first order.
    let thin = Case {
        thickness: "0.06 mm",
        windows: &[21],
        ..RED
    };
    judge(&thin, [0.25, 0.0]);
}
