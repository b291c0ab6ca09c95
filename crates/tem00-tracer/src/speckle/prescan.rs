use std::collections::BTreeSet;

use glam::DVec2;
use rayon::prelude::*;
use tem00_camera::Camera;
use tem00_decorrelation::ImagingGeometry;

use super::{
    SpecklePoint,
    change::{Change, ReferencePoint},
    multiple::MultipleMap,
    perspective::Perspective,
    shifts::Light,
};
use crate::{Intersector, Scene, TracerError};

/// Rays per image side with which a frame is sampled.
const RAYS_PER_SIDE: u32 = 128;

/// Number of frames that are sampled beside those of the keyframes.
const FRAMES: u32 = 16;

/// The maximum number of keyframes that are sampled.
const KEYFRAMES: usize = 64;

/// Requirements of the image and the motion in a scene on a pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct MotionPrescan {
    /// Width and height of the image, in pixels.
    pub image: DVec2,
    /// The lowest corner of the region of the reference frame's image from which speckle is looked
    /// up, in pixels: that of the image itself, and of where lit points of other frames were.
    low: DVec2,
    /// The highest corner of that region.
    high: DVec2,
    /// The largest motion of the pupil over the speckle to either side of the reference frame, in
    /// pupil diameters; the second to the side of the farthest.
    pub shifts: [f64; 2],
    /// A point over whose speckle the pupil has moved farthest.
    pub reference_point: Option<ReferencePoint>,
}

/// Requirements of one frame on a pattern.
#[derive(Clone, Copy, Debug)]
struct FrameSample {
    low: DVec2,
    high: DVec2,
    /// The largest motion of the pupil over the speckle, in pupil diameters.
    shift: f64,
    /// The point where it is.
    farthest: Option<SpecklePoint>,
}

impl MotionPrescan {
    fn of_image(camera: &Camera) -> Self {
        let [low, high] = Perspective::new(*camera).image();
        Self {
            image: high - low,
            low,
            high,
            shifts: [0.0; 2],
            reference_point: None,
        }
    }

    /// Returns width and height of the region from which speckle is looked up, in pixels.
    pub(super) fn region(&self) -> DVec2 {
        self.high - self.low
    }
}

/// The imaging geometries of the lasers, and the groups of surfaces with a pattern each.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaserGroups<'a> {
    /// The imaging geometry of each laser.
    pub geometries: &'a [ImagingGeometry],
    /// The group of each surface.
    pub groups: &'a [usize],
}

/// Returns the multiple light in a frame, if it asks for slices of its own.
pub(crate) type SurveyOfFrame<'a> =
    dyn Fn(u32, &Intersector, &Change) -> Option<MultipleMap> + Sync + 'a;

/// Follows rays to the points that the lasers light, in frames spread over the sequence, and returns
/// what each laser asks of the pattern of each group of surfaces.
///
/// Each frame is sampled on its own thread.
pub(super) fn prescan(
    scene: &Scene,
    laser_groups: LaserGroups<'_>,
    survey: &SurveyOfFrame<'_>,
) -> Result<Vec<Vec<MotionPrescan>>, TracerError> {
    let groups = laser_groups.groups.iter().max().map_or(0, |last| last + 1);
    let still = vec![vec![MotionPrescan::of_image(&scene.camera); groups]; scene.lasers.len()];
    let moves = |laser: usize| {
        let mut surfaces = 0..scene.surfaces.len();
        surfaces.any(|surface| scene.speckle_moves(laser, surface))
    };
    if !(0..scene.lasers.len()).any(moves) {
        return Ok(still);
    }
    let frames: Vec<u32> = frames(scene).into_iter().collect();
    let changes: Vec<_> = frames.iter().map(|&f| Change::new(scene, f)).collect();
    let samples = frames
        .par_iter()
        .zip(&changes)
        .map(|(&frame, change)| {
            let intersector = Intersector::build(&scene.shapes_at(frame))?;
            let mut samples = frame_samples(laser_groups, &intersector, change);
            if let Some(map) = survey(frame, &intersector, change) {
                add_multiple_light(&mut samples, laser_groups, &map, change);
            }
            Ok(samples)
        })
        .collect::<Result<Vec<_>, TracerError>>()?;
    let mut prescans = still;
    for (laser, geometry) in laser_groups.geometries.iter().enumerate() {
        for (group, prescan) in prescans[laser].iter_mut().enumerate() {
            let seen = changes.iter().zip(&samples);
            let seen: Vec<_> = seen.map(|(c, g)| (c, &g[laser][group])).collect();
            prescan.add(laser, geometry, &seen);
        }
    }
    Ok(prescans)
}

impl MotionPrescan {
    /// Adds what the frames ask of the pattern of a laser.
    fn add(&mut self, laser: usize, geometry: &ImagingGeometry, seen: &[(&Change, &FrameSample)]) {
        let mut largest = 0.0;
        for (change, sample) in seen {
            let farther = sample.farthest.filter(|_| sample.shift > largest);
            if let Some(reference_point) =
                farther.and_then(|point| change.reference_point(laser, geometry, &point))
            {
                largest = sample.shift;
                self.reference_point = Some(reference_point);
            }
        }
        for (change, sample) in seen {
            self.low = self.low.min(sample.low);
            self.high = self.high.max(sample.high);
            let side = change.side(laser, geometry, self.reference_point.as_ref());
            let shift = &mut self.shifts[usize::from(side > 0.0)];
            *shift = shift.max(sample.shift);
        }
    }
}

/// Returns the requirements of one frame on the pattern of each laser and group.
fn frame_samples(
    laser_groups: LaserGroups<'_>,
    intersector: &Intersector,
    change: &Change,
) -> Vec<Vec<FrameSample>> {
    let none = FrameSample {
        low: DVec2::INFINITY,
        high: DVec2::NEG_INFINITY,
        shift: 0.0,
        farthest: None,
    };
    let groups = laser_groups.groups.iter().max().map_or(0, |last| last + 1);
    let mut samples = vec![vec![none; groups]; laser_groups.geometries.len()];
    for pixel in pixels_of(change.camera()) {
        let Some(hit) = intersector.intersect(&change.camera().ray(pixel)) else {
            continue;
        };
        let Some(&group) = laser_groups.groups.get(hit.surface) else {
            continue;
        };
        let point = SpecklePoint {
            pixel,
            position: hit.position,
            normal: hit.normal,
            surface: hit.surface,
            wave: 0.5,
        };
        for (laser, geometry) in laser_groups.geometries.iter().enumerate() {
            if change.laser(laser).illuminate(hit.position).is_some() {
                let shift = change.speckle_shift(laser, geometry, &point);
                let origin = change.perspective().point(pixel) - shift.displacement;
                samples[laser][group].add(&point, origin, shift.pupil);
            }
        }
    }
    samples
}

/// Adds what the speckle of light that has met several surfaces asks for, where it is not faint.
fn add_multiple_light(
    samples: &mut [Vec<FrameSample>],
    laser_groups: LaserGroups<'_>,
    map: &MultipleMap,
    change: &Change,
) {
    for (laser, geometry) in laser_groups.geometries.iter().enumerate() {
        for ((_, surface), light) in map.bright().filter(|((of, _), _)| *of == laser) {
            let point = &light.point;
            let fraction = light.fraction_beside(light.single);
            let single = change.speckle_shift(laser, geometry, point);
            let carried = change.known_shift(laser, geometry, point, Light::Carried);
            let shift = match carried {
                Some(carried) if !change.is_reference() => light.shift([single, carried], fraction),
                _ => single,
            };
            let origin = change.perspective().point(point.pixel) - shift.displacement;
            if let Some(&group) = laser_groups.groups.get(surface) {
                samples[laser][group].add(point, origin, shift.pupil);
            }
        }
    }
}

impl FrameSample {
    /// Adds a point, where its speckle stood, and how far the pupil has moved over it.
    fn add(&mut self, point: &SpecklePoint, origin: DVec2, shift: f64) {
        self.low = self.low.min(origin);
        self.high = self.high.max(origin);
        if shift > self.shift {
            self.shift = shift;
            self.farthest = Some(*point);
        }
    }
}

/// The frames to sample: evenly spread, first and last among them, and those at keyframes.
fn frames(scene: &Scene) -> BTreeSet<u32> {
    let last = scene.frames.saturating_sub(1);
    let lasers = scene.lasers.iter().map(|laser| laser.trajectory());
    let surfaces = scene.surfaces.iter().map(|surface| &surface.trajectory);
    let trajectories = lasers.chain(surfaces).chain([&scene.camera_trajectory]);
    let times = trajectories.flat_map(|trajectory| trajectory.keyframes().iter());
    let keyframes = times.map(|keyframe| nearest_frame(keyframe.frame, last));
    spread(last).chain(keyframes.take(KEYFRAMES)).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates, and the frame is one of the sequence"
)]
fn nearest_frame(time: f64, last: u32) -> u32 {
    (time.round() as u32).min(last)
}

/// At most [`FRAMES`] frames from 0 to `last` evenly spread, both among them.
fn spread(last: u32) -> impl Iterator<Item = u32> {
    let steps = last.clamp(1, FRAMES - 1);
    (0..=steps)
        .map(move |i| last / steps * i + last % steps * i / steps)
        .take(if last == 0 { 1 } else { FRAMES as usize })
}

/// Image points evenly spread over the image, in pixels.
pub(super) fn pixels_of(camera: &Camera) -> impl Iterator<Item = DVec2> + use<> {
    let size = DVec2::new(camera.width() as f64, camera.height() as f64);
    let position = |index: u32| (f64::from(index) + 0.5) / f64::from(RAYS_PER_SIDE);
    (0..RAYS_PER_SIDE * RAYS_PER_SIDE).map(move |index| {
        let (column, row) = (index % RAYS_PER_SIDE, index / RAYS_PER_SIDE);
        DVec2::new(position(column), position(row)) * size
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampled_frames_are_spread_over_the_sequence() {
        let spread = |last| spread(last).collect::<Vec<_>>();
        assert_eq!(spread(0), [0]);
        assert_eq!(spread(1), [0, 1]);
        assert_eq!(spread(5), [0, 1, 2, 3, 4, 5]);
        let many = spread(40);
        assert_eq!(
            many,
            [0, 2, 5, 8, 10, 13, 16, 18, 21, 24, 26, 29, 32, 34, 37, 40]
        );
        assert_eq!(spread(u32::MAX).last(), Some(&u32::MAX));
    }
}
