//! Speckle under a source of several directions, in one wavelength and in three.
//!
//! Wave numbers and directions are chosen so that all paths over the plate repeat with it. The exact
//! law of motion judges the displacement, too.

use core::f64::consts::TAU;

use tem00::{
    coherence::{CellGeometry, PolychromaticSpeckle, Rows, SourceExtent, Spectrum},
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, DVec2, Illumination as LightOnSurface,
    },
    numerics::disc_overlap,
    wave::DVec3,
};

use super::{
    bench::{Bench, BenchSpectrum, DISTANCE, Light, View},
    contrast::cell,
    heights::{Heights, Random},
    sums::{Moments, contrast, for_surfaces},
};

/// Speckles after which the plate repeats, on both sides.
const SIZE: usize = 10;

const GEOMETRIES: u64 = 14;
const SURFACES: u64 = 120;

/// What is measured, and the largest median and the largest error of all.
const MEASURES: [(&str, f64, f64); 5] = [
    ("contrast", 0.01, 0.03),
    ("frames", 0.02, 0.05),
    ("grains along", 0.02, 0.05),
    ("grains across", 0.02, 0.05),
    ("noise of a line", 0.02, 0.05),
];

/// The displacement of the pupil between two frames, in its diameters.
const MOVED: [f64; 2] = [0.3, -0.2];

/// Steps of the wave number, and their shares of light of one wavelength and of three lines.
const LINES: [(f64, [f64; 2]); 3] = [(0.0, [1.0, 0.5]), (-2.0, [0.0, 0.3]), (1.0, [0.0, 0.2])];

/// The direction to the source whose paths over the plate are so many wavelengths longer along both
/// axes than those of the bench.
fn source(bench: &Bench, [a, b]: [f64; 2]) -> DVec3 {
    let CellGeometry {
        to_source,
        wavelength,
        ..
    } = bench.view;
    let period = |axis: usize| bench.on_plate(bench.axes[axis] * bench.period(axis)) / wavelength;
    let [first, second] = [0, 1].map(period);
    // δ·first = a and δ·second = b in the plane of the plate, z = 0.
    let determinant = first.x * second.y - first.y * second.x;
    let x = to_source.x + (a * second.y - b * first.y) / determinant;
    let y = to_source.y + (b * first.x - a * second.x) / determinant;
    DVec3::new(x, y, (1.0 - x * x - y * y).sqrt())
}

/// Directions of a source, in periods of the paths over the plate, with their shares: discs of some
/// sizes, a strip of modes, random directions of random shares.
fn directions(geometry: u64, random: &mut Random) -> Vec<([f64; 2], f64)> {
    let radius = 1.0 + 2.0 * random.uniform();
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
        let mut whole = || (9.0 * random.uniform()).floor() - 4.0;
        let places: Vec<_> = (0..6).map(|_| [whole(), whole()]).collect();
        list.extend(
            places
                .into_iter()
                .map(|place| (place, 0.2 + random.uniform())),
        );
    }
    let total: f64 = list.iter().map(|(_, share)| share).sum();
    list.iter()
        .map(|(place, share)| (*place, share / total))
        .collect()
}

/// A row of an image adds up what a line along it shows.
fn row_sums(image: &[f64], columns: usize) -> Vec<f64> {
    let rows = image.chunks_exact(columns);
    rows.map(|row| row.iter().sum()).collect()
}

/// Returns the measures of waves and of the law in a random geometry: in light of one wavelength,
/// and in that of three lines.
fn compare(geometry: u64) -> Vec<[[f64; MEASURES.len()]; 2]> {
    let random = &mut Random::new(geometry * 7_919 + 11);
    let view = CellGeometry {
        to_source: random.direction(60.0, DVec3::Z),
        to_pupil: random.direction(50.0, DVec3::Z),
        normal: DVec3::Z,
        sin_aperture: 0.008 + 0.012 * random.uniform(),
        wavelength: 405e-9 + 255e-9 * random.uniform(),
    };
    let wave_number = TAU / view.wavelength;
    let (rms, heights) = match geometry % 3 {
        0 => (0.0, Heights::Flat),
        _ => {
            // Phases of radians where the direction changes by as much as the pupil is wide.
            let rms = (1.0 + 3.0 * random.uniform()) / (wave_number * 2.0 * view.sin_aperture);
            (rms, Heights::Dense { rms, strata: 4 })
        }
    };
    let bench = Bench::new(view, [SIZE; 2], heights);
    let places = directions(geometry, random).into_iter();
    let directions: Vec<_> = places
        .map(|(place, share)| (source(&bench, place), share))
        .collect();
    // Wave numbers differ by so little that the periods of all directions stay whole.
    let lines = match bench.step < 0.004 * wave_number {
        true => &LINES[..],
        false => &LINES[..1],
    };
    let parts = || {
        lines
            .iter()
            .flat_map(|line| directions.iter().map(move |part| (line, part)))
    };
    let light = |((steps, _), (to_source, _)): (&(f64, _), &(DVec3, f64))| Light {
        to_source: *to_source,
        wave_number: bench.wave_number(*steps),
    };
    let lights: Vec<_> = parts().map(light).collect();
    let spectrum = |which: usize| {
        let lit = lines.iter().filter(|(_, shares)| shares[which] > 0.0);
        let peaks = lit.map(|(steps, shares)| [TAU / bench.wave_number(*steps), shares[which]]);
        let line = Spectrum::from_peaks(&peaks.collect::<Vec<_>>());
        BenchSpectrum {
            name: ["one wavelength", "three lines"][which],
            weights: parts()
                .map(|((_, shares), part)| shares[which] * part.1)
                .collect(),
            line: line.expect("a line"),
        }
    };
    let spectra: Vec<_> = (0..lines.len().min(2)).map(spectrum).collect();
    let (pixels, still) = (bench.pixels(), View::default());
    let moved = View {
        pupil: MOVED,
        ..still
    };
    let surfaces = for_surfaces(SURFACES, 2_000 + geometry, |random| {
        let surface = bench.surface(random, |_| 1.0);
        let images = bench.images_in(&surface, &lights, &[still, moved], random);
        let sums: Vec<_> = images[0]
            .iter()
            .map(|image| row_sums(image, pixels[0]))
            .collect();
        let measure = |spectrum: &BenchSpectrum| {
            let [now, later] = [0, 1].map(|frame| spectrum.mix(&images[frame]));
            let product =
                |second, lag| Moments::of_products([&now, second], &images[0], lag, pixels);
            [
                product(&now, [0, 0]),
                product(&later, [0, 0]),
                product(&now, [1, 0]),
                product(&now, [0, 1]),
                Moments::new(&row_sums(&now, pixels[0]), &sums),
            ]
        };
        spectra.iter().map(measure).collect::<Vec<_>>()
    });
    let extent = SourceExtent::directions(&directions).expect("directions");
    let cell = cell(view, rms, 0.0).with_source_extent(extent);
    let compared = |(of_spectrum, spectrum): (usize, &BenchSpectrum)| {
        let measured = |i: usize| {
            let moments: Vec<_> = surfaces.iter().map(|s| s[of_spectrum][i]).collect();
            contrast(&moments).value
        };
        let law = PolychromaticSpeckle {
            spectrum: &spectrum.line,
            cell: &cell,
        };
        let laws = [
            law.contrast(),
            law.covariance(MOVED).sqrt(),
            law.autocovariance([0.5, 0.0]).sqrt(),
            law.autocovariance([0.0, 0.5]).sqrt(),
            law.line_noise_ratio(Rows::Thin),
        ];
        [core::array::from_fn(measured), laws]
    };
    spectra.iter().enumerate().map(compared).collect()
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
        let mut random = Random::new(seed);
        let [to_source, to_pupil] = [60.0, 50.0].map(|degrees| random.direction(degrees, DVec3::Z));
        let view = CellGeometry {
            to_source,
            to_pupil,
            normal: DVec3::Z,
            sin_aperture: 0.02,
            wavelength: 650e-9,
        };
        let other = (to_source + 0.015 * random.direction(90.0, DVec3::Z)).normalize();
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
            cell: &cell(view, rms_height, 0.0).with_source_extent(extent),
        };
        let found = 2.0 * speckle.contrast().powi(2) - 1.0;
        // The law of motion is exact; the cell lacks about half of the angle, 0.0075, of a
        // displacement below one pupil, by which the overlap falls by 2.5.
        assert!((found - shared).abs() < 0.02, "{seed}: {found}, {shared}");
    }
}
