use core::f64::consts::PI;
use std::collections::BTreeMap;

use tem00_testkit::assert_absolute;

use super::*;
use crate::{Pupil, Transmission};

/// The cubic B-spline by its definition (Unser 1999, eq. 5).
pub(in crate::interpolation) fn spline(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        2.0 / 3.0 - x * x + 0.5 * x * x * x
    } else {
        (2.0 - x.min(2.0)).powi(3) / 6.0
    }
}

/// The response of a look-up at r = `f` to the pupil point k, by the sum over its taps: the phase
/// of each tap, and of k itself at the position of the tap.
fn looked_up(k: f64, f: f64, size: f64) -> Complex<f64> {
    let turn = |x: f64| Complex::cis(-2.0 * PI * k * x / size);
    let half = PI * k / size;
    let filter = if half == 0.0 {
        1.0
    } else {
        (half / half.sin()).powi(4)
    };
    let tap = |t: f64| turn(t) * (filter * spline(t - f));
    tap(-1.0) + tap(0.0) + tap(1.0) + tap(2.0)
}

/// Points of the pupil with their transmissions.
fn points(field: &PupilField) -> Vec<([i64; 2], Complex<f64>)> {
    let mask = &field.mask;
    let [x0, y0] = mask.corner();
    let mut points = Vec::new();
    for y in 0..mask.extent()[1] {
        for (x, _) in mask.powers(y) {
            let t = mask
                .weights(y)
                .map_or(Complex::new(1.0, 0.0), |w| to_c64(w[x]));
            points.push(([x0 + to_signed(x), y0 + to_signed(y)], t));
        }
    }
    points
}

/// Position at which two slices of a stack are looked up.
struct Place {
    shift: [i64; 2],
    fractions: [f64; 2],
    f: f64,
}

/// exp(−2πi k·r / Q).
fn wave(field: &PupilField, k: [i64; 2], r: [f64; 2]) -> Complex<f64> {
    let size = field.size().map(|n| n as f64);
    let turns = k[0] as f64 * r[0] / size[0] + k[1] as f64 * r[1] / size[1];
    Complex::cis(-2.0 * PI * turns)
}

/// The total contribution of each lattice point to the blend of two slices, of which one contains
/// it as `value` and the other in the frame turned by `frame`.
fn blended(
    field: &PupilField,
    place: &Place,
    frame: Complex<f64>,
    value: impl Fn([i64; 2]) -> Complex<f64>,
) -> Vec<Complex<f64>> {
    let mut sums = BTreeMap::new();
    for (k, t) in points(field) {
        let value = t * value(k);
        *sums.entry(k).or_insert(Complex::new(0.0, 0.0)) += value * (1.0 - place.f);
        let k = [k[0] + place.shift[0], k[1] + place.shift[1]];
        *sums.entry(k).or_insert(Complex::new(0.0, 0.0)) += value * frame * place.f;
    }
    sums.into_values().collect()
}

/// The blend of the interpolated amplitudes at r = `cell` + fractions.
fn interpolated(field: &PupilField, place: &Place, cell: [f64; 2]) -> Vec<Complex<f64>> {
    let frame = wave(field, place.shift, place.fractions) * wave(field, place.shift, cell);
    blended(field, place, frame, |k| {
        let along = |axis: usize| {
            let size = field.size()[axis] as f64;
            looked_up(k[axis] as f64, place.fractions[axis], size)
        };
        along(0) * along(1) * wave(field, k, cell)
    })
}

/// The blend of the fields themselves at r.
fn exact(field: &PupilField, place: &Place, r: [f64; 2]) -> Vec<Complex<f64>> {
    blended(field, place, wave(field, place.shift, r), |k| {
        wave(field, k, r)
    })
}

fn square(values: &[Complex<f64>]) -> f64 {
    values.iter().map(Complex::norm_sqr).sum()
}

/// |⟨u v*⟩|² of two amplitudes of the same light, each of mean square 1.
fn correlation(u: &[Complex<f64>], v: &[Complex<f64>]) -> f64 {
    let products = u.iter().zip(v).map(|(u, v)| u.conj() * v);
    products.sum::<Complex<f64>>().norm_sqr() / (square(u) * square(v))
}

#[expect(clippy::cast_possible_truncation, reason = "look-ups run in f32")]
fn mean_square_of_look_ups(field: &PupilField, place: &Place) -> f64 {
    let variance = Variance::expected(field);
    let responses = Responses::new(field);
    let covariance = responses.of_phasors(field, place.shift);
    let [x, y] = place.fractions.map(|f| f as f32);
    let [own] = even_at(&mean_square(&variance), &[x], &[y]);
    let [both] = covariance.at(&[x], &[y]);
    let f = place.f;
    let (own, both) = (f64::from(own), f64::from(both));
    ((1.0 - f).powi(2) + f * f) * own + 2.0 * f * (1.0 - f) * both
}

fn fields() -> Vec<PupilField> {
    let slanted = Grid::from_fn(13, 13, |x, y| (40 + x + x * y) as f32 / 208.0);
    // Coma: an odd phase, so that no two halves are equal.
    let coma = Grid::from_fn(25, 25, |x, y| {
        let (x, y) = ((x as f32 - 12.0) / 12.0, (y as f32 - 12.0) / 12.0);
        Complex::cis(4.0 * (3.0 * (x * x + y * y) - 2.0) * (x + 0.5 * y))
    });
    let mut fields = Vec::new();
    for (size, speckle_size) in [([33, 33], 2.0625), ([80, 56], 2.5)] {
        for pupil in [
            Pupil::Circle,
            Pupil::Annulus { inner: 0.4 },
            Pupil::Rectangle { height: 0.8 },
            Pupil::Gaussian { radius: 0.6 },
            Pupil::Sampled(Transmission::new(&slanted).unwrap()),
            Pupil::Sampled(Transmission::from_complex(coma.clone()).unwrap()),
        ] {
            let field = PupilField::from_speckle_size(size, speckle_size, 0).unwrap();
            fields.push(field.with_pupil(pupil).unwrap());
        }
    }
    fields
}

const FRACTIONS: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [0.5, 0.0],
    [0.125, 0.25],
    [0.5, 0.5],
    [0.875, 0.25],
];

#[test]
fn the_mean_square_between_slices_is_the_sum_over_the_points_of_both_pupils() {
    let mut worst = 0.0_f64;
    for field in fields() {
        for shift in [[0, 0], [-5, 6], [9, 4], [2, -14]] {
            for fractions in FRACTIONS {
                for f in [0.0, 0.25, 0.5] {
                    let place = Place {
                        shift,
                        fractions,
                        f,
                    };
                    let points = interpolated(&field, &place, [0.0; 2]);
                    let expected = square(&points) / field.mask.power();
                    let got = mean_square_of_look_ups(&field, &place);
                    worst = worst.max((got - expected).abs());
                    // On a slice sums of 16 terms of at most 4 in f32. Between slices sums of some
                    // ten terms (1e−6), the polynomials (1e−6) and the odd terms that are left out
                    // (2e−6), each halved by 2 f (1 − f).
                    let tolerance = if f > 0.0 { 2e-6 } else { 1e-6 };
                    assert_absolute(got, expected, tolerance);
                }
            }
        }
    }
    assert!(worst > 1e-8, "no rounding at all: {worst:e}");
}

#[test]
fn an_external_field_has_the_covariance_of_what_its_pupils_see() {
    let field = PupilField::from_speckle_size([40, 48], 2.0, 5).unwrap();
    let responses = Responses::new(&field);
    let shift = [4, -7];
    let phasors = responses.of_phasors(&field, shift);
    // Phasors of magnitude 1 are a special case of a field.
    let power = field.mask.power();
    let seen = |centre| {
        let mut grid = field.seen(centre);
        let scale = power.sqrt().recip();
        #[expect(clippy::cast_possible_truncation, reason = "fields are f32")]
        grid.values_mut()
            .iter_mut()
            .for_each(|z| *z *= scale as f32);
        grid
    };
    let light = responses.of_light(&seen([0, 0]), &seen(shift), shift);
    for [x, y] in [[0.0, 0.0], [0.5, 0.5], [0.875, 0.25]] {
        let ([a], [b]) = (phasors.at(&[x], &[y]), light.at(&[x], &[y]));
        assert!((a - b).abs() < 1e-6, "({x}, {y}): {a} | {b}");
    }
}

/// Against the fields of both slices, blended without any interpolation in the plane.
#[test]
fn correlations_deviate_as_documented_on_slices_and_between() {
    for (size, lag, stated) in [(48, 2.0, 3.8e-3), (96, 3.0, 1.3e-4), (192, 5.0, 7e-6)] {
        let field = PupilField::from_speckle_size([size; 2], size as f64 / 24.0, 0).unwrap();
        // A slice itself, and neighbours of 4 and 32 slices.
        let worst = [[0, 0], [12, 12], [1, 0]].map(|shift| deviation(&field, shift, lag));
        let within = |worst: f64| worst < stated && worst > 0.8 * stated;
        let between = f64::max(worst[1], worst[2]);
        assert!(within(worst[0]) && within(between), "{size}: {worst:?}");
    }
}

/// The largest deviation half-way between two slices, over fractions and over lags that include the
/// steepest.
fn deviation(field: &PupilField, shift: [i64; 2], lag: f64) -> f64 {
    const STEPS: [f64; 4] = [0.0, 0.25, 0.499_99, 0.75];
    let place = |fractions| Place {
        shift,
        fractions,
        f: 0.5,
    };
    let fractions = || STEPS.iter().flat_map(|&x| [[x, 0.0], [x, x]]);
    let origin = exact(field, &place([0.0; 2]), [0.0; 2]);
    let mut worst = 0.0_f64;
    for a in fractions() {
        let here = interpolated(field, &place(a), [0.0; 2]);
        for cell in [[0.0, 0.0], [lag, 0.0], [lag - 1.0, 0.0]] {
            for b in fractions() {
                let there = interpolated(field, &place(b), cell);
                let apart = [cell[0] + b[0] - a[0], cell[1] + b[1] - a[1]];
                let law = correlation(&origin, &exact(field, &place([0.0; 2]), apart));
                worst = worst.max((correlation(&here, &there) - law).abs());
            }
        }
    }
    worst
}

#[test]
fn the_field_of_the_spline_deviates_as_documented() {
    for (size, stated) in [(64, 4.3e-3), (128, 2e-4)] {
        let field = PupilField::from_speckle_size([size; 2], size as f64 / 32.0, 0).unwrap();
        let mut rms = 0.0_f64;
        for fractions in FRACTIONS {
            let (shift, f) = ([0, 0], 0.0);
            let place = Place {
                shift,
                fractions,
                f,
            };
            let found = interpolated(&field, &place, [0.0; 2]);
            let wanted = exact(&field, &place, fractions);
            let errors: Vec<_> = found.iter().zip(&wanted).map(|(a, b)| a - b).collect();
            rms = rms.max((square(&errors) / field.mask.power()).sqrt());
        }
        assert!(rms < stated && rms > 0.8 * stated, "rms error {rms:e}");
    }
}
