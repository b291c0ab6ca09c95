//! A refusal names the parameter, its value and what is allowed.

use tem00_testkit::refuses;
use tem00_wave::{
    Amplitudes, Arrangement, BeamDescription, Camera, DMat3, DVec3, FanDescription, Illumination,
    Lens, PatchDescription, RigidMotion, RoughSurface, Roughness, SamplePlane, Scatterer,
};

const BEAM: BeamDescription = BeamDescription {
    wavelength: 650e-9,
    waist: DVec3::ZERO,
    direction: DVec3::Z,
    waist_radius: 1e-3,
};

const FAN: FanDescription = FanDescription {
    wavelength: 650e-9,
    apex: DVec3::ZERO,
    direction: DVec3::Z,
    opening: DVec3::X,
    half_angle: 0.3,
    waist_radius: 1e-4,
    waist_distance: 0.3,
};

const PATCH: PatchDescription = PatchDescription {
    centre: DVec3::ZERO,
    normal: DVec3::Z,
    along: DVec3::X,
    size: [1e-3; 2],
    scatterers: [8; 2],
    arrangement: Arrangement::Lattice,
    roughness: Roughness::FullyDeveloped(Amplitudes::Unit),
    seed: 1,
};

const LENS: Lens = Lens {
    pupil_diameter: 3e-3,
    focus_distance: 0.3,
    pupil_to_image: 0.03,
};

const UP: f64 = f64::INFINITY;
const NAN: f64 = f64::NAN;
const FAR: DVec3 = DVec3::new(0.0, 1e30, 0.0);

#[test]
fn light() {
    refuses!(wavelength = 650e-9, direction = DVec3::Z
        => Illumination::plane(wavelength, direction);
        wavelength: [0.0, -1.0, NAN, UP, 1e-30, 1e30], direction: [DVec3::ZERO, DVec3::NAN]);
    refuses!(position = DVec3::ZERO => Illumination::point(650e-9, position);
        position: [DVec3::NAN, FAR]);
    refuses!(beam = BEAM => Illumination::gaussian_beam(&beam);
        beam.waist_radius: [0.0, -1.0, NAN, UP, 1e-30, 1e30]);
    refuses!(fan = FAN => Illumination::fan(&fan);
        fan.opening: [DVec3::Z],
        fan.half_angle: [1.75, core::f64::consts::FRAC_PI_2],
        fan.waist_distance: [1e30],
        fan.waist_radius: [1e-7],
    );
}

#[test]
fn surfaces_planes_and_motions() {
    let heights = |rms, correlation_length| Roughness::Heights {
        rms,
        correlation_length,
    };
    refuses!(patch = PATCH => RoughSurface::patch(&patch);
        patch.centre: [FAR],
        patch.normal: [DVec3::ZERO],
        patch.along: [DVec3::Z],
        patch.size: [[1e-3, -1.0]],
        patch.scatterers: [[0, 3], [usize::MAX, 3]],
        patch.roughness as "rms": [heights(-1e-6, 0.0), heights(NAN, 0.0)],
        patch.roughness as "correlation_length": [heights(1e-6, -1.0), heights(1e-6, UP)],
    );
    let scatterer = |position, re| Scatterer {
        position,
        amplitude: tem00_wave::Complex::new(re, 0.0),
    };
    refuses!(scatterers = vec![scatterer(DVec3::Y, 1.0)]
        => RoughSurface::from_scatterers(scatterers);
        scatterers: [vec![]],
        scatterers as "position": [vec![scatterer(FAR, 1.0)]],
        scatterers as "amplitude": [vec![scatterer(DVec3::Y, NAN)]],
    );
    refuses!(centre = DVec3::ZERO, steps = [DVec3::X, DVec3::Y], samples = [4, 4]
        => SamplePlane::new(centre, steps, samples);
        centre: [FAR], steps: [[DVec3::X, FAR]],
        samples: [[0, 4], [1 << 20, 1 << 20], [usize::MAX, 2]],
    );
    let plane = SamplePlane::new(DVec3::ZERO, [DVec3::X, DVec3::Y], [4, 4]).expect("a plane");
    refuses!(radius = 1.0 => plane.within(radius); radius: [-1.0]);
    refuses!(translation = DVec3::X => RigidMotion::translation(translation); translation: [FAR]);
    refuses!(axis = DVec3::X, angle = 1.0, centre = DVec3::ZERO
        => RigidMotion::rotation(axis, angle, centre);
        axis: [DVec3::ZERO], angle: [UP], centre: [FAR]);
}

#[test]
fn cameras() {
    let left_handed = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
    refuses!(axes = DMat3::IDENTITY, lens = LENS => Camera::new(DVec3::ZERO, axes, lens);
        axes: [left_handed, DMat3::ZERO],
        lens.pupil_diameter: [0.0, -1.0, NAN, UP, 1e30, 1e-30],
        lens.focus_distance: [0.0, NAN, 1e30],
        lens.pupil_to_image: [0.0, NAN, 1e30],
    );
    refuses!(target = DVec3::Z, up = DVec3::Y => Camera::look_at([DVec3::ZERO, target], up, LENS);
        target: [DVec3::ZERO], up: [DVec3::Z]);
    let camera = Camera::new(DVec3::ZERO, DMat3::IDENTITY, LENS).expect("a camera");
    refuses!(step = 1e-6, samples = 8 => camera.pupil_plane(step, samples);
        step as "steps": [NAN], samples: [0]);
}

#[test]
fn messages_say_what_is_allowed_and_what_was_given() {
    let beam = BeamDescription {
        wavelength: 0.5,
        waist_radius: 0.125,
        ..BEAM
    };
    let messages = [
        (
            Illumination::plane(-1.25, DVec3::Z).err(),
            "wavelength must be from 1e-10 to 1, in metres, got -1.25",
        ),
        (
            Illumination::plane(650e-9, DVec3::ZERO).err(),
            "direction must be finite and not zero, got [0, 0, 0]",
        ),
        (
            Illumination::gaussian_beam(&beam).err(),
            "waist_radius must be at least the paraxial limit of 0.3183098861837907 m, got 0.125",
        ),
    ];
    for (error, text) in messages {
        assert_eq!(error.map(|error| error.to_string()).as_deref(), Some(text));
    }
}
