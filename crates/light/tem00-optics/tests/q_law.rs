//! Beams, rays and second moments through the same optics.

use core::f64::consts::PI;

use proptest::prelude::*;
use tem00_beam::{GaussianBeam, LocatedBeam};
use tem00_optics::{AbcdMatrix, ComplexBeamParameter};

/// A step of light along the axis.
#[derive(Clone, Copy, Debug)]
enum Element {
    Space(f64),
    Lens(f64),
    Mirror(f64),
    /// The index behind the interface, and its curvature.
    Interface(f64, f64),
    /// The gradient of a graded medium, and the length in it.
    Graded(f64, f64),
}

impl Element {
    fn matrix(self, index: f64) -> AbcdMatrix {
        match self {
            Self::Space(length) => AbcdMatrix::free_space(length),
            Self::Lens(focal_length) => AbcdMatrix::thin_lens(focal_length),
            Self::Mirror(curvature) => AbcdMatrix::curved_mirror(curvature),
            Self::Interface(behind, c) => AbcdMatrix::curved_interface(index, behind, c),
            Self::Graded(gradient, length) => AbcdMatrix::grin(gradient, length),
        }
        .unwrap()
    }

    fn index_behind(self, index: f64) -> f64 {
        match self {
            Self::Interface(behind, _) => behind,
            _ => index,
        }
    }

    /// Where a ray goes, from the geometry of the element and not from its matrix.
    fn trace(self, index: f64, [x, s]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Space(length) => [x + length * s, s],
            Self::Lens(focal_length) => [x, s - x / focal_length],
            // The normal is tilted by x c, the reflected ray by twice that.
            Self::Mirror(curvature) => [x, s - 2.0 * (x * curvature)],
            // Snell: angles of incidence and refraction against the normal, tilted by −x c.
            Self::Interface(behind, c) => [x, index * (s + x * c) / behind - x * c],
            Self::Graded(gradient, length) => power_series(-gradient * gradient, length, [x, s]),
        }
    }

    /// Bounds on what errors of height and slope, both positive, become.
    fn spread(self, index: f64, [x, s]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Space(length) => [x + length.abs() * s, s],
            Self::Lens(focal_length) => [x, s + x / focal_length.abs()],
            Self::Mirror(curvature) => [x, s + 2.0 * x * curvature.abs()],
            Self::Interface(behind, c) => {
                let bend = x * c.abs();
                [x, index * (s + bend) / behind + bend]
            }
            Self::Graded(gradient, length) => power_series(gradient * gradient, length, [x, s]),
        }
    }
}

/// The solution of x″ = `k` x at `length`, by its power series.
fn power_series(k: f64, length: f64, [x, s]: [f64; 2]) -> [f64; 2] {
    let (mut even, mut odd) = (x, s * length);
    let (mut height, mut slope) = (even + odd, s);
    for order in (2..40).step_by(2) {
        let n = f64::from(order);
        let step = k * length;
        slope += even * step / (n - 1.0);
        even *= step * length / (n * (n - 1.0));
        slope += odd * step / n;
        odd *= step * length / (n * (n + 1.0));
        height += even + odd;
    }
    [height, slope]
}

/// A beam as two rays: one parallel to the axis at the waist, one through the centre of the waist.
///
/// Their heights are the real and the imaginary part of the complex ray of Arnaud (1985): the sum
/// of the squares of the heights is w², of the slopes δ², and half the derivative of w² is w w'.
#[derive(Clone, Copy, Debug)]
struct TwoRays {
    rays: [[f64; 2]; 2],
    index: f64,
    /// Bounds on height and slope if nothing ever cancelled, which multiply rounding errors.
    bound: [f64; 2],
    roundings: f64,
}

impl TwoRays {
    fn of(beam: &LocatedBeam) -> Self {
        let (w, delta) = (beam.beam().waist_radius(), beam.beam().divergence());
        let z = -beam.waist_distance();
        Self {
            rays: [[w, 0.0], [z * delta, delta]],
            index: 1.0,
            bound: [w.hypot(z * delta), delta],
            roundings: 1.0,
        }
    }

    fn through(self, element: Element) -> Self {
        Self {
            rays: self.rays.map(|ray| element.trace(self.index, ray)),
            index: element.index_behind(self.index),
            bound: element.spread(self.index, self.bound),
            roundings: self.roundings + 1.0,
        }
    }

    fn radius(&self) -> f64 {
        self.rays[0][0].hypot(self.rays[1][0])
    }

    fn divergence(&self) -> f64 {
        self.rays[0][1].hypot(self.rays[1][1])
    }

    fn curvature(&self) -> f64 {
        let [first, second] = self.rays;
        (first[0] * first[1] + second[0] * second[1]) / self.radius() / self.radius()
    }

    /// The error of heights and slopes after some ten roundings per element, here and in the
    /// beams compared.
    fn errors(&self) -> [f64; 2] {
        self.bound
            .map(|bound| 10.0 * f64::EPSILON * self.roundings * bound)
    }

    /// The differences of radius, curvature and divergence, in units of their tolerances.
    fn differences(&self, beam: &LocatedBeam) -> [f64; 3] {
        let [height, slope] = self.errors();
        let w = self.radius();
        let curvature = (slope + 2.0 * self.divergence() * height / w) / w;
        [
            (beam.radius_at(0.0) - w) / height,
            (beam.curvature_at(0.0) - self.curvature()) / curvature,
            (beam.beam().divergence() - self.divergence()) / slope,
        ]
    }
}

fn element() -> impl Strategy<Value = Element> {
    let sign = || prop::sample::select(vec![-1.0, 1.0]);
    prop_oneof![
        3 => (0.0..0.5_f64).prop_map(Element::Space),
        2 => (sign(), 0.05..1.0_f64).prop_map(|(sign, f)| Element::Lens(sign * f)),
        1 => (-4.0..4.0_f64).prop_map(Element::Mirror),
        2 => (1.0..2.0_f64, -20.0..20.0_f64).prop_map(|(n, c)| Element::Interface(n, c)),
        1 => (0.0..200.0_f64, 0.0..10e-3_f64).prop_map(|(g, length)| Element::Graded(g, length)),
    ]
}

fn beam() -> impl Strategy<Value = LocatedBeam> {
    (
        300e-9..2e-6_f64,
        50e-6..2e-3_f64,
        1.0..4.0_f64,
        -1.0..1.0_f64,
    )
        .prop_map(|(wavelength, waist, m_squared, distance)| {
            let beam = GaussianBeam::from_waist(wavelength, waist)
                .and_then(|beam| beam.with_m_squared(m_squared))
                .unwrap();
            LocatedBeam::new(beam, distance).unwrap()
        })
}

/// Variances of height and slope with their covariance, through a matrix: M Σ Mᵀ.
///
/// With `sign` = |·| instead of the identity, the bound on it if nothing cancelled.
fn moments_behind(m: &AbcdMatrix, [xx, xs, ss]: [f64; 3], sign: fn(f64) -> f64) -> [f64; 3] {
    let [a, b, c, d] = [m.a(), m.b(), m.c(), m.d()].map(sign);
    let xs = sign(xs);
    [
        a * a * xx + 2.0 * a * b * xs + b * b * ss,
        a * c * xx + (a * d + b * c) * xs + b * d * ss,
        c * c * xx + 2.0 * c * d * xs + d * d * ss,
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn beams_follow_the_rays_through_random_systems(
        source in beam(),
        elements in prop::collection::vec(element(), 1..=8),
    ) {
        let (mut stepwise, mut rays) = (source, TwoRays::of(&source));
        let mut system = AbcdMatrix::identity();
        for element in elements {
            let matrix = element.matrix(rays.index);
            system = system.then(matrix);
            rays = rays.through(element);
            match matrix.transform(&stepwise) {
                Ok(beam) => stepwise = beam,
                Err(error) => {
                    let too_wide = rays.divergence() + rays.errors()[1] > 0.5;
                    let expected = error.parameter == "waist_radius" && too_wide;
                    prop_assert!(expected, "{}: {:?}", error, rays);
                    return Ok(());
                }
            }
            let at_once = system.transform(&source);
            let at_once = at_once.expect("the beam is not at the limit");
            for beam in [stepwise, at_once] {
                let differences = rays.differences(&beam);
                let worst = differences.iter().fold(0.0, |worst: f64, x| worst.max(x.abs()));
                prop_assert!(worst < 1.0, "{:?}: {:?}\n{:?}", element, differences, rays);
                let wavelength = source.beam().wavelength() / rays.index;
                let ratio = beam.beam().wavelength() / wavelength;
                prop_assert!((ratio - 1.0).abs() < 4e-15, "wavelength: {}", ratio);
            }
            let ratio = system.determinant() * rays.index;
            prop_assert!((ratio - 1.0).abs() < 4e-15, "determinant: {}", ratio);
        }
    }

    #[test]
    fn the_parameter_of_a_beam_follows_the_beam(
        source in beam(),
        elements in prop::collection::vec(element(), 1..=4),
    ) {
        let (mut index, mut system) = (1.0, AbcdMatrix::identity());
        for element in elements {
            system = system.then(element.matrix(index));
            index = element.index_behind(index);
        }
        let Ok(image) = system.transform(&source) else { return Ok(()) };
        let q = system.transform_parameter(&ComplexBeamParameter::of(&source)).unwrap();
        // Both are rounded alike in the matrix: a few roundings of |q| remain.
        let expected = ComplexBeamParameter::of(&image).to_complex();
        let error = (q.to_complex() - expected).norm() / expected.norm();
        prop_assert!(error < 2e-15, "{:?}: {:e}", q, error);

        // The law itself, in complex numbers.
        let before = ComplexBeamParameter::of(&source).to_complex();
        let numerator = system.a() * before + system.b();
        let plain = numerator / (system.c() * before + system.d());
        // A q + B may have cancelled, on the scale of its terms.
        let scale = (system.a().abs() * before.norm() + system.b().abs()) / numerator.norm();
        let error = (q.to_complex() - plain).norm() / plain.norm();
        prop_assert!(error < 1e-14 * scale, "{:?}: {:e}, {:e}", q, error, scale);
    }

    #[test]
    fn every_element_conserves_the_invariant_of_the_moments(
        source in beam(),
        elements in prop::collection::vec(element(), 1..=8),
    ) {
        // Simon et al. 1988: n √(σ_xx σ_ss − σ_xs²) = M² λ / (4π), with the vacuum wavelength.
        let [w, curvature] = [source.radius_at(0.0), source.curvature_at(0.0)];
        let slope = 0.5 * source.beam().divergence();
        let mut moments = [0.25 * w * w, 0.25 * w * w * curvature, slope * slope];
        let (mut index, mut beam) = (1.0, source);
        let expected = source.beam().m_squared() * source.beam().wavelength() / (4.0 * PI);
        // Each moment has four roundings of what it is summed from; their products cancel.
        let errors = |[xx, _, ss]: [f64; 3]| 16.0 * f64::EPSILON * xx * ss / expected.powi(2);
        let mut tolerance = errors(moments);
        for element in elements {
            let matrix = element.matrix(index);
            let Ok(next) = matrix.transform(&beam) else { return Ok(()) };
            let of_beam = next.beam().waist_radius() * next.beam().divergence() / 4.0;
            index = element.index_behind(index);
            beam = next;
            tolerance += errors(moments_behind(&matrix, moments, f64::abs)) * index * index;
            moments = moments_behind(&matrix, moments, |x| x);
            let [xx, xs, ss] = moments;
            let of_rays = (xx * ss - xs * xs) * (index / expected).powi(2);
            // Beyond that, rounding has left too little of the product.
            if tolerance < 1e-6 {
                prop_assert!((of_rays - 1.0).abs() < tolerance, "{:?}: {}", element, of_rays);
            }
            let ratio = of_beam * index / expected;
            prop_assert!((ratio - 1.0).abs() < 4e-15, "{:?}: {}", element, ratio);
        }
    }
}
