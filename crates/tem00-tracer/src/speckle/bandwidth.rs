//! What light that is not of one wavelength, or not from a point, asks of the speckle of a surface.

use core::iter;

use glam::DVec2;
use rayon::prelude::*;
use tem00_coherence::{PatternSum, PolychromaticSpeckle};
use tem00_decorrelation::ImagingGeometry;
use tem00_speckle::Complex;

use super::{
    SpecklePoint,
    change::{Change, ReferencePoint, SpectralShift},
    prescan::{LaserGroups, RAYS_PER_SIDE, first_ray, pixels_of, rays_per_side},
};
use crate::{Intersector, Laser, Scene, TracerError};

/// How a surface looks up the speckle of a laser that has a linewidth.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bandwidth {
    /// Heights that stand for the relief, in metres, with the roots of their fractions of the light. Their fields add.
    pub heights: Vec<[f64; 2]>,
    /// The unit vector in the image, with y up, along which another wavelength displaces the pupil, on the side to which
    /// it moves farthest.
    pub axis: DVec2,
    /// The largest such displacement that the slices hold to either side, in pupil diameters.
    pub reach: f64,
    /// The displacement in pupil diameters over the difference of wave numbers.
    pub tilt: f64,
    /// The change of the phase with the height, in radians per metre, over the difference of wave numbers.
    pub phase_per_height: f64,
}

impl Bandwidth {
    /// The same beside the motion of a point: the axis leads to its side.
    pub(super) fn beside(&self, moving: Option<&ReferencePoint>) -> Self {
        let way = moving.map_or(DVec2::ZERO, ReferencePoint::way_across);
        Self {
            axis: if way.dot(self.axis) < 0.0 {
                -self.axis
            } else {
                self.axis
            },
            ..self.clone()
        }
    }

    /// The same beside a motion that is followed along an axis.
    pub(super) fn along(&self, axis: DVec2) -> Self {
        Self {
            axis,
            ..self.clone()
        }
    }

    /// Returns the difference of wave numbers over which the speckle changes.
    pub(super) fn scale(&self) -> f64 {
        let largest = self.heights.iter().map(|[height, _]| height.abs());
        let phases = self.phase_per_height.abs() * largest.fold(0.0, f64::max);
        self.tilt.max(phases).recip()
    }

    /// Returns the squared correlation that the heights leave of a difference of wave numbers.
    pub(super) fn kept_by_heights(&self, kappa: f64) -> f64 {
        let phase = |height: f64| Complex::cis(self.phase_per_height * kappa * height);
        let fields = self.heights.iter();
        let field: Complex<f64> = fields
            .map(|[height, root]| phase(*height) * root * root)
            .sum();
        field.norm_sqr()
    }
}

/// The light of a laser on a surface: fractions of patterns whose intensities add, and what else its bandwidth asks.
#[derive(Clone, Debug, Default)]
pub(super) struct SurfaceLight {
    /// One, or the modes of heights that dominate, or of directions of the source.
    pub modes: Vec<f64>,
    pub bandwidth: Option<Bandwidth>,
}

/// The spread of the wave number over that which displaces the pupil by its diameter, below which a contrast is above
/// 0.999.
const NEGLIGIBLE_TILT: f64 = 5e-4;

/// The part of the line to either side that the slices need not hold, and the most that they hold in pupil diameters: on
/// a path that closes, the rest finds speckle that is new to nearly all of the line.
const LEFT_OUT: f64 = 5e-4;
const MAX_REACH: f64 = 1.5;

impl SurfaceLight {
    /// Light of one wavelength.
    pub(super) fn single() -> Self {
        Self {
            modes: vec![1.0],
            bandwidth: None,
        }
    }
}

/// Follows rays of the reference frame to what the camera sees, and returns the light of each laser on each surface. Those
/// of other frames show surfaces that are not seen there.
pub(super) fn laser_lights(
    scene: &Scene,
    laser_groups: LaserGroups<'_>,
) -> Result<Vec<Vec<SurfaceLight>>, TracerError> {
    let mut lights = vec![vec![None; scene.surfaces.len()]; scene.lasers.len()];
    let others = if scene.moves() { 0..scene.frames } else { 0..0 };
    let frames = iter::once(scene.reference_frame).chain(others);
    let is_pure = scene.lasers.iter().all(is_pure);
    for frame in frames.take_while(|_| !is_pure) {
        if lights.iter().flatten().all(Option::is_some) {
            break;
        }
        let change = Change::new(scene, frame);
        let points = points_seen(scene, &change, frame)?;
        lights
            .par_iter_mut()
            .enumerate()
            .for_each(|(laser, lights)| {
                let survey = Survey {
                    scene,
                    laser,
                    geometry: &laser_groups.geometries[laser],
                    change: &change,
                };
                for (surface, light) in lights.iter_mut().enumerate() {
                    let points = points.iter().filter(|point| point.surface == surface);
                    *light = light.take().or_else(|| survey.light(surface, points));
                }
            });
    }
    let known = |light: Option<SurfaceLight>| light.unwrap_or_else(SurfaceLight::single);
    let lights = lights.into_iter();
    Ok(lights
        .map(|lights| lights.into_iter().map(known).collect())
        .collect())
}

/// The points that the camera sees.
fn points_seen(
    scene: &Scene,
    change: &Change,
    frame: u32,
) -> Result<Vec<SpecklePoint>, TracerError> {
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let side = match frame == scene.reference_frame {
        true => RAYS_PER_SIDE,
        false => rays_per_side(scene.frames),
    };
    let point = |pixel: DVec2| {
        let hit = intersector.intersect(&change.camera().ray(pixel))?;
        Some(SpecklePoint {
            pixel,
            position: hit.position,
            normal: hit.normal,
            surface: hit.surface,
            wave: 0.5,
        })
    };
    let pixels = pixels_of(change.camera(), side, first_ray(change, side));
    Ok(pixels.filter_map(point).collect())
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
    /// Returns the light on a surface of which these points are seen, if there are any.
    fn light<'p>(
        &self,
        surface: usize,
        points: impl Iterator<Item = &'p SpecklePoint>,
    ) -> Option<SurfaceLight> {
        let single = SurfaceLight::single();
        let laser = &self.scene.lasers[self.laser];
        if is_pure(laser) {
            return Some(single);
        }
        let line = laser.spectral_line();
        let responses = points.filter_map(|point| Some((self.response(point)?, point)));
        let tilt = |response: &SpectralShift| response.pupil.length();
        let farthest = responses.max_by(|a, b| tilt(&a.0).total_cmp(&tilt(&b.0)));
        let (response, point) = farthest?;
        let tilt = tilt(&response);
        // The point of the greatest tilt stands for all: q changes by little over a surface.
        let cell = self
            .change
            .resolution_cell(self.laser, self.geometry, point);
        let relief = self.scene.surfaces[surface].relief;
        let Some(cell) = cell.and_then(|cell| cell.with_relief(relief).ok()) else {
            return Some(single);
        };
        let cell = cell.with_source_extent(laser.source_extent().clone());
        let speckle = PolychromaticSpeckle { line, cell: &cell };
        let PatternSum { fractions, heights } =
            speckle.patterns(|speckle| speckle.contrast().powi(2));
        let is_flat = line.effective_spread() * tilt < NEGLIGIBLE_TILT && heights.len() == 1;
        if heights.is_empty() || is_flat {
            return Some(SurfaceLight {
                modes: fractions,
                bandwidth: None,
            });
        }
        let farthest = line.draw(1.0 - LEFT_OUT).max(-line.draw(LEFT_OUT));
        Some(SurfaceLight {
            modes: fractions,
            bandwidth: Some(Bandwidth {
                heights,
                axis: response.pupil.try_normalize().unwrap_or(DVec2::X),
                reach: (tilt * farthest).min(MAX_REACH),
                tilt,
                phase_per_height: response.phase_per_height,
            }),
        })
    }

    /// Returns the change of the speckle of a point over the difference of wave numbers.
    fn response(&self, point: &SpecklePoint) -> Option<SpectralShift> {
        // Small against every linewidth that counts, and large against rounding.
        let kappa = 1e-6 * self.scene.lasers[self.laser].spectral_line().wave_number();
        let shift = self
            .change
            .spectral_shift(self.laser, self.geometry, point, kappa)?;
        Some(SpectralShift {
            displacement: shift.displacement / kappa,
            pupil: shift.pupil / kappa,
            phase_per_height: shift.phase_per_height / kappa,
        })
    }
}

#[cfg(test)]
mod tests;
