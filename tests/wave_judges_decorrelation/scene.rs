//! A rough surface, its light and its camera, as the judge and the judged describe them.

use tem00::{
    beam::GaussianBeam,
    decorrelation::{CameraFrame, LineOfSight, Motion, SurfacePoint, Wavefront},
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

pub(crate) fn plane(to_source: DVec3) -> Light {
    Light {
        wave: Illumination::plane(WAVELENGTH, -to_source).expect("a plane wave"),
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
const SCATTERERS: usize = 48;

/// Samples along each side of the square of the pupil plane that is looked at.
const SAMPLES: usize = 96;

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

    pub(crate) fn point(&self) -> SurfacePoint {
        let sight = LineOfSight::new(&self.frame(), self.eye).expect("a line of sight");
        SurfacePoint::new(sight, self.normal, self.light.wavefront).expect("a point")
    }

    /// The speckle on the pupil is as wide as the finest fringe across the patch.
    pub(crate) fn pupil_speckle(&self) -> f64 {
        WAVELENGTH * self.eye.length() / self.size[0].max(self.size[1])
    }

    /// How far the speckle moves across the pupil between two states, by cross-correlation, on the
    /// mean over some surfaces.
    pub(crate) fn measured(&self, states: &States, seeds: u64) -> Option<DVec2> {
        let step = 0.4 * self.pupil_speckle();
        let before = self.camera();
        let after = before.moved(&states.camera);
        let light = states.light.unwrap_or(self.light.wave).moved(&states.source);
        let mut sum = DVec2::ZERO;
        for seed in 1..=seeds {
            let surface = self.surface(seed);
            let on_pupil = |lit: &LitSurface, camera: &Camera| {
                let plane = camera.pupil_plane(step, SAMPLES).expect("a plane");
                lit.field_on(&plane).intensity()
            };
            let first = on_pupil(&surface.lit_by(&self.light.wave), &before);
            let second = on_pupil(&surface.moved(&states.surface).lit_by(&light), &after);
            let shift = displacement_between(&first, &second)?;
            sum += shift.offset * step;
        }
        #[expect(clippy::cast_precision_loss, reason = "a few surfaces")]
        let count = seeds as f64;
        Some(sum / count)
    }
}

/// What the second state differs in from the first.
#[derive(Clone, Copy)]
pub(crate) struct States {
    pub(crate) surface: RigidMotion,
    pub(crate) camera: RigidMotion,
    pub(crate) source: RigidMotion,
    /// Another light in the second state.
    pub(crate) light: Option<Illumination>,
}

impl Default for States {
    fn default() -> Self {
        Self {
            surface: RigidMotion::IDENTITY,
            camera: RigidMotion::IDENTITY,
            source: RigidMotion::IDENTITY,
            light: None,
        }
    }
}

impl From<Motion> for States {
    fn from(motion: Motion) -> Self {
        let along = |v| RigidMotion::translation(v).expect("a translation");
        Self {
            surface: along(motion.surface),
            camera: along(motion.camera),
            source: along(motion.source),
            light: None,
        }
    }
}
