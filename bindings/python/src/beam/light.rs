//! The three lights as one, and their queries over many points.

use tem00_beam::{
    self as physics, AngularProfile, LineLight, NextEventSlices, RayPdf, SpotLight,
    TabulatedLineLight,
};
use tem00_numerics::cast::to_f32;

/// A light as the beam crate holds it.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Light {
    Spot(SpotLight),
    Line(LineLight),
    Tabulated(LineLight, AngularProfile),
}

impl Light {
    /// The fields of the light, as rows of four.
    pub(super) fn rows(&self) -> Vec<[f64; 4]> {
        match self {
            Self::Spot(light) => light.to_rows().to_vec(),
            Self::Line(light) | Self::Tabulated(light, _) => light.to_rows().to_vec(),
        }
    }

    /// The rows that all lights have: origin and power, ex and cutoff, ey, ez.
    pub(super) fn frame_rows(&self) -> [[f64; 4]; 4] {
        let rows = self.rows();
        std::array::from_fn(|i| rows[i])
    }

    pub(super) fn single_rows(&self) -> Vec<[f32; 4]> {
        self.rows().into_iter().map(|row| row.map(to_f32)).collect()
    }

    /// Asks the light, whichever it is.
    pub(super) fn ask<R>(&self, query: impl FnOnce(&dyn physics::Emitter) -> R) -> R {
        match self {
            Self::Spot(light) => query(light),
            Self::Line(light) => query(light),
            Self::Tabulated(line, profile) => query(&TabulatedLineLight {
                line: *line,
                knots: profile.knots(),
            }),
        }
    }
}

/// A query of a light at many points, block by block.
impl Light {
    /// Writes the point, distance, direction and irradiance of each next event.
    ///
    /// The point follows from the batch form, which leaves it out: `p + distance · wi`.
    pub(super) fn next_events(&self, points: [&[f64]; 3], out: [&mut [f64]; 4]) {
        let [x, y, z] = points;
        let [point, distance, wi, e_perp] = out;
        let mut towards = [const { Vec::new() }; 3];
        for component in &mut towards {
            component.resize(x.len(), 0.0);
        }
        let slices = NextEventSlices {
            wi: towards.each_mut().map(Vec::as_mut_slice),
            distance,
            e_perp,
        };
        self.ask(|light| light.next_event_batch(x, y, z, slices));
        for (i, (point, wi)) in vectors(point).zip(vectors(wi)).enumerate() {
            *wi = towards.each_ref().map(|component| component[i]);
            if e_perp[i] > 0.0 {
                let p = points.map(|component| component[i]);
                *point = std::array::from_fn(|k| p[k] + distance[i] * wi[k]);
            }
        }
    }

    /// Writes the point, distance, direction, value and density of each sampled event.
    pub(super) fn sampled_events(&self, columns: [&[f64]; 5], out: [&mut [f64]; 5]) {
        let [point, distance, wi, value, pdf] = out;
        for (i, (point, wi)) in vectors(point).zip(vectors(wi)).enumerate() {
            let [x, y, z, u @ ..] = columns.map(|column| column[i]);
            let event = self.ask(|light| light.next_event_sampled([x, y, z], u));
            if let Some(event) = event {
                (*point, *wi) = (event.point, event.wi);
                (distance[i], value[i], pdf[i]) = (event.distance, event.value, event.pdf);
            }
        }
    }

    /// Writes the point, distance, radiance and density of each hit.
    pub(super) fn hits(&self, columns: [&[f64]; 6], out: [&mut [f64]; 4]) {
        let [point, distance, radiance, pdf] = out;
        for (i, point) in vectors(point).enumerate() {
            let [x, y, z, wi @ ..] = columns.map(|column| column[i]);
            if let Some(hit) = self.ask(|light| light.hit([x, y, z], wi)) {
                *point = hit.point;
                (distance[i], radiance[i], pdf[i]) = (hit.distance, hit.radiance, hit.pdf);
            }
        }
    }

    /// Writes the members of each sampled ray.
    pub(super) fn rays(&self, columns: [&[f64]; 4], out: [&mut [f64]; 8]) {
        let [origin, flux, direction, cos, mut pdf @ ..] = out;
        for (i, (origin, direction)) in vectors(origin).zip(vectors(direction)).enumerate() {
            let u = columns.map(|column| column[i]);
            let ray = self.ask(|light| light.sample_ray(u));
            (*origin, *direction) = (ray.origin, ray.direction);
            (flux[i], cos[i]) = (ray.flux, ray.cos);
            put(ray.pdf, i, &mut pdf);
        }
    }

    /// Writes the densities of each ray, in the order of the fields of `RayPdf`.
    pub(super) fn ray_pdfs(&self, columns: [&[f64]; 6], mut out: [&mut [f64]; 4]) {
        for i in 0..out[0].len() {
            let [x, y, z, d @ ..] = columns.map(|column| column[i]);
            let pdf = self.ask(|light| light.ray_pdf([x, y, z], d));
            put(pdf, i, &mut out);
        }
    }
}

/// Writes densities, in the order of their fields, to the place `i` of each column.
fn put(pdf: RayPdf, i: usize, columns: &mut [&mut [f64]; 4]) {
    let values = [
        pdf.position,
        pdf.direction_given_position,
        pdf.direction,
        pdf.position_given_direction,
    ];
    for (column, value) in columns.iter_mut().zip(values) {
        column[i] = value;
    }
}

/// Numbers as the vectors that they hold one after another.
pub(super) fn vectors(numbers: &mut [f64]) -> impl Iterator<Item = &mut [f64; 3]> {
    let (vectors, _) = numbers.as_chunks_mut();
    vectors.iter_mut()
}
