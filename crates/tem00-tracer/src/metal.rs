use core::ops::RangeInclusive;

use crate::TracerError;

/// A metal, by its measured complex refractive index `n + ik`.
///
/// The index is interpolated linearly between the measured wavelengths. Plain steel reflects much
/// like [`Iron`](Self::Iron).
///
/// # Validity
///
/// Vacuum wavelengths from 368 nm to 1088 nm. The tables are those of clean, smooth films: oxide,
/// alloying and the way a film is made change the reflectance by a few per cent.
///
/// # Examples
///
/// Gold is yellow because it hardly reflects blue:
///
/// ```
/// use tem00_tracer::Metal;
///
/// assert!(Metal::Gold.normal_reflectance(650e-9)? > 0.95);
/// assert!(Metal::Gold.normal_reflectance(450e-9)? < 0.42);
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
///
/// # References
///
/// - P. B. Johnson and R. W. Christy, *Optical Constants of the Noble Metals*, 1972.
/// - P. B. Johnson and R. W. Christy, *Optical Constants of Transition Metals: Ti, V, Cr, Mn, Fe,
///   Co, Ni, and Pd*, 1974.
/// - A. D. Rakić, *Algorithm for the Determination of Intrinsic Optical Constants of Metal Films:
///   Application to Aluminum*, 1995.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Metal {
    /// Aluminium (Rakić 1995).
    Aluminium,
    /// Silver (Johnson and Christy 1972).
    Silver,
    /// Gold (Johnson and Christy 1972).
    Gold,
    /// Copper (Johnson and Christy 1972).
    Copper,
    /// Iron (Johnson and Christy 1974).
    Iron,
    /// A metal with the same index at every wavelength.
    Custom {
        /// The real part of the index.
        n: f64,
        /// The imaginary part of the index, the extinction coefficient.
        k: f64,
    },
}

impl Metal {
    /// Returns `n` and `k` at a vacuum wavelength in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is outside the measured range, or if a custom metal has
    /// an `n` that is not positive and finite or a `k` that is negative or not finite.
    pub fn refractive_index(self, wavelength: f64) -> Result<(f64, f64), TracerError> {
        self.check_index()?;
        self.check_wavelength(wavelength)?;
        Ok(self.nearest_refractive_index(wavelength))
    }

    /// Returns the fraction of power that a polished surface reflects at normal incidence, at a
    /// vacuum wavelength in metres.
    ///
    /// ```text
    /// R = ((n − 1)² + k²) / ((n + 1)² + k²)
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`refractive_index`](Self::refractive_index).
    pub fn normal_reflectance(self, wavelength: f64) -> Result<f64, TracerError> {
        let index = self.refractive_index(wavelength)?;
        Ok(fresnel_reflectance(1.0, index))
    }

    /// Checks that the index of a custom metal is possible.
    pub(crate) fn check_index(self) -> Result<(), TracerError> {
        let Self::Custom { n, k } = self else {
            return Ok(());
        };
        if !(n > 0.0 && n.is_finite()) {
            return Err(TracerError::OutOfRange {
                parameter: "n",
                value: n,
                allowed: "positive and finite",
            });
        }
        if !(k >= 0.0 && k.is_finite()) {
            return Err(TracerError::OutOfRange {
                parameter: "k",
                value: k,
                allowed: "finite and not negative",
            });
        }
        Ok(())
    }

    /// Checks that the metal was measured at a wavelength.
    pub(crate) fn check_wavelength(self, wavelength: f64) -> Result<(), TracerError> {
        if matches!(self, Self::Custom { .. }) || MEASURED.contains(&wavelength) {
            return Ok(());
        }
        Err(TracerError::OutOfRange {
            parameter: "wavelength",
            value: wavelength,
            allowed: "from 368e-9 m to 1088e-9 m, where the metal was measured",
        })
    }

    /// Returns `n` and `k` at the wavelength of the table that is nearest to `wavelength`.
    pub(crate) fn nearest_refractive_index(self, wavelength: f64) -> (f64, f64) {
        let table: &[Row] = match self {
            Self::Aluminium => &ALUMINIUM,
            Self::Silver => &SILVER,
            Self::Gold => &GOLD,
            Self::Copper => &COPPER,
            Self::Iron => &IRON,
            Self::Custom { n, k } => return (n, k),
        };
        interpolate(table, wavelength * 1e9)
    }
}

/// Returns the fraction of unpolarised power that a conductor of index `n + ik` reflects, at the
/// cosine of the angle of incidence.
///
/// The average of the Fresnel reflectances of both polarisations, without approximation. With
/// s = sin θ, c = cos θ:
///
/// ```text
/// a² + b² = √((n² − k² − s²)² + 4n²k²)       2a² = a² + b² + n² − k² − s²
/// R_s = (a² + b² − 2ac + c²) / (a² + b² + 2ac + c²)
/// R_p = R_s (c²(a² + b²) − 2acs² + s⁴) / (c²(a² + b²) + 2acs² + s⁴)
/// ```
///
/// # References
///
/// - M. Born and E. Wolf, *Principles of Optics*, §14.2 (metals) with §1.5 (Fresnel's formulae).
pub(crate) fn fresnel_reflectance(cosine: f64, (n, k): (f64, f64)) -> f64 {
    let c2 = cosine * cosine;
    let s2 = 1.0 - c2;
    let real = n * n - k * k - s2;
    let modulus = real.hypot(2.0 * n * k);
    let a = (0.5 * (modulus + real)).max(0.0).sqrt();
    let cross = 2.0 * a * cosine;
    let perpendicular = (modulus + c2 - cross) / (modulus + c2 + cross);
    let ratio = (c2 * modulus + s2 * s2 - cross * s2) / (c2 * modulus + s2 * s2 + cross * s2);
    0.5 * perpendicular * (1.0 + ratio)
}

fn interpolate(table: &[Row], nanometres: f64) -> (f64, f64) {
    let last = table.len() - 1;
    let above = table.partition_point(|row| row.0 < nanometres);
    let (low, high) = (table[above.max(1) - 1], table[above.clamp(1, last)]);
    let fraction = ((nanometres - low.0) / (high.0 - low.0)).clamp(0.0, 1.0);
    (
        low.1 + fraction * (high.1 - low.1),
        low.2 + fraction * (high.2 - low.2),
    )
}

/// The vacuum wavelengths, in metres, that all tables contain.
const MEASURED: RangeInclusive<f64> = 368e-9..=1088e-9;

/// Wavelength in nanometres, n, k.
type Row = (f64, f64, f64);

/// Rakić 1995: evaporated films, by a Kramers–Kronig analysis of the literature.
const ALUMINIUM: [Row; 21] = [
    (364.66, 0.39877, 4.3957),
    (413.28, 0.52135, 5.0008),
    (442.8, 0.6079, 5.3676),
    (476.87, 0.7278, 5.7781),
    (516.6, 0.8734, 6.2418),
    (563.57, 1.0728, 6.7839),
    (619.93, 1.366, 7.4052),
    (652.25, 1.5724, 7.7354),
    (688.81, 1.8301, 8.0601),
    (729.32, 2.1606, 8.3565),
    (774.91, 2.6154, 8.4914),
    (794.78, 2.7675, 8.3866),
    (815.69, 2.7668, 8.2573),
    (837.74, 2.6945, 8.1878),
    (885.61, 2.2802, 8.1134),
    (911.66, 1.9739, 8.3058),
    (939.28, 1.6784, 8.597),
    (968.63, 1.4867, 9.0655),
    (999.88, 1.4359, 9.4939),
    (1033.2, 1.3998, 9.8914),
    (1127.1, 1.3281, 10.969),
];

/// Johnson and Christy 1972: evaporated films at room temperature.
const SILVER: [Row; 19] = [
    (367.9, 0.07, 1.657),
    (381.5, 0.05, 1.864),
    (397.4, 0.05, 2.07),
    (413.3, 0.05, 2.275),
    (430.5, 0.04, 2.462),
    (450.9, 0.04, 2.657),
    (471.4, 0.05, 2.869),
    (495.9, 0.05, 3.093),
    (520.9, 0.05, 3.324),
    (548.6, 0.06, 3.586),
    (582.1, 0.05, 3.858),
    (616.8, 0.06, 4.152),
    (659.5, 0.05, 4.483),
    (704.5, 0.04, 4.838),
    (756.0, 0.03, 5.242),
    (821.1, 0.04, 5.727),
    (892.0, 0.04, 6.312),
    (984.0, 0.04, 6.992),
    (1088.0, 0.04, 7.795),
];

/// Johnson and Christy 1972: evaporated films at room temperature.
const GOLD: [Row; 19] = [
    (367.9, 1.48, 1.895),
    (381.5, 1.46, 1.933),
    (397.4, 1.47, 1.952),
    (413.3, 1.46, 1.958),
    (430.5, 1.45, 1.948),
    (450.9, 1.38, 1.914),
    (471.4, 1.31, 1.849),
    (495.9, 1.04, 1.833),
    (520.9, 0.62, 2.081),
    (548.6, 0.43, 2.455),
    (582.1, 0.29, 2.863),
    (616.8, 0.21, 3.272),
    (659.5, 0.14, 3.697),
    (704.5, 0.13, 4.103),
    (756.0, 0.14, 4.542),
    (821.1, 0.16, 5.083),
    (892.0, 0.17, 5.663),
    (984.0, 0.22, 6.35),
    (1088.0, 0.27, 7.15),
];

/// Johnson and Christy 1972: evaporated films at room temperature.
const COPPER: [Row; 19] = [
    (367.9, 1.36, 1.975),
    (381.5, 1.33, 2.045),
    (397.4, 1.32, 2.116),
    (413.3, 1.28, 2.207),
    (430.5, 1.25, 2.305),
    (450.9, 1.24, 2.397),
    (471.4, 1.25, 2.483),
    (495.9, 1.22, 2.564),
    (520.9, 1.18, 2.608),
    (548.6, 1.02, 2.577),
    (582.1, 0.7, 2.704),
    (616.8, 0.3, 3.205),
    (659.5, 0.22, 3.747),
    (704.5, 0.21, 4.205),
    (756.0, 0.24, 4.665),
    (821.1, 0.26, 5.18),
    (892.0, 0.3, 5.768),
    (984.0, 0.32, 6.421),
    (1088.0, 0.36, 7.217),
];

/// Johnson and Christy 1974: evaporated films at room temperature.
const IRON: [Row; 19] = [
    (368.0, 2.02, 2.43),
    (381.0, 2.12, 2.5),
    (397.0, 2.24, 2.58),
    (413.0, 2.35, 2.65),
    (431.0, 2.48, 2.71),
    (451.0, 2.59, 2.77),
    (471.0, 2.67, 2.82),
    (496.0, 2.74, 2.88),
    (521.0, 2.86, 2.91),
    (549.0, 2.95, 2.93),
    (582.0, 2.94, 2.99),
    (617.0, 2.88, 3.05),
    (659.0, 2.92, 3.1),
    (704.0, 2.86, 3.19),
    (756.0, 2.87, 3.28),
    (821.0, 2.94, 3.39),
    (892.0, 2.96, 3.56),
    (984.0, 2.92, 3.79),
    (1088.0, 2.97, 4.06),
];

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [Metal; 5] = [
        Metal::Aluminium,
        Metal::Silver,
        Metal::Gold,
        Metal::Copper,
        Metal::Iron,
    ];

    #[test]
    fn tables_rise_in_wavelength_and_contain_the_measured_range() {
        for table in [&ALUMINIUM[..], &SILVER, &GOLD, &COPPER, &IRON] {
            assert!(table.is_sorted_by(|a, b| a.0 < b.0), "{table:?}");
            assert!(table[0].0 <= 368.0, "{table:?}");
            assert!(table[table.len() - 1].0 >= 1088.0, "{table:?}");
        }
    }

    #[test]
    fn other_laboratories_measured_the_same_reflectance_in_red() {
        // n and k at 650 nm as measured by Cheng et al. 2016 (aluminium), McPeak et al. 2015
        // (silver, gold, copper) and Querry 1985 (iron).
        for (metal, n, k) in [
            (Metal::Aluminium, 0.917, 6.221),
            (Metal::Silver, 0.051, 4.460),
            (Metal::Gold, 0.126, 3.792),
            (Metal::Copper, 0.105, 3.72),
            (Metal::Iron, 2.427, 3.361),
        ] {
            let other = Metal::Custom { n, k }.normal_reflectance(650e-9).unwrap();
            let got = metal.normal_reflectance(650e-9).unwrap();
            // Films differ: by 1 % for the best mirrors, by 5 % of the light for iron.
            assert!(
                (got - other).abs() < 0.05,
                "{metal:?}: {got}, elsewhere {other}"
            );
        }
    }

    #[test]
    fn index_is_the_measurement_at_a_measured_wavelength_and_the_mean_between_two() {
        let at = |nanometres: f64| Metal::Gold.refractive_index(nanometres * 1e-9).unwrap();
        for (nanometres, n, k) in [
            (659.5, 0.14, 3.697),
            (638.15, 0.175, 3.4845),
            (1088.0, 0.27, 7.15),
        ] {
            let (got_n, got_k) = at(nanometres);
            // Nanometres to metres and back is good to two roundings; the table rises by 1 in 40.
            assert!((got_n - n).abs() < 1e-12, "{nanometres} nm: n = {got_n}");
            assert!((got_k - k).abs() < 1e-12, "{nanometres} nm: k = {got_k}");
        }
    }

    #[test]
    fn wavelengths_outside_the_tables_are_refused() {
        for wavelength in [-650e-9, 0.0, 367e-9, 1.1e-6, 650.0, f64::NAN] {
            for metal in ALL {
                let result = metal.refractive_index(wavelength);
                assert!(
                    matches!(
                        result,
                        Err(TracerError::OutOfRange {
                            parameter: "wavelength",
                            ..
                        })
                    ),
                    "{metal:?} at {wavelength:e}: {result:?}"
                );
            }
        }
    }

    #[test]
    fn impossible_custom_indices_are_refused() {
        for (n, k, name) in [
            (0.0, 1.0, "n"),
            (f64::NAN, 1.0, "n"),
            (1.0, -0.1, "k"),
            (1.0, f64::INFINITY, "k"),
        ] {
            let result = Metal::Custom { n, k }.refractive_index(650e-9);
            assert!(
                matches!(result, Err(TracerError::OutOfRange { parameter, .. }) if parameter == name),
                "n = {n}, k = {k}: {result:?}"
            );
        }
    }

    #[test]
    fn normal_incidence_follows_the_closed_form() {
        for (n, k) in [(0.05, 4.5), (1.5, 0.0), (2.9, 3.1), (1.5, 7.7), (1e-3, 1e3)] {
            let closed = ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
            let got = fresnel_reflectance(1.0, (n, k));
            // a = n is a difference of squares as large as k²: its error grows to (k/n)² ε / 4, and
            // R moves by at most 4a/k² times the relative error of a.
            let error_of_a = 1.0 + (k / n) * (k / n);
            let tolerance = 4e-16 * (4.0 + 4.0 * n / (n * n + k * k).max(1.0) * error_of_a);
            assert!(
                (got - closed).abs() < tolerance,
                "n = {n}, k = {k}: {got}, not {closed}"
            );
        }
    }

    /// Complex numbers, as pairs.
    type Complex = (f64, f64);

    fn mul(a: Complex, b: Complex) -> Complex {
        (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0)
    }

    fn sub(a: Complex, b: Complex) -> Complex {
        (a.0 - b.0, a.1 - b.1)
    }

    fn add(a: Complex, b: Complex) -> Complex {
        (a.0 + b.0, a.1 + b.1)
    }

    fn modulus(a: Complex) -> f64 {
        a.0.hypot(a.1)
    }

    fn sqrt(a: Complex) -> Complex {
        let (angle, root) = (0.5 * a.1.atan2(a.0), modulus(a).sqrt());
        (root * angle.cos(), root * angle.sin())
    }

    /// Reflectance from the complex amplitudes of both polarisations (Born and Wolf, §1.5).
    fn reflectance_from_amplitudes(cosine: f64, index: Complex) -> f64 {
        let c = (cosine, 0.0);
        let square = mul(index, index);
        // n cos θ_t, from Snell's law.
        let transmitted = sqrt(sub(square, (1.0 - cosine * cosine, 0.0)));
        let r_s = modulus(sub(c, transmitted)) / modulus(add(c, transmitted));
        let p = mul(square, c);
        let r_p = modulus(sub(p, transmitted)) / modulus(add(p, transmitted));
        0.5 * (r_s * r_s + r_p * r_p)
    }

    proptest! {
        #[test]
        fn fresnel_reflectance_is_that_of_the_complex_amplitudes(
            cosine in 0.0_f64..=1.0, n in 0.05_f64..4.0, k in 0.0_f64..10.0,
        ) {
            let got = fresnel_reflectance(cosine, (n, k));
            let want = reflectance_from_amplitudes(cosine, (n, k));
            // The difference of squares in a² loses (k/n)² ≤ 4e4 roundings of 1.1e−16; R moves by
            // less than the relative error of a.
            prop_assert!((got - want).abs() < 2e-11, "got {got}, want {want}");
            prop_assert!((0.0..=1.0).contains(&got), "R = {got}");
        }
    }

    #[test]
    fn everything_reflects_at_grazing_incidence() {
        for metal in ALL {
            let index = metal.refractive_index(650e-9).unwrap();
            assert!(
                (fresnel_reflectance(0.0, index) - 1.0).abs() < 1e-15,
                "{metal:?}"
            );
        }
    }

    #[test]
    fn only_one_polarisation_is_reflected_at_the_brewster_angle() {
        let n: f64 = 1.5;
        let cosine = 1.0 / (1.0 + n * n).sqrt();
        // tan θ = n, hence r_s = (1 − n²)/(1 + n²).
        let r_s = (1.0 - n * n) / (1.0 + n * n);
        let got = fresnel_reflectance(cosine, (n, 0.0));
        assert!((got - 0.5 * r_s * r_s).abs() < 1e-15, "R = {got}");
    }
}
