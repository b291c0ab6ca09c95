use std::collections::BTreeSet;

use glam::DVec2;
use rayon::prelude::*;
use tem00_decorrelation::ImagingGeometry;

use super::{SpecklePoint, change::Change, perspective::Perspective};
use crate::{Camera, Intersector, Scene, TracerError};

/// Rays per image side with which a frame is surveyed.
const RAYS_PER_SIDE: u32 = 128;

/// How many frames are surveyed beside those of the keyframes.
const FRAMES: u32 = 16;

/// The most keyframes that are surveyed.
const KEYFRAMES: usize = 64;

/// What the image and the motion in a scene ask of a pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct Survey {
    /// Width and height of the image, in pixels.
    pub image: DVec2,
    /// The lowest corner of the region of the reference frame's image from which speckle is looked
    /// up, in pixels: that of the image itself, and of where lit points of other frames were.
    low: DVec2,
    /// The highest corner of that region.
    high: DVec2,
    /// The largest motion of the pupil over the speckle before the reference frame and after it, in
    /// pupil diameters.
    pub shifts: [f64; 2],
}

impl Survey {
    fn of_image(camera: &Camera) -> Self {
        let [low, high] = Perspective::of(*camera).image();
        Self {
            image: high - low,
            low,
            high,
            shifts: [0.0; 2],
        }
    }

    /// Returns width and height of the region from which speckle is looked up, in pixels.
    pub(super) fn region(&self) -> DVec2 {
        self.high - self.low
    }

    /// Returns what both ask for.
    pub(super) fn and(&self, other: &Self) -> Self {
        Self {
            image: self.image,
            low: self.low.min(other.low),
            high: self.high.max(other.high),
            shifts: [0, 1].map(|side| self.shifts[side].max(other.shifts[side])),
        }
    }
}

/// Which lasers light which surfaces, as far as patterns go.
#[derive(Clone, Copy, Debug)]
pub(super) struct Audience<'a> {
    /// The imaging geometry of each laser.
    pub geometries: &'a [ImagingGeometry],
    /// The group of each surface.
    pub groups: &'a [usize],
}

/// Follows rays to the points that the lasers light, in frames spread over the sequence, and returns
/// what each laser asks of the pattern of each group of surfaces.
///
/// Each frame is surveyed on its own thread; the largest of all does not depend on their order.
pub(super) fn surveys(
    scene: &Scene,
    audience: Audience<'_>,
) -> Result<Vec<Vec<Survey>>, TracerError> {
    let groups = audience.groups.iter().max().map_or(0, |last| last + 1);
    let still = vec![vec![Survey::of_image(&scene.camera); groups]; scene.lasers.len()];
    let moves = |laser: usize| {
        let mut surfaces = 0..scene.surfaces.len();
        surfaces.any(|surface| scene.speckle_moves(laser, surface))
    };
    if !(0..scene.lasers.len()).any(moves) {
        return Ok(still);
    }
    let frames: Vec<u32> = frames(scene).into_iter().collect();
    frames
        .into_par_iter()
        .map(|frame| of_frame(scene, audience, frame, still.clone()))
        .try_reduce(
            || still.clone(),
            |one, other| {
                let rows = one.iter().zip(&other);
                Ok(rows
                    .map(|(a, b)| a.iter().zip(b).map(|(a, b)| a.and(b)).collect())
                    .collect())
            },
        )
}

/// What one frame asks for, added to `surveys`.
fn of_frame(
    scene: &Scene,
    audience: Audience<'_>,
    frame: u32,
    mut surveys: Vec<Vec<Survey>>,
) -> Result<Vec<Vec<Survey>>, TracerError> {
    let change = Change::new(scene, frame);
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let side = usize::from(!change.is_before());
    for pixel in pixels(image_size(change.camera())) {
        let Some(hit) = intersector.intersect(&change.camera().ray(pixel)) else {
            continue;
        };
        let Some(&group) = audience.groups.get(hit.surface) else {
            continue;
        };
        let point = SpecklePoint {
            pixel,
            position: hit.position,
            normal: hit.normal,
            surface: hit.surface,
        };
        for (laser, geometry) in audience.geometries.iter().enumerate() {
            if change.laser(laser).illuminate(hit.position).is_none() {
                continue;
            }
            let drift = change.drift(laser, geometry, &point);
            let origin = change.perspective().point(pixel) - drift.displacement;
            let survey = &mut surveys[laser][group];
            survey.low = survey.low.min(origin);
            survey.high = survey.high.max(origin);
            survey.shifts[side] = survey.shifts[side].max(drift.shift);
        }
    }
    Ok(surveys)
}

/// The frames to survey: evenly spread, first and last among them, and those at keyframes.
fn frames(scene: &Scene) -> BTreeSet<u32> {
    let last = scene.render.frames.saturating_sub(1);
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

fn pixels(size: DVec2) -> impl Iterator<Item = DVec2> {
    let position = |index: u32| (f64::from(index) + 0.5) / f64::from(RAYS_PER_SIDE);
    (0..RAYS_PER_SIDE * RAYS_PER_SIDE).map(move |index| {
        let (column, row) = (index % RAYS_PER_SIDE, index / RAYS_PER_SIDE);
        DVec2::new(position(column), position(row)) * size
    })
}

#[expect(
    clippy::cast_precision_loss,
    reason = "an image has at most 2²⁸ pixels"
)]
fn image_size(camera: &Camera) -> DVec2 {
    DVec2::new(camera.width() as f64, camera.height() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surveyed_frames_are_spread_over_the_sequence() {
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
