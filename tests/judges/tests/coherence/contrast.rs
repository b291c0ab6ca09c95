//! The contrast, over random geometries and in scenes whose numbers are known.

use core::f64::consts::TAU;

use tem00::{
    coherence::{CellGeometry, PeakShape, PolychromaticSpeckle, Relief, ResolutionCell, Spectrum},
    wave::DVec3,
};

use super::{
    bench::{Bench, BenchSpectrum, View, plane_of_incidence, weights},
    comparison::Comparison,
    heights::{Heights, Random},
    sums::{Moments, assert_agrees, contrast, covariance, for_surfaces},
};

/// Wave numbers on each side of the mean one.
pub(crate) const STEPS: i32 = 10;

pub(crate) fn cell(view: CellGeometry, rms_height: f64, defocus: f64) -> ResolutionCell {
    let relief = Relief {
        rms_height,
        correlation_length: 0.0,
    };
    ResolutionCell::new(view)
        .and_then(|cell| cell.with_relief(relief))
        .and_then(|cell| cell.with_defocus(defocus))
        .expect("a cell")
}

/// Lines of all shapes, some steps between wave numbers wide.
pub(crate) fn spectra(wavelength: f64, step: f64) -> Vec<BenchSpectrum> {
    let per_step = step * wavelength.powi(2) / TAU;
    let peaks = |weights: &[f64]| {
        let peak = |(i, &weight): (usize, &f64)| {
            let steps = i as f64 - f64::from(STEPS);
            [TAU / (TAU / wavelength + steps * step), weight]
        };
        let lit = weights
            .iter()
            .enumerate()
            .filter(|(_, weight)| **weight > 0.0);
        Spectrum::from_peaks(&lit.map(peak).collect::<Vec<_>>()).expect("peaks")
    };
    let of_peaks = |name, shape: &dyn Fn(f64) -> f64| {
        let weights = weights(STEPS, shape);
        let line = peaks(&weights);
        BenchSpectrum {
            name,
            weights,
            line,
        }
    };
    let full_width = 9.0;
    let rectangular = Spectrum::new(wavelength, full_width * per_step, PeakShape::Rectangular);
    let comb = Spectrum::comb(wavelength, 16.0 * per_step, 5);
    let inside = |is_inside: bool| f64::from(u8::from(is_inside));
    vec![
        // 3.4 standard deviations on each side.
        BenchSpectrum::gaussian(wavelength, step, STEPS, 7.0 * per_step),
        BenchSpectrum {
            name: "rectangular",
            weights: weights(STEPS, |i| inside(2.0 * i.abs() < full_width)),
            line: rectangular.expect("a line"),
        },
        BenchSpectrum {
            name: "comb",
            weights: weights(STEPS, |i| inside(i.abs() < 9.0 && i.rem_euclid(4.0) < 0.5)),
            line: comb.expect("a comb"),
        },
        of_peaks("lorentzian, cut", &|i| 1.0 / (1.0 + (i / 1.5).powi(2))),
        of_peaks("two lines", &|i| {
            0.7 * inside((i + 3.0).abs() < 0.5) + 0.3 * inside((i - 4.0).abs() < 0.5)
        }),
    ]
}

/// A camera and a source anywhere above the plate, whose paths differ enough over the patch for
/// some nanometres.
fn random_view(random: &mut Random) -> CellGeometry {
    loop {
        let [to_source, to_pupil] = [60.0, 45.0].map(|degrees| random.direction(degrees, DVec3::Z));
        let view = CellGeometry {
            to_source,
            to_pupil,
            normal: DVec3::Z,
            sin_aperture: 0.01 + 0.02 * random.uniform(),
            wavelength: 405e-9 + 255e-9 * random.uniform(),
        };
        let bench = Bench::new(view, SIZE, Heights::Flat);
        if bench.step * f64::from(STEPS) < 0.05 * TAU / view.wavelength {
            return view;
        }
    }
}

const SIZE: [usize; 2] = [20, 8];

/// Compares the contrasts of all lines in a random geometry, in focus and up to three speckles out
/// of it.
fn compare(geometry: u64, random: &mut Random) -> Vec<Comparison> {
    let mut view = random_view(random);
    if geometry % 8 == 7 {
        // The direction of a mirror: all of the plate at one path.
        view.to_source = view.to_pupil * DVec3::new(-1.0, -1.0, 1.0);
    }
    let bench = |heights| Bench::with_step(view, SIZE, heights, 1e-3 * TAU / view.wavelength);
    // The path per height is two or more: up to some 0.4 rad between neighbouring wave numbers.
    let rms = match geometry % 4 {
        0 => 0.0,
        _ => 0.15 * random.uniform() / bench(Heights::Flat).step,
    };
    let bench = bench(match geometry % 4 {
        0 => Heights::Flat,
        _ => Heights::Dense { rms, strata: 3 },
    });
    let blur = (0.5 + 2.5 * random.uniform()) * bench.speckle_size();
    let views = [0.0, blur / view.sin_aperture].map(|defocus| View {
        defocus,
        ..View::default()
    });
    let spectra = spectra(view.wavelength, bench.step);
    let surfaces = for_surfaces(44, 100 + geometry, |random| {
        let surface = bench.surface(random, |_| 1.0);
        let images = bench.images(&surface, STEPS, &views, random);
        let moments = |images: &Vec<Vec<f64>>| -> Vec<Moments> {
            let mixed = spectra.iter().map(|spectrum| spectrum.mix(images));
            mixed.map(|mixed| Moments::new(&mixed, images)).collect()
        };
        images.iter().flat_map(moments).collect::<Vec<_>>()
    });
    let cases = views
        .iter()
        .flat_map(|view| spectra.iter().map(move |line| (view, line)));
    let compared =
        |(i, (seen, BenchSpectrum { name, line, .. })): (usize, (&View, &BenchSpectrum))| {
            let moments: Vec<Moments> = surfaces.iter().map(|surface| surface[i]).collect();
            let cell = &cell(view, rms, seen.defocus);
            Comparison {
                what: format!(
                    "{name}, {:e} m out of focus, {rms:e} m, {view:?}",
                    seen.defocus
                ),
                waves: contrast(&moments),
                law: PolychromaticSpeckle {
                    spectrum: line,
                    cell,
                }
                .contrast(),
            }
        };
    cases.enumerate().map(compared).collect()
}

#[test]
fn contrasts_of_random_geometries_and_lines_are_those_of_the_law() {
    let mut random = Random::new(11);
    let all = (0..24).flat_map(|geometry| compare(geometry, &mut random));
    Comparison::assert_all(all.collect());
}

/// A scene of a Gaussian line, at 450 nm and sin u = 0.025.
struct Scene {
    name: &'static str,
    angles: [f64; 2],
    heights: Heights,
    rms: f64,
    linewidth: f64,
    defocus: f64,
    /// Between wave numbers, in those of the bench.
    steps: f64,
    count: u64,
    /// What the law says, by quadratures outside of this project.
    contrast: f64,
    tolerance: f64,
}

#[test]
fn contrasts_of_known_scenes_are_those_of_waves() {
    let scenes = [
        Scene {
            name: "flat, 30°",
            angles: [0.0, 30.0],
            heights: Heights::Flat,
            rms: 0.0,
            linewidth: 20e-9,
            defocus: 0.0,
            steps: 2.0,
            count: 120,
            contrast: 0.7306,
            tolerance: 0.008,
        },
        Scene {
            name: "flat, 30°, 1.5 mm out of focus",
            angles: [0.0, 30.0],
            heights: Heights::Flat,
            rms: 0.0,
            linewidth: 20e-9,
            defocus: 1.5e-3,
            steps: 2.0,
            count: 120,
            contrast: 0.401,
            tolerance: 0.01,
        },
        Scene {
            // As 1.6 µm and 20 nm, whose band would be wide enough for the limit shown below.
            name: "6.4 µm, mirror direction, phases of heights alone",
            angles: [-30.0, 30.0],
            heights: Heights::Alone { rms: 6.4e-6 },
            rms: 6.4e-6,
            linewidth: 5e-9,
            defocus: 0.0,
            steps: 1.0,
            count: 400,
            contrast: 0.752,
            tolerance: 0.008,
        },
        Scene {
            name: "6 µm, 30°",
            angles: [0.0, 30.0],
            heights: Heights::Dense {
                rms: 6e-6,
                strata: 8,
            },
            rms: 6e-6,
            linewidth: 10e-9,
            defocus: 0.0,
            steps: 1.0,
            count: 60,
            contrast: 0.508,
            tolerance: 0.01,
        },
    ];
    for scene in scenes {
        let [incidence, observation] = scene.angles;
        let view = plane_of_incidence(incidence, observation);
        let mut bench = Bench::with_step(view, [24, 8], scene.heights, 2.5e4);
        bench.step *= scene.steps;
        let spectrum = BenchSpectrum::gaussian(view.wavelength, bench.step, 9, scene.linewidth);
        let seen = View {
            defocus: scene.defocus,
            ..View::default()
        };
        let surfaces = for_surfaces(scene.count, 1, |random| {
            let surface = bench.surface(random, |_| 1.0);
            let images = &bench.images(&surface, 9, &[seen], random)[0];
            Moments::new(&spectrum.mix(images), images)
        });
        let cell = cell(view, scene.rms, scene.defocus);
        let law = PolychromaticSpeckle {
            spectrum: &spectrum.line,
            cell: &cell,
        };
        let (waves, law) = (contrast(&surfaces), law.contrast());
        assert!((law - scene.contrast).abs() < 1e-3, "{}: {law}", scene.name);
        assert_agrees(scene.name, waves, law, scene.tolerance);
    }
}

#[test]
fn two_wavelengths_share_what_the_law_leaves_of_the_pupil() {
    let view = plane_of_incidence(0.0, 30.0);
    let bench = Bench::new(view, [24, 8], Heights::Flat);
    let cell = cell(view, 0.0, 0.0);
    let apart = [2, 4, 8, 16];
    let surfaces = for_surfaces(150, 2, |random| {
        let surface = bench.surface(random, |_| 1.0);
        let images = &bench.images(&surface, 8, &[View::default()], random)[0];
        let pixels = bench.pixels();
        apart.map(|apart| {
            let pair = |first: usize| [&*images[first], &*images[first + apart]];
            let pairs = 0..images.len() - apart;
            Moments::mean(
                pairs.map(|first| Moments::of_products(pair(first), images, [0, 0], pixels)),
            )
        })
    });
    for (i, apart) in apart.into_iter().enumerate() {
        let moments: Vec<Moments> = surfaces.iter().map(|surface| surface[i]).collect();
        let law = cell.squared_correlation(apart as f64 * bench.step);
        let waves = covariance(&moments);
        assert_agrees(&format!("{apart} steps apart"), waves, law, 0.02);
    }
}

/// The law takes the pupil in wavelengths as constant. Where nothing else tells wave numbers apart,
/// the wavelengths show by the sizes of their speckles: discs of the radii k and k' share `min/max`
/// of their fields.
#[test]
fn wide_bands_cost_contrast_without_a_tilt_as_the_stated_limit_says() {
    let view = plane_of_incidence(0.0, 0.0);
    let bench = Bench::with_step(view, [10, 10], Heights::Flat, 1.0e5);
    let spectrum = BenchSpectrum::gaussian(view.wavelength, bench.step, 9, 20e-9);
    let surfaces = for_surfaces(150, 5, |random| {
        let surface = bench.surface(random, |_| 1.0);
        let images = &bench.images(&surface, 9, &[View::default()], random)[0];
        Moments::new(&spectrum.mix(images), images)
    });
    let cell = cell(view, 0.0, 0.0);
    let law = PolychromaticSpeckle {
        spectrum: &spectrum.line,
        cell: &cell,
    };
    let stated = law.contrast() - 0.48 * 20.0 / 450.0;
    assert_agrees("flat, head-on", contrast(&surfaces), stated, 0.005);
}
