use tem00_numerics::quadrature::integrate;

use super::*;
use crate::{CellGeometry, LineShape, Relief, ResolutionCell, SpectralLine};

const WAVELENGTH: f64 = 650e-9;
const SIN_APERTURE: f64 = 0.02;

/// A direction in the plane of incidence, by its angle to the normal in degrees.
fn direction(degrees: f64) -> DVec3 {
    let (sin, cos) = degrees.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

fn cell(incidence: f64, observation: f64) -> ResolutionCell {
    ResolutionCell::new(CellGeometry {
        to_source: direction(incidence),
        to_pupil: direction(observation),
        normal: DVec3::Z,
        sin_aperture: SIN_APERTURE,
        wavelength: WAVELENGTH,
    })
    .unwrap()
}

fn contrast(cell: &ResolutionCell, extent: Result<SourceExtent, CoherenceError>) -> f64 {
    let line = &SpectralLine::monochromatic(WAVELENGTH).unwrap();
    PolychromaticSpeckle { line, cell }.contrast_of(&extent.unwrap())
}

#[test]
fn a_change_in_the_plane_of_incidence_moves_the_field_by_the_ratio_of_cosines() {
    for (incidence, observation) in [(0.0, 0.0), (40.0, -20.0), (-35.0, 50.0)] {
        let cell = cell(incidence, observation);
        let change = direction(incidence + 1e-4) - direction(incidence);
        let (moved, _) = cell.change_with_source(change);
        let ratio = incidence.to_radians().cos() / observation.to_radians().cos();
        // The direction turns, too: by half of 2e−6.
        assert!((moved.length() / change.length() / ratio - 1.0).abs() < 2e-6);
        assert!(moved.dot(direction(observation)).abs() < 1e-18);
        let (across, _) = cell.change_with_source(1e-3 * DVec3::Y);
        assert!((across.length() - 1e-3).abs() < 1e-15);
    }
}

#[test]
fn two_directions_have_the_contrast_of_their_overlap() {
    let cell = cell(0.0, 0.0);
    for degrees in [0.1, 1.0, 2.0, 5.0] {
        let list = [(direction(0.0), 3.0), (2.0 * direction(degrees), 1.0)];
        let overlap = disc_overlap(degrees.to_radians().sin() / (2.0 * SIN_APERTURE));
        let squared = (10.0 + 6.0 * overlap.powi(2)) / 16.0;
        let found = contrast(&cell, SourceExtent::directions(&list)).powi(2);
        assert!((found - squared).abs() < 1e-14, "{degrees}: {found}");
    }
}

#[test]
fn directions_that_share_no_pupil_add_as_patterns() {
    let list: Vec<_> = (0..9)
        .map(|i| (direction(f64::from(i) * 4.0), 1.0))
        .collect();
    let found = contrast(&cell(10.0, 30.0), SourceExtent::directions(&list));
    assert!((found - 1.0 / 3.0).abs() < 1e-15, "{found}");
}

#[test]
fn points_and_lamps_are_the_limits_of_a_source() {
    let cell = cell(0.0, 0.0);
    for small in [0.0, 1e-6] {
        assert!(contrast(&cell, SourceExtent::disc(small)) > 1.0 - 1e-4);
        assert!(contrast(&cell, SourceExtent::gaussian(small)) > 1.0 - 1e-4);
    }
    // Lamps have as many patterns as speckles of their own fit into them: ∫ chat² over the squared pupil.
    let area = integrate(|x| TAU * x * disc_overlap(x).powi(2), [0.0, 1.0], 0.1);
    let of_pupil = (2.0 * SIN_APERTURE).powi(2) * area;
    let (wide, spread) = (0.3, 0.1);
    let gaussian = contrast(&cell, SourceExtent::gaussian(spread)).powi(2);
    // To second order in the ratio of pupil and source, with ⟨x²⟩ < 0.1.
    assert!((gaussian * 2.0 * TAU * spread * spread / of_pupil - 1.0).abs() < 0.01);
    let disc = contrast(&cell, SourceExtent::disc(wide)).powi(2);
    // The rim has half as many neighbours: 4/π ⟨x⟩ sin u / α < 0.03.
    let ratio = disc * PI * wide * wide / of_pupil;
    assert!((0.96..0.99).contains(&ratio), "{ratio}");
}

/// Equally bright points of a disc, in a spiral.
fn points_of_disc(to_source: DVec3, half_angle: f64, count: u32) -> Vec<(DVec3, f64)> {
    let (first, second) = to_source.any_orthonormal_pair();
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let point = |i: u32| {
        let radius = half_angle * ((f64::from(i) + 0.5) / f64::from(count)).sqrt();
        let angle = golden * f64::from(i);
        let across = radius * (angle.cos() * first + angle.sin() * second);
        ((1.0 - radius * radius).sqrt() * to_source + across, 1.0)
    };
    (0..count).map(point).collect()
}

#[test]
fn a_disc_is_the_sum_of_its_points_with_heights_and_a_linewidth_too() {
    const POINTS: u32 = 120;
    for (linewidth, rms_height) in [(0.0, 0.0), (0.0, 2e-6), (4e-9, 0.0), (4e-9, 2e-6)] {
        let relief = Relief {
            rms_height,
            correlation_length: 0.0,
        };
        let cell = cell(35.0, -20.0).with_relief(relief).unwrap();
        let line = &SpectralLine::new(WAVELENGTH, linewidth, LineShape::Gaussian).unwrap();
        let speckle = PolychromaticSpeckle { line, cell: &cell };
        let points = points_of_disc(cell.source(), 0.015, POINTS);
        let points = SourceExtent::directions(&points).unwrap();
        let [points, disc] = [points, SourceExtent::disc(0.015).unwrap()]
            .map(|extent| speckle.contrast_of(&extent).powi(2));
        // Each point stands for its neighbourhood, over which the overlap falls a little.
        assert!(
            (disc / points - 1.0).abs() < 0.005,
            "{linewidth:e}, {rms_height:e}: {disc}, {points}"
        );
        assert!(disc < 0.9 * speckle.contrast().powi(2), "{disc}");
    }
}

#[test]
fn what_cannot_be_is_refused_by_its_name() {
    for angle in [-0.1, 0.4, f64::NAN] {
        let refused = SourceExtent::disc(angle).unwrap_err();
        assert_eq!(refused.parameter(), "half_angle", "{refused}");
        let refused = SourceExtent::gaussian(angle).unwrap_err();
        assert_eq!(refused.parameter(), "standard_deviation", "{refused}");
    }
    for shares in [
        [0.0, 0.0],
        [2.0, -1.0],
        [f64::NAN, 1.0],
        [f64::INFINITY, 1.0],
    ] {
        let list = shares.map(|share| (DVec3::Z, share));
        let refused = SourceExtent::directions(&list).unwrap_err();
        assert_eq!(refused.parameter(), "share", "{refused}");
    }
    let refused = SourceExtent::directions(&[(DVec3::ZERO, 1.0)]).unwrap_err();
    assert_eq!(refused.parameter(), "direction", "{refused}");
    assert!(SourceExtent::directions(&[]).is_err());
}
