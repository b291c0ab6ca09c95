//! The correlation at the peak as a polynomial, for many points at once.

use tem00_numerics::{disc_overlap_inverse, vectorised};

use super::pupil_overlap_correlation;

/// Coefficients along each axis.
const TERMS: usize = 12;

/// Axial shifts below this one reduce the correlation by at most β²/4 = π² x² = 1e-13.
const NO_AXIAL_SHIFT: f64 = 1e-7;

/// Coefficients of the factor by which an axial displacement reduces the correlation at the peak,
/// in addition to a displacement of the pupil: a polynomial in 2 s − 1, row by row, and 2 x² − 1.
///
/// ```text
/// γ(s, x) / γ(s, 0)       s from 0 to 1 pupil diameter, x from 0 to 1 decorrelation length
/// ```
///
/// The factor is analytic in s and x², so that the polynomial through 12 × 12 Chebyshev points
/// reproduces the integral of [`CorrelationLaw::AtPeak`](crate::CorrelationLaw::AtPeak) within
/// 1e−5. Its arithmetic runs on several points at a time in vector units.
#[rustfmt::skip]
const COEFFICIENTS: [[f64; TERMS]; TERMS] = [
    [
        6.206875851723219e-1, -2.9197398443603934e-1, 7.443244478263564e-2, -1.1615262580285076e-2,
        1.1986735977735918e-3, -8.721171703873765e-5, 4.652432217255864e-6, -1.8084843548630639e-7,
        4.443604003275444e-9, 1.683986283751437e-12, -7.607544224204807e-12, 1.0610771520684163e-12,
    ],
    [
        4.567570092342492e-1, 2.530206832623729e-1, -1.5780587938405738e-1, 3.96615301641107e-2,
        -5.699021683012923e-3, 5.329979686367351e-4, -3.5115351518575734e-5, 1.7154498372501381e-6,
        -6.408322906585144e-8, 1.847442268609889e-9, -3.9642363465948925e-11, 3.9729330936211227e-13,
    ],
    [
        -4.306308783791253e-3, 9.220519307825853e-2, 4.9584768446347384e-2, -3.6625819187775646e-2,
        8.987713117641962e-3, -1.199039008877576e-3, 1.0646347271486977e-4, -7.251900222303894e-6,
        4.231971153327111e-7, -2.240901335788988e-8, 1.0776784418557266e-9, -4.4639976900147836e-11,
    ],
    [
        8.190143778575348e-2, 6.935035204939081e-2, -7.263426357355673e-3, 4.8303830333727514e-4,
        -3.6231523667750692e-3, 1.0309228889988256e-3, -1.379898997762899e-4, 1.1780252310159462e-5,
        -7.372261964742425e-7, 3.6818267748252774e-8, -1.5602004942623833e-9, 6.302162032974697e-11,
    ],
    [
        -4.773219924753497e-2, 7.644034362153404e-2, 1.1278658437008257e-1, -1.2657904372230109e-2,
        -1.23273376951642e-3, 4.236970175726276e-5, 7.5849960915839315e-6, 3.4273758527855283e-6,
        -8.922631932380595e-7, 1.0016002391250815e-7, -7.229176174350371e-9, 3.696083578086373e-10,
    ],
    [
        -1.1265661631033648e-1, -1.7936452561909624e-1, -2.1069007672249285e-2, 4.15941647149488e-2,
        -4.336374546469482e-3, -2.0374252626620157e-4, 7.648975641871543e-5, -1.0229312139275247e-5,
        1.078219927456442e-6, -9.138637966259074e-8, 6.07787481577612e-9, -3.453884049424427e-10,
    ],
    [
        -6.998765014866857e-3, -4.885757673832217e-2, -6.773683996580478e-2, -1.7949398288899618e-2,
        7.042896917614643e-3, -6.806572040728829e-4, 1.5843061790402573e-4, -4.035014890779579e-5,
        5.740067875579118e-6, -5.197554638803858e-7, 3.36182172976172e-8, -1.6227714652544054e-9,
    ],
    [
        2.883895607130017e-3, 1.3690206282491672e-2, 1.2811238986547326e-2, -2.4596327698325022e-3,
        -3.336281638521503e-3, 9.069229887335123e-4, -1.826174687993796e-4, 3.382689815695541e-5,
        -4.475223997190861e-6, 4.0824410223333144e-7, -2.7182150069713256e-8, 1.435648668414273e-9,
    ],
    [
        1.6133437062891573e-3, -5.784076748613101e-3, -1.1450148538185276e-2, 7.999503392677308e-4,
        4.401382628425506e-3, -7.291617992887256e-4, -1.9737160564676487e-4, 6.977919480213372e-5,
        -9.800778975799158e-6, 8.579483412011182e-7, -5.3919810573676034e-8, 2.5568278738985427e-9,
    ],
    [
        8.089287392796496e-3, 1.9696838882662472e-2, 1.0425356259038815e-2, -5.426221861244048e-3,
        -3.590947002797942e-3, 7.941475644527709e-4, 8.68619648165049e-5, -4.625799812246336e-5,
        7.227138970355095e-6, -6.741868403164804e-7, 4.439356014017635e-8, -2.253806082973688e-9,
    ],
    [
        8.857634753618223e-4, 5.3443720840846394e-3, 8.84807385420758e-3, 3.885866611139529e-3,
        -1.3873801948942543e-3, -5.234593520967183e-4, 2.947244048372131e-4, -5.8272646924549954e-5,
        6.755249132973466e-6, -5.366403484929075e-7, 3.1810861311554565e-8, -1.4560196796817445e-9,
    ],
    [
        -1.1242025048227126e-3, -3.767049325126088e-3, -3.5620737502252606e-3, 3.1054034565119906e-4,
        1.5755540597226577e-3, 1.1589093156397916e-4, -1.8214591962296476e-4, 4.202227121676335e-5,
        -5.259865513405946e-6, 4.3945338459456485e-7, -2.7045844778931266e-8, 1.2967942891545047e-9,
    ],
];

/// Replaces the first `count` shifts across the pupil, in pupil diameters, by equivalent shifts:
/// alone, each leaves the correlation that the original shift leaves together with a shift along
/// the axis, in axial decorrelation lengths.
///
/// ```text
/// chat²(s') = γ(s, x)       the law at the peak, CorrelationLaw::AtPeak
/// ```
///
/// Shifts beyond one diameter keep growing, so that two later states can be distinguished. They are
/// exact for motion across the line of sight. For motion along it, beyond the first zero of the
/// correlation, they are in units of this zero and omit the revival of 4.7 % beyond it. Infinite
/// shifts across the pupil stay infinite. The shifts up to the next multiple of 8 may be replaced
/// as well.
///
/// # Examples
///
/// A quarter of the pupil and half a decorrelation length:
///
/// ```
/// use tem00_decorrelation::{CorrelationLaw, add_axial_shifts, pupil_overlap_correlation};
///
/// let mut shift = [0.25];
/// add_axial_shifts(1, &mut shift, &[0.5]);
/// let left = pupil_overlap_correlation(shift[0]);
/// assert!((left - CorrelationLaw::AtPeak.correlation(0.25, 0.5)).abs() < 1e-5);
/// ```
#[inline(always)] // The arrays are read and written in place.
pub fn add_axial_shifts<const N: usize>(
    count: usize,
    pupil_shifts: &mut [f64; N],
    axial_shifts: &[f64; N],
) {
    let count = count.min(N);
    let is_lateral = |axial: &f64| axial.abs() < NO_AXIAL_SHIFT;
    if axial_shifts[..count].iter().all(is_lateral) {
        return;
    }
    // Whole vectors are faster than a partial one.
    let count = count.next_multiple_of(8).min(N);
    let mut kept = [0.0; N];
    vectorised(
        #[inline(always)]
        || {
            write_factors(count, [pupil_shifts, axial_shifts], &mut kept);
            let axial = axial_shifts.iter().zip(&kept);
            for (pupil, (axial, kept)) in pupil_shifts[..count].iter_mut().zip(axial) {
                *pupil = equivalent_shift(*pupil, axial.abs(), *kept);
            }
        },
    );
}

/// The shift whose overlap leaves the same correlation as a shift across the pupil and a shift
/// along the axis; the axial shift multiplies the correlation by `kept`.
#[inline(always)]
fn equivalent_shift(lateral: f64, axial: f64, kept: f64) -> f64 {
    let equivalent = disc_overlap_inverse((pupil_overlap_correlation(lateral) * kept).sqrt());
    let beyond_the_zero = if axial >= 1.0 { axial } else { 0.0 };
    let both = equivalent.max(lateral).max(beyond_the_zero);
    if axial < NO_AXIAL_SHIFT {
        lateral
    } else {
        both
    }
}

/// Writes the factors for the first `count` shifts across the pupil and along the axis, each
/// clamped to 1.
#[inline(always)]
fn write_factors<const N: usize>(
    count: usize,
    [pupil_shifts, axial_shifts]: [&[f64; N]; 2],
    factors: &mut [f64; N],
) {
    let count = count.min(N);
    let s = pupil_shifts.map(|shift| 2.0 * shift.min(1.0) - 1.0);
    let y = axial_shifts.map(|shift| 2.0 * (shift * shift).min(1.0) - 1.0);
    factors.fill(0.0);
    // Horner's rule, step by step for all points.
    for row in COEFFICIENTS.iter().rev() {
        let mut sums = [0.0; N];
        for coefficient in row.iter().rev() {
            for i in 0..count {
                sums[i] = sums[i] * y[i] + coefficient;
            }
        }
        for i in 0..count {
            factors[i] = factors[i] * s[i] + sums[i];
        }
    }
    for factor in factors {
        *factor = factor.clamp(0.0, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_absolute;

    use super::*;
    use crate::CorrelationLaw;

    #[test]
    fn the_polynomial_meets_the_integral() {
        let (mut worst, mut factor) = (0.0_f64, [0.0]);
        for (i, j) in (0..=200).flat_map(|i| (0..=200).map(move |j| (i, j))) {
            let (shift, axial) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
            let exact = CorrelationLaw::AtPeak.correlation(shift, axial);
            write_factors(1, [&[shift], &[axial]], &mut factor);
            let found = pupil_overlap_correlation(shift) * factor[0];
            worst = worst.max((found - exact).abs());
        }
        assert!(worst < 1e-5, "off by {worst:e}");
    }

    #[test]
    fn shifts_along_the_axis_add_what_they_take_of_the_correlation() {
        let shift = |lateral, axial| {
            let mut shift = [lateral];
            add_axial_shifts(1, &mut shift, &[axial]);
            shift[0]
        };
        for lateral in [0.0, 1e-3, 0.25, 0.7, 0.98, 1.0, 3.0] {
            for axial in [0.0, 0.99e-7, 1.01e-7, 1e-5, 1e-3, 0.3, 0.9] {
                let shift = shift(lateral, axial);
                let correlation = CorrelationLaw::AtPeak.correlation(lateral, axial);
                let error = pupil_overlap_correlation(shift) - correlation;
                assert!(
                    error.abs() < 1e-5 && shift >= lateral,
                    "{lateral} across, {axial:e} along: {error:e}"
                );
            }
            assert_absolute(shift(lateral, 1.5), lateral.max(1.5), 1e-15);
        }
        assert!(
            shift(f64::INFINITY, 0.5).is_infinite(),
            "new speckle stays new"
        );
    }
}
