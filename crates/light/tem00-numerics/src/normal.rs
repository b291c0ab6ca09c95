/// Returns the quantile of the standard normal distribution, below which a variate lies with the
/// probability `p` in (0, 1), to 16 digits.
///
/// # References
///
/// - M. J. Wichura, *Algorithm AS 241, PPND16*, Applied Statistics 37, 1988: the coefficients.
///
/// # Examples
///
/// ```
/// let quantile = tem00_numerics::normal_quantile(0.975);
/// assert!((quantile - 1.959_963_984_540_054).abs() < 1e-15);
/// ```
pub fn normal_quantile(p: f64) -> f64 {
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.425 * 0.425 - q * q;
        return q * polynomial(&CENTRE.0, r) / polynomial(&CENTRE.1, r);
    }
    let r = (-p.min(1.0 - p).ln()).sqrt();
    let (coefficients, r) = if r <= 5.0 {
        (&MIDDLE, r - 1.6)
    } else {
        (&TAIL, r - 5.0)
    };
    let magnitude = polynomial(&coefficients.0, r) / polynomial(&coefficients.1, r);
    magnitude.copysign(q)
}

/// Evaluates a polynomial with ascending coefficients by Estrin's scheme: in pairs, which are
/// independent of each other.
fn polynomial(c: &[f64; 8], x: f64) -> f64 {
    let (x2, x4) = (x * x, x * x * (x * x));
    let low = (c[0] + c[1] * x) + (c[2] + c[3] * x) * x2;
    let high = (c[4] + c[5] * x) + (c[6] + c[7] * x) * x2;
    low + high * x4
}

type Rational = ([f64; 8], [f64; 8]);

#[expect(clippy::excessive_precision, reason = "as published")]
const CENTRE: Rational = (
    [
        3.387_132_872_796_366_608,
        1.331_416_678_917_843_774_5e2,
        1.971_590_950_306_551_442_7e3,
        1.373_169_376_550_946_112_5e4,
        4.592_195_393_154_987_145_7e4,
        6.726_577_092_700_870_085_3e4,
        3.343_057_558_358_812_810_5e4,
        2.509_080_928_730_122_672_7e3,
    ],
    [
        1.0,
        4.231_333_070_160_091_125_2e1,
        6.871_870_074_920_579_083e2,
        5.394_196_021_424_751_107_7e3,
        2.121_379_430_158_659_586_7e4,
        3.930_789_580_009_271_061e4,
        2.872_908_573_572_194_267_4e4,
        5.226_495_278_852_854_561e3,
    ],
);

#[expect(clippy::excessive_precision, reason = "as published")]
const MIDDLE: Rational = (
    [
        1.423_437_110_749_683_577_34,
        4.630_337_846_156_545_295_9,
        5.769_497_221_460_691_405_5,
        3.647_848_324_763_204_605_04,
        1.270_458_252_452_368_382_58,
        2.417_807_251_774_506_117_7e-1,
        2.272_384_498_926_918_458_33e-2,
        7.745_450_142_783_414_076_4e-4,
    ],
    [
        1.0,
        2.053_191_626_637_758_821_87,
        1.676_384_830_183_803_849_4,
        6.897_673_349_851_000_045_5e-1,
        1.481_039_764_274_800_745_9e-1,
        1.519_866_656_361_645_719_66e-2,
        5.475_938_084_995_344_946e-4,
        1.050_750_071_644_416_843_24e-9,
    ],
);

#[expect(clippy::excessive_precision, reason = "as published")]
const TAIL: Rational = (
    [
        6.657_904_643_501_103_777_2,
        5.463_784_911_164_114_369_9,
        1.784_826_539_917_291_335_8,
        2.965_605_718_285_048_912_3e-1,
        2.653_218_952_657_612_309_3e-2,
        1.242_660_947_388_078_438_6e-3,
        2.711_555_568_743_487_578_15e-5,
        2.010_334_399_292_288_132_65e-7,
    ],
    [
        1.0,
        5.998_322_065_558_879_376_9e-1,
        1.369_298_809_227_358_053_1e-1,
        1.487_536_129_085_061_485_25e-2,
        7.868_691_311_456_132_591e-4,
        1.846_318_317_510_054_681_8e-5,
        1.421_511_758_316_445_888_7e-7,
        2.044_263_103_389_939_785_64e-15,
    ],
);

#[cfg(test)]
mod tests {
    use core::f64::consts::SQRT_2;

    use tem00_testkit::assert_relative;

    use super::*;

    /// The distribution function, from the error function of another author (libm).
    fn cumulative(x: f64) -> f64 {
        0.5 * libm::erfc(-x / SQRT_2)
    }

    #[test]
    fn quantile_inverts_the_distribution_function() {
        let probabilities = [
            1e-300, 1e-60, 1e-16, 1e-11, 1e-9, 1e-3, 0.02, 0.07, 0.08, 0.3, 0.5, 0.7, 0.93,
        ];
        for p in probabilities {
            let x = normal_quantile(p);
            // A relative error η of x changes ln Φ by about x² η: 16 digits of x allow this.
            let tolerance = 4e-16 * (1.0 + x * x);
            assert_relative(cumulative(x), p, 4.0 * tolerance);
        }
    }

    #[test]
    fn quantile_is_odd_about_one_half() {
        for p in [0.25, 0.0625, 2_f64.powi(-20)] {
            let sum = normal_quantile(p) + normal_quantile(1.0 - p);
            assert!(sum.abs() < 1e-12, "p = {p}: {sum:e}");
        }
    }
}
