//! Correlation of the speckle in the image, when the pattern is looked up where the laws say.

use core::f64::consts::{PI, TAU};

use tem00::{
    decorrelation::{
        self, CameraFrame, Configuration, ConfigurationData, ImagingGeometry, PupilDistances,
        SpeckleMotion, axial_correlation, pupil_overlap_correlation,
    },
    numerics::Fft2,
    wave::{
        Amplitudes, Arrangement, Camera, Complex, DVec2, DVec3, Estimate, FieldCorrelation, Grid,
        Illumination, Lens, PatchDescription, RigidMotion, RoughSurface, Roughness,
    },
};

use super::{
    geometries::v,
    scene::{Motion, States, WAVELENGTH},
};

const DISTANCE: f64 = 0.3;
const PUPIL_TO_IMAGE: f64 = 0.06;

/// Sides of patch and image, in speckle sizes. Of the even numbers below 50, it is the one for
/// which lattice points count the area of a disc best.
const WIDTH: usize = 40;

/// Lattice points of the pupil along a side, with a rim to spare.
const PUPIL: usize = WIDTH + 3;

/// A camera straight before a patch in focus whose image fills the window.
///
/// The image is that of the rays through a lattice of pupil points, D/[`WIDTH`] apart, so that it
/// repeats with the period of the patch: what the edge cuts off on one side of an image point is
/// seen again from the other. So it is the image of a surface without an edge, of which even a
/// patch of 30 speckles would lack some percent of the light. Displacements by whole steps of the
/// lattice are exact.
struct Bench {
    pupil_diameter: f64,
    to_source: DVec3,
}

/// A second state.
#[derive(Clone, Copy, Default)]
struct State {
    motion: Motion,
    /// Where the pattern is looked up beside the projected surface, in speckle sizes.
    aside: DVec2,
}

impl Bench {
    fn speckle_size(&self) -> f64 {
        WAVELENGTH * PUPIL_TO_IMAGE / self.pupil_diameter
    }

    /// The speckle size on the surface.
    fn cell(&self) -> f64 {
        WAVELENGTH * DISTANCE / self.pupil_diameter
    }

    fn geometry(&self) -> ImagingGeometry {
        ImagingGeometry::from_distances(PupilDistances {
            wavelength: WAVELENGTH,
            surface_to_pupil: DISTANCE,
            pupil_to_image: PUPIL_TO_IMAGE,
            pupil_diameter: self.pupil_diameter,
            pixel_pitch: 1e-6,
        })
        .expect("a camera")
    }

    fn law(&self, motion: &Motion) -> SpeckleMotion {
        let eye = v(0.0, 0.0, DISTANCE);
        let before = Configuration::new(ConfigurationData {
            wavelength: WAVELENGTH,
            point: DVec3::ZERO,
            normal: DVec3::Z,
            illumination: decorrelation::Illumination::collimated(self.to_source).expect("light"),
            camera: CameraFrame::look_at(eye, DVec3::ZERO, DVec3::Y).expect("a frame"),
            pupil: eye,
        })
        .expect("a configuration");
        let after = States::from(*motion).after(&before);
        SpeckleMotion::between(&self.geometry(), &before, &after)
    }

    fn camera(&self) -> Camera {
        let lens = Lens {
            pupil_diameter: self.pupil_diameter,
            focus_distance: DISTANCE,
            pupil_to_image: PUPIL_TO_IMAGE,
        };
        let places = [v(0.0, 0.0, DISTANCE), DVec3::ZERO];
        Camera::look_at(places, DVec3::Y, lens).expect("a camera")
    }

    fn surface(&self, seed: u64) -> RoughSurface {
        RoughSurface::patch(&PatchDescription {
            centre: DVec3::ZERO,
            normal: DVec3::Z,
            along: DVec3::X,
            size: [WIDTH as f64 * self.cell(); 2],
            // Half a speckle size apart, and independent: every product of two amplitudes in the
            // image is sampled finely enough to have the mean of a continuous surface.
            scatterers: [2 * WIDTH; 2],
            arrangement: Arrangement::Lattice,
            roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
            seed,
        })
        .expect("a patch")
    }

    /// The image of the patch in a state, at the same points of the surface before and after a
    /// motion, half a speckle size apart.
    ///
    /// A picture in which the point X is the middle is the Fourier transform of the field on the
    /// pupil times exp(−ik |p − X'|), where X' is in focus and seen in the direction of X.
    fn image(&self, surface: &RoughSurface, state: &State) -> Grid<Complex<f64>> {
        let camera = self.camera().moved(&along(state.motion.camera));
        let seen = state.motion.surface - state.motion.camera;
        let scale = 1.0 - seen.z / DISTANCE;
        let aside = state.aside * self.cell() * scale;
        let in_focus = (state.motion.surface + aside.extend(0.0) - camera.pupil_centre()) / scale;

        let light = Illumination::plane(WAVELENGTH, -self.to_source).expect("a plane wave");
        let lit = surface.moved(&along(state.motion.surface)).lit_by(&light);
        let step = self.pupil_diameter / WIDTH as f64 * scale;
        let plane = camera.pupil_plane(step, PUPIL).expect("a plane");
        // Points on the rim are inside, however they are rounded.
        let radius = 0.50005 * self.pupil_diameter;
        let plane = plane.within(radius).expect("a stop");
        let field = lit.field_on(&plane);
        let focused = Grid::from_fn(PUPIL, PUPIL, |x, y| {
            let path = (plane.point(x, y) - camera.pupil_centre()).distance(in_focus);
            let phasor = Complex::from_polar(1.0, -TAU * (path / WAVELENGTH).fract());
            let value = field.amplitude()[(x, y)] * phasor;
            #[expect(
                clippy::cast_possible_truncation,
                reason = "the transform works in f32"
            )]
            Complex::new(value.re as f32, value.im as f32)
        });
        let transform =
            Fft2::with_aperture(2 * WIDTH, 2 * WIDTH, PUPIL, PUPIL).expect("a transform");
        transform.forward(&focused, |_, _, value: Complex<f32>| {
            Complex::new(f64::from(value.re), f64::from(value.im))
        })
    }

    /// Shows the image at rest and that of each state in turn, for some surfaces.
    fn compare(
        &self,
        states: &[State],
        repetitions: u64,
        mut judge: impl FnMut(usize, &Grid<Complex<f64>>, &Grid<Complex<f64>>),
    ) {
        for seed in 1..=repetitions {
            let surface = self.surface(seed);
            let before = self.image(&surface, &State::default());
            for (index, state) in states.iter().enumerate() {
                judge(index, &before, &self.image(&surface, state));
            }
        }
    }

    /// Measures what is left of the intensities of each state.
    fn intensity_correlations(&self, states: &[State], repetitions: u64) -> Vec<Estimate> {
        let mut sums = vec![Vec::new(); states.len()];
        self.compare(states, repetitions, |index, before, after| {
            sums[index].push(Sums::of(before, after));
        });
        sums.iter().map(|sums| jackknife(sums)).collect()
    }
}

fn along(translation: DVec3) -> RigidMotion {
    RigidMotion::translation(translation).expect("a translation")
}

/// Sums over the samples of one repetition: 1, a, b, aa, ab, bb.
#[derive(Clone, Copy, Default)]
struct Sums([f64; 6]);

impl Sums {
    fn of(first: &Grid<Complex<f64>>, second: &Grid<Complex<f64>>) -> Self {
        let mut sums = [0.0; 6];
        for (a, b) in first.values().iter().zip(second.values()) {
            let (a, b) = (a.norm_sqr(), b.norm_sqr());
            for (sum, term) in sums.iter_mut().zip([1.0, a, b, a * a, a * b, b * b]) {
                *sum += term;
            }
        }
        Self(sums)
    }

    fn plus(self, other: Self, sign: f64) -> Self {
        Self(core::array::from_fn(|i| self.0[i] + sign * other.0[i]))
    }

    fn correlation(self) -> f64 {
        let [n, a, b, aa, ab, bb] = self.0;
        (n * ab - a * b) / ((n * aa - a * a) * (n * bb - b * b)).sqrt()
    }
}

/// The correlation over all repetitions, and its standard error from leaving out one at a time.
fn jackknife(repetitions: &[Sums]) -> Estimate {
    let total = repetitions
        .iter()
        .fold(Sums::default(), |sum, &one| sum.plus(one, 1.0));
    let without = |&one: &Sums| total.plus(one, -1.0).correlation();
    let partial: Vec<_> = repetitions.iter().map(without).collect();
    let spread = Estimate::of_repetitions(&partial).expect("repetitions");
    Estimate {
        value: total.correlation(),
        standard_error: spread.standard_error * (partial.len() - 1) as f64,
    }
}

/// Asserts that a measured correlation is within four standard errors of a law: a correct law fails
/// with a probability of 6e-5.
fn assert_agrees(name: &str, measured: Estimate, law: f64) {
    // A lattice of 40 points across counts the area of a disc to 6e-4.
    let error = measured.standard_error.hypot(3e-4);
    let deviation = (measured.value - law) / error;
    assert!(
        deviation.abs() < 4.0,
        "{name}: {measured:?}, law {law:.4}: {deviation:.1} errors"
    );
}

/// Asserts that a measured correlation is more than six standard errors from a number.
fn assert_refutes(name: &str, measured: Estimate, number: f64) {
    let deviation = (measured.value - number) / measured.standard_error;
    assert!(
        deviation.abs() > 6.0,
        "{name}: {measured:?}, not {number:.4}: {deviation:.1} errors"
    );
}

#[test]
fn sideways_motion_leaves_the_overlap_of_the_pupils() {
    let bench = Bench {
        pupil_diameter: 4e-3,
        to_source: v(1.0, 0.0, 1.0),
    };
    let part = |x: f64, y: f64| v(x, y, 0.0) * bench.pupil_diameter;
    let state = |surface, camera| State {
        motion: Motion {
            surface,
            camera,
            ..Motion::default()
        },
        aside: DVec2::ZERO,
    };
    let still = DVec3::ZERO;
    let cases = [
        ("surface 0.1 D", state(part(0.1, 0.0), still), 0.1),
        ("surface 0.25 D", state(part(0.25, 0.0), still), 0.25),
        ("surface 0.5 D", state(part(0.0, 0.5), still), 0.5),
        ("surface 0.75 D", state(part(0.6, 0.45), still), 0.75),
        ("camera 0.25 D", state(still, part(0.0, 0.25)), 0.25),
        ("camera 0.5 D", state(still, part(0.3, 0.4)), 0.5),
        ("opposite", state(part(0.25, 0.0), part(-0.25, 0.0)), 0.5),
        ("together", state(part(0.5, 0.0), part(0.5, 0.0)), 0.0),
    ];
    let measured = bench.intensity_correlations(&cases.map(|case| case.1), 12);
    for ((name, _, shift), measured) in cases.into_iter().zip(measured) {
        assert_agrees(name, measured, pupil_overlap_correlation(shift));
    }
}

#[test]
fn motion_along_the_axis_leaves_a_squared_sinc_with_its_zero_at_twice_the_printed_length() {
    let bench = Bench {
        pupil_diameter: 30e-3,
        to_source: DVec3::Z,
    };
    let geometry = bench.geometry();
    // a_O is the motion in units of the printed length.
    let printed = tem00_paper::axial_decorrelation_length(&geometry);
    let motions = [0.25, 0.5, 1.0, 1.5, 2.0, 2.5, -1.0];
    let state = |a_o: &f64| State {
        motion: Motion {
            surface: v(0.0, 0.0, a_o * printed),
            ..Motion::default()
        },
        aside: DVec2::ZERO,
    };
    let mut correlations = vec![FieldCorrelation::default(); motions.len()];
    bench.compare(
        &motions.each_ref().map(state),
        12,
        |index, before, after| {
            correlations[index].add(before, after);
        },
    );
    let mut all = Vec::new();
    for (a_o, correlation) in motions.into_iter().zip(correlations) {
        let measured = correlation.estimate().expect("repetitions");
        let shift = a_o * printed / geometry.axial_decorrelation_length();
        assert_agrees(&format!("a_O = {a_o}"), measured, axial_correlation(shift));
        all.push(measured);
    }
    // Where the paper takes the speckle for decorrelated, 4/π² are left.
    let at_printed_length = all[2];
    assert_agrees("printed length", at_printed_length, 4.0 / (PI * PI));
    assert_refutes("printed length", at_printed_length, 0.0);
}

#[test]
fn motion_aside_and_along_the_axis_leaves_what_the_law_says() {
    let bench = Bench {
        pupil_diameter: 30e-3,
        to_source: DVec3::Z,
    };
    let length = bench.geometry().axial_decorrelation_length();
    let shifts = [
        [0.2, 0.0, 0.65],
        [0.1, 0.2, -0.5],
        [0.0, -0.4, 0.8],
        [-0.3, 0.1, 0.3],
    ];
    let motions = shifts.map(|[x, y, along]| Motion {
        surface: v(
            x * bench.pupil_diameter,
            y * bench.pupil_diameter,
            along * length,
        ),
        ..Motion::default()
    });
    let laws = motions.map(|motion| bench.law(&motion));
    let states = [0, 1, 2, 3].map(|i| State {
        motion: motions[i],
        aside: laws[i].defocus_displacement / bench.speckle_size(),
    });
    // The pattern of an approaching surface moves against its displacement on the pupil, by 4 s x.
    for (state, [x, y, along]) in states.iter().zip(shifts) {
        let expected = -4.0 * along * DVec2::new(x, y);
        assert!((state.aside - expected).length() < 0.02, "{}", state.aside);
    }
    let measured = bench.intensity_correlations(&states, 16);
    for ((shift, law), measured) in shifts.iter().zip(laws).zip(&measured) {
        assert_agrees(&format!("{shift:?}"), *measured, law.correlation);
    }
    // Beside its peak less is left: the product of the laws of either motion is that of neither
    // place.
    let product = pupil_overlap_correlation(0.2) * axial_correlation(0.65);
    assert_refutes("product at the peak", measured[0], product);
}
