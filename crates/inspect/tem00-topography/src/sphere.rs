use glam::DVec3;

use crate::{
    Artefact, Estimate, Field, ProfileSensor, Shape,
    estimate::{jackknife, mean, shortest_interval},
    fit::FittedSphere,
};

/// The number of profiles over the cap.
pub(crate) const PROFILES: u32 = 64;
/// The half-angle of the cap that is measured, in radians: 45°.
const CAP: f64 = core::f64::consts::FRAC_PI_4;
/// The rings of places that represent the cap: their angle, as a fraction of the cap's, and the
/// number of places.
const RINGS: [(f64, u32); 3] = [(0.0, 1), (0.5, 8), (0.85, 16)];
/// The half-angle of the region of one place, as a fraction of the cap's.
const REGION: f64 = 0.1;

/// Results of a sphere, from the points of its upper cap of 45° half-angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereResult {
    /// The diameter of the sphere, in metres.
    pub diameter: f64,
    /// The probing size error, in metres: the diameter of the sphere of least squares through all
    /// points, minus the true diameter.
    pub size: Estimate,
    /// The probing form error of 95 % of the points, in metres: the smallest distance of two
    /// spheres about the centre of that sphere that enclose them.
    pub form: Estimate,
    /// The probing form error of 25 places, in metres: the range of the distances from the sphere
    /// of least squares through them, each the mean of the points of a region.
    pub form_of_places: Estimate,
}

impl SphereResult {
    /// Measures a sphere; `None` if one of the places on it is not seen.
    pub(crate) fn measure<S: ProfileSensor>(sensor: &mut S) -> Result<Option<Self>, S::Error> {
        let field = sensor.field();
        let radius = radius(&field);
        let half = radius * libm::sin(CAP);
        let sphere = Artefact {
            name: "sphere",
            shape: Shape::Sphere { radius },
            size: [2.0 * half; 2],
        };
        let top = top(&field, radius);
        let place = |k: u32| {
            let y = half * (2.0 * (f64::from(k) + 0.5) / f64::from(PROFILES) - 1.0);
            DVec3::new(0.0, -y, top)
        };
        let places: Vec<DVec3> = (0..PROFILES).map(place).collect();
        let profiles = sensor.measure(&sphere, &places)?;
        let truth = FittedSphere {
            centre: DVec3::new(0.0, 0.0, -radius),
            radius,
        };
        let on_cap = |point: &DVec3| (*point - truth.centre).angle_between(DVec3::Z) <= CAP;
        let positions = profiles.iter().map(|points| {
            let positions = points.iter().map(|point| point.position);
            positions.filter(on_cap).collect()
        });
        Ok(Self::of(truth, &positions.collect::<Vec<_>>()))
    }

    fn of(truth: FittedSphere, profiles: &[Vec<DVec3>]) -> Option<Self> {
        let points = |kept: &[usize]| -> Vec<DVec3> {
            kept.iter().flat_map(|&k| profiles[k].clone()).collect()
        };
        let fit = |points: &[DVec3]| FittedSphere::new(points, truth);
        let size = |kept: &[usize]| Some(2.0 * (fit(&points(kept))?.radius - truth.radius));
        let form = |kept: &[usize]| {
            let points = points(kept);
            let fitted = fit(&points)?;
            let residuals = points.iter().map(|point| fitted.residual(*point));
            shortest_interval(residuals.collect(), 0.95)
        };
        let of_places = |kept: &[usize]| {
            let means = at_places(&points(kept), &truth)?;
            let fitted = fit(&means)?;
            let residuals = means.iter().map(|point| fitted.residual(*point));
            shortest_interval(residuals.collect(), 1.0)
        };
        Some(Self {
            diameter: 2.0 * truth.radius,
            size: jackknife(profiles.len(), size)?,
            form: jackknife(profiles.len(), form)?,
            form_of_places: jackknife(profiles.len(), of_places)?,
        })
    }
}

/// The radius whose cap fits the field and the range of heights.
fn radius(field: &Field) -> f64 {
    let [low, high] = field.heights;
    let by_heights = 0.5 * (high - low) / (1.0 - libm::cos(CAP));
    let by_width = 0.3 * field.width / libm::sin(CAP);
    by_heights.min(by_width)
}

/// The height of the top that has the cap in the middle of the range.
fn top(field: &Field, radius: f64) -> f64 {
    let [low, high] = field.heights;
    0.5 * (low + high) + 0.5 * radius * (1.0 - libm::cos(CAP))
}

/// The means of the points about each place on the cap; `None` if a place has none.
fn at_places(points: &[DVec3], sphere: &FittedSphere) -> Option<Vec<DVec3>> {
    let mean_about = |direction: DVec3| {
        let min = libm::cos(REGION * CAP);
        let near = points.iter().map(|point| *point - sphere.centre);
        let near: Vec<DVec3> = near
            .filter(|from| from.normalize_or_zero().dot(direction) >= min)
            .collect();
        let distances: Vec<f64> = near.iter().map(|from| from.length()).collect();
        (!near.is_empty()).then(|| sphere.centre + mean(&distances) * direction)
    };
    directions().map(mean_about).collect()
}

fn directions() -> impl Iterator<Item = DVec3> {
    RINGS.into_iter().flat_map(|(part, count)| {
        (0..count).map(move |k| {
            let turn = core::f64::consts::TAU * f64::from(k) / f64::from(count);
            let (sin, cos) = (libm::sin(part * CAP), libm::cos(part * CAP));
            DVec3::new(sin * libm::cos(turn), sin * libm::sin(turn), cos)
        })
    })
}
