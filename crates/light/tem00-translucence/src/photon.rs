use core::{array, f64::consts::PI};

use rand_chacha::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use crate::{Medium, medium::dot};

/// A photon below the surface, and the random numbers that move it.
pub(crate) struct Photon<'a> {
    pub medium: &'a Medium,
    random: ChaCha8Rng,
    /// The place along the surface, and the depth, in metres.
    pub place: [f64; 3],
    pub direction: [f64; 3],
    /// The length of the path so far, in metres.
    pub length: f64,
    /// The light of the photon.
    pub weight: f64,
}

/// What ends a flight.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Meets {
    Collision,
    /// The photon left the medium.
    Outside,
    /// The boundary lost the photon.
    Nothing,
}

impl<'a> Photon<'a> {
    pub(crate) fn new(medium: &'a Medium, seed: u64) -> Self {
        Self {
            medium,
            random: ChaCha8Rng::seed_from_u64(seed),
            place: [0.0; 3],
            direction: [0.0, 0.0, 1.0],
            length: 0.0,
            weight: 1.0,
        }
    }

    /// Starts a photon at the surface, and moves it to its first collision.
    pub(crate) fn enter(&mut self, direction: [f64; 3], weight: f64, uniform: f64) {
        self.length = self.flight(uniform);
        self.place = direction.map(|component| self.length * component);
        (self.direction, self.weight) = (direction, weight);
    }

    /// Draws the slopes of a facet.
    pub(crate) fn facet(&mut self) -> [f64; 2] {
        let slope = self.medium.slope();
        if slope == 0.0 {
            return [0.0; 2];
        }
        // Box and Muller 1958.
        let radius = slope * (-2.0 * libm::log1p(-self.uniform())).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * self.uniform());
        [radius * cos, radius * sin]
    }

    /// Moves the photon to its next collision, or out of the medium.
    pub(crate) fn advance(&mut self) -> Meets {
        let uniform = self.uniform();
        let mut rest = self.flight(uniform);
        loop {
            let to_surface = -self.place[2] / self.direction[2];
            let meets = self.direction[2] < 0.0 && to_surface < rest;
            let step = if meets { to_surface } else { rest };
            self.place[0] += step * self.direction[0];
            self.place[1] += step * self.direction[1];
            self.length += step;
            if !meets {
                self.place[2] += step * self.direction[2];
                return Meets::Collision;
            }
            self.place[2] = 0.0;
            rest -= step;
            if let Some(end) = self.reflect() {
                return end;
            }
        }
    }

    /// Reflects the photon that meets the boundary from below, by chance; returns its end
    /// otherwise.
    fn reflect(&mut self) -> Option<Meets> {
        let [p, q] = self.facet();
        let length = (1.0 + p * p + q * q).sqrt();
        let normal = [p / length, q / length, 1.0 / length];
        let cosine = -dot(self.direction, normal);
        // Facets that look away are not met.
        self.weight *= (-cosine * length / self.direction[2]).max(0.0);
        if cosine <= 0.0 {
            return Some(Meets::Nothing);
        }
        if self.uniform() >= self.medium.reflectance_from_inside(cosine) {
            return Some(Meets::Outside);
        }
        self.direction = array::from_fn(|i| self.direction[i] + 2.0 * cosine * normal[i]);
        // What a facet sends upwards would meet another: without masking it is lost both ways.
        (self.direction[2] <= 0.0).then_some(Meets::Nothing)
    }

    /// Returns the length of a flight for a uniform number.
    fn flight(&self, uniform: f64) -> f64 {
        -libm::log1p(-uniform) / self.medium.extinction()
    }

    /// Returns whether a collision scatters the photon.
    pub(crate) fn survives(&mut self) -> bool {
        self.uniform() < self.medium.scattered_fraction()
    }

    /// Draws the direction behind a collision.
    pub(crate) fn scatter(&mut self) {
        let cosine = self.medium.scattering_cosine(self.uniform());
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(2.0 * PI * self.uniform());
        let [u, v] = [sine * cos, sine * sin];
        // A frame around the direction (Frisvad 2012, as revised by Duff et al. 2017).
        let [x, y, z] = self.direction;
        let sign = 1.0_f64.copysign(z);
        let a = -1.0 / (sign + z);
        let b = x * y * a;
        let along = [1.0 + sign * x * x * a, sign * b, -sign * x];
        let across = [b, sign + y * y * a, -y];
        let direction = self.direction;
        self.direction = array::from_fn(|i| u * along[i] + v * across[i] + cosine * direction[i]);
    }

    /// A uniform number from 0 to below 1.
    pub(crate) fn uniform(&mut self) -> f64 {
        (self.random.next_u64() >> 11) as f64 * (0.5_f64).powi(53)
    }
}
