//! Cameras and lasers that several tests share.

use glam::DVec3;
use tem00_coherence::Spectrum;

use crate::{BeamShape, LaserDescription};

/// A round spot of 650 nm and 1 mW that is aimed at the origin, where its waist lies.
pub(crate) fn spot(position: DVec3, waist_radius: f64) -> LaserDescription {
    LaserDescription {
        spectrum: Spectrum::monochromatic(650e-9).unwrap(),
        power: 1e-3,
        position,
        look_at: DVec3::ZERO,
        line_direction: DVec3::X,
        shape: BeamShape::Spot {
            waist_radius: [waist_radius; 2],
            waist_distance: [position.length(); 2],
            m_squared: [1.0; 2],
        },
    }
}
