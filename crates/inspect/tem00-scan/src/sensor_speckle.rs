use glam::{DMat2, DVec2};
use tem00_numerics::{cast::to_usize, quadrature::gauss_legendre};

use crate::airy_pattern::airy_pattern;

/// Speckle as the pixels of a sensor see it, at a position of the image.
///
/// The autocovariance of fully developed speckle behind a circular pupil is Airy's pattern, in
/// directions that the pupil resolves:
///
/// ```text
/// c(Δ) = C² |2 J₁(π|M Δ|) / π|M Δ||²      M = (D/λ) ∂t/∂x
/// ```
///
/// with the tangents t of the chief rays, at the image points x. On a plain sensor speckle is as
/// wide everywhere and in all directions; a tilt of the sensor and a lens that distorts stretch it
/// as they stretch the image.
///
/// # Validity
///
/// Paraxial: at the angle θ off the axis speckle is longer by up to 1/cos³θ.
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007: the autocovariance of speckle in an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensorSpeckle {
    /// The matrix M: how many speckles a pixel to the right (first column) and a pixel down (second
    /// column) span, along the axes of the camera.
    pub speckles_per_pixel: DMat2,
    /// The side of the sensitive part of a pixel, in pixels.
    pub sensitive_side: f64,
    /// The variance C² of the speckle factor in a point: 1 for one polarised pattern.
    pub variance: f64,
}

impl SensorSpeckle {
    /// Returns the speckle size along rows and along columns, in pixels.
    pub fn size(&self) -> [f64; 2] {
        let DMat2 { x_axis, y_axis } = self.speckles_per_pixel;
        [x_axis.length().recip(), y_axis.length().recip()]
    }

    /// Returns the covariance of the speckle factors of two pixels, a displacement in pixels apart.
    pub(super) fn covariance(&self, displacement: [f64; 2]) -> f64 {
        let [across, down] = [0, 1].map(|axis| self.nodes(axis, displacement[axis]));
        let sum: f64 = across
            .iter()
            .flat_map(|a| down.iter().map(move |d| (a, d)))
            .map(|((x, weight_x), (y, weight_y))| {
                let speckles = self.speckles_per_pixel * DVec2::new(*x, *y);
                weight_x * weight_y * airy_pattern(speckles.length())
            })
            .sum();
        self.variance * sum
    }

    /// The distances, in pixels, at which the integral along an axis takes its values, with the
    /// weights.
    fn nodes(&self, axis: usize, displacement: f64) -> Vec<(f64, f64)> {
        // Each panel is at most half a speckle wide, to either side of the kink of the triangle.
        let panels = (2.0 * self.sensitive_side / self.size()[axis])
            .ceil()
            .clamp(1.0, 64.0);
        let half_width = 0.5 / panels;
        let half = (0..to_usize(panels)).flat_map(|panel| {
            let middle = 2.0 * panel as f64 + 1.0;
            RULE.map(|(node, weight)| (half_width * (middle + node), half_width * weight))
        });
        half.flat_map(|(u, weight)| [(u, weight), (-u, weight)])
            .map(|(u, weight)| {
                let distance = displacement + self.sensitive_side * u;
                (distance, weight * (1.0 - u.abs()))
            })
            .collect()
    }
}

/// Four points per panel.
const RULE: [(f64, f64); 4] = gauss_legendre();
