//! Millions of surface points per second for displacement, correlation and pattern coordinates, in
//! batches and call by call, and the time of each law of correlation.
//!
//! The peer is what one writes first: a plain loop over the same slices with the arc cosine and the
//! sine of the standard library.

#![expect(
    clippy::expect_used,
    reason = "a benchmark has no one to hand an error to"
)]

use core::f64::consts::{FRAC_2_PI, PI};
use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use tem00::decorrelation::{
    CameraFrame, CorrelationLaw, DVec2, DVec3, FieldLight, FieldPoints, FieldSetup, FieldSlices,
    ImageOrientation, ImagingGeometry, LensData, LineOfSight, Motion, MotionField, SpeckleMotion,
    SurfacePoint, Wavefront,
};

/// Few enough for coordinates and results to stay in the nearer caches.
const POINTS: u32 = 4_096;
const SOURCE: DVec3 = DVec3::new(0.1, 0.05, 0.25);

fn setup() -> FieldSetup {
    let pupil_centre = DVec3::new(0.02, -0.01, 0.3);
    FieldSetup {
        geometry: ImagingGeometry::from_lens(LensData {
            wavelength: 650e-9,
            focal_length: 25e-3,
            f_number: 8.0,
            surface_to_pupil: 0.3,
            pixel_pitch: 3.45e-6,
        })
        .expect("a valid lens"),
        camera: CameraFrame::look_at(pupil_centre, DVec3::ZERO, DVec3::Y).expect("a valid view"),
        pupil_centre,
        orientation: ImageOrientation::ScreenUpright,
        pattern_speckle_size: 4.0,
    }
}

/// The number `i` of an even spread over (−½, ½).
fn spread(i: u32, step: f64) -> f64 {
    (f64::from(i) * step).fract() - 0.5
}

/// Three columns of vectors around `middle` that fill a cube with edges of `size`.
fn vectors(middle: DVec3, size: f64) -> [Vec<f64>; 3] {
    let steps = [0.618_033_988_7, 0.414_213_562_4, 0.732_050_807_6];
    [0, 1, 2].map(|k| {
        let component = |i| middle[k] + size * spread(i, steps[k]);
        (0..POINTS).map(component).collect()
    })
}

struct Scene {
    position: [Vec<f64>; 3],
    normal: [Vec<f64>; 3],
    motion: [Vec<f64>; 3],
    curvature: [Vec<f64>; 6],
}

fn slices<const N: usize>(columns: &[Vec<f64>]) -> [&[f64]; N] {
    core::array::from_fn(|k| columns[k].as_slice())
}

impl Scene {
    /// A hand's breadth of rough surface, tilted this way and that; half of the points lose half of
    /// their correlation.
    fn new() -> Self {
        let position = vectors(DVec3::ZERO, 0.1);
        let wave = |i: usize| {
            let to_source = SOURCE - DVec3::from([0, 1, 2].map(|k| position[k][i]));
            let wave = Wavefront::spherical(to_source, 1.0 / to_source.length());
            wave.expect("a valid wave").curvature()
        };
        let tensors: Vec<_> = (0..position[0].len()).map(wave).collect();
        let component = |row: usize, column: usize| {
            let of = tensors.iter().map(|k| k.col(column)[row]);
            of.collect::<Vec<_>>()
        };
        let curvature = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]
            .map(|(row, column)| component(row, column));
        Self {
            position,
            normal: vectors(DVec3::Z, 0.8),
            motion: vectors(DVec3::new(0.3e-3, 0.0, 5e-3), 1e-3),
            curvature,
        }
    }

    fn points<'a>(&'a self, light: FieldLight<'a>) -> FieldPoints<'a> {
        FieldPoints {
            position: slices(&self.position),
            normal: slices(&self.normal),
            motion: slices(&self.motion),
            light,
        }
    }
}

fn vector(columns: &[&[f64]; 3], i: usize) -> DVec3 {
    DVec3::new(columns[0][i], columns[1][i], columns[2][i])
}

fn output(out: &mut [Vec<f64>; 7]) -> FieldSlices<'_> {
    let [a, b, c, d, e, f, g] = out;
    FieldSlices {
        speckle_displacement: [a, b],
        pupil_displacement: [c, d],
        correlation: e,
        pattern_coordinate: [f, g],
    }
}

/// The tangents of the angle at which the camera sees a point, to the right and up.
fn tangents(setup: &FieldSetup, position: DVec3) -> DVec2 {
    let (camera, to_pupil) = (setup.camera, setup.pupil_centre - position);
    let across = DVec2::new(to_pupil.dot(camera.right()), to_pupil.dot(camera.up()));
    across / -to_pupil.dot(camera.towards_camera())
}

/// The same results from one call after another.
fn by_calls(
    setup: &FieldSetup,
    source: Option<DVec3>,
    points: &FieldPoints<'_>,
    i: usize,
) -> [f64; 3] {
    let position = vector(&points.position, i);
    let sight = LineOfSight::new(&setup.camera, setup.pupil_centre - position);
    let wave = match source {
        Some(source) => {
            let to_source = source - position;
            Wavefront::spherical(to_source, 1.0 / to_source.length())
        }
        None => Wavefront::plane(DVec3::Z),
    };
    let point = SurfacePoint::new(
        sight.expect("in view"),
        vector(&points.normal, i),
        wave.expect("a valid wave"),
    );
    let motion = Motion {
        surface: vector(&points.motion, i),
        ..Motion::default()
    };
    let point = point.expect("a valid point");
    let speckle = SpeckleMotion::new(&setup.geometry, &point, &motion, setup.orientation);
    let scale = setup.geometry.principal_distance() / setup.geometry.pixel_pitch();
    let pattern = setup.geometry.pattern_coordinate(
        tangents(setup, position) * DVec2::new(scale, -scale),
        speckle.defocus_displacement,
        setup.pattern_speckle_size,
    );
    [pattern.x, pattern.y, speckle.correlation]
}

/// The results in collimated light as one writes them first.
fn plain_loop(setup: &FieldSetup, points: &FieldPoints<'_>, out: &mut [Vec<f64>; 7]) {
    let geometry = &setup.geometry;
    let (b1, b2, b3) = (
        setup.camera.right(),
        setup.camera.up(),
        setup.camera.towards_camera(),
    );
    for i in 0..points.position[0].len() {
        let to_pupil = setup.pupil_centre - vector(&points.position, i);
        let a = vector(&points.motion, i);
        let depth = to_pupil.dot(b3);
        let seen = a - to_pupil * (a.dot(b3) / depth);
        let [x, y] = [seen.dot(b1), seen.dot(b2)];
        let magnification = geometry.pupil_to_image() / depth;
        let defocus = 1.0 / depth - 1.0 / geometry.surface_to_pupil();
        let beside = -geometry.pupil_to_image() * defocus;
        let speckle = [x, y].map(|x| x * magnification + x * beside);
        let s = x.hypot(y) / geometry.pupil_diameter();
        let overlap = if s < 1.0 {
            FRAC_2_PI * (s.acos() - s * (1.0 - s * s).sqrt())
        } else {
            0.0
        };
        let z = PI * a.dot(b3) / geometry.axial_decorrelation_length_at(depth);
        let sinc = if z == 0.0 { 1.0 } else { z.sin() / z };
        let (h_p, h) = (setup.pattern_speckle_size, geometry.speckle_size());
        let amplitude = overlap * sinc.abs();
        let image = tangents(setup, vector(&points.position, i)) * geometry.pupil_to_image();
        let results = [
            speckle[0],
            speckle[1],
            x,
            y,
            amplitude * amplitude,
            (image.x - x * beside) * h_p / h,
            (image.y - y * beside) * h_p / h,
        ];
        for (column, result) in out.iter_mut().zip(results) {
            column[i] = result;
        }
    }
}

fn fields(criterion: &mut Criterion) {
    let scene = Scene::new();
    let setup = setup();
    let field = MotionField::new(setup).expect("a valid field");
    let mut out = [(); 7].map(|()| vec![0.0; POINTS as usize]);

    let mut group = criterion.benchmark_group("batch");
    group.throughput(Throughput::Elements(POINTS.into()));
    for (name, light) in [
        ("collimated", FieldLight::Collimated),
        ("point source", FieldLight::PointSource(SOURCE)),
        ("curvature", FieldLight::Curvature(slices(&scene.curvature))),
    ] {
        let points = scene.points(light);
        group.bench_function(name, |bencher| {
            bencher.iter(|| field.evaluate(black_box(&points), output(black_box(&mut out))));
        });
    }
    group.finish();

    let points = scene.points(FieldLight::Collimated);
    let mut group = criterion.benchmark_group("call");
    group.throughput(Throughput::Elements(POINTS.into()));
    for (name, source) in [("collimated", None), ("point source", Some(SOURCE))] {
        group.bench_function(name, |bencher| {
            bencher.iter(|| {
                for i in 0..POINTS as usize {
                    black_box(by_calls(&setup, black_box(source), &points, i));
                }
            });
        });
    }
    group.finish();

    let mut group = criterion.benchmark_group("plain loop");
    group.throughput(Throughput::Elements(POINTS.into()));
    group.bench_function("collimated", |bencher| {
        bencher.iter(|| plain_loop(&setup, black_box(&points), black_box(&mut out)));
    });
}

fn laws(criterion: &mut Criterion) {
    use CorrelationLaw::{AtImageDisplacement, AtPeak, Product};
    let mut group = criterion.benchmark_group("law");
    for law in [Product, AtImageDisplacement, AtPeak] {
        for x in [0.6, 60.0] {
            group.bench_function(BenchmarkId::new(format!("{law:?}"), x), |bencher| {
                bencher.iter(|| law.correlation(black_box(0.2), black_box(x)));
            });
        }
    }
}

criterion_group!(benches, fields, laws);
criterion_main!(benches);
