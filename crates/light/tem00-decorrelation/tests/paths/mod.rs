//! The law of motion against exact optical paths, without any of its formulas.
//!
//! A scene here is a list of positions: scatterers fixed to a body, a source, a pupil. Paths are
//! distances, the phase is 2π/λ times the path, and the law is found by looking where phases agree.

use glam::{DMat2, DMat3, DQuat, DVec2, DVec3, EulerRot};
use tem00_decorrelation::{
    CameraFrame, Configuration, ConfigurationData, Illumination, RigidMotion, RigidMotions,
    Wavefront,
};

mod images;
mod points;

/// A rotation about the origin of the body and where the origin then lies.
#[derive(Clone, Copy)]
struct Pose {
    turn: DQuat,
    place: DVec3,
}

impl Pose {
    fn new(degrees: [f64; 3], place: DVec3) -> Self {
        let [x, y, z] = degrees.map(f64::to_radians);
        let turn =
            DQuat::from_rotation_z(z) * DQuat::from_rotation_y(y) * DQuat::from_rotation_x(x);
        Self { turn, place }
    }

    fn at(&self, body: DVec3) -> DVec3 {
        self.turn * body + self.place
    }

    /// The motion from this pose to another.
    fn motion_to(&self, other: &Self) -> RigidMotion {
        let rotation = other.turn * self.turn.inverse();
        let translation = other.place - rotation * self.place;
        RigidMotion::new(DMat3::from_quat(rotation), translation).unwrap()
    }
}

#[derive(Clone, Copy)]
enum Source {
    /// Far away, in this direction.
    Sun(DVec3),
    Point(DVec3),
    /// A wave that converges to a point.
    Focus(DVec3),
    /// An exact astigmatic wave: rays from the nearest point of a circle, whose wavefronts are
    /// tori.
    ///
    /// Seen from the origin the circle lies around `centre` in the plane of the origin and `axis`.
    /// In that plane the rays come from the centre, across it from the circle.
    Fan {
        centre: DVec3,
        axis: DVec3,
        radius: f64,
    },
}

impl Source {
    /// The point of the source that lights `x`.
    fn nearest_point(&self, x: DVec3) -> DVec3 {
        match *self {
            Self::Sun(direction) => x + direction.normalize(),
            Self::Point(position) | Self::Focus(position) => position,
            Self::Fan {
                centre,
                axis,
                radius,
            } => {
                let across = centre.cross(axis).normalize();
                let in_plane = (x - centre).reject_from_normalized(across);
                centre + in_plane.normalize() * radius
            }
        }
    }

    /// The path to `x`, but for a constant.
    fn path(&self, x: DVec3) -> f64 {
        match *self {
            Self::Sun(direction) => -direction.normalize().dot(x),
            Self::Focus(focus) => -focus.distance(x),
            _ => self.nearest_point(x).distance(x),
        }
    }

    /// Unit vector from `x` to the source.
    fn direction_from(&self, x: DVec3) -> DVec3 {
        let towards = (self.nearest_point(x) - x).normalize();
        match self {
            Self::Focus(_) => -towards,
            _ => towards,
        }
    }

    /// The light at the origin, to second order.
    fn wavefront(&self) -> Wavefront {
        match *self {
            Self::Sun(direction) => Wavefront::plane(direction),
            Self::Point(position) => Wavefront::spherical(position, 1.0 / position.length()),
            Self::Focus(focus) => Wavefront::spherical(-focus, -1.0 / focus.length()),
            Self::Fan {
                centre,
                axis,
                radius,
            } => {
                let (along, across) = (centre.length(), centre.length() - radius);
                Wavefront::astigmatic(centre, axis, 1.0 / along, 1.0 / across)
            }
        }
        .unwrap()
    }

    fn illumination(&self) -> Illumination {
        match *self {
            Self::Sun(direction) => Illumination::collimated(direction),
            Self::Point(position) => Illumination::point_source(position),
            _ => Illumination::near(DVec3::ZERO, self.wavefront()),
        }
        .unwrap()
    }
}

/// One state of a scene. The surface is the plane z = 0 of its body, the pupil that of its own.
#[derive(Clone, Copy)]
struct State {
    surface: Pose,
    pupil: Pose,
    source: Source,
    wavelength: f64,
}

impl State {
    /// The optical path, in wavelengths, by way of a scatterer of the body to a point of the pupil.
    fn waves(&self, scatterer: DVec3, pupil_point: DVec3) -> f64 {
        let x = self.surface.at(scatterer);
        (self.source.path(x) + self.pupil.at(pupil_point).distance(x)) / self.wavelength
    }

    /// How the path differs between scatterers next to the middle, in waves per metre.
    fn slope(&self, pupil_point: DVec2) -> DVec2 {
        let x = self.surface.place;
        let to_pupil = (self.pupil.at(pupil_point.extend(0.0)) - x).normalize();
        let towards = self.surface.turn.inverse() * (self.source.direction_from(x) + to_pupil);
        -towards.truncate() / self.wavelength
    }

    /// The pupil point of `self` that sees the slope that `q` sees in `before`, by Newton's method.
    fn matching_point(&self, before: &Self, q: DVec2) -> DVec2 {
        const STEP: f64 = 1e-4;
        let wanted = before.slope(q);
        let mut p = q;
        for _ in 0..20 {
            let difference = |e: DVec2| self.slope(p + e * STEP) - self.slope(p - e * STEP);
            let jacobian = DMat2::from_cols(difference(DVec2::X), difference(DVec2::Y));
            p += (jacobian * (0.5 / STEP)).inverse() * (wanted - self.slope(p));
        }
        p
    }

    fn configuration(&self) -> Configuration {
        Configuration::new(ConfigurationData {
            wavelength: self.wavelength,
            point: self.surface.place,
            normal: self.surface.turn * DVec3::Z,
            illumination: self.source.illumination(),
            camera: CameraFrame::from_axes(DMat3::from_quat(self.pupil.turn)).unwrap(),
            pupil: self.pupil.place,
        })
        .unwrap()
    }

    /// The configuration of another state, reached from that of this one.
    fn configuration_after(&self, after: &Self) -> Configuration {
        let moved = self.configuration().moved(&RigidMotions {
            surface: self.surface.motion_to(&after.surface),
            camera: self.pupil.motion_to(&after.pupil),
            ..RigidMotions::default()
        });
        let lit = moved.and_then(|state| state.with_illumination(after.source.illumination()));
        lit.and_then(|state| state.with_wavelength(after.wavelength))
            .unwrap()
    }

    /// The state with surface, camera and source shifted, and its configuration by the law.
    fn shifted(&self, by: [DVec3; 3]) -> (Self, Configuration) {
        let [surface, camera, source] = by.map(|by| RigidMotion::along(by).unwrap());
        let motions = RigidMotions {
            surface,
            camera,
            source,
        };
        // Only distances count: the source stays, and all else goes the other way.
        let mut after = *self;
        after.surface.place += by[0] - by[2];
        after.pupil.place += by[1] - by[2];
        (after, self.configuration().moved(&motions).unwrap())
    }
}

/// Surfaces at the origin and the pupils they are seen through.
fn set_ups(source: Source) -> impl Iterator<Item = State> {
    let oblique = DVec3::new(0.3, -0.2, 1.0).normalize();
    let set_ups = [
        ([0.0; 3], [0.0; 2], 0.3, DVec3::Z),
        ([60.0, 0.0, 0.0], [0.0; 2], 0.3, DVec3::Z),
        ([-35.0, 50.0, 20.0], [0.0; 2], 0.25, DVec3::Z),
        ([0.0; 3], [0.35, 0.0], 0.3, DVec3::Z),
        ([25.0, -40.0, -70.0], [-0.3, 0.2], 0.4, oblique),
        ([-10.0, 15.0, 130.0], [0.5, 0.5], 1.2, oblique),
    ];
    set_ups
        .into_iter()
        .map(move |(rotation, [x, y], depth, normal)| {
            let [yaw, pitch, roll] = rotation.map(f64::to_radians);
            let turn = DQuat::from_euler(EulerRot::YXZ, yaw, pitch, roll);
            State {
                surface: Pose {
                    turn: DQuat::from_rotation_arc(DVec3::Z, normal),
                    place: DVec3::ZERO,
                },
                pupil: Pose {
                    turn,
                    place: turn * DVec3::new(x, y, 1.0) * depth,
                },
                source,
                wavelength: 650e-9,
            }
        })
}

/// Motions of surface, camera and source.
fn unit_motions() -> [[DVec3; 3]; 7] {
    let none = DVec3::ZERO;
    [
        [DVec3::X, none, none],
        [DVec3::Y, none, none],
        [DVec3::Z, none, none],
        [none, DVec3::X, none],
        [none, DVec3::new(0.2, -0.4, 0.9), none],
        [none, none, DVec3::new(0.8, 0.5, -0.3)],
        [
            DVec3::new(0.3, 0.9, -0.3),
            DVec3::new(-0.5, 0.4, 0.6),
            DVec3::new(0.1, -0.7, 0.7),
        ],
    ]
}
