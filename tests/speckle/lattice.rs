//! The oracle of these tests: the points of a pupil on the lattice, one by one by their definition,
//! and what theory makes of them. And the parameters that the tests are tried on.

use core::f64::consts::TAU;
use core::ops::Range;

use proptest::prelude::*;
use tem00::{
    numerics::Grid,
    speckle::{Complex, Phasors, Pupil, PupilField, Transmission},
};

/// The shape of a pupil.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Circle,
    Annulus(f64),
    Rectangle(f64),
    Gaussian(f64),
    /// Sampled, without symmetry, with aberrations.
    Aberrated(f32),
}

impl Shape {
    pub(crate) fn pupil(self) -> Pupil {
        match self {
            Self::Circle => Pupil::Circle,
            Self::Annulus(inner) => Pupil::Annulus { inner },
            Self::Rectangle(height) => Pupil::Rectangle { height },
            Self::Gaussian(radius) => Pupil::Gaussian { radius },
            Self::Aberrated(phase) => {
                let samples = Grid::from_fn(31, 37, |x, y| {
                    let place = (x + y * y) as f32;
                    Complex::from_polar(1.0 / (1.0 + 0.001 * place), phase * place)
                });
                Pupil::Sampled(Transmission::from_complex(samples).expect("a transmission below 1"))
            }
        }
    }
}

pub(crate) fn shapes() -> impl Strategy<Value = Shape> {
    prop_oneof![
        Just(Shape::Circle),
        (0.1_f64..0.7).prop_map(Shape::Annulus),
        (0.5_f64..1.0).prop_map(Shape::Rectangle),
        (0.4_f64..2.0).prop_map(Shape::Gaussian),
        (0.0_f32..1.0).prop_map(Shape::Aberrated),
    ]
}

/// What a property is tried on.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    pub(crate) seed: u64,
    pub(crate) size: [usize; 2],
    pub(crate) speckle_size: f64,
    pub(crate) shape: Shape,
    pub(crate) phasors: Phasors,
    pub(crate) offset: [f64; 2],
    pub(crate) defocus: f64,
}

impl Case {
    /// The field, unless its pupil holds too few phasors.
    fn build(&self) -> Option<PupilField> {
        PupilField::from_speckle_size(self.size, self.speckle_size, self.seed)
            .and_then(|field| field.with_pupil(self.shape.pupil()))
            .map(|field| field.with_phasors(self.phasors))
            .ok()
    }

    pub(crate) fn field(&self) -> PupilField {
        self.build().expect("a field of enough phasors")
    }

    /// Whether the mean of every tile is fixed.
    pub(crate) fn is_unit(&self) -> bool {
        self.phasors == Phasors::Unit
    }
}

/// Cases with sides in `sides` and speckles of 2 up to `largest` samples, as far as both allow.
pub(crate) fn cases(sides: Range<usize>, largest: f64) -> impl Strategy<Value = Case> {
    let offset = prop_oneof![Just([0.0; 2]), [-1e3_f64..1e3, -1e3_f64..1e3],];
    (
        any::<u64>(),
        [sides.clone(), sides],
        0.0_f64..1.0,
        shapes(),
        prop_oneof![Just(Phasors::Unit), Just(Phasors::Gaussian)],
        offset,
        -5.0_f64..5.0,
    )
        .prop_map(
            move |(seed, size, share, shape, phasors, offset, defocus)| {
                let widest = (size[0].min(size[1]) as f64 / 8.0).min(largest);
                Case {
                    seed,
                    size,
                    speckle_size: 2.0 + share * (widest - 2.0),
                    shape,
                    phasors,
                    offset,
                    defocus,
                }
            },
        )
        .prop_filter("enough phasors", |case| case.build().is_some())
}

/// The points of the lattice inside a pupil, by the definition of the shapes.
pub(crate) struct Lattice {
    size: [usize; 2],
    /// Points relative to the lattice point nearest to the pupil's centre, and what they transmit.
    points: Vec<([i64; 2], Complex<f64>)>,
}

impl Lattice {
    pub(crate) fn of(field: &PupilField, offset: [f64; 2]) -> Self {
        let diameter = field.diameter();
        let fraction = [0, 1].map(|axis| {
            let centre = offset[axis] * diameter[axis];
            centre - centre.round()
        });
        let mut points = Vec::new();
        for y in reach(diameter[1]) {
            for x in reach(diameter[0]) {
                let p = [
                    (x as f64 - fraction[0]) / diameter[0],
                    (y as f64 - fraction[1]) / diameter[1],
                ];
                let t = transmission(field.pupil(), p);
                if t.norm_sqr() > 0.0 {
                    points.push(([x, y], t));
                }
            }
        }
        Self {
            size: field.size(),
            points,
        }
    }

    fn power(&self) -> f64 {
        self.points.iter().map(|(_, t)| t.norm_sqr()).sum()
    }

    /// The number of equal phasors, (Σ |t|²)² / Σ |t|⁴.
    pub(crate) fn phasors(&self) -> f64 {
        let fourth: f64 = self.points.iter().map(|(_, t)| t.norm_sqr().powi(2)).sum();
        self.power().powi(2) / fourth
    }

    /// μ(lag) = Σ |t|² exp(−2πi k·lag/Q) / Σ |t|².
    pub(crate) fn correlation(&self, lag: [i64; 2]) -> Complex<f64> {
        let term = |(k, t): &([i64; 2], Complex<f64>)| {
            let turns = [0, 1].map(|axis| (k[axis] * lag[axis]) as f64 / self.size[axis] as f64);
            Complex::from_polar(t.norm_sqr(), -TAU * (turns[0] + turns[1]))
        };
        self.points.iter().map(term).sum::<Complex<f64>>() / self.power()
    }

    /// μ at every lag of the period.
    pub(crate) fn correlations(&self) -> Grid<Complex<f64>> {
        let wave = |axis: usize| {
            let size = self.size[axis];
            move |k: i64, lag: usize| Complex::cis(-TAU * (k * signed(lag)) as f64 / size as f64)
        };
        let (across, along) = (wave(0), wave(1));
        let [width, height] = self.size;
        let mut grid = Grid::filled(width, height, Complex::new(0.0, 0.0));
        // Row by row of the pupil: first along x, then along y.
        for row in self.points.chunk_by(|a, b| a.0[1] == b.0[1]) {
            let sums: Vec<Complex<f64>> = (0..width)
                .map(|x| {
                    row.iter()
                        .map(|(k, t)| across(k[0], x) * t.norm_sqr())
                        .sum()
                })
                .collect();
            for y in 0..height {
                let turn = along(row[0].0[1], y) / self.power();
                for (x, sum) in sums.iter().enumerate() {
                    grid[(x, y)] += sum * turn;
                }
            }
        }
        grid
    }

    /// Σ t(k) t*(k − shift) / Σ |t|²: the correlation with the pupil `shift` points away.
    pub(crate) fn overlap(&self, shift: [i64; 2]) -> Complex<f64> {
        let there: std::collections::HashMap<_, _> = self.points.iter().copied().collect();
        let shared = self.points.iter().filter_map(|(k, t)| {
            let other = there.get(&[k[0] - shift[0], k[1] - shift[1]])?;
            Some(t * other.conj())
        });
        shared.sum::<Complex<f64>>() / self.power()
    }

    /// The least stride whose multiples, and those plus or minus `lag`, correlate by less than 5 %
    /// in intensity: pairs `lag` apart taken at this stride are independent.
    pub(crate) fn stride(&self, lag: [i64; 2]) -> usize {
        let min = lag[0].abs().max(lag[1].abs()) + 1;
        let apart = |stride: i64| {
            (-2..=2).flat_map(move |y| (-2..=2).map(move |x| [x * stride, y * stride]))
        };
        let independent = |&stride: &i64| {
            apart(stride)
                .filter(|at| *at != [0, 0])
                .flat_map(|[x, y]| [-1, 0, 1].map(|s| [x + s * lag[0], y + s * lag[1]]))
                .all(|at| self.correlation(at).norm_sqr() < 0.05)
        };
        let stride = (min..100).find(independent);
        usize::try_from(stride.expect("speckles far smaller than the pattern"))
            .unwrap_or(usize::MAX)
    }
}

/// What a pupil transmits at p diameters from its centre.
fn transmission(pupil: &Pupil, [x, y]: [f64; 2]) -> Complex<f64> {
    let rim = 0.5 * (1.0 + 1e-12);
    let radius = x.hypot(y);
    let in_box = x.abs() <= rim && y.abs() <= rim;
    match pupil {
        Pupil::Circle if radius <= rim => Complex::new(1.0, 0.0),
        Pupil::Annulus { inner } if radius <= rim && radius >= inner * 0.5 * (1.0 - 1e-12) => {
            Complex::new(1.0, 0.0)
        }
        Pupil::Rectangle { height } if in_box && y.abs() <= height * rim => Complex::new(1.0, 0.0),
        Pupil::Gaussian { radius: r } if radius <= rim => {
            Complex::new((-(radius / r).powi(2)).exp(), 0.0)
        }
        Pupil::Sampled(samples) if in_box => {
            let grid = samples.values();
            let cell = |p: f64, n: usize| (0..n).rev().find(|&i| i as f64 <= (p + 0.5) * n as f64);
            let at = |p, n| cell(p, n).unwrap_or(0);
            let value = grid[(at(x, grid.width()), at(y, grid.height()))];
            Complex::new(value.re.into(), value.im.into())
        }
        _ => Complex::new(0.0, 0.0),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a few lattice points")]
fn reach(diameter: f64) -> core::ops::RangeInclusive<i64> {
    let max = (0.5 * diameter) as i64 + 2;
    -max..=max
}

pub(crate) fn signed(index: usize) -> i64 {
    i64::try_from(index).unwrap_or(i64::MAX)
}

/// The standard deviation, from pattern to pattern, of the mean of (I(x) − 1)(I(x + lag) − 1) over
/// a tile. At zero lag, for the squared contrast, it is 2 √(mean |μ|⁴).
///
/// With the field U a Gaussian process, the part of the product that varies is the Wick product
/// :|U(x)|² |U(x + lag)|²:, whose covariance at the distance d is |μ(d)² + μ(d + lag) μ(d − lag)|².
/// Gaussian phasors also let |μ| fluctuate: by 4 |μ(lag)|² / N at most.
pub(crate) fn covariance_spread(
    correlations: &Grid<Complex<f64>>,
    [lag_x, lag_y]: [i64; 2],
    fluctuating_phasors: Option<f64>,
) -> f64 {
    let mut sum = 0.0;
    for y in 0..correlations.height() {
        for x in 0..correlations.width() {
            let at = |dx: i64, dy: i64| *correlations.wrapped(signed(x) + dx, signed(y) + dy);
            sum += (at(0, 0) * at(0, 0) + at(lag_x, lag_y) * at(-lag_x, -lag_y)).norm_sqr();
        }
    }
    let variance = sum / (correlations.width() * correlations.height()) as f64;
    let mu = correlations.wrapped(lag_x, lag_y).norm_sqr();
    (variance + fluctuating_phasors.map_or(0.0, |count| 4.0 * mu / count)).sqrt()
}
