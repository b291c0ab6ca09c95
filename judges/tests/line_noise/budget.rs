//! The budget of a set-up against images of a rough surface that are summed wave by wave.

use core::sync::atomic::AtomicBool;

use tem00::{
    triangulation::{
        Budget, BudgetTerm, DetectorSettings, ImagedLine, LineDetector, Setup, SimulationOptions,
        UncertaintySource, parse_setup, simulate,
    },
    wave::{
        Amplitudes, Arrangement, Camera, DVec2, DVec3, FanDescription, Grid, Illumination,
        ImageSampling, ImageWindow, Lens, PatchDescription, RoughSurface, Roughness,
    },
};

/// Pixels along each side of an image.
const PIXELS: usize = 64;

/// Samples of a pixel along each side: five to a speckle.
const SAMPLES: usize = 3;

/// Pixels at each end of the line that are not looked at: four speckles.
const END: usize = 7;

const WAVELENGTH: f64 = 660e-9;
const PITCH: f64 = 3.45e-6;
const DISTANCE: f64 = 0.3;

/// A lens of 25 mm at f/8, 0.3 m from a line of this width that is seen at 30°.
fn setup(line_thickness: &str, window: usize) -> Setup {
    let text = format!(
        r#"
        laser = {{ wavelength = "660 nm", power = "10 mW", line_thickness = "{line_thickness}", line_length = "70 mm" }}
        surface = {{ reflectance = 0.4 }}
        sensor = {{ quantum_efficiency = 0.6, exposure = "0.06 ms" }}
        detector = {{ method = "centre_of_gravity", window = {window} }}
        [camera]
        focal_length = "25 mm"
        f_number = 8
        pixel_pitch = "3.45 um"
        resolution = [640, 480]
        distance = "300 mm"
        angle = "30 deg"
        "#
    );
    parse_setup(&text).expect("a set-up")
}

/// A camera that sees such a line, from above, as wide and with speckle as large.
struct Waves {
    window: ImageWindow,
    light: Illumination,
    patch: PatchDescription,
}

impl Waves {
    fn of(line: &ImagedLine) -> Self {
        let lens = Lens {
            pupil_diameter: 25e-3 / 8.0,
            focus_distance: DISTANCE,
            pupil_to_image: line.speckle_size[1] * PITCH * 25e-3 / 8.0 / WAVELENGTH,
        };
        let eye = DVec3::new(0.0, 0.0, DISTANCE);
        let camera = Camera::look_at([eye, DVec3::ZERO], DVec3::Y, lens).expect("a camera");
        let sampling = ImageSampling {
            wavelength: WAVELENGTH,
            centre: DVec2::ZERO,
            step: PITCH / SAMPLES as f64,
            samples: PIXELS * SAMPLES,
        };
        // On the part, in units of a pixel.
        let pixel = PITCH * DISTANCE / lens.pupil_to_image;
        let radius = 0.5 * line.projected_thickness;
        let speckle = line.speckle_size[1];
        let light = Illumination::fan(&FanDescription {
            wavelength: WAVELENGTH,
            apex: DVec3::Z,
            direction: DVec3::NEG_Z,
            opening: DVec3::Y,
            half_angle: 0.1,
            waist_radius: radius * pixel,
            waist_distance: 1.0,
        });
        // Independent scatterers so close that the squared pupil function does not see their lattice, out
        // to 1e-4 of the irradiance.
        let [across, along] = [4.4 * radius, 60.0];
        let spacing = [(0.5 * radius).min(0.75 * speckle), 0.8 * speckle];
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "small numbers"
        )]
        let scatterers = [across / spacing[0], along / spacing[1]].map(|n| n.ceil() as usize);
        Self {
            window: ImageWindow::new(&camera, &sampling).expect("a window"),
            light: light.expect("a line"),
            patch: PatchDescription {
                centre: DVec3::ZERO,
                normal: DVec3::Z,
                along: DVec3::X,
                size: [across * pixel, along * pixel],
                scatterers,
                arrangement: Arrangement::Lattice,
                roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
                seed: 0,
            },
        }
    }

    /// Returns what pixels see of one surface, in rows across the line, and the place of the line in them.
    ///
    /// `phase` moves the pixels by as many samples.
    fn rows(&self, seed: u64, phase: usize) -> (Grid<f32>, f64) {
        let surface = RoughSurface::patch(&PatchDescription { seed, ..self.patch });
        let lit = surface.expect("a surface").lit_by(&self.light);
        let image = self.window.image(&lit).intensity();
        let pixel = |x: usize, y: usize| {
            let samples = (0..SAMPLES * SAMPLES).map(|i| {
                let (column, row) = (i % SAMPLES, i / SAMPLES);
                let column = (SAMPLES * x + column + phase) % image.width();
                image[(column, SAMPLES * (y + END) + row)]
            });
            samples.sum::<f32>()
        };
        let rows = Grid::from_fn(PIXELS, PIXELS - 2 * END, pixel);
        // Sample i is the middle of the i-th part of the row.
        let middle = (image.width() / 2 - phase) as f64 + 0.5;
        (rows, middle / SAMPLES as f64)
    }
}

/// Returns the mean square of how far the detector finds lines from where they are, in pixels, for each
/// of some images.
fn squares(setup: &Setup, images: u64) -> Vec<f64> {
    let waves = Waves::of(setup.line());
    let detector = LineDetector::new(DetectorSettings {
        min_peak: 0.0,
        saturation: f64::INFINITY,
        ..*setup.detector().settings()
    });
    let detector = detector.expect("a detector");
    let of_image = |seed: u64| {
        let phase = usize::try_from(seed).expect("a small number") % SAMPLES;
        let (rows, middle) = waves.rows(seed, phase);
        let places = detector.detect_rows(&rows).into_iter().map(|points| {
            let brightest = points.into_iter().max_by(|a, b| a.peak.total_cmp(&b.peak));
            brightest.expect("a line").position
        });
        let squares = places.map(|place| (place - middle).powi(2));
        squares.sum::<f64>() / rows.height() as f64
    };
    (0..images).map(of_image).collect()
}

/// Returns the root of the mean, and its standard error.
fn root_mean(squares: &[f64]) -> [f64; 2] {
    let count = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / count;
    let scatter: f64 = squares.iter().map(|s| (s - mean).powi(2)).sum();
    let error = (scatter / (count * (count - 1.0))).sqrt();
    [mean.sqrt(), 0.5 * error / mean.sqrt()]
}

/// Holds trials and formula to waves; the formula may say too much by the part `excess`.
fn judge(line_thickness: &str, window: usize, images: u64, excess: f64) {
    let setup = setup(line_thickness, window);
    let [waves, error] = root_mean(&squares(&setup, images));
    let budget = Budget::new(&setup).expect("a line");
    let speckle = |term: &&BudgetTerm| term.source == UncertaintySource::Speckle;
    let formula = budget.terms().iter().find(speckle).expect("a term");
    let formula = formula.uncertainty;
    let options = SimulationOptions {
        trials: 150,
        seed: 5,
    };
    let trials = simulate(&setup, options, |_| (), &AtomicBool::new(false)).expect("trials");
    let trials = trials.term(UncertaintySource::Speckle).expect("a term");
    let per_pixel = setup.line().height_per_pixel.abs();
    let [tried, error_of_trials] =
        [trials.uncertainty, trials.standard_error].map(|u| u / per_pixel);
    let found = format!(
        "{line_thickness}: waves {waves:.4} ± {error:.4}, trials {tried:.4} ± {error_of_trials:.4}, formula \
         {formula:.4} pixels"
    );
    let chance = 3.3 * error.hypot(error_of_trials);
    assert!((tried - waves).abs() < chance, "{found}");
    let chance = 3.3 * error;
    let allowed = waves - chance..(1.0 + excess) * waves + chance;
    assert!(allowed.contains(&formula), "{found}, allowed {allowed:?}");
}

// h = 1.67 pixels. The noise of some 34 independent rows in each of 300 images is known to 0.7 %, that of 150
// trials too. With an image of the line that has no wings and a window at rest the formula is 3.6 % low for
// the line of a speckle, and trials with a pattern times that image are 6 %.

#[test]
fn the_budget_of_a_line_of_a_speckle_is_that_of_waves() {
    // w = 1.4 h
    judge("0.2 mm", 21, 300, 0.0);
}

#[test]
fn the_budget_of_a_wide_line_is_that_of_waves() {
    // w = 4.1 h
    judge("0.6 mm", 31, 300, 0.0);
}

#[test]
fn the_budget_of_a_thin_line_is_that_of_waves_and_its_formula_on_the_safe_side() {
    // w = 0.41 h: a pattern times the blurred line moves it farther.
    judge("0.06 mm", 21, 300, 0.1);
}
