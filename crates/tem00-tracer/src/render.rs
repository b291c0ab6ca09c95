use core::{
    error, fmt,
    sync::atomic::{AtomicBool, Ordering},
};

use glam::DVec2;
use rayon::prelude::*;

use crate::{
    Camera, Frame, Intersector, Lamp, Scene, Shape, SpeckleModel, TracerError,
    film::{self, Pixel, Row},
    integrator::Integrator,
    sampler::{Sampler, Strata},
};

/// Which formulas a render uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Formulas {
    /// The physics as it was derived and checked for this project.
    #[default]
    Derived,
    /// The formulas as printed in Bergmann et al. 2016, with their errors, for comparison.
    AsPrinted,
}

/// How a frame is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RenderOptions {
    /// The number of camera samples per pixel, at least 1.
    pub samples_per_pixel: u32,
    /// The seed of the camera samples.
    pub seed: u64,
    /// The formulas.
    pub formulas: Formulas,
}

impl Default for RenderOptions {
    fn default() -> Self {
        Self {
            samples_per_pixel: 16,
            seed: 0,
            formulas: Formulas::Derived,
        }
    }
}

/// Why a frame was not rendered.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RenderError {
    /// The caller asked to stop.
    Cancelled,
    /// The scene cannot be rendered.
    Scene(TracerError),
}

impl fmt::Display for RenderError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cancelled => write!(f, "the render was cancelled"),
            Self::Scene(source) => source.fmt(f),
        }
    }
}

impl error::Error for RenderError {}

impl From<TracerError> for RenderError {
    fn from(source: TracerError) -> Self {
        Self::Scene(source)
    }
}

/// The light that one pass over the image follows.
#[derive(Clone, Copy, Debug)]
enum Pass {
    Laser(usize),
    Lamps,
}

impl Scene {
    /// Returns the camera as it stands in `frame`.
    pub fn camera_at(&self, frame: u32) -> Camera {
        self.camera
            .translated(f64::from(frame) * self.camera_displacement_per_frame)
    }

    /// Returns the shapes as they stand in `frame`: the surfaces, then the area lamps.
    pub fn shapes_at(&self, frame: u32) -> Vec<Shape> {
        let surfaces = self.surfaces.iter().map(|surface| {
            surface
                .shape
                .translated(f64::from(frame) * surface.displacement_per_frame)
        });
        let lamps = self.lamps.iter().filter_map(|lamp| match lamp {
            Lamp::Area { rectangle, .. } => Some(Shape::Rectangle(*rectangle)),
            Lamp::Point { .. } | Lamp::Environment(_) => None,
        });
        surfaces.chain(lamps).collect()
    }

    /// Returns the number of camera samples that one frame takes, over all its sources of light.
    pub fn samples_per_frame(&self, samples_per_pixel: u32) -> u64 {
        (self.camera.width() * self.camera.height()) as u64
            * u64::from(samples_per_pixel)
            * self.passes().len() as u64
    }

    fn passes(&self) -> Vec<Pass> {
        let lasers = (0..self.lasers.len()).map(Pass::Laser);
        let lamps = (!self.lamps.is_empty()).then_some(Pass::Lamps);
        lasers.chain(lamps).collect()
    }
}

/// Renders one frame, on the threads of the current rayon pool.
///
/// Without a `speckle` model every speckle factor is 1. `progress` is told, from any thread, the
/// number of camera samples done since its last call; once `cancel` is set, the render stops at the
/// next sample. The result has the same bits for any number of threads.
///
/// # Errors
///
/// Returns [`RenderError::Cancelled`] if `cancel` was set before the end, and an error if there are
/// no samples or the geometry cannot be built.
///
/// # Panics
///
/// Panics unless `frame < scene.render.frames` and `speckle` has a pattern for every laser, as a model
/// of the same scene has.
pub fn render_frame(
    scene: &Scene,
    speckle: Option<&SpeckleModel>,
    frame: u32,
    options: &RenderOptions,
    progress: impl Fn(u64) + Sync,
    cancel: &AtomicBool,
) -> Result<Frame, RenderError> {
    if options.samples_per_pixel == 0 {
        return Err(TracerError::OutOfRange {
            parameter: "samples_per_pixel",
            value: 0.0,
            allowed: "at least 1",
        }
        .into());
    }
    assert!(
        frame < scene.render.frames,
        "frame {frame} of a scene with {}",
        scene.render.frames
    );
    assert!(
        speckle.is_none_or(|model| model.pattern_count() >= scene.lasers.len()),
        "the speckle model belongs to another scene"
    );
    let intersector = Intersector::build(&scene.shapes_at(frame))?;
    let integrator = Integrator {
        scene,
        camera: scene.camera_at(frame),
        intersector: &intersector,
        speckle,
        formulas: options.formulas,
        frame,
    };
    let (mut lasers, mut lamps) = (Vec::new(), None);
    for pass in scene.passes() {
        let job = PassJob {
            integrator: &integrator,
            pass,
            strata: Strata::new(options.samples_per_pixel),
            seed: options.seed,
            progress: &progress,
            cancel,
        };
        let rows = job.rows()?;
        match pass {
            Pass::Laser(index) => {
                lasers.push(film::laser_layers(scene.lasers[index].wavelength(), &rows));
            }
            Pass::Lamps => lamps = Some(film::lamp_layer(&rows)),
        }
    }
    let dark = || tem00_numerics::Grid::filled(scene.camera.width(), scene.camera.height(), 0.0);
    Ok(Frame {
        lasers,
        lamps: lamps.unwrap_or_else(dark),
    })
}

/// One pass over the image.
struct PassJob<'a, P> {
    integrator: &'a Integrator<'a>,
    pass: Pass,
    strata: Strata,
    seed: u64,
    progress: &'a P,
    cancel: &'a AtomicBool,
}

impl<P: Fn(u64) + Sync> PassJob<'_, P> {
    fn rows(&self) -> Result<Vec<Row>, RenderError> {
        let camera = &self.integrator.camera;
        (0..camera.height())
            .into_par_iter()
            .map(|y| {
                let pixels = (0..camera.width()).map(|x| self.pixel(x, y));
                Ok(Row {
                    pixels: pixels.collect::<Result<_, _>>()?,
                })
            })
            .collect()
    }

    #[expect(
        clippy::cast_precision_loss,
        reason = "an image has at most 2²⁸ pixels"
    )]
    fn pixel(&self, x: usize, y: usize) -> Result<Pixel, RenderError> {
        let mut sampler = Sampler::new(self.seed, self.stream(x, y));
        let samples = self.strata.samples();
        let mut mean = Pixel::default();
        let mut unreported = 0;
        for index in 0..samples {
            if self.cancel.load(Ordering::Relaxed) {
                return Err(RenderError::Cancelled);
            }
            let [u, v] = self.strata.position(index, sampler.uniform_2d());
            let image_point = DVec2::new(x as f64 + u, y as f64 + v);
            mean.add(
                &self.sample(image_point, &mut sampler),
                1.0 / f64::from(samples),
            );
            unreported += 1;
            if unreported == REPORTED_AT_ONCE {
                (self.progress)(unreported);
                unreported = 0;
            }
        }
        (self.progress)(unreported);
        Ok(mean)
    }

    fn sample(&self, image_point: DVec2, sampler: &mut Sampler) -> Pixel {
        match self.pass {
            Pass::Laser(laser) => self.integrator.laser_sample(laser, image_point, sampler),
            Pass::Lamps => self.integrator.lamp_sample(image_point, sampler),
        }
    }

    /// Every pixel of every pass of every frame has a stream of random numbers of its own.
    fn stream(&self, x: usize, y: usize) -> u64 {
        let scene = self.integrator.scene;
        let pass = match self.pass {
            Pass::Laser(index) => index,
            Pass::Lamps => scene.lasers.len(),
        } as u64;
        let passes = scene.lasers.len() as u64 + 1;
        let pixel = (y * self.integrator.camera.width() + x) as u64;
        (u64::from(self.integrator.frame) * passes + pass) << 28 | pixel
    }
}

/// The most samples of a pixel that are done before progress is told.
const REPORTED_AT_ONCE: u64 = 1 << 12;
