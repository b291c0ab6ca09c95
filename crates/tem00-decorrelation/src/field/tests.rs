use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::{LensData, LineOfSight, SurfacePoint, Wavefront, correlation};

const EYE: DVec3 = DVec3::new(0.02, -0.01, 0.3);
const SOURCE: DVec3 = DVec3::new(0.1, 0.05, 0.25);

fn setup() -> FieldSetup {
    FieldSetup {
        geometry: ImagingGeometry::from_lens(LensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            surface_to_pupil: 0.3,
            pixel_pitch: 3.45e-6,
        })
        .unwrap(),
        camera: CameraFrame::look_at(EYE, DVec3::ZERO, DVec3::new(0.1, 1.0, 0.0)).unwrap(),
        pupil_centre: EYE,
        orientation: ImageOrientation::ScreenUpright,
        pattern_speckle_size: 4.0,
    }
}

/// A point with its motion and curvature, as one row of the columns.
type Row = [f64; 15];
/// Speckle displacement, pupil displacement, correlation and pattern coordinate of a point.
type Results = [f64; 7];

#[derive(Clone, Copy, Debug)]
enum Light {
    Collimated,
    PointSource,
    Curvature,
}

const LIGHTS: [Light; 3] = [Light::Collimated, Light::PointSource, Light::Curvature];

fn evaluate(field: &MotionField, light: Light, rows: &[Row]) -> Vec<Results> {
    let columns: Vec<Vec<f64>> = (0..15)
        .map(|k| rows.iter().map(|row| row[k]).collect())
        .collect();
    let column = |k: usize| columns[k].as_slice();
    let points = FieldPoints {
        position: [0, 1, 2].map(column),
        normal: [3, 4, 5].map(column),
        motion: [6, 7, 8].map(column),
        light: match light {
            Light::Collimated => FieldLight::Collimated,
            Light::PointSource => FieldLight::PointSource(SOURCE),
            Light::Curvature => FieldLight::Curvature([9, 10, 11, 12, 13, 14].map(column)),
        },
    };
    let mut out = [(); 7].map(|()| vec![f64::NAN; rows.len()]);
    let [a, b, c, d, e, f, g] = &mut out;
    field.evaluate(
        &points,
        FieldSlices {
            speckle_displacement: [a, b],
            pupil_displacement: [c, d],
            correlation: e,
            pattern_coordinate: [f, g],
        },
    );
    (0..rows.len())
        .map(|i| core::array::from_fn(|k| out[k][i]))
        .collect()
}

/// The number `i` of an even spread over (−½, ½).
fn spread(i: u32, k: usize) -> f64 {
    const STEPS: [f64; 15] = [
        0.618_034, 0.414_214, 0.732_051, 0.236_068, 0.645_751, 0.316_625, 0.605_551, 0.123_106,
        0.385_165, 0.567_764, 0.082_763, 0.403_124, 0.557_439, 0.855_655, 0.280_110,
    ];
    (f64::from(i) * STEPS[k]).fract() - 0.5
}

/// Points all over the field of view of the camera, tilted by up to 45° and moved by up to half
/// of the pupil.
fn rows(count: u32) -> Vec<Row> {
    let middle = [
        0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0,
    ];
    let size = [
        0.1, 0.1, 0.1, 1.0, 1.0, 0.4, 2e-3, 2e-3, 2e-2, 8.0, 3.0, 3.0, 8.0, 3.0, 8.0,
    ];
    (0..count)
        .map(|i| core::array::from_fn(|k| middle[k] + size[k] * spread(i, k)))
        .collect()
}

fn vector(row: &Row, k: usize) -> DVec3 {
    DVec3::new(row[k], row[k + 1], row[k + 2])
}

/// The results from the types for single points.
fn by_calls(setup: &FieldSetup, light: Light, shared: &Motion, row: &Row) -> Results {
    let position = vector(row, 0);
    let sight = LineOfSight::new(&setup.camera, setup.pupil_centre - position).unwrap();
    let wave = match light {
        Light::Collimated => Wavefront::plane(DVec3::Z),
        _ => Wavefront::spherical(SOURCE - position, 1.0 / SOURCE.distance(position)),
    };
    let point = SurfacePoint::new(sight, vector(row, 3), wave.unwrap()).unwrap();
    let motion = Motion {
        surface: vector(row, 6) + shared.surface,
        ..*shared
    };
    let geometry = &setup.geometry;
    let pupil = point.pupil_displacement(&motion).unwrap();
    let beside = beside(geometry, sight.depth(), setup.orientation) * pupil;
    let image = point.image_displacement(geometry, &motion, setup.orientation) + beside;
    let axial = motion
        .surface_seen_by_camera()
        .dot(setup.camera.towards_camera());
    let left = correlation(
        pupil.length() / geometry.pupil_diameter(),
        axial / geometry.axial_decorrelation_length_at(sight.depth()),
    );
    let pixel = pixel_of(setup, position);
    let pattern = geometry.pattern_coordinate(pixel, beside, setup.pattern_speckle_size);
    [
        image.x, image.y, pupil.x, pupil.y, left, pattern.x, pattern.y,
    ]
}

/// The image of a point by similar triangles, in pixels along the axes that the orientation counts in,
/// rows downwards.
fn pixel_of(setup: &FieldSetup, position: DVec3) -> DVec2 {
    let (camera, from_pupil) = (setup.camera, position - setup.pupil_centre);
    let depth = -from_pupil.dot(camera.towards_camera());
    let across = DVec2::new(from_pupil.dot(camera.right()), from_pupil.dot(camera.up()));
    let pixel =
        across * (setup.geometry.principal_distance() / depth / setup.geometry.pixel_pitch());
    match setup.orientation {
        ImageOrientation::ScreenUpright => DVec2::new(pixel.x, -pixel.y),
        ImageOrientation::SensorInverted => DVec2::new(-pixel.x, pixel.y),
    }
}

/// Where a ray through the pupil point 1 meets the sensor beside one through the centre, by the lens
/// equation: it leads from 1 in the pupil to 0 at the image of the point, before or behind the
/// sensor. The axes of the sensor are those of the pupil if the image is inverted.
fn beside(geometry: &ImagingGeometry, depth: f64, orientation: ImageOrientation) -> f64 {
    let image_distance = 1.0 / (1.0 / geometry.focal_length() - 1.0 / depth);
    let on_sensor = 1.0 - geometry.pupil_to_image() / image_distance;
    match orientation {
        ImageOrientation::ScreenUpright => -on_sensor,
        ImageOrientation::SensorInverted => on_sensor,
    }
}

/// Fills in the curvature of the waves from the point source.
fn with_tensor(mut row: Row) -> Row {
    let to_source = SOURCE - vector(&row, 0);
    let wave = Wavefront::spherical(to_source, 1.0 / to_source.length()).unwrap();
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = wave.curvature().to_cols_array_2d();
    row[9..].copy_from_slice(&[xx, xy, xz, yy, yz, zz]);
    row
}

#[test]
fn batches_and_single_calls_agree() {
    let rows: Vec<_> = rows(500).into_iter().map(with_tensor).collect();
    let shared = Motion {
        surface: DVec3::new(0.1e-3, -0.2e-3, 1e-3),
        camera: DVec3::new(-0.3e-3, 0.1e-3, 2e-3),
        source: DVec3::new(0.2e-3, 0.3e-3, -1e-3),
    };
    // Some 20 roundings of 1e-16 each: of 1 mm in the image, 10 mm at the pupil, 2000 samples.
    let tolerance = [1e-17, 1e-17, 1e-15, 1e-15, 1e-13, 4e-12, 4e-12];
    for orientation in [
        ImageOrientation::ScreenUpright,
        ImageOrientation::SensorInverted,
    ] {
        let setup = FieldSetup {
            orientation,
            ..setup()
        };
        let field = MotionField::new(setup).unwrap().with_shared_motion(&shared);
        for light in LIGHTS {
            let results = evaluate(&field, light, &rows);
            for (row, result) in rows.iter().zip(&results) {
                let expected = by_calls(&setup, light, &shared, row);
                for k in 0..7 {
                    let error = (result[k] - expected[k]).abs();
                    assert!(
                        error <= tolerance[k],
                        "{light:?}, result {k} of {row:?}: {} instead of {}",
                        result[k],
                        expected[k]
                    );
                }
            }
            for row in &rows {
                let at_rest = field.pattern_coordinate(vector(row, 0)).unwrap();
                let pixel = pixel_of(&setup, vector(row, 0));
                let expected = setup.geometry.pattern_coordinate(pixel, DVec2::ZERO, 4.0);
                let error = (at_rest - expected).length();
                assert!(error <= tolerance[5], "{at_rest} at {row:?}");
            }
            let partial = results.iter().filter(|r| r[4] > 0.05 && r[4] < 0.95);
            assert!(partial.count() > 100, "too few points in between");
        }
    }
}

#[test]
fn results_do_not_depend_on_the_points_around() {
    let field = MotionField::new(setup()).unwrap();
    // Three blocks and a part of one.
    let rows = rows(101);
    for light in LIGHTS {
        let together = evaluate(&field, light, &rows);
        for (row, expected) in rows.iter().zip(&together) {
            let alone = evaluate(&field, light, &[*row])[0];
            assert_eq!(
                alone.map(f64::to_bits),
                expected.map(f64::to_bits),
                "{light:?} at {row:?}"
            );
        }
    }
    let none = evaluate(&field, Light::Collimated, &[]);
    assert!(none.is_empty(), "{none:?}");
}

/// A point in the middle of the view, moved sideways, in waves of 5/m.
fn middle() -> Row {
    let mut row = [0.0; 15];
    row[3..9].copy_from_slice(&[0.0, 0.0, 1.0, 1e-5, 3e-5, 0.0]);
    row[9..].copy_from_slice(&[5.0, 0.0, 0.0, 5.0, 0.0, 5.0]);
    row
}

#[test]
fn points_out_of_sight_are_decorrelated() {
    let field = MotionField::new(setup()).unwrap();
    let behind = EYE + setup().camera.towards_camera() * 0.1;
    let beside = EYE + setup().camera.right() * 0.1;
    for position in [behind, beside, EYE, DVec3::splat(1e200)] {
        assert_eq!(field.pattern_coordinate(position), None, "{position}");
        let mut moved = middle();
        moved[..3].copy_from_slice(&position.to_array());
        let mut still = moved;
        still[6..9].fill(0.0);
        for light in LIGHTS {
            for result in evaluate(&field, light, &[moved, still]) {
                let [speckle_x, speckle_y, pupil_x, pupil_y, left, _, _] = result;
                let stands = speckle_x == 0.0 && speckle_y == 0.0;
                let gone = pupil_x == f64::INFINITY && pupil_y == f64::INFINITY;
                assert!(stands && gone, "{light:?} at {position}: {result:?}");
                assert!(left == 0.0, "{light:?} at {position}: {result:?}");
                assert_eq!(result[5..], [0.0; 2], "{light:?} at {position}");
            }
        }
    }
}

#[test]
fn points_seen_edge_on_in_curved_light_are_decorrelated() {
    let field = MotionField::new(setup()).unwrap();
    let camera = setup().camera;
    for normal in [
        camera.up(),
        camera.right() + 1e-9 * camera.towards_camera(),
        DVec3::ZERO,
    ] {
        let mut row = middle();
        row[3..6].copy_from_slice(&normal.to_array());
        for light in [Light::PointSource, Light::Curvature] {
            let result = evaluate(&field, light, &[row])[0];
            let gone = result[2] == f64::INFINITY && result[3] == f64::INFINITY;
            assert!(gone && result[4] == 0.0, "{light:?}, {normal}: {result:?}");
            assert!(result[0] > 0.0, "the image still moves: {result:?}");
            let mut still = row;
            still[6..9].fill(0.0);
            let left = evaluate(&field, light, &[still])[0][4];
            assert!(1.0 - left == 0.0, "nothing moved, and {left} is left");
        }
        // In collimated light the tilt of the surface does not matter.
        let result = evaluate(&field, Light::Collimated, &[row])[0];
        assert!(result[4] > 0.9, "{result:?}");
    }
}

#[test]
fn invalid_fields_are_rejected() {
    for bad in [DVec3::NAN, DVec3::INFINITY] {
        let result = MotionField::new(FieldSetup {
            pupil_centre: bad,
            ..setup()
        });
        assert!(
            matches!(
                result,
                Err(DecorrelationError::Vector {
                    parameter: "pupil_centre",
                    ..
                })
            ),
            "{bad}: {result:?}"
        );
    }
    for bad in [0.0, -4.0, f64::NAN, f64::INFINITY] {
        let result = MotionField::new(FieldSetup {
            pattern_speckle_size: bad,
            ..setup()
        });
        assert!(
            matches!(
                result,
                Err(DecorrelationError::OutOfRange {
                    parameter: "pattern_speckle_size",
                    ..
                })
            ),
            "{bad}: {result:?}"
        );
    }
}

/// Evaluates two points with slices of equal length but for the last ones in and out.
fn evaluate_with_last_slices(input: &[f64], output: &mut [f64]) {
    let two = [0.0; 2];
    let points = FieldPoints {
        position: [&two, &two, &two],
        normal: [&two, &two, &two],
        motion: [&two, &two, &two],
        light: FieldLight::Curvature([&two, &two, &two, &two, &two, input]),
    };
    let mut out = [[0.0; 2]; 6];
    let [a, b, c, d, e, f] = &mut out;
    let out = FieldSlices {
        speckle_displacement: [a, b],
        pupil_displacement: [c, d],
        correlation: e,
        pattern_coordinate: [f, output],
    };
    MotionField::new(setup()).unwrap().evaluate(&points, out);
}

#[test]
#[should_panic(expected = "all slices must be of equal length")]
fn inputs_of_unequal_length_panic() {
    evaluate_with_last_slices(&[0.0; 1], &mut [0.0; 2]);
}

#[test]
#[should_panic(expected = "all slices must be of equal length")]
fn outputs_of_unequal_length_panic() {
    evaluate_with_last_slices(&[0.0; 2], &mut [0.0; 3]);
}

#[test]
fn fields_can_cross_threads() {
    fn check<T: Send + Sync>() {}
    check::<MotionField>();
    check::<FieldPoints<'_>>();
    check::<FieldSlices<'_>>();
}

fn any_finite() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    prop_oneof![
        POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO,
        -1.0_f64..1.0
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn any_finite_point_has_results(row in prop::array::uniform15(any_finite())) {
        let field = MotionField::new(setup()).unwrap();
        for light in LIGHTS {
            let result = evaluate(&field, light, &[row])[0];
            prop_assert!(result.iter().all(|x| !x.is_nan()), "{:?}", result);
            prop_assert!((0.0..=1.0).contains(&result[4]));
            prop_assert!(result[0].is_finite() && result[1].is_finite());
        }
    }
}
