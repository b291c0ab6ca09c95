use tem00_numerics::quadrature::integrate;
use tem00_testkit::assert_relative;

use super::*;
use crate::{
    CellGeometry, PeakShape, PolychromaticSpeckle, Relief, ResolutionCell, Rows, Spectrum,
    law::tests::{direction, of},
};

const WAVELENGTH: f64 = 650e-9;
const SIN_APERTURE: f64 = 0.02;

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

fn contrast(cell: &ResolutionCell, extent: Result<SourceExtent, Refusal>) -> f64 {
    let line = &Spectrum::monochromatic(WAVELENGTH).unwrap();
    let cell = &cell.clone().with_source_extent(extent.unwrap());
    of(line, cell).contrast()
}

#[test]
fn a_change_in_the_plane_of_incidence_moves_the_field_by_the_ratio_of_cosines() {
    for (incidence, observation) in [(0.0, 0.0), (40.0, -20.0), (-35.0, 50.0), (30.0, -30.0)] {
        let cell = cell(incidence, observation);
        let pupils = TAU * 2.0 * SIN_APERTURE / WAVELENGTH;
        let change = direction(incidence + 1e-4) - direction(incidence);
        let (moved, _) = cell.change_with_source(change);
        let ratio = incidence.to_radians().cos() / observation.to_radians().cos();
        // The direction turns, too: by half of 2e−6.
        assert!((moved.length() * pupils / change.length() / ratio - 1.0).abs() < 2e-6);
        let (moved_across, _) = cell.change_with_source(1e-3 * DVec3::Y);
        assert!((moved_across.length() * pupils - 1e-3).abs() < 1e-15);
        assert!(
            moved.dot(moved_across).abs() < 1e-12,
            "{moved} {moved_across}"
        );
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
    // The number of patterns of a lamp is the number of its own speckles that fit into it: ∫ chat²
    // over the squared pupil.
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
    let laws: [fn(&PolychromaticSpeckle<'_>) -> f64; 4] = [
        |speckle| speckle.contrast().powi(2),
        |speckle| speckle.covariance([0.3, -0.2]),
        |speckle| speckle.line_noise_ratio(Rows::Height(2.0)).powi(2),
        |speckle| speckle.autocovariance([0.4, 0.3]),
    ];
    for (linewidth, rms_height, laws) in [
        (0.0, 0.0, &laws[..]),
        (0.0, 2e-6, &laws[..3]),
        (4e-9, 0.0, &laws[..1]),
        (4e-9, 2e-6, &laws[..1]),
    ] {
        let relief = Relief {
            rms_height,
            correlation_length: 0.0,
        };
        let cell = cell(35.0, -20.0).with_relief(relief).unwrap();
        let line = &Spectrum::new(WAVELENGTH, linewidth, PeakShape::Gaussian).unwrap();
        let points = SourceExtent::directions(&points_of_disc(cell.source(), 0.015, 100)).unwrap();
        for (i, law) in laws.iter().enumerate() {
            let of = |extent: &SourceExtent| {
                let cell = &cell.clone().with_source_extent(extent.clone());
                law(&of(line, cell))
            };
            let (points, disc) = (of(&points), of(&SourceExtent::disc(0.015).unwrap()));
            // Each point represents its neighbourhood, over which the overlap falls a little.
            assert_relative(disc, points, 0.005);
            let point = of(&SourceExtent::default());
            assert!(disc < 0.95 * point, "law {i}: {disc}, {point}");
        }
    }
}

/// Pairs of the four waves `k (l_S + l)`, split across the line of sight and along the normal.
#[test]
fn two_wavelengths_from_two_directions_correlate_by_their_waves() {
    let (sight, rms_height) = (direction(-20.0), 2e-6);
    let relief = Relief {
        rms_height,
        correlation_length: 0.0,
    };
    let list = [34.75, 35.75].map(|degrees| (direction(degrees), 1.0));
    let wavelengths = [640e-9, 660e-9];
    let waves = wavelengths.map(|wavelength| {
        list.map(|(source, _)| {
            let wave = TAU / wavelength * (source + sight);
            let height_factor = wave.dot(sight) / sight.z;
            (wave - height_factor * DVec3::Z, height_factor)
        })
    });
    let waves = waves.as_flattened();
    let pairs = waves.iter().flat_map(|a| waves.iter().map(move |b| (a, b)));
    let squares = pairs.map(|((across, factor), (other_across, other_factor))| {
        let pupils = (across - other_across).length() * WAVELENGTH / (2.0 * TAU * SIN_APERTURE);
        let heights = (factor - other_factor) * rms_height;
        disc_overlap(pupils).powi(2) * (-heights * heights).exp()
    });
    let expected = squares.sum::<f64>() / 16.0;
    let extent = SourceExtent::directions(&list).unwrap();
    let cell = cell(35.25, -20.0).with_relief(relief).unwrap();
    let cell = &cell.with_source_extent(extent);
    let line = &Spectrum::from_peaks(&wavelengths.map(|peak| [peak, 1.0])).unwrap();
    let found = of(line, cell).contrast().powi(2);
    // Linear in both changes, of 1 % and 3 % of their sums.
    assert!((found / expected - 1.0).abs() < 0.01, "{found}, {expected}");
}

#[test]
fn directions_share_chords_and_lenses_of_the_pupil() {
    // Two directions of half of the light each, displaced across the tilt by half a pupil, and
    // along it.
    let cell = cell(20.0, 0.0);
    let line = &Spectrum::monochromatic(WAVELENGTH).unwrap();
    let displaced = |axis: DVec3| {
        let other = cell.source() + 2.0 * SIN_APERTURE * 0.5 * axis;
        let list = [(cell.source(), 1.0), (other, 1.0)];
        let extent = SourceExtent::directions(&list).unwrap();
        cell.clone().with_source_extent(extent)
    };
    let shared = |cell: &ResolutionCell, rows| {
        let ratio = of(line, cell).line_noise_ratio(rows);
        2.0 * ratio.powi(2) - 1.0
    };
    // Chords of two discs that are displaced along the chords: ∫ (2√(1 − x²) − 1)₊² dx · 3/16 over
    // half a chord.
    let sine = 0.75_f64.sqrt();
    let chords = 5.0 * sine - 4.0 * sine.powi(3) / 3.0 - 2.0 * (sine * 0.5 + sine.asin());
    let across = displaced(DVec3::Y);
    assert!((shared(&across, Rows::Thin) - 2.0 * chords * 3.0 / 16.0).abs() < 1e-3);
    // The ratio of the cosines, to first order in the 0.02 rad of the change.
    let along = displaced(direction(110.0) / 20_f64.to_radians().cos());
    assert!((shared(&along, Rows::Thin) - (1.0 - 0.75 + 0.0625)).abs() < 0.02);
    for cell in [&across, &along] {
        assert!((shared(cell, Rows::Tall) - disc_overlap(0.5)).abs() < 0.02);
        let rows = [Rows::Thin, Rows::Height(1.0), Rows::Height(4.0), Rows::Tall];
        let shared = rows.map(|rows| shared(cell, rows));
        assert!(shared.is_sorted(), "{shared:?}");
        let squared = disc_overlap(0.5).powi(2);
        let contrast = 2.0 * of(line, cell).contrast().powi(2) - 1.0;
        assert!((contrast - squared).abs() < 0.02, "{contrast}");
    }
}

#[test]
fn differences_are_bounded_in_number() {
    for extent in [SourceExtent::disc(0.3), SourceExtent::gaussian(0.3)] {
        let extent = extent.unwrap();
        for feature in [1e-300, 1e-9, 1e-3, 0.1, 1e9] {
            let (mut count, mut sum) = (0, 0.0);
            extent.for_each_difference(DVec3::Z, feature, |_, share| {
                count += 1;
                sum += share;
            });
            assert!(count <= 17_000, "{feature:e}: {count}");
            assert!((sum - 1.0).abs() < 1e-4, "{feature:e}: {sum}");
        }
    }
    let many = vec![(DVec3::Z, 1.0); 101];
    let refused = SourceExtent::directions(&many).unwrap_err();
    assert_eq!(refused.parameter(), "directions", "{refused}");
}
