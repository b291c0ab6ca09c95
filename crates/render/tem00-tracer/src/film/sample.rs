use glam::DVec3;

/// The light that a camera sample finds, and the surface that it sees.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The weight of the sample in its pixel, of mean 1.
    pub weight: f64,
    /// The radiance from lights.
    pub lights: f64,
    /// The surface point seen there, if any.
    pub seen: Option<Seen>,
}

/// The surface that a camera sample sees.
#[derive(Clone, Copy, Debug)]
pub struct Seen {
    /// The distance along the axis of the camera, in metres.
    pub depth: f64,
    /// The unit normal of the side that is seen.
    pub normal: DVec3,
}

/// Radiance that a camera sample finds from one laser.
#[derive(Clone, Copy, Debug)]
pub struct LaserSample {
    /// Radiance of light that has met one rough surface, before speckle.
    pub single: f64,
    /// The part of it that comes from below the surface.
    pub below: f64,
    /// Radiance of light that has met more than one, before speckle.
    pub multiple: f64,
    /// The speckle factor.
    pub speckle: f64,
    /// Radiance of all light, with its speckle.
    pub radiance: f64,
    /// The power on the surface that the sample covers, in watts.
    pub power: f64,
}

impl LaserSample {
    /// No light.
    pub const DARK: Self = Self {
        single: 0.0,
        below: 0.0,
        multiple: 0.0,
        speckle: 1.0,
        radiance: 0.0,
        power: 0.0,
    };

    /// Adds light that has met one rough surface, or more.
    pub const fn add(&mut self, radiance: f64, is_single: bool) {
        if is_single {
            self.single += radiance;
        } else {
            self.multiple += radiance;
        }
    }

    /// Adds light that has met one rough surface, from below it.
    pub const fn add_below(&mut self, radiance: f64) {
        self.single += radiance;
        self.below += radiance;
    }

    /// Returns whether the sample finds no light of the laser.
    pub fn is_dark(&self) -> bool {
        self.single == 0.0 && self.multiple == 0.0
    }

    /// Gives the light its speckle.
    pub const fn settle(&mut self, speckle: f64) {
        self.speckle = speckle;
        self.radiance = self.single * speckle + self.multiple * speckle;
    }

    /// Gives the light from below the surface a factor of its own, once the light has its speckle.
    pub const fn settle_below(&mut self, factor: f64) {
        self.radiance += self.below * (factor - self.speckle);
    }
}
