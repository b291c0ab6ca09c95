//! Points for tests.

use glam::DMat3;
use glam::{DVec2, DVec3};
use tem00_triangulation::{PositionNoise, ProfilePoint, UncertainPoint, Validity};

use crate::frame::{IndirectLight, MeasuredPoint};

/// A point in a column whose position moves it by 10 µm per pixel along z.
pub(super) fn point(column: usize, position: DVec3) -> MeasuredPoint {
    MeasuredPoint {
        seen: ProfilePoint {
            column,
            line: 0,
            pixel: DVec2::new(column as f64 + 0.5, 20.0),
            point: UncertainPoint {
                position,
                uncertainty: DVec3::ZERO,
                along: 0.0,
                direction: DVec3::Z,
            },
            width: 6.0,
            reflectance: 1000.0,
            validity: Validity::Valid,
        },
        position,
        per_pixel: -1e-5 * DVec3::Z,
        noise: PositionNoise {
            speckle: 0.04,
            shot: 0.0025,
            prnu: 0.01,
            ..PositionNoise::default()
        },
        indirect: IndirectLight::default(),
        calibration: DMat3::ZERO,
    }
}

/// The same, but not to be trusted.
pub(super) fn doubtful(column: usize, position: DVec3) -> MeasuredPoint {
    let mut point = point(column, position);
    point.seen.validity = Validity::Saturated;
    point
}
