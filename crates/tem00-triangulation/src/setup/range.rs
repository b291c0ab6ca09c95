use super::Setup;

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
        let at = |y: f64| self.height_at(y);
        HeightRange {
            low: at(height as f64 - margin).unwrap_or(-limit).max(-limit),
            high: at(margin).unwrap_or(limit).min(limit),
        }
    }

    /// Returns the heights at which the line stays fine, in metres: defocus makes its image at most √2 times as wide as in
    /// focus, and it spreads on the part to at most √2 times its thickness.
    ///
    /// ```text
    /// D s |1/Z − 1/L| ≤ W₀      Z = L + y sin θ − z cos θ
    /// |z| ≤ π w₀² cos τ / λ     w₀ = line_thickness / 2
    /// ```
    ///
    /// with the place y of the laser plane at the height z and its tilt τ. The line has its waist on the reference
    /// plane: a fine one spreads within its Rayleigh range, which ends the depth of field where the lens does not. A set-up
    /// after Scheimpflug has the whole laser plane in focus.
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

    /// That of the lens, without end for a pupil so small that the disc of defocus never grows as wide as the line.
    fn lens_range(&self) -> HeightRange {
        if self.description().camera.scheimpflug {
            return HeightRange {
                low: f64::NEG_INFINITY,
                high: f64::INFINITY,
            };
        }
        let distance = self.description().camera.distance;
        let width = self.line().width * self.description().sensor.pixel_pitch;
        let camera = self.camera();
        let vergence = width / (camera.pupil_diameter() * camera.image_distance());
        let height = |inverse_depth: f64| {
            let (sin, cos) = self.description().camera.angle.sin_cos();
            let laser = &self.description().laser;
            (distance + self.description().laser_offset() * sin - 1.0 / inverse_depth)
                / (cos - libm::tan(laser.tilt) * sin)
        };
        let farthest = 1.0 / distance - vergence;
        HeightRange {
            low: if farthest > 0.0 {
                height(farthest)
            } else {
                f64::NEG_INFINITY
            },
            high: height(1.0 / distance + vergence),
        }
    }

    /// Returns the heights that can be measured, in metres: those that are both
    /// [seen](Self::seen_range) and within the [depth of field](Self::depth_of_field).
    pub fn measuring_range(&self) -> HeightRange {
        self.seen_range().and(&self.depth_of_field())
    }
}
