use glam::DVec2;
use tem00_decorrelation::ImagingGeometry;

use crate::{Camera, RadialDistortion, SensorTilt};

/// The image of a camera in perspective: as an untilted sensor would see it through a lens without
/// distortion.
///
/// Speckle has one size there, that of the imaging geometry on the axis, since it is as wide as
/// directions that the pupil tells apart. On a tilted sensor it is stretched as the perspective is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Perspective {
    camera: Camera,
    tilted: bool,
    /// Whether image points are those of the sensor itself.
    plain: bool,
}

/// Points along each edge of the image that are looked at to find how far it reaches.
const EDGE_POINTS: u32 = 32;

impl Perspective {
    pub(super) fn of(camera: Camera) -> Self {
        let description = camera.description();
        let tilted = description.tilt != SensorTilt::default();
        Self {
            camera,
            tilted,
            plain: !tilted && description.distortion == RadialDistortion::default(),
        }
    }

    /// Returns where an image point lies in perspective, in pixels.
    pub(super) fn point(&self, pixel: DVec2) -> DVec2 {
        if self.plain {
            return pixel;
        }
        let local = self.camera.axes().transpose() * self.camera.ray(pixel).direction;
        // The camera looks along −z; pixels count downwards.
        let tangent = DVec2::new(local.x, -local.y) / -local.z;
        let pitch = self.camera.description().pixel_pitch;
        let point = tangent * (self.camera.image_distance() / pitch) + 0.5 * self.size();
        if point.is_finite() { point } else { pixel }
    }

    /// Returns the lowest and the highest corner of the image in perspective, in pixels.
    pub(super) fn image(&self) -> [DVec2; 2] {
        let size = self.size();
        if self.plain {
            return [DVec2::ZERO, size];
        }
        let along = (0..=EDGE_POINTS).map(|i| f64::from(i) / f64::from(EDGE_POINTS));
        let edges = along.flat_map(|t| {
            let [lower, upper] = [0.0, 1.0].map(|s| [DVec2::new(t, s), DVec2::new(s, t)]);
            [lower, upper].concat()
        });
        let points = edges.map(|part| self.point(part * size));
        points.fold(
            [DVec2::INFINITY, DVec2::NEG_INFINITY],
            |[low, high], point| [low.min(point), high.max(point)],
        )
    }

    /// Returns the imaging geometry for an image point, from that on the axis: in focus may be
    /// another distance.
    pub(super) fn geometry(&self, on_axis: &ImagingGeometry, pixel: DVec2) -> ImagingGeometry {
        let tilted = self.tilted.then(|| {
            self.camera
                .imaging_geometry_at(pixel, on_axis.wavelength())
                .ok()
        });
        tilted.flatten().unwrap_or(*on_axis)
    }

    #[expect(
        clippy::cast_precision_loss,
        reason = "an image has at most 2²⁸ pixels"
    )]
    fn size(&self) -> DVec2 {
        DVec2::new(self.camera.width() as f64, self.camera.height() as f64)
    }
}
