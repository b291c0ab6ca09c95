use core::f64::consts::PI;

use tem00_numerics::{check, jinc, sinc};

use crate::StatisticsError;

/// Lit area of a rough surface, with lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LitArea {
    /// A uniformly lit disc.
    Disc {
        /// The diameter of the disc.
        diameter: f64,
    },
    /// A uniformly lit rectangle.
    Rectangle {
        /// The width of the rectangle, along x.
        width: f64,
        /// The height of the rectangle, along y.
        height: f64,
    },
    /// A Gaussian spot.
    GaussianSpot {
        /// The radius at which the irradiance has fallen to 1/e².
        radius: f64,
    },
}

/// Speckle without a lens: the pattern of a lit area of a rough surface in a distant plane.
///
/// ```text
/// disc        c(r) = [2 J₁(πr/h) / (πr/h)]²,          h = λ z / D
/// rectangle   c(x, y) = sinc²(πx/h_x) sinc²(πy/h_y),  h_x = λ z / W_x, h_y = λ z / W_y
/// Gaussian    c(r) = exp(−(π w r / λz)²)
/// ```
///
/// The correlation of the field in the plane is the Fourier transform of the irradiance on the
/// surface (van Cittert and Zernike), and c is its squared magnitude. A uniformly lit area takes
/// the role of the pupil for the speckle in an image; z is the distance.
///
/// # Validity
///
/// The speckle is fully developed and close to the axis. The plane is parallel to the surface, at a
/// distance of many wavelengths and several sizes of the lit area, and the correlation length of
/// the light on the surface is of the order of the wavelength.
///
/// # Examples
///
/// A red laser spot of 1 mm diameter on a wall produces speckles of 1.3 mm at a distance of 2 m:
///
/// ```
/// use tem00_statistics::laws::{LitArea, ObjectiveSpeckle};
///
/// let spot = LitArea::Disc { diameter: 1e-3 };
/// let speckle = ObjectiveSpeckle::new(650e-9, 2.0, spot)?;
/// assert!((speckle.size()[0] - 1.3e-3).abs() < 1e-12);
/// # Ok::<(), tem00_statistics::StatisticsError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, 1975, §2.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectiveSpeckle {
    /// λ z.
    scale: f64,
    area: LitArea,
}

impl ObjectiveSpeckle {
    /// Creates the speckle from the wavelength λ and the distance z of the plane, in metres, and
    /// the lit area.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength, the distance and all lengths of the area are
    /// positive and finite.
    pub fn new(wavelength: f64, distance: f64, area: LitArea) -> Result<Self, StatisticsError> {
        let is_length = |x: f64| x > 0.0 && x.is_finite();
        for (name, length) in [("wavelength", wavelength), ("distance", distance)] {
            let allowed = "positive and finite, in metres";
            check::that(is_length(length), name, length, "", allowed)?;
        }
        let lengths = match area {
            LitArea::Disc { diameter } => [diameter; 2],
            LitArea::Rectangle { width, height } => [width, height],
            LitArea::GaussianSpot { radius } => [radius; 2],
        };
        for length in lengths {
            let allowed = "positive and finite in every length, in metres";
            check::that(is_length(length), "area", length, "", allowed)?;
        }
        Ok(Self {
            scale: wavelength * distance,
            area,
        })
    }

    /// Returns the speckle size along x and y, in metres: λz divided by the diameter or the sides
    /// of the lit area, the period of the finest fringes.
    ///
    /// A Gaussian spot has no finest fringes. Its speckle size is that of the uniform disc with the
    /// same coherence area, whose diameter is 2w.
    pub fn size(&self) -> [f64; 2] {
        match self.area {
            LitArea::Disc { diameter } => [self.scale / diameter; 2],
            LitArea::Rectangle { width, height } => [self.scale / width, self.scale / height],
            LitArea::GaussianSpot { radius } => [self.scale / (2.0 * radius); 2],
        }
    }

    /// Returns the normalised autocovariance of the intensity at a `lag` along x and y, in metres.
    pub fn autocovariance(&self, lag: [f64; 2]) -> f64 {
        let size = self.size();
        let [x, y] = [lag[0] / size[0], lag[1] / size[1]];
        match self.area {
            LitArea::Disc { .. } => jinc(PI * x.hypot(y)).powi(2),
            LitArea::Rectangle { .. } => (sinc(PI * x) * sinc(PI * y)).powi(2),
            LitArea::GaussianSpot { .. } => (-(0.5 * PI * x.hypot(y)).powi(2)).exp(),
        }
    }

    /// Returns the coherence area, in m²: the integral of the autocovariance over the plane.
    ///
    /// ```text
    /// (λz)² ∫ E² dA / (∫ E dA)²          E the irradiance
    /// = (4/π) h²,  h_x h_y,  (4/π) h²    disc, rectangle, Gaussian spot
    /// ```
    pub fn coherence_area(&self) -> f64 {
        let [x, y] = self.size();
        match self.area {
            LitArea::Rectangle { .. } => x * y,
            LitArea::Disc { .. } | LitArea::GaussianSpot { .. } => 4.0 / PI * x * y,
        }
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::{assert_absolute, assert_relative};

    use super::*;
    use tem00_numerics::quadrature::{integrate, integrate_from_root};

    const WAVELENGTH: f64 = 633e-9;
    const DISTANCE: f64 = 0.8;

    fn speckle(area: LitArea) -> ObjectiveSpeckle {
        ObjectiveSpeckle::new(WAVELENGTH, DISTANCE, area).unwrap()
    }

    /// |∫ E(x) exp(2πi x lag / λz) dx / ∫ E dx|², where E is even in x.
    fn by_transform(profile: impl Fn(f64) -> f64, half: f64, lag: f64) -> f64 {
        let scale = 2.0 * PI * lag / (WAVELENGTH * DISTANCE);
        // The integral runs from the edge inwards, since the profile may have a root at the edge.
        let wave = |depth: f64| profile(half - depth) * (scale * (half - depth)).cos();
        let power = |depth: f64| profile(half - depth);
        let range = [0.0, half];
        let ratio =
            integrate_from_root(wave, range, 0.02) / integrate_from_root(power, range, 0.02);
        ratio * ratio
    }

    #[test]
    fn autocovariance_is_the_squared_transform_of_the_irradiance() {
        let disc = speckle(LitArea::Disc { diameter: 3e-3 });
        let box_ = speckle(LitArea::Rectangle {
            width: 3e-3,
            height: 0.5e-3,
        });
        let spot = speckle(LitArea::GaussianSpot { radius: 1e-3 });
        for lag in [0.0, 40e-6, 150e-6, 210e-6, 700e-6] {
            // Integrated over y, the disc becomes a half circle and the Gaussian a Gaussian.
            let chord = |x: f64| (1.5e-3 * 1.5e-3 - x * x).max(0.0).sqrt();
            let law = by_transform(chord, 1.5e-3, lag);
            assert_absolute(disc.autocovariance([0.6 * lag, -0.8 * lag]), law, 1e-12);
            let law = by_transform(|_| 1.0, 1.5e-3, lag);
            assert_absolute(box_.autocovariance([lag, 0.0]), law, 1e-12);
            let law = by_transform(|_| 1.0, 0.25e-3, lag);
            assert_absolute(box_.autocovariance([0.0, lag]), law, 1e-12);
            let gauss = |x: f64| (-2.0 * (x / 1e-3).powi(2)).exp();
            let law = by_transform(gauss, 4.5e-3, lag);
            assert_absolute(spot.autocovariance([0.0, lag]), law, 1e-12);
        }
    }

    #[test]
    fn coherence_area_is_that_of_the_irradiance() {
        let squared_scale = (WAVELENGTH * DISTANCE).powi(2);
        let disc = speckle(LitArea::Disc { diameter: 3e-3 }).coherence_area();
        let lit = PI * 1.5e-3 * 1.5e-3;
        assert_relative(disc, squared_scale / lit, 1e-14);
        let area = LitArea::Rectangle {
            width: 3e-3,
            height: 0.5e-3,
        };
        let rectangle = speckle(area).coherence_area();
        assert_relative(rectangle, squared_scale / 1.5e-6, 1e-14);
        // ∫ E² divided by (∫ E)², as radial integrals.
        let spot = speckle(LitArea::GaussianSpot { radius: 1e-3 });
        let radial = |power: f64| {
            let ring = |r: f64| (-2.0 * power * (r / 1e-3).powi(2)).exp() * 2.0 * PI * r;
            integrate(ring, [0.0, 5e-3], 2e-4)
        };
        let exact = squared_scale * radial(2.0) / radial(1.0).powi(2);
        assert_relative(spot.coherence_area(), exact, 1e-12);
        // The coherence area is also the integral of the autocovariance.
        let h = spot.size()[0];
        let ring = |r: f64| spot.autocovariance([r * h, 0.0]) * 2.0 * PI * r;
        let integral = h * h * integrate(ring, [0.0, 5.0], 0.2);
        assert_relative(spot.coherence_area(), integral, 1e-12);
    }
}
