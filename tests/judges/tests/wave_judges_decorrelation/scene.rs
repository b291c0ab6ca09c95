//! A rough surface, its light and its camera, as the judge and the judged describe them.

use tem00::{
    beam::GaussianBeam,
    decorrelation::{self, CameraFrame, Configuration, ConfigurationData, RigidMotions, Wavefront},
    tracer::{Rotation, Trajectory},
    wave::{
        Amplitudes, Arrangement, BeamDescription, Camera, DVec2, DVec3, FanDescription,
        Illumination, Lens, LitSurface, PatchDescription, RigidMotion, RoughSurface, Roughness,
        displacement_between,
    },
};

pub(crate) const WAVELENGTH: f64 = 650e-9;

/// The wave for the judge, and what the judged is told of it at the origin.
#[derive(Clone, Copy)]
pub(crate) struct Light {
    pub(crate) wave: Illumination,
    pub(crate) wavefront: Wavefront,
}

impl Light {
    fn near_origin(&self) -> decorrelation::Illumination {
        decorrelation::Illumination::near(DVec3::ZERO, self.wavefront).expect("light")
    }
}

pub(crate) fn plane(to_source: DVec3) -> Light {
    plane_of(WAVELENGTH, to_source)
}

pub(crate) fn plane_of(wavelength: f64, to_source: DVec3) -> Light {
    Light {
        wave: Illumination::plane(wavelength, -to_source).expect("a plane wave"),
        wavefront: Wavefront::plane(to_source).expect("a plane wave"),
    }
}

pub(crate) fn point_source(position: DVec3) -> Light {
    let curvature = position.length().recip();
    Light {
        wave: Illumination::point(WAVELENGTH, position).expect("a spherical wave"),
        wavefront: Wavefront::spherical(position, curvature).expect("a spherical wave"),
    }
}

/// A Gaussian beam that meets the origin at the distance `z` behind its waist and at `aside` from
/// its axis.
pub(crate) struct Beam {
    pub(crate) to_source: DVec3,
    pub(crate) waist_radius: f64,
    pub(crate) z: f64,
    pub(crate) aside: DVec3,
}

pub(crate) fn beam(beam: Beam) -> Light {
    let to_source = beam.to_source.normalize();
    let aside = beam.aside.reject_from_normalized(to_source);
    let curvature = curvature_at(beam.waist_radius, beam.z);
    let wave = Illumination::gaussian_beam(&BeamDescription {
        wavelength: WAVELENGTH,
        waist: to_source * beam.z - aside,
        direction: -to_source,
        waist_radius: beam.waist_radius,
    });
    // The wave travels along −to_source and, off its axis, outwards by its curvature.
    let seen = to_source - aside * curvature;
    Light {
        wave: wave.expect("a beam"),
        wavefront: Wavefront::spherical(seen, curvature).expect("a beam"),
    }
}

/// A laser line that meets the origin at a slant distance from its apex, at the distance `z` behind
/// its waist and at an angle from the middle of the fan, in radians.
pub(crate) struct Fan {
    pub(crate) to_source: DVec3,
    pub(crate) opening: DVec3,
    pub(crate) distance: f64,
    pub(crate) waist_radius: f64,
    pub(crate) z: f64,
    pub(crate) off_middle: f64,
}

pub(crate) fn fan(fan: Fan) -> Light {
    let to_source = fan.to_source.normalize();
    let opening = fan.opening.reject_from_normalized(to_source).normalize();
    let (sin, cos) = fan.off_middle.sin_cos();
    let wave = Illumination::fan(&FanDescription {
        wavelength: WAVELENGTH,
        apex: to_source * fan.distance,
        direction: -to_source * cos + opening * sin,
        opening,
        half_angle: 0.3,
        waist_radius: fan.waist_radius,
        waist_distance: fan.distance - fan.z,
    });
    let curvatures = [fan.distance.recip(), curvature_at(fan.waist_radius, fan.z)];
    let wavefront = Wavefront::astigmatic(to_source, opening, curvatures[0], curvatures[1]);
    Light {
        wave: wave.expect("a fan"),
        wavefront: wavefront.expect("a fan"),
    }
}

fn curvature_at(waist_radius: f64, z: f64) -> f64 {
    let beam = GaussianBeam::from_waist(WAVELENGTH, waist_radius).expect("a beam");
    beam.curvature_at(z)
}

/// A camera at `eye` that looks at `target`, and a lit patch of a surface about the origin.
#[derive(Clone, Copy)]
pub(crate) struct Scene {
    pub(crate) eye: DVec3,
    pub(crate) target: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) light: Light,
    /// Sides of the patch along and across the x axis of the world, or y where that is the normal.
    pub(crate) size: [f64; 2],
}

/// Scatterers along each side of a patch.
const SCATTERERS: usize = 32;

/// Samples along each side of the square of the pupil plane that is looked at: odd, so that it lies
/// about its centre.
const SAMPLES: usize = 81;

impl Scene {
    pub(crate) fn surface(&self, seed: u64) -> RoughSurface {
        RoughSurface::patch(&PatchDescription {
            centre: DVec3::ZERO,
            normal: self.normal,
            along: DVec3::X,
            size: self.size,
            scatterers: [SCATTERERS; 2],
            arrangement: Arrangement::Stratified,
            roughness: Roughness::FullyDeveloped(Amplitudes::ComplexGaussian),
            seed,
        })
        .expect("a patch")
    }

    /// The camera. Its lens plays no part in what falls on the pupil.
    pub(crate) fn camera(&self) -> Camera {
        let lens = Lens {
            pupil_diameter: 5e-3,
            focus_distance: 0.3,
            pupil_to_image: 0.06,
        };
        Camera::look_at([self.eye, self.target], DVec3::Y, lens).expect("a camera")
    }

    pub(crate) fn frame(&self) -> CameraFrame {
        CameraFrame::look_at(self.eye, self.target, DVec3::Y).expect("a frame")
    }

    /// The speckle on the pupil is as wide as the finest fringe across the patch.
    pub(crate) fn pupil_speckle(&self) -> f64 {
        WAVELENGTH * self.eye.length() / self.size[0].max(self.size[1])
    }

    /// The scene in its first state, as the law describes it.
    pub(crate) fn configuration(&self) -> Configuration {
        Configuration::new(ConfigurationData {
            wavelength: self.light.wave.wavelength(),
            point: DVec3::ZERO,
            normal: self.normal,
            illumination: self.light.near_origin(),
            camera: self.frame(),
            pupil: self.eye,
        })
        .expect("a configuration")
    }

    /// How far the speckle moves across the pupil between two states, by cross-correlation, on the
    /// mean over some surfaces.
    pub(crate) fn measured(&self, states: &States, seeds: u64) -> Option<DVec2> {
        let mut sum = DVec2::ZERO;
        for seed in 1..=seeds {
            // The pattern also stretches by motion over distance. Once the second window has
            // followed it, both see the same part of it, and the stretch adds nothing to the mean.
            let rough = self.measured_from(states, seed, states.window)?;
            sum += self.measured_from(states, seed, rough)?;
        }
        let count = seeds as f64;
        Some(sum / count)
    }

    /// The same, with the second window displaced on the pupil.
    fn measured_from(&self, states: &States, seed: u64, window: DVec2) -> Option<DVec2> {
        let step = 0.4 * self.pupil_speckle();
        let on_pupil = |camera: &Camera, lit: &LitSurface| {
            let plane = camera.pupil_plane(step, SAMPLES).expect("a plane");
            lit.field_on(&plane).intensity()
        };
        let surface = self.surface(seed);
        let before = on_pupil(&self.camera(), &surface.lit_by(&self.light.wave));

        let camera = self.camera().moved(&states.camera.judge());
        let aside = RigidMotion::translation(camera.axes() * window.extend(0.0));
        let camera = camera.moved(&aside.expect("a translation"));
        let light = states.light.unwrap_or(self.light).wave;
        let light = light.moved(&states.source.judge());
        let surface = surface.moved(&states.surface.judge());
        let after = on_pupil(&camera, &surface.lit_by(&light));

        let shift = displacement_between(&before, &after)?;
        Some(shift.offset * step + window)
    }
}

/// What the second state differs in from the first.
#[derive(Clone, Copy, Default)]
pub(crate) struct States {
    pub(crate) surface: Body,
    pub(crate) camera: Body,
    pub(crate) source: Body,
    /// Another light, before its source moves.
    pub(crate) light: Option<Light>,
    /// Where on the pupil the speckle of the second state is looked for at first, in metres.
    pub(crate) window: DVec2,
}

/// Translations.
#[derive(Clone, Copy, Default)]
pub(crate) struct Motion {
    pub(crate) surface: DVec3,
    pub(crate) camera: DVec3,
    pub(crate) source: DVec3,
}

impl From<Motion> for States {
    fn from(motion: Motion) -> Self {
        Self {
            surface: Body::along(motion.surface),
            camera: Body::along(motion.camera),
            source: Body::along(motion.source),
            ..Self::default()
        }
    }
}

impl States {
    /// The second state, as the law describes it.
    pub(crate) fn after(&self, before: &Configuration) -> Configuration {
        let lit = self.light.map_or(Ok(*before), |light| {
            let changed = before.with_wavelength(light.wave.wavelength())?;
            changed.with_illumination(light.near_origin())
        });
        lit.and_then(|lit| lit.moved(&self.motions()))
            .expect("a configuration")
    }

    /// The motions, as the law describes them.
    pub(crate) fn motions(&self) -> RigidMotions {
        RigidMotions {
            surface: self.surface.judged(),
            camera: self.camera.judged(),
            source: self.source.judged(),
        }
    }
}

/// A rotation and then a translation of a rigid body.
#[derive(Clone, Copy)]
pub(crate) struct Body {
    pub(crate) pivot: DVec3,
    pub(crate) axis: DVec3,
    /// In radians.
    pub(crate) angle: f64,
    pub(crate) translation: DVec3,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            pivot: DVec3::ZERO,
            axis: DVec3::Z,
            angle: 0.0,
            translation: DVec3::ZERO,
        }
    }
}

impl Body {
    pub(crate) fn along(translation: DVec3) -> Self {
        Self {
            translation,
            ..Self::default()
        }
    }

    pub(crate) fn about(pivot: DVec3, axis: DVec3, angle: f64) -> Self {
        Self {
            pivot,
            axis,
            angle,
            translation: DVec3::ZERO,
        }
    }

    pub(crate) fn judge(&self) -> RigidMotion {
        let turn = RigidMotion::rotation(self.axis, self.angle, self.pivot).expect("a rotation");
        turn.then(&RigidMotion::translation(self.translation).expect("a translation"))
    }

    /// The motion from each frame of a render to the next.
    pub(crate) fn trajectory(&self) -> Trajectory {
        let rotation = Rotation {
            axis: self.axis,
            angle: self.angle,
        };
        Trajectory::turning(self.pivot, rotation, self.translation).expect("a motion")
    }

    fn judged(&self) -> decorrelation::RigidMotion {
        let turn = decorrelation::RigidMotion::about(self.pivot, self.axis, self.angle);
        let along = decorrelation::RigidMotion::along(self.translation);
        turn.expect("a rotation")
            .then(&along.expect("a translation"))
    }
}
