use core::f64::consts::PI;

use tem00_numerics::{circular_path_overlap_inverse, disc_overlap, disc_overlap_inverse, sinc};

/// Returns the intensity correlation left when the speckle slides across a circular pupil.
///
/// ```text
/// γ = chat²(s),    chat(s) = (2/π) (acos s − s √(1 − s²))
/// ```
///
/// `shift` is the length s of the pupil displacement in units of the pupil diameter. The part of the
/// pupil that sees the same field as before is the overlap of two discs; from s = 1 on there is
/// none. The function is even.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::pupil_overlap_correlation;
///
/// assert!((pupil_overlap_correlation(0.25) - 0.469_276_571_606_7).abs() < 1e-12);
/// assert!(pupil_overlap_correlation(1.0) == 0.0);
/// ```
///
/// # References
///
/// - M. Sjödahl, *Calculation of speckle displacement, decorrelation, and object-point location in
///   imaging systems*, 1995.
/// - S. Bergmann et al. 2016, §6.4.
pub fn pupil_overlap_correlation(shift: f64) -> f64 {
    disc_overlap(shift).powi(2)
}

/// Returns the intensity correlation left when the surface moves along the optical axis.
///
/// ```text
/// γ = sinc²(π x),    x = d_z / (8 λ (L/D)²),    sinc(x) = sin(x) / x
/// ```
///
/// `shift` is the displacement x in units of
/// [`axial_decorrelation_length`](crate::ImagingGeometry::axial_decorrelation_length), where the
/// correlation first vanishes. Beyond, it revives to 4.7 % at most. The function is even.
///
/// In the notation of the original x = `a_O`/2. Bergmann et al. 2016 take the pattern for
/// decorrelated at `a_O` = 1, where 40.5 % are left: see
/// [`paper::axial_decorrelation_length`](crate::paper::axial_decorrelation_length).
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::axial_correlation;
///
/// assert!((axial_correlation(0.5) - 0.405_284_734_569_4).abs() < 1e-12);
/// assert!(axial_correlation(1.0) < 1e-30);
/// ```
///
/// # References
///
/// - D. W. Li and F. P. Chiang, *Decorrelation functions in laser speckle photography*, 1986.
pub fn axial_correlation(shift: f64) -> f64 {
    sinc(PI * shift).powi(2)
}

/// Returns the intensity correlation left after a pupil displacement and an axial displacement
/// together, as the product of [`pupil_overlap_correlation`] and [`axial_correlation`].
///
/// `pupil_shift` is in units of the pupil diameter, `axial_shift` in units of the axial
/// decorrelation length.
///
/// # Validity
///
/// The product is exact where one of the two is zero. In between it deviates by at most 0.048 from
/// the overlap integral of the defocused pupil taken at the geometric displacement of the speckle,
/// and by at most 0.121 from the peak of the cross-correlation, which defocus moves elsewhere.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::{axial_correlation, correlation, pupil_overlap_correlation};
///
/// let product = pupil_overlap_correlation(0.2) * axial_correlation(0.3);
/// assert_eq!(correlation(0.2, 0.3), product);
/// ```
pub fn correlation(pupil_shift: f64, axial_shift: f64) -> f64 {
    pupil_overlap_correlation(pupil_shift) * axial_correlation(axial_shift)
}

/// Returns the distance between two slices of a circular speckle stack that have a given intensity
/// correlation γ.
///
/// ```text
/// u = M x    with    1 − x − sin(π x)/π = √γ
/// ```
///
/// `half_period` is M, the number of slices to the first uncorrelated one; the stack has 2M. The
/// result runs from 0 for γ ≥ 1 to M for γ ≤ 0. It is the exact inverse of the stack's own law, so
/// that two slices this far apart have the correlation asked for.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::slice_coordinate;
///
/// // Neighbours in a stack of 16 slices.
/// let gamma = 0.567_292_284_154_527;
/// assert!((slice_coordinate(gamma, 8) - 1.0).abs() < 1e-12);
/// assert_eq!(slice_coordinate(0.0, 8), 8.0);
/// ```
pub fn slice_coordinate(correlation: f64, half_period: usize) -> f64 {
    half_period as f64 * circular_path_overlap_inverse(amplitude(correlation))
}

/// Returns the pupil displacement, in units of the pupil diameter, that alone would leave a given
/// intensity correlation γ.
///
/// ```text
/// s = chat⁻¹(√γ)
/// ```
///
/// It places any kind of decorrelation on a stack whose pupil moves along a straight line. The
/// result runs from 0 for γ ≥ 1 to 1 for γ ≤ 0.
///
/// # Examples
///
/// ```
/// use tem00_decorrelation::{equivalent_pupil_shift, pupil_overlap_correlation};
///
/// let gamma = pupil_overlap_correlation(0.3);
/// assert!((equivalent_pupil_shift(gamma) - 0.3).abs() < 1e-12);
/// ```
pub fn equivalent_pupil_shift(correlation: f64) -> f64 {
    disc_overlap_inverse(amplitude(correlation))
}

/// √γ, with rounding noise below zero taken for zero.
fn amplitude(correlation: f64) -> f64 {
    correlation.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;
    use tem00_numerics::circular_path_overlap;

    use super::*;

    /// The correlation of a pupil displaced by `s` diameters and defocused by the path difference
    /// `beta` r² over the unit disc, by the midpoint rule over the overlap of both discs.
    ///
    /// `reference` is the centre of the defocus: 0.5 puts it in the middle of the overlap, which is
    /// where the cross-correlation peaks; 0 at the centre of the undisplaced pupil, which is the
    /// geometric displacement with the reference in focus.
    fn overlap_integral(s: f64, beta: f64, reference: f64) -> f64 {
        const STEPS: u32 = 200;
        let (mut re, mut im) = (0.0, 0.0);
        let half_width = 1.0 - s;
        for i in 0..STEPS {
            // x = half_width · sin t and y = height · sin t' remove the square-root end points.
            let t = FRAC_PI_2 * ((f64::from(i) + 0.5) * 2.0 / f64::from(STEPS) - 1.0);
            let x = half_width * t.sin();
            let height = (1.0 - (x.abs() + s).powi(2)).max(0.0).sqrt();
            let dx = half_width * t.cos() * PI / f64::from(STEPS);
            let along = (x + (1.0 - 2.0 * reference) * s).powi(2);
            for j in 0..STEPS / 4 {
                let y = height * (f64::from(j) + 0.5) * 4.0 / f64::from(STEPS);
                let area = 2.0 * dx * height * 4.0 / f64::from(STEPS) / PI;
                let phase = beta * (along + y * y);
                re += phase.cos() * area;
                im += phase.sin() * area;
            }
        }
        re * re + im * im
    }

    /// The largest deviation of the product from the integral over shift and defocus.
    fn largest_product_error(reference: f64) -> (f64, f64, f64) {
        let mut worst = (0.0, 0.0, 0.0);
        for i in 0..20_u32 {
            for j in 0..=16_u32 {
                let (s, x) = (f64::from(i) * 0.05, f64::from(j) * 0.0625);
                let exact = overlap_integral(s, 2.0 * PI * x, reference);
                let error = (correlation(s, x) - exact).abs();
                if error > worst.0 {
                    worst = (error, s, x);
                }
            }
        }
        worst
    }

    #[test]
    fn overlap_correlation_has_the_reference_values() {
        // Squares of chat(s) to 15 digits, computed in extended precision.
        let reference = [
            (0.1, 0.872_888_571_569_538_f64),
            (0.25, 0.685_037_642_474_293),
            (0.5, 0.391_002_218_955_771),
            (0.75, 0.144_293_612_814_387),
        ];
        for (s, chat) in reference {
            let gamma = pupil_overlap_correlation(s);
            assert!((gamma - chat * chat).abs() < 2e-15, "γ({s}) = {gamma}");
        }
    }

    #[test]
    fn axial_correlation_has_the_reference_values() {
        // sinc²(π a_O/2) at a_O = 0.5, 1, 1.5, computed in extended precision.
        let reference = [
            (0.25, 0.810_569_469_138_7),
            (0.5, 0.405_284_734_569_4),
            (0.75, 0.090_063_274_348_7),
        ];
        for (x, expected) in reference {
            let gamma = axial_correlation(x);
            assert!((gamma - expected).abs() < 1e-13, "γ({x}) = {gamma}");
        }
        // The first zero of the sine, with sin π = 1.2e−16 in floating point.
        assert!(axial_correlation(1.0) < 1e-30, "not a zero");
        assert!(axial_correlation(f64::NEG_INFINITY) == 0.0, "the limit");
        assert!(axial_correlation(f64::MAX) == 0.0, "an overflow");
        // The revival, at a_O = 2.86.
        assert!(
            (axial_correlation(1.43) - 0.0472).abs() < 5e-5,
            "not the first side lobe"
        );
    }

    #[test]
    fn either_law_alone_is_the_overlap_integral() {
        // The midpoint rule in y, with h = 1/50 of the height, errs by h²/24 times the slope at the
        // end, 2β at most: 1.9e−4 at β = 2π · 0.9. Over the disc that is 2.4e−4 in the amplitude
        // and at most twice that in γ.
        for reference in [0.0, 0.5] {
            for value in [0.1, 0.4, 0.9] {
                let shifted = overlap_integral(value, 0.0, reference);
                let law = pupil_overlap_correlation(value);
                assert!((shifted - law).abs() < 5e-4, "s = {value}: {shifted}");
                let defocused = overlap_integral(0.0, 2.0 * PI * value, reference);
                let law = axial_correlation(value);
                assert!((defocused - law).abs() < 5e-4, "x = {value}: {defocused}");
            }
        }
    }

    #[test]
    fn product_stays_within_the_stated_error() {
        // The bounds are stated to three digits; the quadrature adds up to 5e−4.
        let (geometric, s, x) = largest_product_error(0.0);
        assert!(
            (0.045..0.0485).contains(&geometric),
            "{geometric} at s = {s}, x = {x}"
        );
        let (peak, s, x) = largest_product_error(0.5);
        assert!(
            (0.115..0.1215).contains(&peak),
            "{peak} at s = {s}, x = {x}"
        );
    }

    #[test]
    fn slice_coordinate_inverts_the_law_of_the_stack() {
        // γ between neighbouring slices, from 1 − 1/M − sin(π/M)/π to 15 digits.
        let reference = [
            (4, 0.275_541_973_262_254),
            (8, 0.567_292_284_154_527),
            (16, 0.766_326_598_814_221),
        ];
        for (half_period, gamma) in reference {
            let u = slice_coordinate(gamma, half_period);
            assert!((u - 1.0).abs() < 1e-12, "M = {half_period}: u = {u}");
        }
    }

    #[test]
    fn correlations_out_of_range_map_to_the_ends() {
        for (gamma, end) in [(1.0, 0.0), (1.5, 0.0), (0.0, 1.0), (-1e-17, 1.0)] {
            let (u, s) = (slice_coordinate(gamma, 8), equivalent_pupil_shift(gamma));
            assert!((u - 8.0 * end).abs() < 1e-15, "u({gamma}) = {u}");
            assert!((s - end).abs() < 1e-15, "s({gamma}) = {s}");
        }
    }

    proptest! {
        #[test]
        fn slices_that_far_apart_have_the_correlation_asked_for(
            gamma in 0.0_f64..1.0,
            half_period in 1_usize..100,
        ) {
            let u = slice_coordinate(gamma, half_period);
            let stack = circular_path_overlap(u / half_period as f64).powi(2);
            // Rounding of u by ε changes the overlap by 2ε and γ by twice that.
            prop_assert!((stack - gamma).abs() < 1e-14);
            let straight = pupil_overlap_correlation(equivalent_pupil_shift(gamma));
            prop_assert!((straight - gamma).abs() < 1e-14);
        }
    }
}
