/// The relative accuracy at which the quadrature stops.
const RELATIVE_ERROR: f64 = 1e-13;

/// The most panels into which the quadrature divides its range.
const MAX_PANELS: usize = 1_000;

/// Abscissae in [0, 1) of the 15-point Kronrod rule, outermost first; every second one is a node of
/// the 7-point Gauss rule (R. Piessens et al., *QUADPACK*, 1983, routine QK15).
#[expect(clippy::excessive_precision, reason = "as published")]
const NODES: [f64; 8] = [
    0.991_455_371_120_812_639_206_854_697_526_329,
    0.949_107_912_342_758_524_526_189_684_047_851,
    0.864_864_423_359_769_072_789_712_788_640_926,
    0.741_531_185_599_394_439_863_864_773_280_788,
    0.586_087_235_467_691_130_294_144_691_693_013,
    0.405_845_151_377_397_166_906_606_412_076_961,
    0.207_784_955_007_898_467_600_689_403_773_245,
    0.0,
];

/// Weights of the Kronrod rule at [`NODES`], from the same source.
#[expect(clippy::excessive_precision, reason = "as published")]
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224_963_732_008_058_970,
    0.063_092_092_629_978_553_290_700_663_189_204,
    0.104_790_010_322_250_183_839_876_322_541_518,
    0.140_653_259_715_525_918_745_189_590_510_238,
    0.169_004_726_639_267_902_826_583_426_598_550,
    0.190_350_578_064_785_409_913_256_402_421_014,
    0.204_432_940_075_298_892_414_161_999_234_649,
    0.209_482_141_084_727_828_012_999_174_891_714,
];

/// Weights of the Gauss rule at [`NODES`], from the same source; 0 where it has no node.
#[expect(clippy::excessive_precision, reason = "as published")]
const GAUSS: [f64; 8] = [
    0.0,
    0.129_484_966_168_869_693_270_611_432_679_082,
    0.0,
    0.279_705_391_489_276_667_901_467_771_423_780,
    0.0,
    0.381_830_050_505_118_944_950_369_775_488_975,
    0.0,
    0.417_959_183_673_469_387_755_102_040_816_327,
];

/// The integral over one part of the range.
#[derive(Clone, Copy)]
struct Panel {
    start: f64,
    end: f64,
    value: f64,
    error: f64,
}

impl Panel {
    fn new(f: &impl Fn(f64) -> f64, start: f64, end: f64) -> Self {
        let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
        let (mut kronrod, mut gauss) = (0.0, 0.0);
        for (i, node) in NODES.into_iter().enumerate() {
            let pair = if i == 7 {
                f(middle)
            } else {
                f(middle - half * node) + f(middle + half * node)
            };
            kronrod += KRONROD[i] * pair;
            gauss += GAUSS[i] * pair;
        }
        Self {
            start,
            end,
            value: half * kronrod,
            error: (half * (kronrod - gauss)).abs(),
        }
    }
}

/// Integrates `f`, which is never negative, from the first to the last of the ascending `breaks`.
///
/// The difference of the Gauss and the Kronrod rule bounds the error of each panel with a wide
/// margin; the worst panel is halved until the sum of the bounds is 1e−13 of the integral, or there
/// are 1000 panels. The breaks must resolve the features of `f` so far that each shows at some node.
///
/// # Examples
///
/// ```
/// use tem00_numerics::quadrature::integrate_adaptively;
///
/// let area = integrate_adaptively(f64::sqrt, &[0.0, 1.0]);
/// assert!((area - 2.0 / 3.0).abs() < 1e-13);
/// ```
pub fn integrate_adaptively(f: impl Fn(f64) -> f64, breaks: &[f64]) -> f64 {
    let mut panels: Vec<_> = breaks
        .windows(2)
        .map(|ends| Panel::new(&f, ends[0], ends[1]))
        .collect();
    loop {
        let value: f64 = panels.iter().map(|panel| panel.value).sum();
        let error: f64 = panels.iter().map(|panel| panel.error).sum();
        let worst = (0..panels.len()).max_by(|&i, &j| panels[i].error.total_cmp(&panels[j].error));
        match worst {
            Some(worst) if error > RELATIVE_ERROR * value && panels.len() < MAX_PANELS => {
                let Panel { start, end, .. } = panels[worst];
                let middle = 0.5 * (start + end);
                panels[worst] = Panel::new(&f, start, middle);
                panels.push(Panel::new(&f, middle, end));
            }
            _ => return value,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_rules_integrate_polynomials_up_to_their_degree() {
        for degree in 0..=23 {
            let panel = Panel::new(&|x: f64| x.powi(degree), 0.0, 1.0);
            let exact = 1.0 / f64::from(degree + 1);
            // A sum of 15 terms of at most 1.
            let error = panel.value - exact;
            assert!(error.abs() < 1e-15, "degree {degree}: {error:e}");
            assert!(
                (panel.error < 1e-15) == (degree <= 13),
                "degree {degree}: Gauss differs by {:e}",
                panel.error
            );
        }
    }

    #[test]
    fn a_singular_end_is_resolved() {
        let value = integrate_adaptively(|x| x.sqrt(), &[0.0, 1.0]);
        assert!((1.5 * value - 1.0).abs() < 1e-13, "{value}");
    }

    #[test]
    fn an_empty_range_holds_nothing() {
        for breaks in [&[][..], &[1.0], &[1.0, 1.0]] {
            let value = integrate_adaptively(|x| 1.0 / x, breaks);
            assert!(value.abs() < f64::MIN_POSITIVE, "{breaks:?}: {value}");
        }
    }
}
