//! Displacement of the speckle on the pupil.

use core::fmt::Write as _;

use crate::geometries::{Case, cases};

/// The length of the difference between the measured displacement and that of the formula, in units
/// of the latter, and in speckles the latter itself.
fn judged(case: &Case) -> [f64; 2] {
    let theory = case.scene.point().pupil_displacement(&case.motion);
    let theory = theory.expect("no grazing view");
    let measured = case.scene.measured(&case.motion.into(), case.seeds);
    let measured = measured.expect("a maximum of the cross-correlation");
    eprintln!("{} {:?} {:?}", case.name, theory, measured);
    let error = (measured - theory).length() / theory.length();
    [error, theory.length() / case.scene.pupil_speckle()]
}

#[test]
fn speckle_moves_across_the_pupil_as_the_formula_says() {
    let cases = cases();
    assert!(cases.len() >= 24, "{} geometries", cases.len());
    let mut report = String::new();
    let mut errors = Vec::new();
    for case in &cases {
        let [error, speckles] = judged(case);
        let (name, percent) = (case.name, 100.0 * error);
        let line = writeln!(report, "{percent:7.3} % of {speckles:5.2} speckles: {name}");
        assert!(line.is_ok(), "strings take all");
        errors.push(error);
    }
    errors.sort_by(f64::total_cmp);
    let (median, worst) = (errors[errors.len() / 2], errors[errors.len() - 1]);
    eprintln!("{report}\nmedian {median} worst {worst}");
    assert!(median < 5e-3, "median {median:.4}:\n{report}");
    assert!(worst < 3e-2, "worst {worst:.4}:\n{report}");
}
