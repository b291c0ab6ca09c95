//! Light below a surface against the exact integral equation, reciprocity, the balance of energy,
//! and photons that another program counted.

use core::f64::consts::FRAC_PI_4;
use std::sync::atomic::AtomicBool;

use tem00::{
    DVec2, DVec3,
    tracer::{Frame, ReferenceSpeckle, Scene, render_reference},
    translucence::{Bin, LineSpread, Material, Medium, PeakShape, Spectrum, SpreadLine, Walk},
};

use tem00_testkit::on_threads;

use crate::{means, renders};

/// Chance, up to a constant, that a collision at each of some depths is seen from outside.
///
/// S(τ) = exp(−τ/cos b) + c ∫ K(τ, τ′) S(τ′) dτ′ with the albedo c, optical depths τ, and
/// K = ½ E₁(|τ − τ′|) + ½ ∫₀¹ R(µ) exp(−(τ + τ′)/µ) dµ/µ; by Nyström's method on a stretched grid,
/// with the singularity of E₁ subtracted.
struct Importance {
    depths: Vec<f64>,
    weights: Vec<f64>,
    /// The rows of 1 − c K.
    matrix: Vec<Vec<f64>>,
}

const NODES: usize = 300;
const ANGLES: usize = 48;

impl Importance {
    fn new(medium: &Medium) -> Self {
        let albedo = medium.scattered_fraction();
        let deepest = 30.0 / (3.0 * (1.0 - albedo)).sqrt().min(1.0);
        // τ = a sinh²(u) is dense at the surface.
        let last = (deepest / 0.05_f64).sqrt().asinh();
        let step = last / NODES as f64;
        let at = |index: usize| (index as f64 + 0.5) * step;
        let depths: Vec<_> = (0..NODES).map(|i| 0.05 * at(i).sinh().powi(2)).collect();
        let weights: Vec<_> = (0..NODES)
            .map(|i| step * 0.1 * at(i).sinh() * at(i).cosh())
            .collect();
        let cosines = (0..ANGLES).map(|i| (i as f64 + 0.5) / ANGLES as f64);
        let cosines: Vec<_> = cosines
            .map(|mu| (mu, medium.reflectance_from_inside(mu)))
            .collect();
        let mirrored = |depth: f64| -> f64 {
            let part = |(mu, reflected): &(f64, f64)| reflected * (-depth / mu).exp() / mu;
            0.5 * cosines.iter().map(part).sum::<f64>() / ANGLES as f64
        };
        let matrix = (0..NODES).map(|i| {
            let direct = |j: usize| 0.5 * e1((depths[i] - depths[j]).abs());
            let mut row: Vec<_> = (0..NODES)
                .map(|j| {
                    let kernel = mirrored(depths[i] + depths[j]);
                    let direct = if i == j { 0.0 } else { direct(j) };
                    -albedo * weights[j] * (kernel + direct)
                })
                .collect();
            // ∫ ½ E₁ = 1 − ½ E₂(τ), less what the other nodes have of it.
            let others: f64 = (0..NODES)
                .filter(|&j| j != i)
                .map(|j| weights[j] * direct(j))
                .sum();
            row[i] += 1.0 - albedo * (1.0 - 0.5 * e2(depths[i]) - others);
            row
        });
        let matrix = matrix.collect();
        Self {
            depths,
            weights,
            matrix,
        }
    }

    /// Returns the chances for light that leaves at the cosine, below the surface.
    fn seen_from(&self, cosine: f64) -> Vec<f64> {
        let source = self.depths.iter().map(|depth| (-depth / cosine).exp());
        solved(self.matrix.clone(), source.collect())
    }

    /// Returns the mean of the first flight at the cosine over those that are seen, as optical
    /// depth.
    fn mean_flight(&self, cosine: f64, seen: &[f64]) -> f64 {
        let mut sums = [0.0; 2];
        for ((depth, weight), seen) in self.depths.iter().zip(&self.weights).zip(seen) {
            let flight = depth / cosine;
            let light = weight * (-flight).exp() * seen;
            sums[0] += light;
            sums[1] += light * flight;
        }
        sums[1] / sums[0]
    }
}

/// Solves a system of equations by Gaussian elimination; the matrix is dominated by its diagonal.
fn solved(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    for i in 0..right.len() {
        let (above, below) = matrix.split_at_mut(i + 1);
        let pivot = &above[i];
        for (row, j) in below.iter_mut().zip(i + 1..) {
            let factor = row[i] / pivot[i];
            for (value, other) in row[i..].iter_mut().zip(&pivot[i..]) {
                *value -= factor * other;
            }
            right[j] -= factor * right[i];
        }
    }
    for i in (0..right.len()).rev() {
        let known: f64 = (i + 1..right.len()).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}

/// The exponential integral E₁: its series, or its continued fraction (Abramowitz and Stegun 5.1).
fn e1(x: f64) -> f64 {
    if x < 1.0 {
        let mut term = 1.0;
        let mut sum = -0.577_215_664_901_532_9 - x.ln();
        for k in 1..30 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        return sum;
    }
    let fraction = (1..80).rev().fold(0.0, |fraction, k| {
        let k = f64::from(k);
        k / (1.0 + k / (x + fraction))
    });
    (-x).exp() / (x + fraction)
}

fn e2(x: f64) -> f64 {
    (-x).exp() - x * e1(x)
}

#[test]
fn exponential_integrals_have_the_values_of_tables() {
    // Abramowitz and Stegun, tables 5.1 and 5.4.
    for (x, expected) in [
        (0.5, 0.559_773_595),
        (1.0, 0.219_383_934),
        (2.0, 0.048_900_511),
    ] {
        assert!((e1(x) / expected - 1.0).abs() < 1e-7, "E1({x}) = {}", e1(x));
    }
    assert!((e2(0.5) / 0.326_643_9 - 1.0).abs() < 1e-6, "E2");
}

/// n, µs′ and µa in 1/mm: marble in red light, a body that absorbs, skin in red and blue light, and
/// a dense white body.
const BODIES: [[f64; 3]; 5] = [
    [1.5, 2.19, 0.0021],
    [1.5, 2.19, 0.05],
    [1.3, 0.74, 0.032],
    [1.3, 1.01, 0.48],
    [1.5, 12.0, 0.01],
];

fn medium([n, scattering, absorption]: [f64; 3]) -> Medium {
    Medium::new(n, 1e3 * scattering, 1e3 * absorption).expect("a medium")
}

/// Follows photons from a line to cameras.
fn simulated(medium: &Medium, angles: (f64, &[f64]), photons: u64, seed: u64) -> Vec<LineSpread> {
    let walk = Walk {
        incidence: angles.0,
        exits: angles.1.to_vec(),
        photons,
        seed,
    };
    LineSpread::simulate(medium, &walk).expect("a simulation")
}

#[test]
fn the_centre_of_the_line_is_that_of_the_integral_equation() {
    let angles = [0.0, 20.0, 45.0, 60.0].map(f64::to_radians);
    for body in BODIES {
        let medium = medium(body);
        let importance = Importance::new(&medium);
        let ways = angles.map(|angle: f64| {
            let sine = angle.sin() / medium.refractive_index();
            let cosine = (1.0 - sine * sine).sqrt();
            (sine, cosine, importance.seen_from(cosine))
        });
        let (exits, ways_out) = (&angles[1..], &ways[1..]);
        for (incidence, way_in) in angles.iter().zip(&ways) {
            let seen = simulated(&medium, (*incidence, exits), 30_000, 7);
            for ((exit, way_out), seen) in exits.iter().zip(ways_out).zip(seen) {
                let part = |(sine, cosine, _): &(f64, f64, Vec<f64>), other: &[f64]| {
                    sine * importance.mean_flight(*cosine, other) / medium.extinction()
                };
                let exact = part(way_in, &way_out.2) + part(way_out, &way_in.2);
                let error = seen.centroid() / exact - 1.0;
                let allowed = 4.0 * seen.standard_error() / exact;
                assert!(
                    error.abs() < allowed + 1e-3,
                    "{body:?}, {incidence}, {exit}: {error}"
                );
            }
        }
    }
}

#[test]
fn light_paths_can_be_reversed_at_any_anisotropy_and_slope() {
    for (g, slope) in [(-0.5, 0.0), (0.5, 0.0), (0.9, 0.0), (0.0, 0.2), (0.5, 0.5)] {
        let medium = medium([1.5, 2.19, 0.05]).with_anisotropy(g);
        let medium = medium.and_then(|medium| medium.with_matt_boundary(slope));
        let medium = medium.expect("a medium");
        // Steep facets at grazing angles carry rare bright light.
        let photons = if slope > 0.3 { 600_000 } else { 30_000 };
        let [there, back] = [(0.2, 0.9, 1), (0.9, 0.2, 2)].map(|(incidence, exit, seed)| {
            simulated(&medium, (incidence, &[exit]), photons, seed).remove(0)
        });
        let noise = there.standard_error().hypot(back.standard_error());
        let difference = there.centroid() - back.centroid();
        assert!(
            difference.abs() < 3.0 * noise,
            "g = {g}, {slope}: {difference} m"
        );
        // Radiance is reciprocal as well: the factors are those of one function.
        let ratio = there.radiance_factor() / back.radiance_factor();
        assert!((ratio - 1.0).abs() < 0.03, "g = {g}, {slope}: {ratio}");
    }
}

#[test]
fn facets_shift_the_line_as_another_program_computed() {
    // Root mean square slopes along each axis.
    for (slope, expected) in [(0.1, 180e-6), (0.25, 187e-6), (0.5, 205e-6)] {
        let matt = medium([1.5, 2.19, 0.05]).with_matt_boundary(slope);
        let seen = simulated(&matt.expect("a medium"), (0.0, &[FRAC_PI_4]), 60_000, 5);
        let ratio = seen[0].centroid() / expected;
        assert!((ratio - 1.0).abs() < 0.02, "{slope}: {ratio}");
    }
}

/// A body that was counted photon by photon, without next events, by a program that shares no code
/// with this one: lit along the normal, seen at 45°.
#[derive(Debug)]
struct Counted {
    body: [f64; 3],
    anisotropy: f64,
    /// The centre of the line and its standard error, in millimetres.
    centroid: [f64; 2],
    /// Contrast of the whole line at 1 pm, 10 pm, 0.1 nm and 1 nm about 660 nm.
    whole: [f64; 4],
    /// Contrast of the light that leaves within 0.1 mm of the entry.
    near: [f64; 4],
    /// The fraction of the photons that leaves the body.
    albedo: f64,
    /// A line of 0.2 mm between the points of 1/e²: its full width at half maximum, and its centre
    /// within 0.2, 0.5 and 1.5 mm of itself, in millimetres.
    detected: [f64; 4],
}

/// Red marble, the same with forward scattering, a white plastic, and skin.
const COUNTED: [Counted; 4] = [
    Counted {
        body: [1.5, 2.19, 0.0021],
        anisotropy: 0.0,
        centroid: [0.2155, 0.0046],
        whole: [0.8915, 0.5885, 0.2541, 0.0854],
        near: [0.9841, 0.8790, 0.6127, 0.3084],
        albedo: 0.83797,
        detected: [0.4, 0.0916, 0.1254, 0.1592],
    },
    Counted {
        body: [1.5, 2.19, 0.0021],
        anisotropy: 0.9,
        centroid: [0.2153, 0.0046],
        whole: [0.8921, 0.5927, 0.2559, 0.0852],
        near: [0.9800, 0.8465, 0.5144, 0.2049],
        albedo: 0.83829,
        detected: [0.992, 0.0977, 0.1596, 0.1992],
    },
    Counted {
        body: [1.5, 12.0, 0.003],
        anisotropy: 0.0,
        centroid: [0.0402, 0.0012],
        whole: [0.9567, 0.7802, 0.4566, 0.1779],
        near: [0.9953, 0.9477, 0.7375, 0.3660],
        albedo: 0.91235,
        detected: [0.248, 0.0259, 0.0327, 0.0376],
    },
    Counted {
        body: [1.3, 0.74, 0.032],
        anisotropy: 0.0,
        centroid: [0.5830, 0.0048],
        whole: [0.9878, 0.7595, 0.3267, 0.1089],
        near: [0.9970, 0.9135, 0.6452, 0.3915],
        albedo: 0.43949,
        detected: [0.686, 0.1559, 0.2755, 0.4131],
    },
];

impl Counted {
    fn medium(&self) -> Medium {
        let medium = medium(self.body).with_anisotropy(self.anisotropy);
        medium.expect("a medium")
    }

    /// Asserts the contrasts of the whole line and of the light near the entry.
    fn assert_contrasts(
        &self,
        contrast: impl Fn(&Spectrum, [f64; 2]) -> Option<f64>,
        tolerance: f64,
    ) {
        let expected = self.whole.iter().zip(self.near);
        for (linewidth, (whole, near)) in [1e-12, 1e-11, 1e-10, 1e-9].into_iter().zip(expected) {
            let line = Spectrum::new(660e-9, linewidth, PeakShape::Gaussian);
            let line = line.expect("a line");
            for (end, expected) in [(1.0, *whole), (1e-4, near)] {
                let contrast = contrast(&line, [-end, end]).expect("paths");
                assert!(
                    (contrast / expected - 1.0).abs() < tolerance,
                    "{self:?}, {linewidth}: {contrast} for {expected}"
                );
            }
        }
    }
}

#[test]
fn shift_contrast_and_albedo_are_those_of_photons_that_were_counted() {
    for counted in COUNTED {
        let seen = simulated(&counted.medium(), (0.0, &[FRAC_PI_4]), 100_000, 5).remove(0);
        assert!(
            (seen.albedo() - counted.albedo).abs() < 0.005,
            "{counted:?}: {}",
            seen.albedo()
        );
        let [centroid, error] = counted.centroid.map(|length| 1e-3 * length);
        let error = error.hypot(seen.standard_error());
        assert!(
            (seen.centroid() - centroid).abs() < 3.0 * error,
            "{counted:?}: {}",
            seen.centroid()
        );
        counted.assert_contrasts(|line, places| seen.contrast(line, places), 0.05);
    }
}

/// The light of a line, in steps of 2 µm, as a lens without blur would image it.
struct Profile {
    places: Vec<f64>,
    light: Vec<f64>,
}

impl Profile {
    /// Returns the light of a Gaussian line of a full width between the points of 1/e².
    fn new(line: &SpreadLine, width: f64) -> Self {
        let scale = 8.0_f64.sqrt() / width;
        let places: Vec<_> = (-4000..=4000).map(|step| 2e-6 * f64::from(step)).collect();
        let at = |place: f64| -> f64 {
            let part = |bin: Bin| {
                let edge = |edge: f64| libm::erf(scale * (place - edge));
                bin.fraction / (bin.to - bin.from) * (edge(bin.from) - edge(bin.to))
            };
            line.bins().map(part).sum()
        };
        let light = places.iter().map(|&place| at(place)).collect();
        Self { places, light }
    }

    fn peak(&self) -> usize {
        (0..self.light.len())
            .max_by(|&a, &b| self.light[a].total_cmp(&self.light[b]))
            .expect("light")
    }

    fn width_at_half_maximum(&self) -> f64 {
        let half = 0.5 * self.light[self.peak()];
        2e-6 * self.light.iter().filter(|&&light| light > half).count() as f64
    }

    /// Returns the centre of the light within `window` of that centre.
    fn centre(&self, window: f64) -> f64 {
        (0..200).fold(self.places[self.peak()], |centre, _| {
            let pairs = self.places.iter().zip(&self.light);
            let seen = pairs.filter(|(place, _)| (*place - centre).abs() <= window);
            let sums = seen.fold([0.0; 2], |[light, moment], (place, l)| {
                [light + l, moment + l * place]
            });
            sums[1] / sums[0]
        })
    }
}

#[test]
fn detectors_find_the_line_where_they_find_counted_photons() {
    for counted in COUNTED {
        let line = SpreadLine::new(&counted.medium(), 0.0, FRAC_PI_4).expect("a line");
        // A twentieth of the photons that a simulation of one's own has.
        counted.assert_contrasts(|spectrum, places| line.contrast(spectrum, places), 0.12);
        let profile = Profile::new(&line, 0.2e-3);
        // Forward scattering spreads the line to a plateau, whose counts are noisy.
        let tolerance = if counted.anisotropy > 0.0 { 0.12 } else { 0.03 };
        let windows = [0.2e-3, 0.5e-3, 1.5e-3];
        let found = [profile.width_at_half_maximum()]
            .into_iter()
            .chain(windows.map(|window| profile.centre(window)));
        for (found, expected) in found.zip(counted.detected) {
            let expected = 1e-3 * expected;
            assert!(
                (found - expected).abs() < tolerance * expected + 2e-6,
                "{counted:?}: {found} m for {expected} m"
            );
        }
    }
}

/// A line on marble as a render shows it, beside the line of the half space: its light, and its
/// centre in windows.
#[test]
fn a_rendered_line_is_that_of_the_half_space() {
    let angle = FRAC_PI_4;
    let mut scene = renders::scene(&format!(
        r#"
        [camera]
        position = [{0}, 0, {0}]
        focal_length = "100 mm"
        pixel_pitch = "2 um"
        resolution = [640, 16]
        [[laser]]
        wavelength = "660 nm"
        power = "5 mW"
        position = [0, 0, 1]
        line_direction = [0, 1, 0]
        line = {{ fan_angle = "10 deg", thickness = "0.2 mm" }}
        [[surface]]
        rectangle.size = [0.2, 0.2]
        translucent = {{ material = "marble", roughness = 0.01 }}
        "#,
        angle.sin()
    ));
    scene.render.samples_per_pixel = 512;
    let frame = means::render(&scene, &scene.render);
    let image = &frame.lasers[0].single;
    // The place and the light of each column, with the length that it covers.
    let columns = (0..image.width()).map(|column| {
        let place = |column: f64| {
            let ray = scene.camera.ray(DVec2::new(column, 8.0));
            ray.origin.x - ray.direction.x * ray.origin.z / ray.direction.z
        };
        let column_f64 = column as f64;
        let length = (place(column_f64 + 1.0) - place(column_f64)).abs();
        let light: f64 = (0..image.height())
            .map(|row| f64::from(image[(column, row)]))
            .sum();
        [
            place(column_f64 + 0.5),
            light * length / image.height() as f64,
        ]
    });
    let columns: Vec<_> = columns.collect();
    let marble = Material::ALL
        .iter()
        .find(|material| material.name == "marble");
    let medium = marble.expect("marble").medium(660e-9).expect("a medium");
    let line = SpreadLine::new(&medium, 0.0, angle).expect("a line");
    let profile = Profile::new(&line, 0.2e-3);
    // The same columns of the line.
    let light_at = |place: f64| {
        let after = profile.places.partition_point(|&x| x < place);
        profile.light.get(after).copied().unwrap_or_default()
    };
    for window in [0.2e-3, 0.5e-3, 1.5e-3] {
        let centre = |light: &dyn Fn(f64, f64) -> f64| {
            let seen = columns.iter().filter(|[place, _]| place.abs() <= window);
            let sums = seen.fold([0.0; 2], |[sum, moment], &[place, l]| {
                let light = light(place, l);
                [sum + light, moment + light * place]
            });
            sums[1] / sums[0]
        };
        let [found, expected] = [centre(&|_, l| l), centre(&|place, _| light_at(place))];
        assert!(
            (found - expected).abs() < 0.05 * expected,
            "±{window}: {found} for {expected}"
        );
    }
    let spread = &simulated(&medium, (0.0, &[angle]), 100_000, 1)[0];
    let laser = scene.laser_at(0, 0);
    let irradiance = |step: i32| {
        let event = laser.next_event(DVec3::new(1e-6 * f64::from(step), 0.0, 0.0));
        event.map_or(0.0, |event| event.e_perp)
    };
    let lit: f64 = (-500..=500).map(|step| 1e-6 * irradiance(step)).sum();
    let ends = [columns[0][0], columns[columns.len() - 1][0]];
    let [from, to] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
    let within = |bin: &Bin| bin.from > from && bin.to < to;
    let seen: f64 = line.bins().filter(within).map(|bin| bin.fraction).sum();
    let expected = seen * lit * spread.radiance_factor() / core::f64::consts::PI;
    let found: f64 = columns.iter().map(|[_, light]| light).sum();
    assert!(
        (found / expected - 1.0).abs() < 0.03,
        "{found} for {expected}"
    );
}

/// Light from below a surface, in renders: its contrast is that of the paths, and its pattern is
/// new once the surface has moved.
#[test]
fn speckle_of_light_from_below_is_that_of_its_paths() {
    let scene = |linewidth: &str| {
        renders::scene(&format!(
            r#"
            [camera]
            position = [0, -0.1, 0.28]
            focal_length = "25 mm"
            f_number = 16
            pixel_pitch = "3 um"
            resolution = [192, 160]
            [[laser]]
            wavelength = "660 nm"
            linewidth = {linewidth}
            power = "2 mW"
            position = [0, 0, 0.2]
            spot.waist_radius = "0.3 mm"
            [[surface]]
            displacement_per_frame = ["1 um", 0, 0]
            rectangle.size = [0.05, 0.05]
            translucent = {{ material = "marble", roughness = 0.01 }}
            [render]
            samples_per_pixel = 8
            frames = 2
            "#
        ))
    };
    // The factor of each pixel that light reaches.
    let factors = |frame: &Frame| -> Vec<Option<f64>> {
        let [light, speckled] = [&frame.lasers[0].single, &frame.lasers[0].radiance];
        let pairs = light.values().iter().zip(speckled.values());
        pairs
            .map(|(light, speckled)| (*light > 0.0).then(|| f64::from(speckled / light)))
            .collect()
    };
    let covariance = |one: &[Option<f64>], other: &[Option<f64>]| {
        let pairs = one.iter().zip(other);
        let pairs: Vec<_> = pairs.filter_map(|(a, b)| a.zip(*b)).collect();
        let mean = |value: &dyn Fn(&(f64, f64)) -> f64| {
            pairs.iter().map(value).sum::<f64>() / pairs.len() as f64
        };
        mean(&|(a, b)| a * b) - mean(&|(a, _)| *a) * mean(&|(_, b)| *b)
    };
    let renders = |scene: &Scene, number: u32| {
        let model = renders::speckle(scene, 1);
        let prepared = ReferenceSpeckle::prepare(scene, 1).expect("patterns");
        let go_on = AtomicBool::new(false);
        let options = &scene.render;
        let reference = render_reference(scene, Some(&prepared), number, options, &|_| (), &go_on);
        [
            renders::frame(scene, Some(&model), number, options),
            reference.expect("a render"),
        ]
    };
    let [sharp, wide] = ["0", "\"0.1 nm\""].map(scene);
    let medium = *sharp.surfaces[0].material.below().expect("marble");
    let [incidence, exit] = [0.0, 0.1_f64.atan2(0.28)];
    let line = SpreadLine::new(&medium, incidence, exit).expect("a line");
    let spectrum = wide.lasers[0].spectrum();
    let expected = line.contrast(spectrum, [-0.3e-3, 0.3e-3]).expect("paths");
    let [first, moved, wide] =
        [(&sharp, 0), (&sharp, 1), (&wide, 0)].map(|(scene, n)| renders(scene, n));
    for renderer in 0..2 {
        let [first, moved, wide] = [&first, &moved, &wide].map(|of| factors(&of[renderer]));
        let variance = covariance(&first, &first);
        let left = (covariance(&wide, &wide) / variance).sqrt();
        assert!(
            (left / expected - 1.0).abs() < 0.05,
            "{renderer}: {left} of {expected}"
        );
        let shared = covariance(&first, &moved) / variance;
        assert!(
            shared.abs() < 0.2,
            "{renderer}: {shared} is left after a motion"
        );
    }
}

#[test]
fn materials_have_the_diffuse_reflectance_that_was_published_with_them() {
    // Jensen et al. 2001, table 1: in red, green and blue light, to two digits.
    for (material, published) in Material::ALL.iter().zip([
        [0.85, 0.84, 0.53],
        [0.31, 0.15, 0.10],
        [0.32, 0.16, 0.10],
        [0.98, 0.90, 0.73],
        [0.16, 0.01, 0.00],
        [0.83, 0.79, 0.75],
        [0.77, 0.62, 0.21],
        [0.81, 0.81, 0.69],
        [0.44, 0.22, 0.13],
        [0.63, 0.44, 0.34],
        [0.91, 0.88, 0.76],
    ]) {
        for (wavelength, expected) in [650e-9, 550e-9, 450e-9].into_iter().zip(published) {
            let medium = material.medium(wavelength).expect("a medium");
            let albedo = simulated(&medium, (0.0, &[0.0]), 20_000, 3)[0].albedo();
            let name = material.name;
            assert!(
                (albedo - expected).abs() < 0.02,
                "{name}: {albedo} for {expected}"
            );
        }
    }
}

/// Chandrasekhar's function H of isotropic scattering at the cosine `mu`, for an albedo c of a
/// collision: 1/H(µ) = √(1 − c) + c/2 ∫ H(µ′) µ′/(µ + µ′) dµ′ (Radiative Transfer, 1960, § 40).
fn h_function(c: f64, mu: f64) -> f64 {
    let nodes: Vec<_> = (0..400).map(|i| (f64::from(i) + 0.5) / 400.0).collect();
    let inverse = |h: &[f64], mu: f64| {
        let part = |(node, h): (&f64, &f64)| h * node / (mu + node) / nodes.len() as f64;
        (1.0 - c).sqrt() + 0.5 * c * nodes.iter().zip(h).map(part).sum::<f64>()
    };
    let mut h = vec![1.0; nodes.len()];
    for _ in 0..200 {
        h = nodes.iter().map(|&mu| 1.0 / inverse(&h, mu)).collect();
    }
    1.0 / inverse(&h, mu)
}

/// Without a step of the refractive index the reflectance has a closed form, 1 − √(1 − c) H(µ);
/// with n = 1.5 and c = 0.9 Giovanelli (Opt. Acta 2, 153, 1955) computed 0.2600, with what the
/// boundary reflects.
#[test]
fn a_half_space_reflects_what_theory_says() {
    let albedo = |n: f64, c: f64, incidence: f64| {
        let medium = Medium::new(n, 1e3, 1e3 * (1.0 / c - 1.0)).expect("a medium");
        simulated(&medium, (incidence, &[0.0]), 400_000, 3)[0].albedo()
    };
    for c in [0.5_f64, 0.9, 0.99] {
        for incidence in [0.0_f64, 60_f64.to_radians()] {
            let expected = 1.0 - (1.0 - c).sqrt() * h_function(c, incidence.cos());
            let found = albedo(1.0, c, incidence);
            // Four standard errors of 400,000 photons.
            assert!(
                (found - expected).abs() < 0.003,
                "{c}, {incidence}: {found} for {expected}"
            );
        }
    }
    let boundary = 0.04;
    let found = boundary + (1.0 - boundary) * albedo(1.5, 0.9, 0.0);
    assert!((found - 0.26).abs() < 0.002, "{found}");
}

#[test]
fn tables_hold_for_every_body_and_angle() {
    for body in BODIES {
        let medium = medium(body);
        for (incidence, exits) in [(0.0_f64, &[45.0_f64, 22.5][..]), (12.5, &[37.5])] {
            let incidence = incidence.to_radians();
            let exits: Vec<_> = exits.iter().map(|exit| exit.to_radians()).collect();
            let seen = simulated(&medium, (incidence, &exits), 100_000, 9);
            for (exit, seen) in exits.into_iter().zip(seen) {
                let line = SpreadLine::new(&medium, incidence, exit).expect("a line");
                let ratio = line.centroid() / seen.centroid();
                assert!((ratio - 1.0).abs() < 0.012, "{body:?}, {exit}: {ratio}");
            }
        }
    }
}

#[test]
fn radiances_of_all_directions_add_up_to_the_light_that_leaves() {
    // Along the normal nothing depends on the azimuth: T albedo = ∫ factor d(sin²θ).
    const DIRECTIONS: u32 = 24;
    let sines = (0..DIRECTIONS).map(|k| (f64::from(k) + 0.5) / f64::from(DIRECTIONS));
    for body in BODIES {
        let medium = medium(body);
        let exits: Vec<_> = sines.clone().map(|square| square.sqrt().asin()).collect();
        let seen = simulated(&medium, (0.0, &exits), 60_000, 11);
        let left: f64 = seen.iter().map(LineSpread::radiance_factor).sum();
        let left = left / f64::from(DIRECTIONS);
        let expected = seen[0].albedo() * (1.0 - medium.reflectance_from_inside(1.0));
        // Photons that leave are counted, and 24 directions are few near grazing.
        let albedo = seen[0].albedo();
        let error = ((1.0 - albedo) / albedo / 60_000.0).sqrt();
        assert!(
            (left / expected - 1.0).abs() < 4.0 * error + 0.01,
            "{body:?}: {left} for {expected}"
        );
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_for_any_number_of_threads() {
    let medium = medium(BODIES[1]);
    let run = |threads| on_threads(threads, || simulated(&medium, (0.1, &[0.3, 0.5]), 2_000, 3));
    assert_eq!(run(1), run(3));
}
