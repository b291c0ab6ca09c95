use super::{Setup, SetupCamera};

/// A range of heights, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightRange {
    /// The minimum height.
    pub low: f64,
    /// The maximum height.
    pub high: f64,
}

impl HeightRange {
    /// Returns the length of the range, in metres; 0 if it is empty.
    pub fn length(&self) -> f64 {
        (self.high - self.low).max(0.0)
    }

    fn and(&self, other: &Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.min(other.high),
        }
    }
}

impl Setup {
    /// Returns the heights whose line is in the image, with half a window of the detector above and
    /// below it, in metres; at most those within one camera height of the reference plane.
    pub fn seen_range(&self) -> HeightRange {
        let description = self.description();
        let [_, height] = description.camera.resolution;
        let margin = 0.5 * description.detector.window as f64;
        let limit = description.camera.distance * description.camera.angle.cos();
        // What is higher on the part is higher in the image, unless the laser leans over the
        // camera.
        let mut rows = [height as f64 - margin, margin];
        if self.line().height_per_pixel < 0.0 {
            rows.reverse();
        }
        let [low, high] = rows.map(|row| self.height_at(row));
        HeightRange {
            low: low.unwrap_or(-limit).max(-limit),
            high: high.unwrap_or(limit).min(limit),
        }
    }

    /// Returns the heights at which the line stays fine, in metres: defocus makes its image at most
    /// √2 times as wide as in focus, and it spreads on the part to at most √2 times its thickness.
    ///
    /// ```text
    /// D s |1/Z − 1/L| ≤ W₀      Z = L + y sin θ − z cos θ
    /// |z| ≤ π w₀² cos τ / λ     w₀ = line_thickness / 2
    /// ```
    ///
    /// with the place y of the laser plane at the height z and its tilt τ. The line has its waist
    /// on the reference plane: a fine one spreads within its Rayleigh range, which ends the depth
    /// of field where the lens does not.
    ///
    /// A set-up after Scheimpflug has the whole plane of the laser in focus if that plane goes
    /// through the point that the optical axis meets. With an offset y₀ beside it, and the angle φ
    /// of the sensor, it is fine where
    ///
    /// ```text
    /// Z ≥ f (1 + y₀/H + D |y₀| / (W₀ |H| cos φ))      H = L sin(θ + τ) / cos τ
    /// ```
    pub fn depth_of_field(&self) -> HeightRange {
        self.lens_range().and(&self.line_range())
    }

    fn line_range(&self) -> HeightRange {
        let description = self.description();
        let beam = description.line_beam().ok();
        let rayleigh_range = beam.map_or(0.0, |beam| beam.rayleigh_range());
        let high = rayleigh_range * libm::cos(description.laser.tilt);
        HeightRange { low: -high, high }
    }

    /// Range of the lens, infinite for a pupil so small that the defocus disc never becomes as wide
    /// as the line.
    pub(super) fn lens_range(&self) -> HeightRange {
        let description = self.description();
        let (sin, cos) = description.camera.angle.sin_cos();
        let beside = description.camera.distance + description.laser_offset() * sin;
        // The depth falls with the height, except for a plane that leans out of sight.
        let fall = cos - libm::tan(description.laser.tilt) * sin;
        let [near, far] = self.depths_in_focus().map(|depth| (beside - depth) / fall);
        HeightRange {
            low: near.min(far),
            high: near.max(far),
        }
    }

    /// Returns the smallest and the greatest depth before the lens that is in focus on the plane of
    /// the laser.
    fn depths_in_focus(&self) -> [f64; 2] {
        let (description, camera) = (self.description(), self.camera());
        let SetupCamera {
            distance,
            focal_length,
            angle,
            scheimpflug,
            ..
        } = description.camera;
        let width = self.line().width * description.sensor.pixel_pitch;
        if scheimpflug {
            let (tilt, offset) = (description.laser.tilt, description.laser_offset());
            let beside = distance * libm::sin(angle + tilt) / libm::cos(tilt);
            let blurred = camera.pupil_diameter() * offset
                / (width * beside * libm::cos(camera.description().tilt.angle));
            let near = focal_length * (1.0 + offset / beside + blurred.abs());
            return [near, f64::INFINITY];
        }
        let vergence = width / (camera.pupil_diameter() * camera.image_distance());
        let farthest = 1.0 / distance - vergence;
        let far = if farthest > 0.0 {
            1.0 / farthest
        } else {
            f64::INFINITY
        };
        [1.0 / (1.0 / distance + vergence), far]
    }

    /// Returns the heights that can be measured, in metres: the heights that are both
    /// [seen](Self::seen_range) and within the [depth of field](Self::depth_of_field).
    pub fn measuring_range(&self) -> HeightRange {
        self.seen_range().and(&self.depth_of_field())
    }
}
