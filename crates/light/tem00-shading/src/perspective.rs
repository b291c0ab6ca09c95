use glam::{DVec2, DVec3};
use tem00_camera::{Camera, RadialDistortion, SensorTilt};
use tem00_decorrelation::ImagingGeometry;

/// The image of a camera in perspective, as seen by an untilted sensor through a lens without
/// distortion.
///
/// In this image speckle has one size, the speckle size of the imaging geometry on the axis, since
/// its angular size is the resolution of the pupil. On a tilted sensor the speckle is stretched
/// like the perspective.
#[derive(Clone, Copy, Debug)]
pub struct Perspective {
    camera: Camera,
    tilted: bool,
    /// Whether image points in perspective equal the image points of the sensor.
    plain: bool,
}

/// Number of points along each edge of the image from which its extent is found.
const EDGE_POINTS: u32 = 32;

impl Perspective {
    /// Creates the perspective image of a camera.
    pub fn new(camera: Camera) -> Self {
        let description = camera.description();
        let tilted = description.tilt != SensorTilt::default();
        Self {
            camera,
            tilted,
            plain: !tilted && description.distortion == RadialDistortion::default(),
        }
    }

    /// Returns the camera.
    pub const fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the position of an image point in perspective, in pixels.
    #[inline]
    pub fn point(&self, pixel: DVec2) -> DVec2 {
        if self.plain {
            return pixel;
        }
        // Pixels count downwards.
        let tangent = self.camera.tangents_at(pixel) * DVec2::new(1.0, -1.0);
        let pitch = self.camera.description().pixel_pitch;
        let point = tangent * (self.camera.image_distance() / pitch) + 0.5 * self.size();
        if point.is_finite() { point } else { pixel }
    }

    /// Returns the image point of a point in perspective, both in pixels, or `None` where its ray
    /// misses the sensor.
    pub fn pixel(&self, point: DVec2) -> Option<DVec2> {
        if self.plain {
            return Some(point);
        }
        let pitch = self.camera.description().pixel_pitch;
        let tangent = (point - 0.5 * self.size()) * (pitch / self.camera.image_distance());
        let local = DVec3::new(tangent.x, -tangent.y, -1.0);
        let in_space = self.camera.position() + self.camera.axes() * local;
        self.camera.project(in_space)
    }

    /// Returns the lowest and the highest corner of the image in perspective, in pixels.
    pub fn image(&self) -> [DVec2; 2] {
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

    /// Returns the imaging geometry for an image point from the geometry on the axis: the distance
    /// in focus may differ.
    pub fn geometry(&self, on_axis: &ImagingGeometry, pixel: DVec2) -> ImagingGeometry {
        let tilted = self.tilted.then(|| {
            self.camera
                .imaging_geometry_at(pixel, on_axis.wavelength())
                .ok()
        });
        tilted.flatten().unwrap_or(*on_axis)
    }

    /// Returns the vergence 1/L of the point in focus at an image point, in 1/m.
    #[inline]
    pub fn focus_vergence(&self, on_axis: &ImagingGeometry, pixel: DVec2) -> f64 {
        if self.tilted {
            self.camera.focus_vergence_at(pixel)
        } else {
            on_axis.surface_to_pupil().recip()
        }
    }

    fn size(&self) -> DVec2 {
        DVec2::new(self.camera.width() as f64, self.camera.height() as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tem00_camera::CameraDescription;

    fn description() -> CameraDescription {
        CameraDescription {
            position: DVec3::new(0.02, -0.01, 0.3),
            look_at: DVec3::new(0.0, 0.01, 0.0),
            ..CameraDescription::default()
        }
    }

    #[test]
    fn tilt_and_distortion_drop_out_of_the_perspective() {
        let plain = Camera::new(description()).unwrap();
        let bent = Camera::new(CameraDescription {
            tilt: SensorTilt {
                angle: 0.15,
                azimuth: 0.7,
            },
            distortion: RadialDistortion {
                k1: -0.1,
                k2: 0.05,
                k3: 0.0,
            },
            ..description()
        });
        let bent = Perspective::new(bent.unwrap());
        let [low, high] = bent.image();
        for i in 0..100_u32 {
            let (x, y) = (f64::from(i % 10) - 4.5, f64::from(i / 10) - 4.5);
            let point = DVec3::new(2e-3 * x, 1.5e-3 * y, 1e-3 * (x + y));
            let sensor = bent.camera.project(point).unwrap();
            let perspective = bent.point(sensor);
            let error = perspective.distance(plain.project(point).unwrap());
            // The tolerance covers rounding over 8000 pixels of image distance and the inversion of
            // the distortion.
            assert!(error < 1e-8, "{point}: {error:e} pixels");
            let moved = perspective.distance(sensor);
            assert!(moved > 1e-3, "{point}: the sensor sees the perspective");
            let back = bent.pixel(perspective).unwrap().distance(sensor);
            assert!(back < 1e-8, "{point}: {back:e} pixels off on the way back");
            let inside = sensor.cmpge(DVec2::ZERO).all() && sensor.cmple(bent.size()).all();
            let held = perspective.cmpge(low).all() && perspective.cmple(high).all();
            assert!(held || !inside, "{perspective} beyond {low} to {high}");
        }
    }

    #[test]
    fn a_plain_camera_sees_the_perspective_itself() {
        let plain = Perspective::new(Camera::new(description()).unwrap());
        let pixel = DVec2::new(12.3, 400.7);
        assert_eq!(plain.point(pixel), pixel);
        assert_eq!(plain.pixel(pixel), Some(pixel));
        assert_eq!(plain.image(), [DVec2::ZERO, DVec2::new(640.0, 480.0)]);
    }

    #[test]
    fn points_in_the_plane_in_focus_of_a_tilted_camera_are_in_focus() {
        let tilted = CameraDescription {
            tilt: SensorTilt {
                angle: 0.1,
                azimuth: 0.3,
            },
            ..description()
        };
        let tilted = Perspective::new(Camera::new(tilted).unwrap());
        let camera = tilted.camera;
        let on_axis = camera.imaging_geometry(650e-9).unwrap();
        let (origin, normal) = camera.plane_in_focus();
        let (u, v) = normal.any_orthonormal_pair();
        let mut largest = 0.0_f64;
        for (a, b) in [(0.0, 0.0), (3e-3, 1e-3), (-2e-3, 4e-3), (4e-3, 4e-3)] {
            let point = origin + a * u + b * v;
            let pixel = camera.project(point).unwrap();
            let geometry = tilted.geometry(&on_axis, pixel);
            let depth = (point - camera.position()).dot(-camera.axes().z_axis);
            let defocus = geometry.defocus_at(depth);
            // The tolerance covers rounding of lengths of 0.3 m over some ten operations.
            assert!(defocus.abs() < 1e-12, "{a}, {b}: {defocus:e} per metre");
            largest = largest.max(on_axis.defocus_at(depth).abs());
        }
        // 4 mm times tan τ′ = 1.1 over the square of 0.3 m.
        assert!(largest > 0.02, "{largest} per metre: not tilted");
    }
}
