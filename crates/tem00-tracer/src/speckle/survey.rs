use glam::DVec2;
use tem00_decorrelation::ImagingGeometry;

use super::{Origin, SpecklePoint};
use crate::{Camera, Intersector, Laser, Scene, TracerError};

/// Rays per image side with which a frame is surveyed.
const RAYS_PER_SIDE: u32 = 128;

/// The most frames that are surveyed.
const FRAMES: u32 = 8;

/// What the image and the motion in a scene ask of a pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct Survey {
    /// Width and height of the image, in pixels.
    pub image: DVec2,
    /// Width and height of the region of the first frame's image from which speckle is looked up, in
    /// pixels: the image itself and where lit points of later frames would have been seen.
    pub region: DVec2,
    /// The largest motion of the pupil over the speckle, in pupil diameters.
    pub shift: f64,
}

impl Survey {
    /// Follows rays to the points that the laser lights, in frames spread over the sequence.
    pub(super) fn new(
        scene: &Scene,
        laser: &Laser,
        geometry: &ImagingGeometry,
    ) -> Result<Self, TracerError> {
        let size = image_size(&scene.camera);
        let (mut low, mut high, mut shift) = (DVec2::ZERO, size, 0.0_f64);
        if scene.moves() {
            for frame in frames(scene.render.frames - 1) {
                let camera = scene.camera_at(frame);
                let intersector = Intersector::build(&scene.shapes_at(frame))?;
                for pixel in pixels(size) {
                    let Some(point) = lit_point(&camera, &intersector, laser, pixel) else {
                        continue;
                    };
                    let origin = Origin::of(scene, laser, &point, frame, geometry);
                    if let Some(pixel) = origin.pixel {
                        low = low.min(pixel);
                        high = high.max(pixel);
                    }
                    shift = shift.max(origin.shift);
                }
            }
        }
        Ok(Self {
            image: size,
            region: high - low,
            shift,
        })
    }
}

fn lit_point(
    camera: &Camera,
    intersector: &Intersector,
    laser: &Laser,
    pixel: DVec2,
) -> Option<SpecklePoint> {
    let hit = intersector.intersect(&camera.ray(pixel))?;
    laser.illuminate(hit.position).map(|_| SpecklePoint {
        pixel,
        position: hit.position,
        normal: hit.normal,
        surface: hit.surface,
    })
}

/// At most [`FRAMES`] frames from 1 to `last`, evenly spread, the last among them.
fn frames(last: u32) -> impl Iterator<Item = u32> {
    let count = last.min(FRAMES);
    (1..=count).map(move |i| last / count * i + last % count * i / count)
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
    fn surveyed_frames_are_spread_up_to_the_last() {
        let spread = |last| frames(last).collect::<Vec<_>>();
        assert_eq!(spread(1), [1]);
        assert_eq!(spread(5), [1, 2, 3, 4, 5]);
        assert_eq!(spread(20), [2, 5, 7, 10, 12, 15, 17, 20]);
        assert_eq!(spread(u32::MAX).last(), Some(&u32::MAX));
    }
}
