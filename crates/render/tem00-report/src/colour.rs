//! The colour of laser light on a screen: wavelength → CIE 1931 XYZ → linear sRGB.

/// The wavelength of the table's first row, in nanometres.
const FIRST: f64 = 380.0;
/// The distance between the table's rows, in nanometres.
const STEP: f64 = 5.0;

/// Returns the CIE 1931 2° colour-matching functions x̄, ȳ, z̄ at a wavelength in metres, and `None`
/// outside the visible 380–780 nm.
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

/// Returns the cubic through `b` and `c` whose slopes are those of the neighbours' chords.
fn catmull_rom([a, b, c, d]: [f64; 4], t: f64) -> f64 {
    b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)))
}

/// x̄, ȳ, z̄ of the CIE 1931 2° standard observer from 380 nm to 780 nm in steps of 5 nm (CIE 015:2018,
/// rounded to six digits).
#[rustfmt::skip]
const MATCHING_FUNCTIONS: [[f64; 3]; 81] = [
    [0.001368, 0.000039, 0.00645],
    [0.002236, 0.000064, 0.01055],
    [0.004243, 0.00012, 0.02005],
    [0.00765, 0.000217, 0.03621],
    [0.01431, 0.000396, 0.06785],
    [0.02319, 0.00064, 0.1102],
    [0.04351, 0.00121, 0.2074],
    [0.07763, 0.00218, 0.3713],
    [0.13438, 0.004, 0.6456],
    [0.21477, 0.0073, 1.03905],
    [0.2839, 0.0116, 1.3856],
    [0.3285, 0.01684, 1.62296],
    [0.34828, 0.023, 1.74706],
    [0.34806, 0.0298, 1.7826],
    [0.3362, 0.038, 1.77211],
    [0.3187, 0.048, 1.7441],
    [0.2908, 0.06, 1.6692],
    [0.2511, 0.0739, 1.5281],
    [0.19536, 0.09098, 1.28764],
    [0.1421, 0.1126, 1.0419],
    [0.09564, 0.13902, 0.81295],
    [0.05795, 0.1693, 0.6162],
    [0.03201, 0.20802, 0.46518],
    [0.0147, 0.2586, 0.3533],
    [0.0049, 0.323, 0.272],
    [0.0024, 0.4073, 0.2123],
    [0.0093, 0.503, 0.1582],
    [0.0291, 0.6082, 0.1117],
    [0.06327, 0.71, 0.07825],
    [0.1096, 0.7932, 0.05725],
    [0.1655, 0.862, 0.04216],
    [0.22575, 0.91485, 0.02984],
    [0.2904, 0.954, 0.0203],
    [0.3597, 0.9803, 0.0134],
    [0.43345, 0.99495, 0.00875],
    [0.51205, 1.0, 0.00575],
    [0.5945, 0.995, 0.0039],
    [0.6784, 0.9786, 0.00275],
    [0.7621, 0.952, 0.0021],
    [0.8425, 0.9154, 0.0018],
    [0.9163, 0.87, 0.00165],
    [0.9786, 0.8163, 0.0014],
    [1.0263, 0.757, 0.0011],
    [1.0567, 0.6949, 0.001],
    [1.0622, 0.631, 0.0008],
    [1.0456, 0.5668, 0.0006],
    [1.0026, 0.503, 0.00034],
    [0.9384, 0.4412, 0.00024],
    [0.85445, 0.381, 0.00019],
    [0.7514, 0.321, 0.0001],
    [0.6424, 0.265, 0.00005],
    [0.5419, 0.217, 0.00003],
    [0.4479, 0.175, 0.00002],
    [0.3608, 0.1382, 0.00001],
    [0.2835, 0.107, 0.0],
    [0.2187, 0.0816, 0.0],
    [0.1649, 0.061, 0.0],
    [0.1212, 0.04458, 0.0],
    [0.0874, 0.032, 0.0],
    [0.0636, 0.0232, 0.0],
    [0.04677, 0.017, 0.0],
    [0.0329, 0.01192, 0.0],
    [0.0227, 0.00821, 0.0],
    [0.01584, 0.005723, 0.0],
    [0.0113592, 0.004102, 0.0],
    [0.00811092, 0.002929, 0.0],
    [0.00579035, 0.002091, 0.0],
    [0.00410946, 0.001484, 0.0],
    [0.00289933, 0.001047, 0.0],
    [0.00204919, 0.00074, 0.0],
    [0.00143997, 0.00052, 0.0],
    [0.000999949, 0.0003611, 0.0],
    [0.000690079, 0.0002492, 0.0],
    [0.000476021, 0.0001719, 0.0],
    [0.000332301, 0.00012, 0.0],
    [0.000234826, 0.0000848, 0.0],
    [0.000166151, 0.00006, 0.0],
    [0.000117413, 0.0000424, 0.0],
    [0.0000830753, 0.00003, 0.0],
    [0.0000587065, 0.0000212, 0.0],
    [0.0000415099, 0.00001499, 0.0],
];

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
        let [r, g, b] = rgb_of_wavelength(650e-9);
        assert!(
            r > 0.99 && g < 0.01 && b < 0.05,
            "650 nm is red: {r} {g} {b}"
        );
        let [r, g, b] = rgb_of_wavelength(546.1e-9);
        assert!(
            g > 0.99 && r < 0.6 && b < 0.01,
            "546.1 nm is green: {r} {g} {b}"
        );
        let [r, g, b] = rgb_of_wavelength(450e-9);
        assert!(
            b > 0.99 && r < 0.3 && g < 0.05,
            "450 nm is blue: {r} {g} {b}"
        );
    }

    #[test]
    fn every_colour_is_in_range_with_largest_component_one() {
        for tenth in 2_000..20_000_u32 {
            let rgb = rgb_of_wavelength(f64::from(tenth) * 1e-10);
            let largest = rgb.iter().copied().fold(0.0, f64::max);
            assert_abs_diff_eq!(largest, 1.0, epsilon = 1e-12);
            assert!(
                rgb.iter().all(|c| (0.0..=1.0).contains(c)),
                "{tenth} Å: {rgb:?}"
            );
        }
    }

    #[test]
    fn invisible_light_is_shown_grey() {
        for wavelength in [355e-9, 850e-9, 1064e-9] {
            assert_abs_diff_eq!(rgb_of_wavelength(wavelength)[..], [1.0; 3][..]);
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
