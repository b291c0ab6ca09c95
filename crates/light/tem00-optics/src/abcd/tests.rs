use core::f64::consts::FRAC_PI_2;

use proptest::prelude::*;
use tem00_testkit::assert_absolute;

use super::elements::ThickLens;
use super::*;

pub(in crate::abcd) fn space(length: f64) -> AbcdMatrix {
    AbcdMatrix::free_space(length).unwrap()
}

pub(in crate::abcd) fn lens(focal_length: f64) -> AbcdMatrix {
    AbcdMatrix::thin_lens(focal_length).unwrap()
}

pub(in crate::abcd) fn mirror(curvature: f64) -> AbcdMatrix {
    AbcdMatrix::curved_mirror(curvature).unwrap()
}

fn entries(m: &AbcdMatrix) -> [f64; 4] {
    [m.a(), m.b(), m.c(), m.d()]
}

/// Asserts that two matrices agree within `tolerance`, each entry in its own unit.
pub(in crate::abcd) fn assert_same(left: &AbcdMatrix, right: &AbcdMatrix, tolerance: f64) {
    for (l, r) in entries(left).into_iter().zip(entries(right)) {
        assert!((l - r).abs() <= tolerance, "{left:?}\n{right:?}");
    }
}

/// One of each element, with the indices before and after it.
fn elements() -> Vec<(AbcdMatrix, f64)> {
    let glass = ThickLens {
        index: 1.5168,
        front_curvature: 20.0,
        back_curvature: -8.0,
        thickness: 6e-3,
    };
    let [tangential, sagittal] = AbcdMatrix::tilted_mirror(5.0, 0.6).unwrap();
    vec![
        (AbcdMatrix::identity(), 1.0),
        (space(0.3), 1.0),
        (space(-0.2), 1.0),
        (lens(0.1), 1.0),
        (lens(-0.3), 1.0),
        (AbcdMatrix::thick_lens(&glass).unwrap(), 1.0),
        (mirror(4.0), 1.0),
        (tangential, 1.0),
        (sagittal, 1.0),
        (AbcdMatrix::flat_interface(1.0, 1.5).unwrap(), 1.0 / 1.5),
        (
            AbcdMatrix::curved_interface(1.6, 1.33, 50.0).unwrap(),
            1.6 / 1.33,
        ),
        (AbcdMatrix::grin(300.0, 7e-3).unwrap(), 1.0),
        (AbcdMatrix::grin_rod(1.59, 300.0, 7e-3).unwrap(), 1.0),
    ]
}

#[test]
fn the_determinant_is_the_ratio_of_the_indices() {
    for (element, ratio) in elements() {
        let [a, b, c, d] = entries(&element);
        // Entries are rounded to 1e−16; both products are below 2.
        assert!((a * d - b * c - ratio).abs() < 2e-15, "{element:?}");
        assert!((element.determinant() - ratio).abs() < 1e-15, "{element:?}");
    }
}

#[test]
fn a_matrix_given_by_its_entries_is_the_same() {
    for (element, _) in elements() {
        let [a, b, c, d] = entries(&element);
        let again = AbcdMatrix::new(a, b, c, d).unwrap();
        assert_same(&element, &again, 0.0);
        assert_absolute(element.determinant(), again.determinant(), 2e-15);
    }
    // 1 + 2⁻⁵⁰ and 1 − 2⁻⁵⁰: the plain difference of products would be 0.
    let [above, below] = [1.0 + 4.0 * f64::EPSILON, 1.0 - 4.0 * f64::EPSILON];
    let close = AbcdMatrix::new(1.0, above, below, 1.0)
        .unwrap()
        .determinant();
    assert!((close * 2_f64.powi(100) - 1.0).abs() < 1e-15, "{close:e}");
}

#[test]
fn the_principal_planes_of_a_plano_convex_lens_touch_the_curved_vertex() {
    // Curved side first: the front plane is at the vertex, the back one t/n before the flat face.
    let lens = AbcdMatrix::thick_lens(&ThickLens {
        index: 1.5,
        front_curvature: 20.0,
        back_curvature: 0.0,
        thickness: 6e-3,
    })
    .unwrap();
    assert_absolute(lens.focal_length().unwrap(), 0.1, 1e-15);
    assert!(
        lens.front_principal_plane().unwrap().abs() < 1e-16,
        "{lens:?}"
    );
    let back = lens.back_principal_plane().unwrap();
    assert!((back + 4e-3).abs() < 1e-16, "{back}");
    assert_absolute(lens.back_focal_distance().unwrap(), 96e-3, 1e-16);
}

#[test]
fn afocal_systems_have_no_focal_length() {
    for system in [AbcdMatrix::identity(), space(0.3), mirror(0.0)] {
        assert_eq!(system.focal_length(), None, "{system:?}");
        assert_eq!(system.back_focal_distance(), None, "{system:?}");
        assert_eq!(system.back_principal_plane(), None, "{system:?}");
        assert_eq!(system.front_principal_plane(), None, "{system:?}");
    }
}

/// Numbers of both signs from 1e−30 to 1e30, and 0.
fn extreme() -> impl Strategy<Value = f64> {
    let sign = prop::sample::select(vec![-1.0, 1.0]);
    prop_oneof![
        1 => Just(0.0),
        9 => (sign, -30.0..30.0_f64).prop_map(|(sign, exponent)| sign * 10_f64.powf(exponent)),
    ]
}

/// Elements with extreme parameters.
fn extreme_element() -> impl Strategy<Value = AbcdMatrix> {
    let index = || (-3.0..3.0_f64).prop_map(|exponent| 10_f64.powf(exponent));
    let accepted = |element: Result<AbcdMatrix, Refusal>| element.unwrap_or(AbcdMatrix::identity());
    prop_oneof![
        extreme().prop_map(move |x| accepted(AbcdMatrix::free_space(x))),
        extreme().prop_map(move |x| accepted(AbcdMatrix::thin_lens(x))),
        extreme().prop_map(move |x| accepted(AbcdMatrix::curved_mirror(x))),
        (extreme(), -FRAC_PI_2..FRAC_PI_2).prop_map(move |(x, angle)| accepted(
            AbcdMatrix::tilted_mirror(x, angle).map(|m| m[0])
        )),
        (index(), index(), extreme())
            .prop_map(move |(n1, n2, x)| accepted(AbcdMatrix::curved_interface(n1, n2, x))),
        (index(), extreme(), extreme()).prop_map(move |(n, g, x)| accepted(AbcdMatrix::grin_rod(
            n,
            g.abs(),
            x
        ))),
        (index(), extreme(), extreme(), extreme()).prop_map(move |(index, front, back, t)| {
            accepted(AbcdMatrix::thick_lens(&ThickLens {
                index,
                front_curvature: front,
                back_curvature: back,
                thickness: t.abs(),
            }))
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    #[test]
    fn no_extreme_system_yields_nan(
        chain in prop::collection::vec(extreme_element(), 1..=3),
        wavelength in -29.0..28.0_f64,
        ratio in 0.0..40.0_f64,
        distance in extreme(),
        height in extreme(),
        slope in extreme(),
    ) {
        let system = chain.into_iter().fold(AbcdMatrix::identity(), AbcdMatrix::then);
        prop_assert!(entries(&system).iter().all(|x| x.is_finite()), "{:?}", system);
        prop_assert!(system.determinant() > 0.0, "{:?}", system);
        let ray = system.transform_ray([height, slope]);
        let queries = [system.half_trace(), ray[0], ray[1]];
        prop_assert!(queries.iter().all(|x| !x.is_nan()), "{:?}: {:?}", system, queries);

        let wavelength = 10_f64.powf(wavelength);
        let waist = (wavelength * 10_f64.powf(ratio)).min(1e30);
        let beam = GaussianBeam::from_waist(wavelength, waist).unwrap();
        let located = LocatedBeam::new(beam, distance).unwrap();
        if let Ok(image) = system.transform(&located) {
            prop_assert!(image.radius_at(0.0) > 0.0, "{:?}", image);
            prop_assert!(image.curvature_at(0.0).is_finite(), "{:?}", image);
        }
        if let Ok(mode) = system.eigenmode() {
            prop_assert!(mode.curvature().is_finite(), "{:?}", mode);
        }
    }
}
