//! The colour of laser light on a screen: wavelength → CIE 1931 XYZ → linear sRGB.

/// The wavelength of the table's first row, in nanometres.
const FIRST: f64 = 380.0;
/// The distance between the table's rows, in nanometres.
const STEP: f64 = 5.0;

/// Returns the CIE 1931 2° colour-matching functions x̄, ȳ, z̄ at a wavelength in metres, and
/// `None` outside the visible 380–780 nm.
///
/// Between the 5 nm rows of the table a cubic (Catmull–Rom) runs through four of them; it stays
/// within 0.0024 of the tabulated 1 nm values.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the row lies in [0, 80]"
)]
pub fn xyz_of_wavelength(wavelength: f64) -> Option<[f64; 3]> {
    let last = MATCHING_FUNCTIONS.len() - 1;
    // A thousandth of a row of slack: 780e-9 · 1e9 is not exactly 780.
    let position = (wavelength * 1e9 - FIRST) / STEP;
    if !(-1e-3..=last as f64 + 1e-3).contains(&position) {
        return None;
    }
    let row = (position.max(0.0) as usize).min(last);
    let fraction = (position - row as f64).clamp(0.0, 1.0);
    let at = |index: usize| MATCHING_FUNCTIONS[index.min(last)];
    let rows = [at(row.saturating_sub(1)), at(row), at(row + 1), at(row + 2)];
    Some([0, 1, 2].map(|k| catmull_rom(rows.map(|values| values[k]), fraction).max(0.0)))
}

/// Returns the colour of monochromatic light of a wavelength in metres: linear sRGB, components in
/// [0, 1], the largest exactly 1.
///
/// No screen shows spectral colours. Negative components are cut to zero, which keeps the hue as
/// close as the screen allows. Light outside 380–780 nm is invisible, but a preview has to show
/// something: it becomes a neutral grey of full brightness.
pub fn rgb_of_wavelength(wavelength: f64) -> [f64; 3] {
    let Some(xyz) = xyz_of_wavelength(wavelength) else {
        return [1.0; 3];
    };
    let rgb = linear_srgb(xyz).map(|component| component.max(0.0));
    let largest = rgb.iter().copied().fold(0.0, f64::max);
    if largest > 0.0 {
        rgb.map(|component| component / largest)
    } else {
        [1.0; 3]
    }
}

/// Returns linear sRGB of CIE XYZ with Y = 1 for white (IEC 61966-2-1:1999, D65).
fn linear_srgb([x, y, z]: [f64; 3]) -> [f64; 3] {
    [
        3.240_625_5 * x - 1.537_208 * y - 0.498_628_6 * z,
        -0.968_930_7 * x + 1.875_756_1 * y + 0.041_517_5 * z,
        0.055_710_1 * x - 0.204_021_1 * y + 1.056_995_9 * z,
    ]
}

/// Returns the sRGB value of a linear component in [0, 1] (IEC 61966-2-1:1999).
pub fn srgb_encoded(linear: f64) -> f64 {
    if linear <= 0.003_130_8 {
        12.92 * linear
    } else {
        1.055 * linear.powf(1.0 / 2.4) - 0.055
    }
}

/// Returns the linear component of an sRGB value in [0, 1] (IEC 61966-2-1:1999).
pub fn srgb_decoded(encoded: f64) -> f64 {
    if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    }
}

/// Returns the cubic through `b` and `c` whose slopes equal the slopes of the neighbours' chords.
fn catmull_rom([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}

/// x̄, ȳ, z̄ of the CIE 1931 2° standard observer from 380 nm to 780 nm in steps of 5 nm (CIE
/// 015:2018, rounded to six digits).
const MATCHING_FUNCTIONS: [[f64; 3]; 81] = include!("colour/matching_functions.in");

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;

    use super::*;

    /// The interpolation error stated in the documentation.
    const INTERPOLATION: f64 = 0.0024;

    #[test]
    fn helium_neon_red_has_the_tabulated_xyz() {
        // The 1 nm table of CIE 015:2018 at 633 nm, which lies between two of our rows.
        let xyz = xyz_of_wavelength(633e-9).expect("633 nm is visible");
        for (got, expected) in xyz.iter().zip([0.581_105, 0.235_334, 3.57e-5]) {
            assert_abs_diff_eq!(*got, expected, epsilon = INTERPOLATION);
        }
    }

    #[test]
    fn the_table_is_met_at_both_ends_and_in_the_middle() {
        let near = |wavelength: f64, expected: [f64; 3]| {
            let xyz = xyz_of_wavelength(wavelength).expect("the wavelength is visible");
            for (got, expected) in xyz.iter().zip(expected) {
                // The slope of the functions is below 0.06 per nm and the rounding below 1e-9 nm.
                assert_abs_diff_eq!(*got, expected, epsilon = 1e-10);
            }
        };
        near(380e-9, [0.001_368, 0.000_039, 0.006_45]);
        near(555e-9, [0.512_05, 1.0, 0.005_75]);
        near(780e-9, [0.000_041_509_9, 0.000_014_99, 0.0]);
    }

    #[test]
    fn an_equal_energy_spectrum_is_equally_bright_in_all_three_functions() {
        // The functions were normalised to the same area: 106.86 nm (CIE 015:2018, 1 nm sums
        // 106.865, 106.857, 106.892). The 5 nm sums of the table agree to four digits.
        for k in 0..3 {
            let area: f64 = STEP * MATCHING_FUNCTIONS.iter().map(|row| row[k]).sum::<f64>();
            assert_abs_diff_eq!(area, 106.87, epsilon = 0.03);
        }
    }

    #[test]
    fn white_is_white() {
        // The white of IEC 61966-2-1 is the row sums of its matrix sRGB → XYZ with four digits; the
        // inverse is given with seven.
        for component in linear_srgb([0.9505, 1.0, 1.089]) {
            assert_abs_diff_eq!(component, 1.0, epsilon = 1e-6);
        }
    }

    #[test]
    fn lasers_have_the_colours_one_sees() {
        // Red, green and blue of which none is larger.
        for (wavelength, limits) in [
            (650e-9, [1.0, 0.01, 0.05]),
            (546.1e-9, [0.6, 1.0, 0.01]),
            (450e-9, [0.3, 0.05, 1.0]),
        ] {
            let rgb = rgb_of_wavelength(wavelength);
            let within = rgb.iter().zip(limits).all(|(value, limit)| *value <= limit);
            assert!(within, "{wavelength}: {rgb:?}");
        }
        // Invisible light is shown grey.
        for wavelength in [355e-9, 850e-9, 1064e-9] {
            assert_abs_diff_eq!(rgb_of_wavelength(wavelength)[..], [1.0; 3][..]);
        }
        for tenth in 2_000..20_000_u32 {
            let rgb = rgb_of_wavelength(f64::from(tenth) * 1e-10);
            let largest = rgb.iter().copied().fold(0.0, f64::max);
            assert_abs_diff_eq!(largest, 1.0, epsilon = 1e-12);
            let are_in_range = rgb.iter().all(|c| (0.0..=1.0).contains(c));
            assert!(are_in_range, "{tenth} Å: {rgb:?}");
        }
    }

    #[test]
    fn the_transfer_curve_inverts() {
        // 0.5 ↔ 0.735357 and 0.002 ↔ 0.02584 by hand from IEC 61966-2-1.
        assert_abs_diff_eq!(srgb_encoded(0.5), 0.735_357, epsilon = 1e-6);
        assert_abs_diff_eq!(srgb_encoded(0.002), 0.025_84, epsilon = 1e-9);
        for percent in 0..=100_u8 {
            let linear = f64::from(percent) / 100.0;
            assert_abs_diff_eq!(srgb_decoded(srgb_encoded(linear)), linear, epsilon = 1e-7);
        }
    }
}
