use glam::{DMat2, DVec2, DVec3};
use tem00_numerics::{circle_point_at_eighth, vectorised};

use super::Camera;
use crate::Ray;

/// The number of rays that are computed together.
const LANES: usize = 64;

/// A ray from a point of the lens into the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// The ray; it starts on the lens.
    pub ray: Ray,
    /// The factor on the radiance that arrives along the ray; its mean over the lens is 1.
    pub weight: f64,
    /// The solid angle that one pixel sees along the ray, from where it starts, in steradian.
    pub solid_angle: f64,
}

/// Connection of a point of the scene to the image through a point of the lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraConnection {
    /// The image point, in pixels; it lies in the image.
    pub pixel: DVec2,
    /// The point of the lens, in metres.
    pub lens_point: DVec3,
    /// The gain of a pixel in radiance, in W/(m² sr), per radiant intensity from the point towards
    /// the lens, in W/sr; in 1/m².
    pub importance: f64,
}

impl Camera {
    /// Returns a ray that arrives at the image point `pixel` through a point of the lens.
    ///
    /// `lens` is a pair of numbers in [0, 1); uniform ones give points that are uniform over the
    /// pupil. All rays of an image point meet at the point in focus. Without depth of field every
    /// ray goes through the centre of the lens.
    ///
    /// The mean of radiance times weight, over the lens and the pixel, is the value of the pixel.
    /// All weights are 1: the pupil counts by area, and the cosines that vary a little over it
    /// belong to the [irradiance](Self::irradiance_per_radiance).
    ///
    /// # References
    ///
    /// - P. Shirley and K. Chiu, *A Low Distortion Map between Disk and Square*, 1997.
    pub fn sample_ray(&self, pixel: DVec2, lens: [f64; 2]) -> CameraRay {
        let chief = self.chief(pixel);
        let stretch = if self.distortion.is_none() {
            DMat2::IDENTITY
        } else {
            self.distortion.jacobian(chief.truncate() / chief.z)
        };
        self.ray_through(chief, stretch, lens)
    }

    /// Writes the rays of [`sample_ray`](Self::sample_ray) for the image points `pixels[i]` and the
    /// pairs `lens[i]` to `rays[i]`, and their solid angles: the same bits in less time.
    ///
    /// # Panics
    ///
    /// Panics unless all slices are of equal length.
    pub fn sample_rays(
        &self,
        pixels: &[DVec2],
        lens: &[[f64; 2]],
        rays: &mut [Ray],
        solid_angles: &mut [f64],
    ) {
        let lengths = [lens.len(), rays.len(), solid_angles.len()];
        assert_eq!(lengths, [pixels.len(); 3], "one ray for each image point");
        let from = pixels.chunks(LANES).zip(lens.chunks(LANES));
        let to = rays.chunks_mut(LANES).zip(solid_angles.chunks_mut(LANES));
        for ((pixels, lens), (rays, solid_angles)) in from.zip(to) {
            if self.distortion.is_none() {
                self.undistorted_rays(pixels, lens, rays, solid_angles);
                continue;
            }
            for lane in 0..pixels.len() {
                let seen = self.sample_ray(pixels[lane], lens[lane]);
                (rays[lane], solid_angles[lane]) = (seen.ray, seen.solid_angle);
            }
        }
    }

    /// Writes rays of a lens without distortion, `LANES` at most, by a loop over separate
    /// coordinates.
    fn undistorted_rays(
        &self,
        pixels: &[DVec2],
        lens: &[[f64; 2]],
        rays: &mut [Ray],
        solid_angles: &mut [f64],
    ) {
        let mut points = [[0.0; LANES]; 4];
        for (lane, (pixel, [u, v])) in pixels.iter().zip(lens).enumerate() {
            [points[0][lane], points[1][lane]] = pixel.to_array();
            [points[2][lane], points[3][lane]] = [*u, *v];
        }
        let (mut origins, mut directions) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3]);
        let mut angles = [0.0; LANES];
        vectorised(
            #[inline(always)]
            || {
                for lane in 0..LANES {
                    let [x, y, u, v] = [0, 1, 2, 3].map(|i| points[i][lane]);
                    let chief = self.sensor.point(DVec2::new(x, y));
                    let seen = self.ray_through(chief, DMat2::IDENTITY, [u, v]);
                    for axis in 0..3 {
                        origins[axis][lane] = seen.ray.origin[axis];
                        directions[axis][lane] = seen.ray.direction[axis];
                    }
                    angles[lane] = seen.solid_angle;
                }
            },
        );
        let vector =
            |of: &[[f64; LANES]; 3], lane: usize| DVec3::new(of[0][lane], of[1][lane], of[2][lane]);
        for (lane, ray) in rays.iter_mut().enumerate() {
            ray.origin = vector(&origins, lane);
            ray.direction = vector(&directions, lane);
        }
        solid_angles.copy_from_slice(&angles[..solid_angles.len()]);
    }

    /// Returns the ray of an image point with the chief ray `chief`, whose length reaches to the
    /// image point. The derivative of the distortion there is `stretch`.
    #[inline(always)]
    fn ray_through(&self, chief: DVec3, stretch: DMat2, lens: [f64; 2]) -> CameraRay {
        let on_lens = if self.description.depth_of_field {
            self.lens_point(lens)
        } else {
            DVec2::ZERO
        };
        // (P − ℓ) s / Z, with the point P in focus at the depth Z: 1/Z = 1/f − 1/s. The form also
        // holds for a focus at infinity or beyond.
        let beyond_focus = chief.z / self.description.focal_length - 1.0;
        let direction = self.world(chief - (beyond_focus * on_lens).extend(0.0));
        let scale = direction.length_recip();
        let cosine = chief.z * scale;
        let tangents = self.sensor.tangents_per_pixel(chief.z)
            * (1.0 + self.sensor.slope().dot(stretch * on_lens))
            / stretch.determinant();
        CameraRay {
            ray: Ray {
                origin: self.position() + self.world(on_lens.extend(0.0)),
                direction: direction * scale,
            },
            weight: 1.0,
            solid_angle: tangents * (cosine * cosine * cosine),
        }
    }

    /// Connects a point of the scene to a point of the lens, chosen as in
    /// [`sample_ray`](Self::sample_ray), to follow light from its source.
    ///
    /// A path that brings the flux Φ to `point` and scatters it with f |cos θ| towards the point of
    /// the lens adds Φ f |cos θ| times the importance to the value of the pixel that contains the
    /// image point. The caller checks whether the path to the lens is unoccluded.
    ///
    /// ```text
    /// importance = 1 / (Ω_ℓ r²)      Ω_ℓ: solid angle per pixel seen from the point ℓ of the lens,
    ///                                r: distance from there to the point
    /// ```
    ///
    /// Returns `None` for a point that is not in the image.
    pub fn connect(&self, point: DVec3, lens: [f64; 2]) -> Option<CameraConnection> {
        let on_lens = if self.description.depth_of_field {
            self.lens_point(lens)
        } else {
            DVec2::ZERO
        };
        let lens_point = self.position() + self.world(on_lens.extend(0.0));
        let local = self.local(point - self.position());
        if local.z <= 0.0 {
            return None;
        }
        // The chief ray to where the ray through ℓ meets the plane at the focus distance.
        let vergence = 1.0 / self.description.focus_distance - 1.0 / local.z;
        let aim = local.truncate() / local.z + vergence * on_lens;
        let (tangent, image) = self.through_lens(aim, on_lens)?;
        let pixel = self.sensor.pixel(image)?;
        let size = self.description.size();
        if pixel.cmplt(DVec2::ZERO).any() || pixel.cmpge(size).any() {
            return None;
        }
        let stretch = self.distortion.jacobian(tangent);
        let tangents = self.sensor.tangents_per_pixel(self.sensor.depth(image)?)
            * (1.0 + self.sensor.slope().dot(stretch * on_lens))
            / stretch.determinant();
        let distance = (local - on_lens.extend(0.0)).length();
        let importance = distance / local.z / (tangents * local.z * local.z);
        // A point on the lens itself has no direction to it.
        importance.is_finite().then_some(CameraConnection {
            pixel,
            lens_point,
            importance,
        })
    }

    /// Returns the tangent of the chief ray, and its image, for the image point that the point ℓ of
    /// the lens reaches when the ray meets an untilted sensor along `aim`.
    ///
    /// ```text
    /// t = aim − ℓ (w·T(t))      T: distortion, w: slope of the sensor
    /// ```
    ///
    /// Newton's iteration for σ = w·T; exact in one step without distortion.
    fn through_lens(&self, aim: DVec2, on_lens: DVec2) -> Option<(DVec2, DVec2)> {
        let slope = self.sensor.slope();
        let mut sigma = 0.0;
        for _ in 0..16 {
            let tangent = aim - sigma * on_lens;
            let image = self.distortion.distorted(tangent)?;
            let error = sigma - slope.dot(image);
            // The remaining error moves the tangent by a few rounding errors.
            if error.abs() * on_lens.length() <= 1e-15 * (1.0 + aim.length()) {
                return Some((tangent, image));
            }
            let stretch = self.distortion.jacobian(tangent);
            sigma -= error / (1.0 + slope.dot(stretch * on_lens));
        }
        None
    }

    /// Returns a point of the pupil, in metres to the right and up: squares of the unit square,
    /// concentric about its middle, become circles.
    #[inline(always)]
    fn lens_point(&self, [u, v]: [f64; 2]) -> DVec2 {
        let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
        let radius = 0.5 * self.pupil_diameter();
        // Choices instead of branches, which a loop over many points could not vectorise.
        let is_wide = x.abs() > y.abs();
        let (long, short) = if is_wide { (x, y) } else { (y, x) };
        let fraction = if long == 0.0 { 0.0 } else { short / long };
        let [cos, sin] = circle_point_at_eighth(fraction);
        let (along, across) = (radius * long * cos, radius * long * sin);
        if is_wide {
            DVec2::new(along, across)
        } else {
            DVec2::new(across, along)
        }
    }
}
