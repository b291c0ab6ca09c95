//! What no lens, mirror or distance changes about a beam (Simon, Mukunda and Sudarshan 1988), and
//! the second moments of the rays that carry it.
//!
//! The oracle is plain 4×4 algebra of the second moments, `M Σ Mᵀ`, with determinants by expansion;
//! the crate itself never forms these products.
#![expect(clippy::expect_used, reason = "helpers of tests")]

use core::f64::consts::PI;

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use tem00_beam::optics::{AbcdMatrix, AstigmaticSystem};
use tem00_beam::{
    AstigmaticBeam, BeamError, DMat2, DVec2, GaussianBeam, GeneralAstigmaticBeam, LocatedBeam,
    SecondMoments,
};

const WAVELENGTH: f64 = 650e-9;
/// Lengths of the systems, in metres: the unit in which positions and slopes weigh the same.
const UNIT: f64 = 0.1;

type Matrix = [[f64; 4]; 4];

/// The 4×4 matrix of the blocks `[[a, b], [c, d]]`, with positions in units of [`UNIT`].
fn matrix([[a, b], [c, d]]: [[DMat2; 2]; 2]) -> Matrix {
    let blocks = [[a, b / UNIT], [c * UNIT, d]];
    core::array::from_fn(|i| core::array::from_fn(|j| blocks[i / 2][j / 2].col(j % 2)[i % 2]))
}

fn covariance(moments: &SecondMoments) -> Matrix {
    let SecondMoments {
        position,
        mixed,
        slope,
    } = *moments;
    let [p, m] = [position / (UNIT * UNIT), mixed / UNIT];
    let blocks = [[p, m], [m.transpose(), slope]];
    core::array::from_fn(|i| core::array::from_fn(|j| blocks[i / 2][j / 2].col(j % 2)[i % 2]))
}

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let entry = |i: usize, j: usize| (0..4).map(|k| a[i][k] * b[k][j]).sum();
    core::array::from_fn(|i| core::array::from_fn(|j| entry(i, j)))
}

fn transpose(a: &Matrix) -> Matrix {
    core::array::from_fn(|i| core::array::from_fn(|j| a[j][i]))
}

/// The Frobenius norm, which bounds how far a matrix stretches.
fn norm(a: &Matrix) -> f64 {
    a.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// The determinant, by expansion along the first row.
fn determinant(a: &[Vec<f64>]) -> f64 {
    if a.len() == 1 {
        return a[0][0];
    }
    let minor = |j: usize| -> Vec<Vec<f64>> {
        let without = |row: &Vec<f64>| {
            let kept = row.iter().enumerate().filter(|(k, _)| *k != j);
            kept.map(|(_, x)| *x).collect()
        };
        a[1..].iter().map(without).collect()
    };
    let term = |j: usize| {
        let sign = if j.is_multiple_of(2) { 1.0 } else { -1.0 };
        sign * a[0][j] * determinant(&minor(j))
    };
    (0..a.len()).map(term).sum()
}

/// The sum of the squares of the two symplectic eigenvalues, and the square of their product, from
/// determinants of the moments.
fn invariants(sigma: &Matrix) -> [f64; 2] {
    // The rows of position and slope along one axis against the columns along another.
    let block =
        |i: usize, j: usize| sigma[i][j] * sigma[i + 2][j + 2] - sigma[i][j + 2] * sigma[i + 2][j];
    let rows: Vec<Vec<f64>> = sigma.iter().map(|row| row.to_vec()).collect();
    [
        block(0, 0) + block(1, 1) + 2.0 * block(0, 1),
        determinant(&rows),
    ]
}

/// A beam in general position: elliptic, turned, partially coherent and sent through a lens.
fn beam(radii: [f64; 2], m_squared: [f64; 2], angle: f64) -> GeneralAstigmaticBeam {
    let axis = |i: usize| {
        let beam = GaussianBeam::from_waist(WAVELENGTH, radii[i])
            .and_then(|beam| beam.with_m_squared(m_squared[i]))
            .expect("a valid beam");
        LocatedBeam::new(beam, 0.1 * m_squared[i] - 0.2).expect("a valid place")
    };
    let simple = AstigmaticBeam::new(axis(0), axis(1))
        .and_then(|beam| beam.with_rotation(angle))
        .expect("a valid beam");
    let lens = AstigmaticSystem::cylinder_lens(0.3, 0.5 - angle).expect("a valid lens");
    GeneralAstigmaticBeam::from(simple)
        .through(&lens)
        .expect("a valid beam")
}

/// One element of each kind.
fn element(kind: u32, length: f64, angle: f64) -> Result<AstigmaticSystem, BeamError> {
    match kind {
        0 => AstigmaticSystem::free_space(length),
        1 => AstigmaticSystem::thin_lens(length),
        2 => AstigmaticSystem::cylinder_lens(length, angle),
        3 => AstigmaticSystem::image_rotation(angle),
        4 => AstigmaticSystem::from_axes([AbcdMatrix::flat_interface(1.0, 1.5)?; 2], angle),
        5 => AstigmaticSystem::from_axes(AbcdMatrix::tilted_mirror(0.5 / length, 0.4)?, angle),
        _ => AstigmaticSystem::new([
            [-DMat2::IDENTITY, DMat2::ZERO],
            [DMat2::ZERO, -DMat2::IDENTITY],
        ]),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_chain_of_elements_changes_the_quality_of_a_beam(
        radii in prop::array::uniform2(0.1e-3..1e-3_f64),
        m_squared in prop::array::uniform2(1.0..5.0_f64),
        angle in -3.0..3.0_f64,
        chain in prop::collection::vec((0..7_u32, 0.1..0.5_f64, -3.0..3.0_f64), 1..7),
    ) {
        let first = beam(radii, m_squared, angle);
        let start = covariance(&first.moments_at(0.0));
        let (mut last, mut sigma) = (first, start);
        let mut growth = norm(&start);
        let mut ratio = 1.0;
        for (kind, length, angle) in chain {
            let system = element(kind, length, angle).unwrap();
            let m = matrix(system.blocks());
            growth *= norm(&m).powi(2);
            sigma = product(&product(&m, &sigma), &transpose(&m));
            ratio *= system.index_ratio();
            last = last.through(&system).unwrap();
            // A step of the chain rounds 4-vectors a dozen times; later steps stretch that by no more
            // than their norms.
            let tolerance = 1e-14 * growth;
            let moments = covariance(&last.moments_at(0.0));
            for (got, want) in moments.as_flattened().iter().zip(sigma.as_flattened()) {
                prop_assert!((got - want).abs() < tolerance, "{system:?}: {got:e}, {want:e}");
            }
            for (got, want) in last.beam_quality().iter().zip(first.beam_quality()) {
                // The eigenvalues are in units of metres, moments in units of UNIT.
                let quantum = WAVELENGTH * ratio / (4.0 * PI) / UNIT;
                prop_assert!((got - want).abs() * quantum < tolerance, "{system:?}: {got}, {want}");
            }
            prop_assert!((last.wavelength() / (WAVELENGTH * ratio) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn beam_quality_is_that_of_the_determinants(
        radii in prop::array::uniform2(0.1e-3..0.5e-3_f64),
        m_squared in prop::array::uniform2(1.0..5.0_f64),
        angle in -3.0..3.0_f64,
    ) {
        let beam = beam(radii, m_squared, angle);
        let sigma = covariance(&beam.moments_at(0.0));
        let [squares, product] = invariants(&sigma);
        let quantum = WAVELENGTH / (4.0 * PI) / UNIT;
        let [a, b] = beam.beam_quality().map(|quality| quality * quantum);
        // Determinants of 2 and 4 dimensions cancel down from powers of the norm.
        let scale = norm(&sigma).powi(2);
        prop_assert!((a * a + b * b - squares).abs() < 1e-14 * scale, "{a}, {b}, {squares}");
        prop_assert!((a * a * b * b - product).abs() < 1e-14 * scale * scale, "{a}, {b}, {product}");
        // In the axes of the beam they are those of the two beams of one dimension.
        let mut known = m_squared;
        known.sort_by(f64::total_cmp);
        for (got, want) in beam.beam_quality().iter().zip(known) {
            prop_assert!((got / want - 1.0).abs() < 1e-11, "{got}, {want}");
        }
    }
}

/// The lower triangular root of a positive definite matrix.
fn cholesky(a: &Matrix) -> Matrix {
    let mut root = [[0.0; 4]; 4];
    for i in 0..4 {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| root[i][k] * root[j][k]).sum();
            root[i][j] = if i == j {
                (a[i][i] - sum).sqrt()
            } else {
                (a[i][j] - sum) / root[j][j]
            };
        }
    }
    root
}

/// Four standard normal numbers (Box and Muller).
fn normals(rng: &mut ChaCha8Rng) -> [f64; 4] {
    let pair = |u: [f64; 2]| {
        let (sin, cos) = (2.0 * PI * u[1]).sin_cos();
        let radius = (-2.0 * (1.0 - u[0]).ln()).sqrt();
        [radius * cos, radius * sin]
    };
    let ([a, b], [c, d]) = (pair(rng.random()), pair(rng.random()));
    [a, b, c, d]
}

#[test]
fn rays_through_lenses_have_the_moments_of_the_beam() {
    const COUNT: u32 = 40_000;
    // Ten moments in each of two planes: 4.6 standard deviations are exceeded by one of them with a
    // probability of 1e−4.
    const SIGMAS: f64 = 4.6;
    let before = beam([0.2e-3, 0.4e-3], [1.0, 2.0], 0.4);
    let system = [(2, 0.2, 1.0), (0, 0.15, 0.0), (2, -0.4, 0.3), (3, 0.0, 0.7)]
        .map(|(kind, length, angle)| element(kind, length, angle).expect("a valid element"))
        .into_iter()
        .reduce(AstigmaticSystem::then)
        .expect("four elements");
    let behind = before.through(&system).expect("a valid beam");
    let root = cholesky(&covariance(&before.moments_at(0.0)));
    for z in [0.0, 0.25] {
        let mut rng = ChaCha8Rng::seed_from_u64(1969);
        let mut sums = [[0.0; 4]; 4];
        for _ in 0..COUNT {
            let u = normals(&mut rng);
            let v: [f64; 4] = core::array::from_fn(|i| (0..4).map(|k| root[i][k] * u[k]).sum());
            let ray = [DVec2::new(v[0], v[1]) * UNIT, DVec2::new(v[2], v[3])];
            let [x, s] = system.transform_ray(ray);
            let x = (x + s * z) / UNIT;
            let ray = [x.x, x.y, s.x, s.y];
            for (row, a) in sums.iter_mut().zip(ray) {
                row.iter_mut().zip(ray).for_each(|(sum, b)| *sum += a * b);
            }
        }
        let want = covariance(&behind.moments_at(z));
        for i in 0..4 {
            for j in 0..=i {
                let got = sums[i][j] / f64::from(COUNT);
                // The product of two normal variates has the variance Σ_ii Σ_jj + Σ_ij².
                let variance = want[i][i] * want[j][j] + want[i][j] * want[i][j];
                let off = (got - want[i][j]) / (variance / f64::from(COUNT)).sqrt();
                assert!(off.abs() < SIGMAS, "z = {z}, entry {i}, {j}: {off} σ");
            }
        }
    }
}
