//! The motion of speckle by the formulas of Bergmann et al. 2016, as printed.

use glam::DVec2;
use tem00_decorrelation::{CameraFrame, ImagingGeometry};
use tem00_paper as paper;

use super::{SpecklePoint, change::Change};

/// Returns the displacement in the image, in metres, and the slice coordinate of a point.
///
/// The formulas know translations of surface and camera, and take the emitter for the centre of the
/// wavefront. Where one has no value, the pattern counts as decorrelated.
pub(super) fn displacement_and_slice(
    change: &Change,
    laser: usize,
    geometry: &ImagingGeometry,
    half_period: usize,
    point: &SpecklePoint,
) -> (DVec2, f64) {
    if change.is_still(laser, point.surface) {
        return (DVec2::ZERO, 0.0);
    }
    motion(change, laser, geometry, half_period, point).unwrap_or((DVec2::ZERO, half_period as f64))
}

fn motion(
    change: &Change,
    laser: usize,
    geometry: &ImagingGeometry,
    half_period: usize,
    point: &SpecklePoint,
) -> Option<(DVec2, f64)> {
    let camera = change.camera();
    let axes = CameraFrame::from_axes(camera.axes()).ok()?;
    let (surface_axes, angles) = paper::EulerAngles::between(&axes, point.normal)?;
    let to_surface = surface_axes.transpose();
    let to_emitter = change.laser(laser).description().position - point.position;
    let emitter = paper::Emitter {
        direction: to_surface * to_emitter.normalize_or_zero(),
        distance: to_emitter.length(),
    };
    let moved = change.translations(point);
    let seen = moved.surface - moved.camera;
    let in_image = paper::image_displacement(geometry.magnification(), angles, to_surface * seen);
    let distance = camera.position().distance(point.position);
    let surface = to_surface * moved.surface;
    let in_pupil = paper::pupil_displacement(angles, emitter, distance, surface)?;
    let (right, up) = (axes.right(), axes.up());
    let of_camera = DVec2::new(moved.camera.dot(right), moved.camera.dot(up));
    let u = paper::slice_coordinate(
        geometry,
        paper::relative_pupil_displacement(of_camera, in_pupil),
        seen.dot(axes.towards_camera()),
        half_period,
    );
    Some((in_image, u))
}
