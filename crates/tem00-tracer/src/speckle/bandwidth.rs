//! What light that is not of one wavelength, or not from a point, asks of the speckle of a surface.

use glam::DVec2;
use rayon::prelude::*;
use tem00_coherence::{PatternSum, PolychromaticSpeckle};
use tem00_decorrelation::ImagingGeometry;

use super::{
    SpecklePoint,
    change::{Change, ReferencePoint},
    prescan::{LaserGroups, pixels_of},
};
use crate::{Intersector, Laser, Scene, TracerError};

/// How a surface looks up the speckle of a laser that has a linewidth.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bandwidth {
    /// Heights that stand for the relief, in metres, with the roots of their fractions of the light. Their fields add.
    pub heights: Vec<[f64; 2]>,
    /// The unit vector in the image, with y up, along which another wavelength displaces the pupil.
    pub axis: DVec2,
    /// The largest such displacement that the slices hold to either side, in pupil diameters.
    pub reach: f64,
    /// The point that tells the motion of the pupil along the axis from that against it.
    pub reference_point: ReferencePoint,
    /// Whether something moves the pupil across the axis: frames then correlate as if it moved along.
    pub is_crossed: bool,
}

impl Bandwidth {
    /// The same, beside the motion of a point.
    pub(super) fn beside(&self, moving: Option<&ReferencePoint>) -> Self {
        let way = moving.map_or(DVec2::ZERO, ReferencePoint::way_across);
        Self {
            is_crossed: way.perp_dot(self.axis).abs() > MAX_CROSSING,
            ..self.clone()
        }
    }
}

/// The light of a laser on a surface: fractions of patterns whose intensities add, and what else its bandwidth asks.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceLight {
    /// One, or the modes of heights that dominate, or of directions of the source.
    pub modes: Vec<f64>,
    pub bandwidth: Option<Bandwidth>,
}

/// The response of a point to the wave number, at its greatest among those that are seen.
#[derive(Clone, Copy, Debug)]
struct Response {
    /// Displacement of the pupil in its diameters over the difference of wave numbers.
    tilt: f64,
    reference_point: ReferencePoint,
}

/// The spread of the wave number over that which displaces the pupil by its diameter, below which a contrast is above
/// 0.999.
const NEGLIGIBLE_TILT: f64 = 5e-4;

/// The part of the line to either side that the slices need not hold, and the most that they hold in pupil diameters: on
/// a path that closes, the rest finds speckle that is new to nearly all of the line.
const LEFT_OUT: f64 = 5e-4;
const MAX_REACH: f64 = 1.5;

/// The largest motion across the axis in pupil diameters that changes no correlation by more than some 0.03.
const MAX_CROSSING: f64 = 0.1;

impl SurfaceLight {
    /// Light of one wavelength.
    pub(super) fn single() -> Self {
        Self {
            modes: vec![1.0],
            bandwidth: None,
        }
    }
}

/// Follows rays of the reference frame to the points that the lasers light, and returns the light of each laser on
/// each surface.
pub(super) fn laser_lights(
    scene: &Scene,
    laser_groups: LaserGroups<'_>,
) -> Result<Vec<Vec<SurfaceLight>>, TracerError> {
    let single = vec![vec![SurfaceLight::single(); scene.surfaces.len()]; scene.lasers.len()];
    if scene.lasers.iter().all(is_pure) {
        return Ok(single);
    }
    let change = Change::new(scene, scene.reference_frame);
    let intersector = Intersector::build(&scene.shapes_at(scene.reference_frame))?;
    let points: Vec<SpecklePoint> = pixels_of(&scene.camera)
        .filter_map(|pixel| {
            let hit = intersector.intersect(&change.camera().ray(pixel))?;
            Some(SpecklePoint {
                pixel,
                position: hit.position,
                normal: hit.normal,
                surface: hit.surface,
                wave: 0.5,
            })
        })
        .collect();
    let lights = single
        .into_par_iter()
        .enumerate()
        .map(|(laser, mut lights)| {
            let survey = Survey {
                scene,
                laser,
                geometry: &laser_groups.geometries[laser],
                change: &change,
            };
            for (surface, light) in lights.iter_mut().enumerate() {
                let points = points.iter().filter(|point| point.surface == surface);
                *light = survey.light(surface, points);
            }
            lights
        });
    Ok(lights.collect())
}

/// Tells whether light is of one wavelength and from a point.
fn is_pure(laser: &Laser) -> bool {
    laser.spectral_line().is_monochromatic() && laser.source_extent().is_point()
}

/// One laser in the reference frame.
struct Survey<'a> {
    scene: &'a Scene,
    laser: usize,
    geometry: &'a ImagingGeometry,
    change: &'a Change,
}

impl Survey<'_> {
    fn light<'p>(
        &self,
        surface: usize,
        points: impl Iterator<Item = &'p SpecklePoint>,
    ) -> SurfaceLight {
        let single = SurfaceLight::single();
        let laser = &self.scene.lasers[self.laser];
        if is_pure(laser) {
            return single;
        }
        let line = laser.spectral_line();
        let responses = points.filter_map(|point| Some((self.response(point)?, point)));
        let farthest = responses.max_by(|a, b| a.0.tilt.total_cmp(&b.0.tilt));
        let Some((
            Response {
                tilt,
                reference_point,
            },
            point,
        )) = farthest
        else {
            return single;
        };
        // The point of the greatest tilt stands for all: q changes by little over a surface.
        let cell = self
            .change
            .resolution_cell(self.laser, self.geometry, point);
        let relief = self.scene.surfaces[surface].relief;
        let Some(cell) = cell.and_then(|cell| cell.with_relief(relief).ok()) else {
            return single;
        };
        let cell = cell.with_source_extent(laser.source_extent().clone());
        let speckle = PolychromaticSpeckle { line, cell: &cell };
        let PatternSum { fractions, heights } =
            speckle.patterns(|speckle| speckle.contrast().powi(2));
        let is_flat = line.effective_spread() * tilt < NEGLIGIBLE_TILT && heights.len() == 1;
        if heights.is_empty() || is_flat {
            return SurfaceLight {
                modes: fractions,
                bandwidth: None,
            };
        }
        let farthest = line.draw(1.0 - LEFT_OUT).max(-line.draw(LEFT_OUT));
        SurfaceLight {
            modes: fractions,
            bandwidth: Some(Bandwidth {
                heights,
                axis: reference_point
                    .way_across()
                    .try_normalize()
                    .unwrap_or(DVec2::X),
                reach: (tilt * farthest).min(MAX_REACH),
                reference_point,
                is_crossed: false,
            }),
        }
    }

    fn response(&self, point: &SpecklePoint) -> Option<Response> {
        // Small against every linewidth that counts, and large against rounding.
        let kappa = 1e-6 * self.scene.lasers[self.laser].spectral_line().wave_number();
        let shift = self
            .change
            .spectral_shift(self.laser, self.geometry, point, kappa)?;
        let reference_point = self
            .change
            .reference_point_along(point, shift.pupil.extend(0.0))?;
        Some(Response {
            tilt: shift.pupil.length() / kappa,
            reference_point,
        })
    }
}

#[cfg(test)]
mod tests;
