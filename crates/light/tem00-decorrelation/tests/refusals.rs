//! Arguments that constructors refuse, by name.

use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, DMat3, DVec3, Focus, Illumination,
    ImagingGeometry, LensData, LineOfSight, PupilDistances, RigidChange, RigidMotion, RigidMotions,
    ThickLensData, Wavefront, equivalent_axial_shift, equivalent_pupil_shift,
};
use tem00_testkit::refuses;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;
const X: DVec3 = DVec3::X;
const Y: DVec3 = DVec3::Y;
const Z: DVec3 = DVec3::Z;
const ZERO: DVec3 = DVec3::ZERO;

#[test]
fn lenses() {
    let lens = LensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        surface_to_pupil: 0.3,
        pixel_pitch: 3.45e-6,
    };
    refuses!(lens = lens => ImagingGeometry::from_lens(lens);
        lens.wavelength: [0.0, -1.0, NAN, INFINITE],
        lens.focal_length: [0.0, -1.0, NAN, INFINITE],
        lens.f_number: [0.0, -1.0, 0.499, NAN, INFINITE],
        // Below the wavelength.
        lens.f_number as "pupil_diameter": [40_000.0],
        // In the focal plane the image is at infinity.
        lens.surface_to_pupil: [25e-3, 0.0, -1.0, NAN, INFINITE],
        lens.pixel_pitch: [0.0, -1.0, NAN, INFINITE],
    );
    let geometry = ImagingGeometry::from_lens(lens).unwrap();
    refuses!(wavelength = 1e-6 => geometry.with_wavelength(wavelength);
        wavelength: [0.0, NAN], wavelength as "pupil_diameter": [1.0]);
    let thick = ThickLensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        pupil_magnification: 0.8,
        focus: Focus::Magnification(0.1),
        pixel_pitch: 3.45e-6,
    };
    refuses!(lens = thick => ImagingGeometry::from_thick_lens(lens);
        lens.wavelength: [0.0, -1.0, NAN, INFINITE],
        lens.focal_length: [0.0, -1.0, NAN, INFINITE],
        lens.f_number: [0.0, -1.0, 0.499, NAN, INFINITE],
        lens.pixel_pitch: [0.0, -1.0, NAN, INFINITE],
        lens.pupil_magnification: [0.0, -1.0, NAN, INFINITE],
        lens.focus as "magnification": [
            Focus::Magnification(0.0),
            Focus::Magnification(-1.0),
            Focus::Magnification(NAN),
            Focus::Magnification(INFINITE),
        ],
        lens.focus as "surface_to_principal_plane": [
            Focus::SurfaceToPrincipalPlane(25e-3),
            Focus::SurfaceToPrincipalPlane(NAN),
            Focus::SurfaceToPrincipalPlane(INFINITE),
        ],
        lens.focus as "surface_to_pupil": [
            Focus::SurfaceToPupil(25e-3 / 0.8),
            Focus::SurfaceToPupil(-1.0),
            Focus::SurfaceToPupil(NAN),
            Focus::SurfaceToPupil(INFINITE),
        ],
    );
    // f m / m_p has no value.
    refuses!(scale = 1.0 => ImagingGeometry::from_thick_lens(ThickLensData {
            pupil_magnification: 1.0 / scale,
            focus: Focus::Magnification(scale),
            ..thick
        });
        scale as "magnification": [1e300]);
    // A numerical aperture above one: L = f (1/10 + 1/2) = 0.6 f, with D = 2 f.
    refuses!(f_number = 1.0 => ImagingGeometry::from_thick_lens(ThickLensData {
            f_number,
            pupil_magnification: 2.0,
            focus: Focus::Magnification(10.0),
            ..thick
        });
        f_number as "pupil_diameter must be at most twice the distance": [0.5]);
    let distances = PupilDistances {
        wavelength: 632.8e-9,
        surface_to_pupil: 0.3,
        pupil_to_image: 30e-3,
        pupil_diameter: 10e-3,
        pixel_pitch: 3.45e-6,
    };
    refuses!(distances = distances => ImagingGeometry::from_distances(distances);
        distances.wavelength: [0.0, -1.0, NAN, INFINITE],
        distances.surface_to_pupil: [0.0, -1.0, NAN, INFINITE],
        distances.pupil_to_image: [0.0, -1.0, NAN, INFINITE],
        distances.pupil_diameter: [0.0, -1.0, 61e-3, NAN, INFINITE],
        distances.pixel_pitch: [0.0, -1.0, NAN, INFINITE],
    );
}

/// The limit that follows from other arguments stands in the message.
#[test]
fn messages_show_the_limit() {
    let thick = ThickLensData {
        wavelength: 650e-9,
        focal_length: 25e-3,
        f_number: 8.0,
        pupil_magnification: 0.5,
        focus: Focus::SurfaceToPupil(0.04),
        pixel_pitch: 3.45e-6,
    };
    let refusal = ImagingGeometry::from_thick_lens(thick).unwrap_err();
    assert_eq!(
        refusal.to_string(),
        "surface_to_pupil must be finite and exceed the focal length over the pupil magnification \
         of 0.05 m, got 0.04 m"
    );
}

#[test]
fn frames_and_motions() {
    let mirror = DMat3::from_cols(X, Y, -Z);
    let shear = DMat3::from_cols(X, DVec3::new(2e-6, 1.0, 0.0), Z);
    let nan = DMat3::from_cols(X, DVec3::NAN, Z);
    refuses!(axes = DMat3::IDENTITY => CameraFrame::from_axes(axes);
        axes: [mirror, shear, nan, DMat3::ZERO, DMat3::IDENTITY * 2.0]);
    refuses!(target = ZERO, up = Y => CameraFrame::look_at(Z, target, up);
        target: [Z, DVec3::NAN, DVec3::INFINITY],
        up: [Z, -Z, ZERO, DVec3::NAN],
    );
    let camera = CameraFrame::look_at(Z, ZERO, Y).unwrap();
    refuses!(to_pupil = Z => LineOfSight::new(&camera, to_pupil);
        to_pupil: [ZERO, X, -Z, DVec3::NAN, DVec3::INFINITY]);
    refuses!(rotation = DMat3::IDENTITY, translation = X => RigidMotion::new(rotation, translation);
        rotation: [mirror, shear, nan],
        translation: [DVec3::NAN, DVec3::INFINITY],
    );
    refuses!(translation = X => RigidMotion::along(translation); translation: [DVec3::NAN]);
    refuses!(pivot = ZERO, axis = X, angle = 1.0 => RigidMotion::about(pivot, axis, angle);
        pivot: [DVec3::NAN, DVec3::INFINITY],
        axis: [ZERO, DVec3::NAN],
        angle: [NAN, INFINITE],
    );
    refuses!(pupil = Z => RigidChange::new(camera, pupil, &RigidMotions::default());
        pupil: [DVec3::NAN]);
    refuses!(correlation = 1.0 => equivalent_pupil_shift(correlation);
        correlation: [-0.2, -1e-17, 1.0 + f64::EPSILON, INFINITE, NAN]);
    refuses!(correlation = 0.0 => equivalent_axial_shift(correlation);
        correlation: [-0.2, -1e-17, 1.0 + f64::EPSILON, INFINITE, NAN]);
}

#[test]
fn light() {
    refuses!(direction = Z, curvature = -2.0 => Wavefront::spherical(direction, curvature);
        direction as "direction_to_source": [ZERO, DVec3::NAN, DVec3::INFINITY],
        curvature: [NAN, INFINITE, -INFINITE],
    );
    refuses!(direction = Z, axis = X, along = 1.0, across = 1.0 =>
        Wavefront::astigmatic(direction, axis, along, across);
        direction as "direction_to_source": [ZERO, DVec3::NAN],
        axis: [-Z, ZERO, DVec3::NAN, DVec3::INFINITY],
        along as "curvature": [NAN, INFINITE],
        across as "curvature": [NAN, INFINITE],
    );
    let skew = DMat3::from_cols(X, DVec3::new(1e-5, 1.0, 0.0), ZERO);
    let nan = DMat3::from_diagonal(DVec3::new(1.0, NAN, 0.0));
    refuses!(direction = Z, curvature = DMat3::IDENTITY
        => Wavefront::from_tensor(direction, curvature);
        direction as "direction_to_source": [ZERO],
        curvature: [skew, nan, DMat3::IDENTITY * INFINITE],
    );
    refuses!(direction = Z, dp = [X, Y], dl = [ZERO; 2]
        => Wavefront::from_differentials(direction, dp, dl);
        direction as "direction_to_source": [ZERO],
        dp: [[Z, X], [X; 2], [ZERO; 2], [X, DVec3::NAN]],
        dl: [[DVec3::INFINITY; 2], [X, DVec3::NAN]],
    );
    let wave = Wavefront::plane(Z).unwrap();
    refuses!(position = X => Illumination::point_source(position);
        position: [DVec3::NAN, DVec3::INFINITY]);
    refuses!(position = X => Illumination::near(position, wave);
        position: [DVec3::NAN, DVec3::INFINITY]);
}

#[test]
fn states() {
    let upright = ConfigurationData {
        wavelength: 650e-9,
        point: ZERO,
        normal: Z,
        illumination: Illumination::collimated(X + Z).unwrap(),
        camera: CameraFrame::look_at(0.3 * Z, ZERO, Y).unwrap(),
        pupil: 0.3 * Z,
    };
    let inside = Illumination::point_source(ZERO).unwrap();
    refuses!(data = upright => Configuration::new(data);
        data.wavelength: [0.0, -1.0, NAN, INFINITE],
        data.normal: [ZERO, DVec3::NAN],
        data.point as "to_pupil": [Z, DVec3::NAN],
        data.illumination as "point": [inside],
    );
    let state = Configuration::new(upright).unwrap();
    refuses!(wavelength = 1e-6 => state.with_wavelength(wavelength); wavelength: [0.0, NAN]);
    refuses!(light = upright.illumination => state.with_illumination(light);
        light as "point": [inside]);
    let past = RigidMotion::along(0.4 * Z).unwrap();
    refuses!(surface = RigidMotion::IDENTITY
        => state.moved(&RigidMotions { surface, ..RigidMotions::default() });
        surface as "to_pupil": [past]);
}
