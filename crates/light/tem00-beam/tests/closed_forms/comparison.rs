//! How far another evaluation of the same formulas may be from the light in double precision.

use tem00_beam::{Emitter, NextEvent};

use super::samples::Sample;

/// The irradiance, then the next event: point, distance, `wi` and `e_perp`. All 0 where it is dark.
pub(crate) type Answer = [f64; 9];

fn answer(light: &impl Emitter, p: [f64; 3]) -> Answer {
    let irradiance = light.irradiance(p);
    match light.next_event(p) {
        Some(NextEvent {
            point: [a, b, c],
            distance,
            wi: [x, y, z],
            e_perp,
        }) => [irradiance, a, b, c, distance, x, y, z, e_perp],
        None => [0.0; 9],
    }
}

/// A light in double precision, the machine epsilon of the evaluation to be judged, and how many
/// points were lit, dark, or too near the cut-off to tell.
#[derive(Debug)]
pub(crate) struct Judge<'a, L> {
    sample: &'a Sample<L>,
    epsilon: f64,
    lit: usize,
    dark: usize,
    on_the_edge: usize,
}

impl<'a, L: Emitter> Judge<'a, L> {
    pub(crate) fn new(sample: &'a Sample<L>, epsilon: f64) -> Self {
        Self {
            sample,
            epsilon,
            lit: 0,
            dark: 0,
            on_the_edge: 0,
        }
    }

    /// Compares an answer at `p` with that of the light.
    ///
    /// The tolerance has two parts. Three local coordinates, each a subtraction and a scalar
    /// product, and what is divided by them are off by 8 ε |p − origin| in all: so far the point
    /// may be moved. What follows is a dozen rounded operations; the exponent `a` of the irradiance
    /// is off by 8 ε a, and exp and erfc by as much again.
    pub(crate) fn compare(&mut self, p: [f64; 3], got: Answer) {
        let name = &self.sample.name;
        let expected = answer(&self.sample.light, p);
        let step = f64::from(f32::EPSILON) * distance(p, self.row(0));
        let nearby = neighbours(p, step).map(|q| answer(&self.sample.light, q));
        let is_lit = |answer: &&Answer| answer[0] > 0.0;
        match nearby.iter().chain([&expected]).filter(is_lit).count() {
            0 => {
                self.dark += 1;
                let dark = got.iter().all(|x| x.abs() <= 0.0);
                assert!(dark, "{name} must be dark at {p:?}: {got:?}");
            }
            7 => {
                self.lit += 1;
                let tolerance = self.tolerance(p, &expected, &nearby);
                for (i, tolerance) in tolerance.into_iter().enumerate() {
                    let error = (got[i] - expected[i]).abs();
                    assert!(
                        error <= tolerance,
                        "{name}, number {i} at {p:?}: {} instead of {}, tolerance {tolerance:e}",
                        got[i],
                        expected[i],
                    );
                }
            }
            _ => self.on_the_edge += 1,
        }
    }

    /// Checks that enough points of each kind were compared.
    pub(crate) fn finish(self) {
        let Self {
            lit,
            dark,
            on_the_edge,
            ..
        } = self;
        let name = &self.sample.name;
        let counts = format!("{name}: {lit} lit, {dark} dark, {on_the_edge} on the edge");
        assert!(lit >= 500 && dark >= 100 && on_the_edge <= 50, "{counts}");
    }

    fn tolerance(&self, p: [f64; 3], expected: &Answer, nearby: &[Answer; 6]) -> Answer {
        let scale = 8.0 * self.epsilon / f64::from(f32::EPSILON);
        let rounding = self.rounding(p, expected);
        core::array::from_fn(|i| {
            let moved = nearby.iter().map(|near| (near[i] - expected[i]).abs());
            scale * moved.fold(0.0, f64::max) + rounding[i]
        })
    }

    fn rounding(&self, p: [f64; 3], expected: &Answer) -> Answer {
        let (origin, axis) = (self.row(0), self.row(3));
        let along: f64 = (0..3).map(|i| (p[i] - origin[i]) * axis[i]).sum();
        let on_axis = core::array::from_fn(|i| origin[i] + along * axis[i]);
        let brightest = self.sample.light.irradiance(on_axis);
        let exponent = (brightest / expected[0]).ln().max(0.0);

        let e = (16.0 + 16.0 * exponent) * expected[8];
        let point = 8.0 * (distance(p, origin) + distance(origin, [0.0; 3]));
        let distance = 8.0 * expected[4];
        [e, point, point, point, distance, 8.0, 8.0, 8.0, e].map(|units| units * self.epsilon)
    }

    /// Returns the vector in a row of the light: its origin in row 0, its axis in row 3.
    fn row(&self, row: usize) -> [f64; 3] {
        core::array::from_fn(|i| f64::from(self.sample.fields[4 * row + i]))
    }
}

fn neighbours(p: [f64; 3], step: f64) -> [[f64; 3]; 6] {
    core::array::from_fn(|i| {
        let mut q = p;
        q[i / 2] += if i % 2 == 0 { step } else { -step };
        q
    })
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
