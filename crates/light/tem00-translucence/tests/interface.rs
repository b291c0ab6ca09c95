//! Refusals; `tests/judges` holds the physics against other sources.

use tem00_translucence::{LineSpread, Medium, Refusal, Walk};

/// Marble in red light.
fn marble() -> Result<Medium, Refusal> {
    Medium::new(1.5, 2.19e3, 2.1)
}

#[test]
fn what_is_out_of_range_is_named() {
    let medium = marble().expect("a medium");
    let walk = |incidence, exit, photons| {
        let walk = Walk {
            incidence,
            exits: vec![exit],
            photons,
            seed: 0,
        };
        LineSpread::simulate(&medium, &walk)
            .expect_err("out of range")
            .to_string()
    };
    let said = [
        walk(1.6, 0.0, 100),
        walk(0.0, f64::NAN, 100),
        walk(0.0, 0.0, 63),
    ];
    for (said, name) in said.iter().zip(["incidence", "exits", "photons"]) {
        assert!(said.contains(name), "{said}");
    }
    let wrong = [
        Medium::new(0.9, 1e3, 1.0),
        Medium::new(1.5, 0.0, 1.0),
        Medium::new(1.5, 1e3, 0.0),
        medium.with_anisotropy(1.0),
        medium.with_matt_boundary(0.6),
    ];
    for (refused, name) in wrong.iter().zip([
        "refractive_index",
        "reduced_scattering",
        "absorption",
        "anisotropy",
        "slope",
    ]) {
        let refusal = refused.as_ref().expect_err(name);
        assert_eq!(refusal.parameter, name);
    }
}
