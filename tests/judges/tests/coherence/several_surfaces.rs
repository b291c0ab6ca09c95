//! The contrast of light that met one rough surface, mixed with light that met two.

use core::f64::consts::{LN_2, TAU};

use tem00::{
    coherence::{CellGeometry, MixedLight, PathPairs, PolychromaticSpeckle, Spectrum, mode_ratio},
    statistics::kolmogorov_smirnov,
    wave::{DVec3, RigidMotion},
};

use super::{
    bench::{BenchSpectrum, plane_of_incidence},
    comparison::Comparison,
    contrast::{STEPS, cell, spectra},
    corner::{Corner, Fields, Wall, Waves},
    heights::Random,
    sums::{Moments, assert_agrees, contrast, for_surfaces},
};

/// Plates before each wall: their single light is independent, and of the multiple light all but
/// what N scatterers have in common.
const PLATES: usize = 40;

/// Light of a corner: so many times as much multiple as single light, depolarised or not.
#[derive(Clone, Copy, Debug)]
struct Light {
    ratio: f64,
    is_depolarised: bool,
}

const LIGHTS: [Light; 4] = [
    Light {
        ratio: 0.3,
        is_depolarised: false,
    },
    Light {
        ratio: 0.3,
        is_depolarised: true,
    },
    Light {
        ratio: 1.0,
        is_depolarised: false,
    },
    Light {
        ratio: 1.0,
        is_depolarised: true,
    },
];

/// Returns the moments of intensities for each light and spectrum.
fn moments(fields: &Fields, lights: &[Light], spectra: &[BenchSpectrum]) -> Vec<Moments> {
    let of_light = |light: &Light| {
        let images = fields.intensities(light.ratio, light.is_depolarised);
        let of_line = |spectrum: &BenchSpectrum| Moments::new(&spectrum.mix(&images), &images);
        spectra.iter().map(of_line).collect::<Vec<_>>()
    };
    lights.iter().flat_map(of_light).collect()
}

/// Returns what the light of a corner has in common with itself: of paths by way of the wall, drawn
/// at random, and of a tilted plate.
fn coherence(corner: &Corner, line: &Spectrum) -> MixedLight {
    let mut pairs = PathPairs::default();
    let mut random = Random::new(77);
    for _ in 0..150 {
        let [sample, other] = [(); 2].map(|()| corner.draw_paths(40, &mut random));
        pairs.add(line, &sample, &other);
    }
    let cell = &cell(corner.view, 0.0, 0.0);
    let single = PolychromaticSpeckle {
        spectrum: line,
        cell,
    }
    .contrast();
    MixedLight {
        within_single: single.powi(2),
        with_single: pairs.coherence_with_single().expect("light"),
        within_multiple: pairs.self_coherence().expect("light"),
        ..MixedLight::default()
    }
}

/// The contrast by the law, and in light of one wavelength.
fn contrasts_of_law(light: Light, coherence: MixedLight) -> [f64; 2] {
    [coherence, MixedLight::default()].map(|coherence| {
        let light = MixedLight {
            multiple: light.ratio / (1.0 + light.ratio),
            polarisation: [1.0, if light.is_depolarised { 0.0 } else { 1.0 }],
            ..coherence
        };
        light.contrast().expect("a contrast")
    })
}

/// A corner of 90°, whose second path is 0.8 mm longer on average and nearly the same over all of
/// the wall.
pub(crate) fn right_angle() -> Corner {
    Corner {
        view: plane_of_incidence(50.0, 40.0),
        wall: Wall {
            centre: DVec3::new(-0.5e-3, 0.0, 0.4e-3),
            sides: [DVec3::Y * 0.7e-3, DVec3::Z * 0.7e-3],
            is_round: false,
        },
        source: None,
        sites: [240, 144],
    }
}

/// Returns the waves of a corner and the Gaussian line that they sample, to 3.3 standard deviations
/// on each side.
fn in_line(corner: &Corner, linewidth: f64) -> (Waves, BenchSpectrum) {
    const STEPS: i32 = 7;
    let wavelength = corner.view.wavelength;
    let full = TAU * linewidth / wavelength.powi(2);
    let step = 3.3 / f64::from(STEPS) * full / (8.0 * LN_2).sqrt();
    let wave_numbers = (-STEPS..=STEPS).map(|i| TAU / wavelength + f64::from(i) * step);
    let wave_numbers: Vec<f64> = wave_numbers.collect();
    (
        corner.waves(&wave_numbers, &RigidMotion::IDENTITY),
        BenchSpectrum::gaussian(wavelength, step, STEPS, linewidth),
    )
}

#[test]
fn a_corner_behind_a_laser_of_one_wavelength_is_fully_developed() {
    let corner = right_angle();
    let wave_number = TAU / corner.view.wavelength;
    let waves = corner.waves(&[wave_number], &RigidMotion::IDENTITY);
    let surfaces = for_surfaces(1000, 18, |random| {
        let fields = waves.fields(&corner.amplitudes(PLATES, random));
        let single = fields.intensities(0.0, false);
        LIGHTS.map(|light| {
            let mixed = &fields.intensities(light.ratio, light.is_depolarised)[0];
            Moments::new(mixed, &single)
        })
    });
    for (i, (light, known)) in LIGHTS.iter().zip([1.0, 0.892, 1.0, 0.791]).enumerate() {
        let moments: Vec<Moments> = surfaces.iter().map(|surface| surface[i]).collect();
        assert_agrees(&format!("{light:?}"), contrast(&moments), known, 0.012);
    }
}

/// The corner has the contrasts of normally distributed delays, 0.82 ± 0.04 mm, to what a tilted
/// cell takes off.
#[test]
fn a_corner_loses_coherence_with_single_light_before_that_with_itself() {
    let corner = right_angle();
    let known = [
        (0.05e-9, 0.9987, 0.7467, [0.954, 0.866, 0.934, 0.749]),
        (0.1e-9, 0.9950, 0.3122, [0.869, 0.821, 0.809, 0.673]),
        (0.2e-9, 0.9805, 0.0102, [0.805, 0.787, 0.707, 0.613]),
        (0.8e-9, 0.7804, 0.0000, [0.796, 0.783, 0.667, 0.590]),
    ];
    for (linewidth, itself, with_single, contrasts) in known {
        let (waves, spectrum) = in_line(&corner, linewidth);
        let spectra = [spectrum];
        let found = coherence(&corner, &spectra[0].line);
        assert!((found.within_multiple - itself).abs() < 0.005, "{found:?}");
        assert!((found.with_single - with_single).abs() < 0.005, "{found:?}");
        let surfaces = for_surfaces(800, 8, |random| {
            moments(
                &waves.fields(&corner.amplitudes(PLATES, random)),
                &LIGHTS,
                &spectra,
            )
        });
        for (i, (light, known)) in LIGHTS.iter().zip(contrasts).enumerate() {
            let moments: Vec<Moments> = surfaces.iter().map(|surface| surface[i]).collect();
            let name = format!("{linewidth:e} m, {light:?}");
            let [law, coherent] = contrasts_of_law(*light, found);
            // What the tilt takes of the single light, c₁₁ down to 0.92.
            assert!(
                law < known + 1e-3 && law > known - 0.04,
                "{name}: {law}, {known}"
            );
            assert_agrees(&name, contrast(&moments), law / coherent, 0.012);
        }
    }
}

/// The matrices of the judge are sums of waves over the wall, then over the plate.
#[test]
fn a_corner_sends_the_waves_of_its_lit_surfaces() {
    let corner = right_angle();
    let wave_number = TAU / corner.view.wavelength;
    let waves = corner.waves(&[wave_number], &RigidMotion::IDENTITY);
    let ratios = (0..4).map(|seed| {
        let amplitudes = corner.amplitudes(1, &mut Random::new(seed));
        corner.multiple_field(wave_number, &amplitudes) / waves.fields(&amplitudes).multiple[0][0]
    });
    let ratios: Vec<_> = ratios.collect();
    for ratio in &ratios {
        assert!((ratio / ratios[0] - 1.0).norm() < 1e-6, "{ratios:?}");
    }
}

/// Draws an intensity of polarised light: independent patterns of single and of multiple light, of
/// which the first two interfere by what both share.
fn draw_recombined(light: Light, coherence: MixedLight, random: &mut Random) -> f64 {
    let (c12, c22) = (coherence.with_single, coherence.within_multiple);
    let multiple = light.ratio / (1.0 + light.ratio);
    // Of the first pattern more than a geometric series has, if the shared part asks for it.
    let first = (1.0 - mode_ratio(c22)).max(c12);
    let t = mode_ratio((c22 - first * first) / (1.0 - first).powi(2));
    let [a, b] = [(); 2].map(|()| random.complex_gaussian());
    let mut sum = (1.0 - multiple) * a.norm_sqr() + multiple * first * b.norm_sqr();
    sum += 2.0 * (c12 * multiple * (1.0 - multiple)).sqrt() * (a * b.conj()).re;
    let mut left = multiple * (1.0 - first);
    while left > 1e-4 {
        sum += left * (1.0 - t) * random.complex_gaussian().norm_sqr();
        left *= t;
    }
    sum
}

#[test]
fn intensities_of_a_corner_are_sums_of_two_patterns_that_interfere_in_parts() {
    let corner = right_angle();
    for linewidth in [0.05e-9, 0.1e-9, 0.2e-9] {
        let (waves, spectrum) = in_line(&corner, linewidth);
        let coherence = coherence(&corner, &spectrum.line);
        let fields = for_surfaces(400, 20, |random| {
            waves.fields(&corner.amplitudes(PLATES, random))
        });
        for light in LIGHTS.into_iter().filter(|light| !light.is_depolarised) {
            let mixed = |fields: &Fields| spectrum.mix(&fields.intensities(light.ratio, false));
            let mut samples: Vec<f64> = fields.iter().flat_map(mixed).collect();
            let mean = samples.iter().sum::<f64>() / samples.len() as f64;
            samples.iter_mut().for_each(|value| *value /= mean);
            let mut random = Random::new(21);
            let mut drawn: Vec<f64> = (0..300_000)
                .map(|_| draw_recombined(light, coherence, &mut random))
                .collect();
            drawn.sort_unstable_by(f64::total_cmp);
            let below =
                |x: f64| drawn.partition_point(|value| *value < x) as f64 / drawn.len() as f64;
            let right = kolmogorov_smirnov(&samples, below).expect("samples");
            let f1 = (1.0 + light.ratio).recip();
            let left_out = |x: f64| -(-(x - 1.0 + f1).max(0.0) / f1).exp_m1();
            let wrong = kolmogorov_smirnov(&samples, left_out).expect("samples");
            let name = format!("{linewidth:e} m, {light:?}");
            assert!(right.p_value > 1e-3, "{name}: {right:?}");
            assert!(wrong.statistic > 0.08, "{name}: {wrong:?}");
        }
    }
}

/// A source and a camera anywhere above a plate, and a wall anywhere beside it.
fn random_corner(random: &mut Random) -> Corner {
    let view = CellGeometry {
        to_source: random.direction(60.0, DVec3::Z),
        to_pupil: random.direction(45.0, DVec3::Z),
        normal: DVec3::Z,
        sin_aperture: 0.01 + 0.02 * random.uniform(),
        wavelength: 405e-9 + 255e-9 * random.uniform(),
    };
    let speckle = 0.5 * view.wavelength / view.sin_aperture;
    let turn = TAU * random.uniform();
    let sideways = DVec3::new(turn.cos(), turn.sin(), 0.0);
    let (sin, cos) = (20.0 + 40.0 * random.uniform()).to_radians().sin_cos();
    let to_wall = sideways * cos + DVec3::Z * sin;
    let distance = (60.0 + 90.0 * random.uniform()) * speckle;
    let (first, second) = random.direction(50.0, to_wall).any_orthonormal_pair();
    let sides = [first, second].map(|side| side * (0.3 + 0.7 * random.uniform()) * distance);
    Corner {
        view,
        wall: Wall {
            centre: to_wall * distance,
            sides,
            is_round: random.uniform() < 0.3,
        },
        source: None,
        sites: [160, 100],
    }
}

/// Compares the contrasts of all lights and lines in a random corner.
fn compare(geometry: u64, random: &mut Random) -> Vec<Comparison> {
    let corner = random_corner(random);
    let delays = corner.draw_paths(200, random);
    let longest = delays.iter().map(|path| path.delay).fold(0.0, f64::max);
    // Lines from much narrower to much broader than what tells the paths apart.
    let step = 2.5 * 0.05_f64.powf(random.uniform()) / longest;
    let wavelength = corner.view.wavelength;
    let spectra = spectra(wavelength, step);
    let wave_numbers = (-STEPS..=STEPS).map(|i| TAU / wavelength + f64::from(i) * step);
    let waves = corner.waves(&wave_numbers.collect::<Vec<_>>(), &RigidMotion::IDENTITY);
    let surfaces = for_surfaces(400, 1000 + geometry, |random| {
        moments(
            &waves.fields(&corner.amplitudes(PLATES, random)),
            &LIGHTS,
            &spectra,
        )
    });
    let lines: Vec<_> = spectra
        .iter()
        .map(|spectrum| (spectrum.name, coherence(&corner, &spectrum.line)))
        .collect();
    let cases = LIGHTS
        .iter()
        .flat_map(|light| lines.iter().map(move |line| (light, line)));
    let compared = |(i, (light, (name, coherence))): (usize, (&Light, &(&str, MixedLight)))| {
        let moments: Vec<Moments> = surfaces.iter().map(|surface| surface[i]).collect();
        let [law, coherent] = contrasts_of_law(*light, *coherence);
        Comparison {
            what: format!("{name}, {light:?}, steps of {step:e} rad/m, delays up to {longest:e} m"),
            waves: contrast(&moments),
            law: law / coherent,
        }
    };
    cases.enumerate().map(compared).collect()
}

#[test]
fn contrasts_of_random_corners_are_those_of_single_and_multiple_light() {
    let mut random = Random::new(19);
    let all = (0..24).flat_map(|geometry| compare(geometry, &mut random));
    Comparison::assert_all(all.collect());
}
