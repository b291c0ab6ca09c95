use crate::{Hit, Lamp};
use glam::DVec3;
pub(super) struct LampSample {
    pub direction: DVec3,
    pub distance: f64,
    pub radiance_over_pdf: f64,
    pub pdf: Option<f64>,
}
impl Lamp {
    pub(super) fn can_be_met(&self) -> bool {
        matches!(self, Self::Area { .. })
    }
    pub(super) fn sample(&self, from: DVec3, u: [f64; 2]) -> Option<LampSample> {
        match *self {
            Self::Point { position, power } => {
                let away = position - from;
                let squared = away.length_squared();
                let distance = squared.sqrt();
                (squared > 0.0).then(|| LampSample {
                    direction: away / distance,
                    distance,
                    radiance_over_pdf: power / (4.0 * core::f64::consts::PI * squared),
                    pdf: None,
                })
            }
            Self::Area {
                rectangle,
                radiance,
            } => {
                let point = rectangle.point(u[0], u[1]);
                let away = point - from;
                let squared = away.length_squared();
                let distance = squared.sqrt();
                let direction = away / distance;
                let cosine = -rectangle.normal().dot(direction);
                (squared > 0.0 && cosine > 0.0).then(|| {
                    let pdf = squared / (cosine * rectangle.area());
                    LampSample {
                        direction,
                        distance,
                        radiance_over_pdf: radiance / pdf,
                        pdf: Some(pdf),
                    }
                })
            }
        }
    }
    pub(super) fn pdf(&self, from: DVec3, direction: DVec3, hit: Option<&Hit>) -> f64 {
        match (self, hit) {
            (Self::Area { rectangle, .. }, Some(hit)) => {
                let cosine = -rectangle.normal().dot(direction);
                let squared = (hit.position - from).length_squared();
                if cosine > 0.0 {
                    squared / (cosine * rectangle.area())
                } else {
                    0.0
                }
            }
            _ => 0.0,
        }
    }
    pub(super) fn radiance(&self, direction: DVec3, hit: Option<&Hit>) -> f64 {
        match (self, hit) {
            (
                Self::Area {
                    rectangle,
                    radiance,
                },
                Some(_),
            ) if rectangle.normal().dot(direction) < 0.0 => *radiance,
            _ => 0.0,
        }
    }
}
