use crate::rectangular_pixel_contrast;

/// Returns the contrast of fully developed speckle on square pixels that integrate over their whole
/// area, where `pixel_size` is their side in units of the speckle size h.
///
/// ```text
/// C² = 4 ∫₀¹∫₀¹ (1−x)(1−y) c(q √(x²+y²)) dx dy      q = pixel_size, c the Airy autocovariance
/// C² = 1 − π²q²/12 + …      q → 0
/// C² = (4/π) / q² − …       q → ∞
/// ```
///
/// For pixels as large as a speckle (q = 1) the contrast is 0.711, for pixels twice as large 0.440.
/// The function is even.
///
/// # Validity
///
/// The limits of [`rectangular_pixel_contrast`] apply.
///
/// # Examples
///
/// ```
/// use tem00_statistics::pixel_contrast;
///
/// assert!((pixel_contrast(0.0) - 1.0).abs() < 1e-12);
/// assert!((pixel_contrast(1.0) - 0.711_268).abs() < 1e-6);
/// ```
///
/// # References
///
/// - J. W. Goodman, *Speckle Phenomena in Optics*, 2007, ch. 4 (integrated speckle).
pub fn pixel_contrast(pixel_size: f64) -> f64 {
    rectangular_pixel_contrast([pixel_size; 2])
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use tem00_testkit::assert_absolute;

    use super::*;

    #[test]
    fn squared_contrast_has_its_known_values() {
        // Six digits, from three equivalent double integrals evaluated independently.
        let table = [
            (0.05, 0.997_947),
            (0.1, 0.991_823),
            (0.25, 0.950_419),
            (0.5, 0.821_415),
            (1.0, 0.505_902),
            (1.5, 0.299_155),
            (2.0, 0.194_010),
            (3.0, 0.099_706),
            (5.0, 0.040_565),
            (10.0, 0.011_209),
        ];
        for (q, squared) in table {
            assert_absolute(pixel_contrast(q).powi(2), squared, 6e-7);
            assert_absolute(pixel_contrast(-q).powi(2), squared, 6e-7);
        }
    }

    #[test]
    fn contrast_falls_from_one_to_zero() {
        // The fourth-order term (5π⁴/192)(17/90) q⁴ at q = 1e−2 is 5e−9.
        let small = 1.0 - PI * PI * 1e-4 / 12.0;
        assert_absolute(pixel_contrast(1e-2).powi(2), small, 1e-8);
        let sizes = (0..2_000).map(|i| 0.05 * f64::from(i));
        let contrasts: Vec<_> = sizes.map(pixel_contrast).collect();
        assert!(
            contrasts.windows(2).all(|pair| pair[1] < pair[0]),
            "the contrast rises somewhere"
        );
        assert!(pixel_contrast(f64::INFINITY).abs() < f64::MIN_POSITIVE);
    }
}
