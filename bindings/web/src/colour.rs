//! The colour of light of one wavelength on a screen.

use tem00_numerics::cast::to_f32;

/// Linear sRGB of the wavelength in nanometres, its largest channel 1; dim red beyond what the eye
/// sees.
///
/// The colour matching functions are the sums of Gaussian lobes of Wyman, Sloan and Shirley 2013
/// ("Simple Analytic Approximations to the CIE XYZ Color Matching Functions", multi-lobe fit). What
/// sRGB cannot show is cut off.
pub(crate) fn of_wavelength(nanometres: f64) -> [f32; 3] {
    let lobe = |height: f64, middle: f64, below: f64, above: f64| {
        let rate = if nanometres < middle { below } else { above };
        height * (-0.5 * ((nanometres - middle) * rate).powi(2)).exp()
    };
    let x = lobe(0.362, 442.0, 0.0624, 0.0374)
        + lobe(1.056, 599.8, 0.0264, 0.0323)
        + lobe(-0.065, 501.1, 0.0490, 0.0382);
    let y = lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322);
    let z = lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725);
    // From XYZ to linear sRGB (IEC 61966-2-1).
    let rgb = [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ];
    let largest = rgb.iter().fold(0.0_f64, |a, &b| a.max(b));
    if largest < 1e-3 {
        return [0.5, 0.05, 0.05];
    }
    rgb.map(|c| to_f32((c / largest).max(0.0)))
}
