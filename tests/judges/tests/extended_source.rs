//! Speckle under a source of several directions, judged by wave optics from first principles.
//!
//! The judge sums the waves of scatterers with exact distances, one direction of the source and one
//! wavelength after the other, and adds the intensities of the images. It knows nothing of overlaps
//! of pupils. Pupil, wave numbers and directions are chosen so that the image and all paths over
//! the plate repeat: no wave sees an edge. The exact law of motion judges the displacement, too.

#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    reason = "the transform works in f32, and on small indices modulo its size"
)]

use core::f64::consts::TAU;

use rayon::prelude::*;
use tem00::{
    coherence::{
        CellGeometry, PolychromaticSpeckle, Relief, ResolutionCell, Rows, SourceExtent, Spectrum,
    },
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, DVec2, Illumination as LightOnSurface,
    },
    numerics::{Fft2, Grid, disc_overlap},
    wave::{Complex, DVec3, Illumination, RoughSurface, Scatterer},
};
use tem00_testkit::Numbers;

/// Distance from the plate to the pupil, in metres.
const DISTANCE: f64 = 0.5;

/// Speckles after which the plate repeats, on both sides; scatterers and pixels of a speckle, on
/// both sides.
const SIZE: usize = 10;
const DENSITY: usize = 2;

const GEOMETRIES: u64 = 14;
const SURFACES: u64 = 120;

/// A direction within so many degrees of the normal, z.
fn direction(random: &mut Numbers, degrees: f64) -> DVec3 {
    let [angle, turn] = random.units();
    let ((sin, cos), turn) = ((degrees * angle).to_radians().sin_cos(), TAU * turn);
    DVec3::new(sin * turn.cos(), sin * turn.sin(), cos)
}

/// One incoherent part of the light.
#[derive(Clone, Copy)]
struct Part {
    to_source: DVec3,
    wave_number: f64,
    share: f64,
}

struct Bench {
    view: CellGeometry,
    axes: [DVec3; 2],
    rms_height: f64,
}

impl Bench {
    fn new(view: CellGeometry, rms_height: f64) -> Self {
        // Along the tilt of the plate, so that wave numbers move the field along one axis.
        let gradient = |axis: DVec3| {
            let path = |across: DVec3| {
                let point = on_plate(&view, across);
                point.distance(view.to_pupil * DISTANCE) - view.to_source.dot(point)
            };
            axis * ((path(1e-6 * axis) - path(-1e-6 * axis)) / 2e-6)
        };
        let (first, second) = view.to_pupil.any_orthonormal_pair();
        let along = (gradient(first) + gradient(second)).normalize();
        Self {
            view,
            axes: [along, view.to_pupil.cross(along)],
            rms_height,
        }
    }

    fn period(&self) -> f64 {
        SIZE as f64 * 0.5 * self.view.wavelength / self.view.sin_aperture
    }

    /// The difference of wave numbers that adds a whole period to the paths over the plate.
    fn step(&self) -> f64 {
        let end = on_plate(&self.view, self.axes[0] * self.period());
        // The path to the pupil is one period of the image long already.
        TAU / (self.view.to_source + self.view.to_pupil).dot(end).abs()
    }

    /// The direction to the source whose paths over the plate are so many wavelengths longer along
    /// both axes.
    fn source(&self, wavelengths: [f64; 2]) -> DVec3 {
        let [first, second] = self
            .axes
            .map(|axis| on_plate(&self.view, axis * self.period()));
        let [a, b] = wavelengths.map(|count| count * self.view.wavelength);
        // δ·first = a and δ·second = b in the plane of the plate, z = 0.
        let determinant = first.x * second.y - first.y * second.x;
        let x = self.view.to_source.x + (a * second.y - b * first.y) / determinant;
        let y = self.view.to_source.y + (b * first.x - a * second.x) / determinant;
        DVec3::new(x, y, (1.0 - x * x - y * y).sqrt())
    }

    fn surface(&self, random: &mut Numbers) -> RoughSurface {
        let sites = SIZE * DENSITY;
        let mut scatterers = Vec::new();
        for site in 0..sites * sites {
            let at = [site % sites, site / sites]
                .map(|i| (i as f64 + 0.5) / sites as f64 - 0.5)
                .map(|part| part * self.period());
            let place = on_plate(&self.view, self.axes[0] * at[0] + self.axes[1] * at[1]);
            for height in self.heights(random) {
                let radius = (-random.unit().max(1e-300).ln()).sqrt();
                scatterers.push(Scatterer {
                    position: place + DVec3::Z * height,
                    amplitude: Complex::from_polar(radius, TAU * random.unit()),
                });
            }
        }
        RoughSurface::from_scatterers(scatterers).expect("a surface")
    }

    /// Normal heights of the scatterers of a site, spread over the quarters of a turn and two
    /// halves of the radii.
    fn heights(&self, random: &mut Numbers) -> Vec<f64> {
        if self.rms_height == 0.0 {
            return vec![0.0];
        }
        let (turn, inner) = (random.unit(), random.unit());
        let height = |i: u32| {
            let part = 0.5 * (f64::from(i % 2) + (inner + 0.5 * f64::from(i / 4 % 2)).fract());
            let radius = (-2.0 * part.max(1e-300).ln()).sqrt();
            self.rms_height * radius * (TAU * (turn + f64::from(i) / 8.0)).cos()
        };
        (0..8).map(height).collect()
    }

    /// The images of a surface in a part of the light, behind the pupil and behind the pupil that
    /// has moved.
    fn images(&self, surface: &RoughSurface, part: &Part, offset: [f64; 2]) -> [Vec<f64>; 2] {
        let pixels = SIZE * DENSITY;
        let transform = Fft2::new(pixels, pixels)
            .expect("a transform")
            .on_one_thread();
        let light = Illumination::plane(TAU / part.wave_number, -part.to_source);
        let lit = surface.lit_by(&light.expect("a plane wave"));
        let spacing = TAU / part.wave_number * DISTANCE / self.period();
        let radius = DISTANCE * self.view.sin_aperture / spacing;
        let mut pupils = [(); 2].map(|()| Grid::filled(pixels, pixels, Complex::new(0.0_f32, 0.0)));
        let (mut open, reach) = ([0.0; 2], SIZE as i32 / 2 + 4);
        for (i, j) in (-reach..=reach).flat_map(|j| (-reach..=reach).map(move |i| (i, j))) {
            let at = [f64::from(i) + offset[0], f64::from(j) + offset[1]];
            let is_open = [[0.0; 2], MOVED].map(|[x, y]| (at[0] - x).hypot(at[1] - y) <= radius);
            if is_open == [false; 2] {
                continue;
            }
            let across = self.axes[0] * at[0] + self.axes[1] * at[1];
            let point = self.view.to_pupil * DISTANCE + across * spacing;
            let phase = part.wave_number * (point.length() - DISTANCE);
            let value = lit.field_at(point) * Complex::from_polar(1.0, -phase);
            let place = [i, j].map(|i| i.rem_euclid(pixels as i32) as usize);
            for frame in (0..2).filter(|frame| is_open[*frame]) {
                pupils[frame][(place[0], place[1])] =
                    Complex::new(value.re as f32, value.im as f32);
                open[frame] += 1.0;
            }
        }
        [0, 1].map(|frame| {
            let intensity = |_, _, value: Complex<f32>| f64::from(value.norm_sqr()) / open[frame];
            transform.forward(&pupils[frame], intensity).into_values()
        })
    }

    /// What waves make of speckle, over many surfaces.
    fn measures(&self, parts: &[Part], seed: u64) -> [f64; MEASURES.len()] {
        let of_surface = |surface: u64| {
            let mut random = Numbers::new(seed * 1_000_003 + surface);
            let offset = [random.unit() - 0.5, random.unit() - 0.5];
            let surface = self.surface(&mut random);
            let pixels = (SIZE * DENSITY).pow(2);
            let ([mut mixed, mut later], mut single) = ([0, 1].map(|_| vec![0.0; pixels]), 0.0);
            for part in parts {
                let [now, moved] = self.images(&surface, part, offset);
                for pixel in 0..pixels {
                    mixed[pixel] += part.share * now[pixel];
                    later[pixel] += part.share * moved[pixel];
                }
                single += part.share * rows(&now);
            }
            [
                mixed.iter().sum(),
                product(&mixed, &mixed, [0, 0]),
                product(&mixed, &later, [0, 0]),
                product(&mixed, &mixed, [1, 0]),
                product(&mixed, &mixed, [0, 1]),
                rows(&mixed),
                single,
            ]
        };
        let all: Vec<[f64; 7]> = (0..SURFACES).into_par_iter().map(of_surface).collect();
        let sums = core::array::from_fn(|i| all.iter().map(|of| of[i]).sum());
        let [sum, contrast, frames, along, across, mixed, single]: [f64; 7] = sums;
        let pixels = (SIZE * DENSITY).pow(2) as f64 * SURFACES as f64;
        let covariance = |products: f64| products * pixels / (sum * sum) - 1.0;
        let side = (SIZE * DENSITY) as f64;
        let of_rows = |squares: f64| squares - sum * sum * side / pixels;
        [
            covariance(contrast).sqrt(),
            covariance(frames).sqrt(),
            covariance(along).sqrt(),
            covariance(across).sqrt(),
            (of_rows(mixed) / of_rows(single)).sqrt(),
        ]
    }
}

/// What is measured, and the largest median and the largest error of all.
const MEASURES: [(&str, f64, f64); 5] = [
    ("contrast", 0.01, 0.03),
    ("frames", 0.02, 0.05),
    ("grains along", 0.02, 0.05),
    ("grains across", 0.02, 0.05),
    ("noise of a line", 0.02, 0.05),
];

/// The displacement of the pupil between two frames, in its samples.
const MOVED: [f64; 2] = [3.0, -2.0];

/// The sum of the products of the pixels of two images that repeat, at a lag in pixels.
fn product(first: &[f64], second: &[f64], lag: [usize; 2]) -> f64 {
    let side = SIZE * DENSITY;
    let at = |i: usize| (i % side + lag[0]) % side + side * ((i / side + lag[1]) % side);
    first
        .iter()
        .enumerate()
        .map(|(i, value)| value * second[at(i)])
        .sum()
}

/// The sum of the squares of the sums of rows, along the tilt.
fn rows(image: &[f64]) -> f64 {
    let rows = image.chunks_exact(SIZE * DENSITY);
    rows.map(|row| row.iter().sum::<f64>().powi(2)).sum()
}

/// The point of the plate, z = 0, that is seen at an offset across the line of sight.
fn on_plate(view: &CellGeometry, across: DVec3) -> DVec3 {
    across - view.to_pupil * (across.z / view.to_pupil.z)
}

/// Directions of a source, in periods of the paths over the plate, with their shares: discs of some
/// sizes, a strip of modes, a ring, random directions of random shares.
fn directions(geometry: u64, random: &mut Numbers) -> Vec<([f64; 2], f64)> {
    let radius = 1.0 + 2.0 * random.unit();
    let inside = |x: f64, y: f64| match geometry % 4 {
        0 | 1 => x.hypot(y) <= radius,
        2 => (0.3 * x + y).abs() < 0.6 && x.abs() < 5.0,
        _ => false,
    };
    let lattice = (-5..=5).flat_map(|y| (-5..=5).map(move |x| (f64::from(x), f64::from(y))));
    let mut list: Vec<_> = lattice
        .filter(|&(x, y)| inside(x, y))
        .map(|(x, y)| ([x, y], 1.0))
        .collect();
    if list.is_empty() {
        let mut whole = || (9.0 * random.unit()).floor() - 4.0;
        let places: Vec<_> = (0..6).map(|_| [whole(), whole()]).collect();
        list.extend(places.into_iter().map(|place| (place, 0.2 + random.unit())));
    }
    let total: f64 = list.iter().map(|(_, share)| share).sum();
    list.iter()
        .map(|(place, share)| (*place, share / total))
        .collect()
}

fn cell(view: CellGeometry, rms_height: f64) -> ResolutionCell {
    let cell = ResolutionCell::new(view).expect("a cell");
    let correlation_length = 0.0;
    let relief = Relief {
        rms_height,
        correlation_length,
    };
    cell.with_relief(relief).expect("a relief")
}

/// Returns the measures of waves and of the law in a random geometry: behind one wavelength, and
/// behind three lines.
fn compare(geometry: u64) -> Vec<[[f64; MEASURES.len()]; 2]> {
    let mut random = Numbers::new(geometry * 7_919 + 11);
    let view = CellGeometry {
        to_source: direction(&mut random, 60.0),
        to_pupil: direction(&mut random, 50.0),
        normal: DVec3::Z,
        sin_aperture: 0.008 + 0.012 * random.unit(),
        wavelength: 405e-9 + 255e-9 * random.unit(),
    };
    let wave_number = TAU / view.wavelength;
    let rms_height = match geometry % 3 {
        0 => 0.0,
        // Phases of radians where the direction changes by as much as the pupil is wide.
        _ => (1.0 + 3.0 * random.unit()) / (wave_number * 2.0 * view.sin_aperture),
    };
    let bench = Bench::new(view, rms_height);
    let directions = directions(geometry, &mut random);
    let cell = cell(view, rms_height);
    let step = bench.step();
    // Wave numbers differ by so little that the periods of all directions stay whole.
    let lines: &[(f64, f64)] = match step < 0.004 * wave_number {
        true => &[(-2.0, 0.3), (0.0, 0.5), (1.0, 0.2)],
        false => &[],
    };
    [&[(0.0, 1.0)], lines]
        .into_iter()
        .filter(|lines| !lines.is_empty())
        .map(|lines| {
            let mut parts = Vec::new();
            for (place, share) in &directions {
                let to_source = bench.source(*place);
                parts.extend(lines.iter().map(|(steps, part)| Part {
                    to_source,
                    wave_number: wave_number + steps * step,
                    share: share * part,
                }));
            }
            let peaks: Vec<_> = lines
                .iter()
                .map(|(steps, part)| [TAU / (wave_number + steps * step), *part])
                .collect();
            let line = Spectrum::from_peaks(&peaks).expect("a line");
            let list: Vec<_> = directions
                .iter()
                .map(|(place, share)| (bench.source(*place), *share))
                .collect();
            let extent = SourceExtent::directions(&list).expect("directions");
            let law = PolychromaticSpeckle {
                spectrum: &line,
                cell: &cell.clone().with_source_extent(extent),
            };
            let moved = MOVED.map(|samples| samples / SIZE as f64);
            let pixel = 1.0 / DENSITY as f64;
            let laws = [
                law.contrast(),
                law.covariance(moved).sqrt(),
                law.autocovariance([pixel, 0.0]).sqrt(),
                law.autocovariance([0.0, pixel]).sqrt(),
                law.line_noise_ratio(Rows::Thin),
            ];
            [bench.measures(&parts, geometry), laws]
        })
        .collect()
}

#[test]
fn speckle_under_sources_of_several_directions_is_that_of_the_law() {
    let all: Vec<_> = (0..GEOMETRIES).flat_map(compare).collect();
    assert!(all.len() > 20, "{}", all.len());
    for (i, (name, median, worst)) in MEASURES.into_iter().enumerate() {
        let mut errors: Vec<f64> = all
            .iter()
            .map(|[waves, law]| (waves[i] / law[i] - 1.0).abs())
            .collect();
        errors.sort_by(f64::total_cmp);
        let found = [errors[errors.len() / 2], errors[errors.len() - 1]];
        let pairs: Vec<_> = all.iter().map(|[waves, law]| [waves[i], law[i]]).collect();
        assert!(
            found[0] < median && found[1] < worst,
            "{name}: {found:?}: {pairs:.3?}"
        );
    }
}

#[test]
fn directions_displace_the_field_as_the_law_of_motion_says() {
    for seed in 0..20 {
        let mut random = Numbers::new(seed);
        let (to_source, to_pupil) = (direction(&mut random, 60.0), direction(&mut random, 50.0));
        let view = CellGeometry {
            to_source,
            to_pupil,
            normal: DVec3::Z,
            sin_aperture: 0.02,
            wavelength: 650e-9,
        };
        let other = (to_source + 0.015 * direction(&mut random, 90.0)).normalize();
        let pupil = DISTANCE * to_pupil;
        let before = Configuration::new(ConfigurationData {
            wavelength: view.wavelength,
            point: DVec3::ZERO,
            normal: view.normal,
            illumination: LightOnSurface::collimated(to_source).expect("light"),
            camera: CameraFrame::look_at(pupil, DVec3::ZERO, DVec3::X).expect("a camera"),
            pupil,
        })
        .expect("a state");
        let light = LightOnSurface::collimated(other).expect("light");
        let after = before.with_illumination(light).expect("a state");
        let moved = before.pupil_point_after(&after, DVec2::ZERO);
        let moved = moved.expect("a place").length() / (2.0 * DISTANCE * view.sin_aperture);
        let rms_height = 2e-6;
        let phases = rms_height * before.height_phase_change(&after).expect("a change");
        let shared = (-phases * phases).exp() * disc_overlap(moved).powi(2);

        let line = Spectrum::monochromatic(view.wavelength).expect("a line");
        let both = [(to_source, 1.0), (other, 1.0)];
        let extent = SourceExtent::directions(&both).expect("directions");
        let speckle = PolychromaticSpeckle {
            spectrum: &line,
            cell: &cell(view, rms_height).with_source_extent(extent),
        };
        let found = 2.0 * speckle.contrast().powi(2) - 1.0;
        // The law of motion is exact; the cell lacks about half of the angle, 0.0075, of a
        // displacement below one pupil, by which the overlap falls by 2.5.
        assert!((found - shared).abs() < 0.02, "{seed}: {found}, {shared}");
    }
}
