use super::*;
use crate::interpolation::covariance::{even_at, mean_square};

/// The cubic B-spline by its definition (Unser 1999, eq. 5).
fn kernel(x: f64) -> f64 {
    let x = x.abs();
    if x < 1.0 {
        2.0 / 3.0 - x * x + 0.5 * x * x * x
    } else {
        (2.0 - x.min(2.0)).powi(3) / 6.0
    }
}

/// What interpolation at the fraction `f` makes of the wave `exp(−2πi k x / Q)`, over the wave.
fn gain(k: f64, f: f64, size: usize) -> Complex<f64> {
    let angle = 2.0 * PI * k / size as f64;
    let filter = (0.5 * angle / (0.5 * angle).sin()).powi(4);
    let filter = if filter.is_nan() { 1.0 } else { filter };
    [-1.0, 0.0, 1.0, 2.0]
        .map(|t| Complex::from_polar(filter * kernel(t - f), -angle * (t - f)))
        .iter()
        .sum()
}

fn points(mask: &Mask) -> Vec<([f64; 2], f64)> {
    let [x0, y0] = mask.corner();
    (0..mask.extent()[1])
        .flat_map(|y| mask.powers(y).map(move |(x, power)| (x, y, power)))
        .map(|(x, y, power)| {
            let k = [(x0 + to_signed(x)) as f64, (y0 + to_signed(y)) as f64];
            (k, power)
        })
        .collect()
}

fn field(size: [usize; 2], speckle_size: f64, pupil: crate::Pupil) -> PupilField {
    let field = PupilField::from_speckle_size(size, speckle_size, 0).unwrap();
    field.with_pupil(pupil).unwrap()
}

const FRACTIONS: [[f64; 2]; 5] = [
    [0.0, 0.0],
    [0.5, 0.0],
    [0.0, 0.25],
    [0.5, 0.5],
    [0.875, 0.125],
];

/// Σ |t|² |gain|² / Σ |t|² at the fractions.
fn mean_square_gain(field: &PupilField, [fx, fy]: [f64; 2]) -> f64 {
    let [width, height] = field.size();
    let term = |&([x, y], power): &([f64; 2], f64)| {
        let (x, y) = (gain(x, fx, width), gain(y, fy, height));
        power * (x * y).norm_sqr()
    };
    points(&field.mask).iter().map(term).sum::<f64>() / field.mask.power()
}

#[expect(clippy::cast_possible_truncation, reason = "exact fractions")]
fn variance_at(variance: &Variance, [x, y]: [f64; 2]) -> f64 {
    let [value] = even_at(&mean_square(variance), &[x as f32], &[y as f32]);
    value.into()
}

#[test]
fn the_closed_variance_is_the_mean_square_gain() {
    let slanted = Grid::from_fn(9, 9, |x, y| (40 + x + x * y) as f32 / 112.0);
    let slanted = crate::Transmission::new(&slanted).unwrap();
    for (size, speckle_size) in [
        ([20, 20], 2.0),
        ([33, 33], 2.0625),
        ([64, 64], 5.3),
        ([36, 26], 2.5),
    ] {
        for pupil in [
            crate::Pupil::Circle,
            crate::Pupil::Annulus { inner: 0.4 },
            crate::Pupil::Rectangle { height: 0.8 },
            crate::Pupil::Gaussian { radius: 0.6 },
            crate::Pupil::Sampled(slanted.clone()),
        ] {
            let field = field(size, speckle_size, pupil.clone());
            let variance = Variance::expected(&field);
            for fractions in FRACTIONS {
                let expected = mean_square_gain(&field, fractions);
                let got = variance_at(&variance, fractions);
                // Sums of 16 terms of at most 4 in f32.
                assert!(
                    (got - expected).abs() < 1e-6,
                    "{pupil:?}, {size:?}, {fractions:?}: {got} | {expected}"
                );
            }
        }
    }
}

/// The largest deviation of the correlation of two look-ups from that of the field, over fractions
/// and over lags that include the steepest.
fn deviation(field: &PupilField, cells: &[[f64; 2]]) -> f64 {
    const STEPS: [f64; 6] = [0.0, 0.25, 0.499_99, 0.5, 0.625, 0.75];
    let size = field.size()[0] as f64;
    let wave =
        |[kx, ky]: [f64; 2], [x, y]: [f64; 2]| Complex::cis(-2.0 * PI * (kx * x + ky * y) / size);
    let points: Vec<_> = points(&field.mask).into_iter().map(|(k, _)| k).collect();
    let fractions = || STEPS.iter().flat_map(|&x| STEPS.map(|y| [x, y]));
    let looked_up = |f: [f64; 2]| -> Vec<Complex<f64>> {
        let side = field.size()[0];
        let along = |axis: usize, k: f64| gain(k, f[axis], side);
        let value = |k: &[f64; 2]| wave(*k, f) * along(0, k[0]) * along(1, k[1]);
        let values: Vec<_> = points.iter().map(value).collect();
        let power: f64 = values.iter().map(Complex::norm_sqr).sum();
        values.iter().map(|v| v / power.sqrt()).collect()
    };
    let fields: Vec<_> = fractions().map(|f| (f, looked_up(f))).collect();
    let mut worst = 0.0_f64;
    for &cell in cells {
        let phases: Vec<_> = points.iter().map(|&k| wave(k, cell)).collect();
        for (f, there) in &fields {
            let there: Vec<_> = there.iter().zip(&phases).map(|(a, b)| a * b).collect();
            for (g, here) in &fields {
                let products = here.iter().zip(&there).map(|(a, b)| a.conj() * b);
                let gamma = products.sum::<Complex<f64>>().norm_sqr();
                let lag = [f[0] - g[0] + cell[0], f[1] - g[1] + cell[1]];
                let exact = field.mask.correlation(lag, field.size()).norm_sqr();
                worst = worst.max((gamma - exact).abs());
            }
        }
    }
    worst
}

#[test]
fn the_error_of_the_spline_is_as_documented() {
    let cells = |lag: f64| [[0.0, 0.0], [lag, 0.0], [lag - 1.0, 0.0], [2.0, 2.0]];
    for (size, lag, stated) in [(48, 2.0, 3.8e-3), (96, 3.0, 1.3e-4), (192, 5.0, 7e-6)] {
        let field = field([size; 2], size as f64 / 24.0, crate::Pupil::Circle);
        let worst = deviation(&field, &cells(lag));
        assert!(
            worst < stated && worst > 0.8 * stated,
            "Q/C = {}: {worst:e}",
            size / 24
        );
    }
}

#[test]
fn the_field_of_the_spline_is_as_documented() {
    for (size, stated) in [(64, 4.3e-3), (128, 2e-4)] {
        let field = field([size; 2], size as f64 / 32.0, crate::Pupil::Circle);
        let mut rms = 0.0_f64;
        for [fx, fy] in FRACTIONS {
            let along = |k, f| gain(k, f, size);
            let square: f64 = points(&field.mask)
                .iter()
                .map(|([x, y], _)| (along(*x, fx) * along(*y, fy) - 1.0).norm_sqr())
                .sum();
            rms = rms.max((square / field.mask.power()).sqrt());
        }
        assert!(rms < stated && rms > 0.8 * stated, "rms error {rms:e}");
    }
}
