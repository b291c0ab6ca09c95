use core::f64::consts::{FRAC_PI_2, TAU};

use tem00_numerics::{Refusal, check};

use crate::TriangulationError;

/// A triangulation sensor, by the parameters of the classical limit of its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dorsch {
    /// The vacuum wavelength of the laser, in metres.
    pub wavelength: f64,
    /// The contrast of the speckle in the image, from 0 to 1.
    pub contrast: f64,
    /// The half-angle u under which the pupil of the camera is seen from the surface, in radians.
    pub aperture_angle: f64,
    /// The angle θ between the axes of laser and camera, in radians.
    pub triangulation_angle: f64,
}

impl Dorsch {
    /// Returns the standard deviation of a distance that is read off the centroid of one laser
    /// spot, in metres.
    ///
    /// ```text
    /// δz = C λ / (2π sin u sin θ)
    /// ```
    ///
    /// Speckle leaves this deviation, however bright the spot and however good the sensor. A *line*
    /// that is read in single rows behaves differently: its noise grows with the root of its width,
    /// equals the noise of a spot at a half-width of some 1.3 speckles and is larger beyond.
    ///
    /// # Validity
    ///
    /// A uniformly lit round spot, much wider than a speckle, and a rough surface. For a camera
    /// without a tilt of its own, `sin u = D / 2L` with the diameter D of its pupil at the distance
    /// L.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength is positive, the contrast lies in [0, 1] and both
    /// angles are positive and at most π/2.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_triangulation::Dorsch;
    ///
    /// let sensor = Dorsch {
    ///     wavelength: 650e-9,
    ///     contrast: 1.0,
    ///     aperture_angle: 0.01,
    ///     triangulation_angle: 0.5,
    /// };
    /// // A pupil of 1 : 50 and half a radian: 22 µm.
    /// assert!((sensor.distance_deviation()? - 21.6e-6).abs() < 0.1e-6);
    /// # Ok::<(), tem00_triangulation::TriangulationError>(())
    /// ```
    ///
    /// # References
    ///
    /// - R. G. Dorsch, G. Häusler, J. M. Herrmann, *Laser triangulation: fundamental uncertainty in
    ///   distance measurement*, Appl. Opt. 33, 1306, 1994.
    pub fn distance_deviation(&self) -> Result<f64, TriangulationError> {
        self.check()?;
        let sines = self.aperture_angle.sin() * self.triangulation_angle.sin();
        Ok(self.contrast * self.wavelength / (TAU * sines))
    }

    fn check(&self) -> Result<(), Refusal> {
        check::positive("wavelength", self.wavelength, "m")?;
        check::range("contrast", self.contrast, [0.0, 1.0], "")?;
        for (parameter, angle) in [
            ("aperture_angle", self.aperture_angle),
            ("triangulation_angle", self.triangulation_angle),
        ] {
            let holds = angle > 0.0 && angle <= FRAC_PI_2;
            check::that(
                holds,
                parameter,
                angle,
                "",
                "positive and at most π/2 radians",
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::refuses;

    use super::*;

    const SENSOR: Dorsch = Dorsch {
        wavelength: 650e-9,
        contrast: 0.7,
        aperture_angle: 0.02,
        triangulation_angle: 0.6,
    };

    #[test]
    fn it_is_the_noise_of_a_wide_disc_of_speckle() {
        // The first order of a disc of 1e6 speckles, whose blurred edge costs ln(a)/a, on the
        // surface: h = λ / (2 sin u), and a height moves the spot by sin θ.
        let speckle_size = SENSOR.wavelength / (2.0 * SENSOR.aperture_angle.sin());
        let position = speckle_size * tem00_statistics::laws::disc_spot_centroid_deviation(1e6);
        let height = SENSOR.contrast * position / SENSOR.triangulation_angle.sin();
        let deviation = SENSOR.distance_deviation().expect("a sensor");
        assert!(
            (deviation / height - 1.0).abs() < 2e-5,
            "{deviation:e} | {height:e}"
        );
    }

    #[test]
    fn sensors_that_cannot_be_are_refused() {
        refuses!(sensor = SENSOR => sensor.distance_deviation();
            sensor.wavelength: [f64::NAN, 0.0],
            sensor.contrast: [1.1, -0.1],
            sensor.aperture_angle: [0.0],
            sensor.triangulation_angle: [1.6],
        );
    }
}
