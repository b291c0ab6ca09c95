//! A set-up that measures artefacts.

use core::{fmt, sync::atomic::AtomicBool};

use glam::DVec2;
use tem00_calibration::CalibrationSettings;
use tem00_camera::{Camera, CameraDescription};
use tem00_engine::render_frame;
use tem00_geometry::{Rectangle, Shape as Surface, Sphere, TriangleMesh};
use tem00_numerics::{
    Grid,
    cast::{to_f32, to_usize},
    seed::{Purpose, derived},
};
use tem00_topography::{Artefact, Axis, DVec3, Field, Groove, ProfileSensor, Shape, SurfacePoint};
use tem00_tracer::{Filter, Keyframe, RenderOptions, Scene, TracerError, Trajectory};
use tem00_triangulation::{LineImage, Setup};

use crate::{
    Averaging, Exposure, MeasuredFrame, MeasuredPoint, Measurement, MeasurementScene, ScanError,
    ScanSettings, average::averaged_profile, setup_scene,
};

/// The depth of grooves, as a fraction of the height that moves the line by its own thickness.
const GROOVE_DEPTH: f64 = 0.5;
/// The number of pixels that are rendered next to an artefact.
const BESIDE: f64 = 8.0;
/// The frames of one scene: few, so that they need few rows of the image.
const FRAMES: usize = 8;

/// The minimum number of rows of a set-up.
const MIN_ROWS: usize = 16;

/// A set-up in front of which artefacts are rendered.
///
/// The artefacts are of the set-up's surface, under its line; camera and laser plane are known
/// exactly. A profile is one frame, its columns averaged as the set-up says. The tracer renders the
/// light on an artefact as a lens without blur sees it, in parts of pixels; a [`LineImage`] then
/// adds the effect of the lens, with diffraction, defocus and speckle as waves have them.
///
/// # Validity
///
/// A whole profile counts as equally far out of focus as the middle of its heights.
#[derive(Clone)]
pub struct SetupSensor<'a> {
    setup: &'a Setup,
    samples_per_pixel: u32,
    seed: u64,
    progress: &'a dyn Fn(&'static str),
    cancel: &'a AtomicBool,
}

impl fmt::Debug for SetupSensor<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SetupSensor")
            .field("setup", self.setup)
            .field("samples_per_pixel", &self.samples_per_pixel)
            .field("seed", &self.seed)
            .finish_non_exhaustive()
    }
}

impl<'a> SetupSensor<'a> {
    /// Creates a sensor that renders a number of samples per pixel. `progress` receives the name of
    /// the artefact after each profile.
    pub const fn new(
        setup: &'a Setup,
        samples_per_pixel: u32,
        seed: u64,
        progress: &'a dyn Fn(&'static str),
        cancel: &'a AtomicBool,
    ) -> Self {
        Self {
            setup,
            samples_per_pixel,
            seed,
            progress,
            cancel,
        }
    }

    /// Returns the scene of an artefact with a frame for each of its places.
    fn scene(
        &self,
        artefact: &Artefact,
        frames: &[&[DVec3]],
    ) -> Result<MeasurementScene, ScanError> {
        let mut scene = setup_scene(self.setup, 0.0)?;
        let places: Vec<DVec3> = frames.iter().map(|same| same[0]).collect();
        scene.camera = self.camera(artefact, &places)?;
        let surface = &mut scene.surfaces[0];
        surface.shape = shape(artefact)?;
        surface.trajectory = self.trajectory(&places)?;
        let description = self.setup.description();
        Ok(MeasurementScene {
            scene: Scene {
                frames: u32::try_from(places.len()).unwrap_or(u32::MAX),
                render: RenderOptions {
                    samples_per_pixel: self.samples_per_pixel,
                    seed: self.seed,
                    ..scene.render
                },
                ..scene
            },
            sensor: description.sensor,
            detector: *self.setup.detector().settings(),
            calibration: CalibrationSettings::default(),
            scan: ScanSettings::default(),
        })
    }

    /// Returns the scene as a lens without blur sees it, in `parts` of each pixel.
    fn sharp(&self, scene: &Scene, parts: usize) -> Result<Scene, ScanError> {
        let camera = scene.camera.description();
        let finer = parts as f64;
        let in_pixel = u32::try_from(parts * parts).unwrap_or(u32::MAX);
        Ok(Scene {
            camera: Camera::new(CameraDescription {
                pixel_pitch: camera.pixel_pitch / finer,
                resolution: camera.resolution.map(|pixels| parts * pixels),
                principal_point: camera.principal_point.map(|point| finer * point),
                depth_of_field: false,
                ..*camera
            })?,
            render: RenderOptions {
                samples_per_pixel: scene.render.samples_per_pixel.div_ceil(in_pixel),
                filter: Filter::Box { radius: 0.5 },
                ..scene.render
            },
            ..scene.clone()
        })
    }

    /// Returns the light that falls on the sensor in a frame of a scene, with the middle of the
    /// artefact's heights at `height`.
    fn exposure(
        &self,
        measurement: &Measurement,
        frame: u32,
        height: f64,
    ) -> Result<Exposure, ScanError> {
        let scene = measurement.scene();
        let line = self.setup.line_at(height).ok_or_else(|| {
            ScanError::Scene(format!("the camera does not see the line at {height} m"))
        })?;
        let size = [scene.camera.width(), scene.camera.height()];
        let image = LineImage::of_line(self.setup, &line, size)?;
        let parts = image.parts_of_pixel();
        let sharp = self.sharp(scene, parts)?;
        let options = &sharp.render;
        let rendered = render_frame(&sharp, None, frame, options, &|_| (), self.cancel)?;
        let light = Exposure::of_frame(&rendered, &sharp.camera, measurement.sensor());
        let light = light
            .electrons
            .map(|&electrons| electrons / to_f32((parts * parts) as f64));
        let light = image.spread(light);
        let seed = scene.render.seed.wrapping_add(u64::from(frame));
        let without_speckle = sums(&light, parts);
        Ok(Exposure {
            electrons: image.speckled_light(seed, &light)?,
            multiple: Grid::filled(size[0], size[1], 0.0),
            coherent: without_speckle.clone(),
            without_speckle,
        })
    }

    /// Returns the camera with the part of the image in which the line on an artefact may be, at
    /// any of its places.
    fn camera(&self, artefact: &Artefact, places: &[DVec3]) -> Result<Camera, ScanError> {
        let whole_image = self.setup.camera();
        let column = self.setup.field_width() / whole_image.width() as f64;
        let beside = whole_image.width() / 2;
        let left = beside.saturating_sub(whole(0.5 * artefact.size[0] / column + BESIDE));
        let [first, last] = self.rows(artefact, places);
        let description = whole_image.description();
        Ok(Camera::new(CameraDescription {
            resolution: [whole_image.width() - 2 * left, last - first],
            principal_point: Some(description.axis_point() - DVec2::new(left as f64, first as f64)),
            ..*description
        })?)
    }

    /// Returns the first row in which the line on an artefact may be, and the row after the last.
    fn rows(&self, artefact: &Artefact, places: &[DVec3]) -> [usize; 2] {
        let [_, height] = self.setup.description().camera.resolution;
        let window = self.setup.detector().settings().window as f64;
        let margin = window + BESIDE + 2.0 * self.setup.line().width;
        let seen = places.iter().flat_map(|place| {
            let sections = artefact.heights_along(-place.y);
            sections.map(move |(x, z)| DVec3::new(x, 0.0, z + place.z))
        });
        let rows = seen.filter_map(|point| {
            let point = point + self.beside(point) * DVec3::Y;
            self.setup.camera().project(point).map(|pixel| pixel.y)
        });
        let (low, high) = rows.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), row| {
            (low.min(row), high.max(row))
        });
        if low > high {
            return [0, height];
        }
        let last = whole(high + margin).clamp(MIN_ROWS, height);
        [whole(low - margin).min(last - MIN_ROWS), last]
    }

    /// The distance along y of the laser plane from a point.
    fn beside(&self, point: DVec3) -> f64 {
        let plane = self.setup.triangulator().plane();
        -plane.distance(point) / plane.normal().y
    }

    /// The motion from place to place, so that the laser plane meets the section y = 0.
    fn trajectory(&self, places: &[DVec3]) -> Result<Trajectory, TracerError> {
        let keyframes = places.iter().zip(0_u32..);
        let keyframes = keyframes.map(|(place, frame)| Keyframe {
            displacement: *place + self.beside(place.with_y(0.0)) * DVec3::Y,
            ..Keyframe::unmoved(f64::from(frame))
        });
        Ok(Trajectory::keyframed(DVec3::ZERO, keyframes)?)
    }

    /// Returns the points that are trusted, their columns averaged.
    fn points(&self, frame: &MeasuredFrame) -> Vec<SurfacePoint> {
        let columns = self.setup.description().average.columns as usize;
        let averaging = Averaging { frames: 1, columns };
        // Positions do not depend on the correlation.
        let points = averaged_profile(core::slice::from_ref(frame), averaging, |_, _| 0.0);
        let point = |measured: MeasuredPoint| SurfacePoint {
            column: measured.seen.column / columns,
            position: measured.position,
        };
        points.into_iter().map(point).collect()
    }
}

impl ProfileSensor for SetupSensor<'_> {
    type Error = ScanError;

    fn field(&self) -> Field {
        let description = self.setup.description();
        let range = self.setup.measuring_range();
        let (width, thickness) = (self.setup.field_width(), description.laser.line_thickness);
        let column = width / description.camera.resolution[0] as f64;
        Field {
            width: width.min(description.laser.line_length),
            heights: [range.low, range.high],
            column: column * f64::from(description.average.columns),
            thickness,
            groove_depth: GROOVE_DEPTH * thickness / description.camera.angle.tan(),
        }
    }

    fn measure(
        &mut self,
        artefact: &Artefact,
        places: &[DVec3],
    ) -> Result<Vec<Vec<SurfacePoint>>, ScanError> {
        let frames: Vec<&[DVec3]> = places.chunk_by(|a, b| a == b).collect();
        let mut profiles = Vec::new();
        for frames in frames.chunks(FRAMES) {
            // Each scene has its own speckle and noise.
            self.seed = derived(self.seed, Purpose::Frame, 0);
            let measurement = Measurement::new(self.scene(artefact, frames)?)?;
            for (same, number) in frames.iter().zip(0..) {
                let height = middle_height(artefact, same[0]);
                let exposure = self.exposure(&measurement, number, height)?;
                let frame = measurement.measure_light(exposure, number, true)?;
                profiles.push(self.points(&frame));
                for _ in 1..same.len() {
                    let repetition = u32::try_from(profiles.len()).unwrap_or(u32::MAX);
                    profiles.push(self.points(&measurement.repeat(&frame, repetition)?));
                }
                same.iter().for_each(|_| (self.progress)(artefact.name));
            }
        }
        Ok(profiles)
    }
}

/// Returns the sums of the parts of each pixel.
fn sums(light: &Grid<f32>, parts: usize) -> Grid<f32> {
    Grid::from_fn(light.width() / parts, light.height() / parts, |x, y| {
        let rows = (parts * y..parts * (y + 1)).map(|y| &light.row(y)[parts * x..parts * (x + 1)]);
        rows.flatten().sum()
    })
}

/// Returns the middle of the heights of an artefact along the line.
fn middle_height(artefact: &Artefact, place: DVec3) -> f64 {
    let heights = artefact.heights_along(-place.y).map(|(_, height)| height);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    let middle = if low > high { 0.0 } else { 0.5 * (low + high) };
    place.z + middle
}

/// A number of pixels, rounded up; at least 0.
fn whole(pixels: f64) -> usize {
    to_usize(pixels.ceil())
}

/// The shape of an artefact about its origin.
fn shape(artefact: &Artefact) -> Result<Surface, ScanError> {
    let [half_x, half_y] = artefact.size.map(|side| 0.5 * side);
    Ok(match &artefact.shape {
        Shape::Flat { slope } => Surface::Rectangle(Rectangle::new(
            DVec3::ZERO,
            half_x * DVec3::new(1.0, 0.0, slope[0]),
            half_y * DVec3::new(0.0, 1.0, slope[1]),
        )?),
        Shape::Sphere { radius } => Surface::Sphere(Sphere::new(-radius * DVec3::Z, *radius)?),
        Shape::Grooves {
            across,
            depth,
            grooves,
        } => grooved(*across, -depth, grooves, [half_x, half_y])?,
    })
}

/// Land at the height 0 with grooves whose floors are at another.
fn grooved(
    across: Axis,
    floor: f64,
    grooves: &[Groove],
    [half_x, half_y]: [f64; 2],
) -> Result<Surface, ScanError> {
    let (half, length) = match across {
        Axis::X => (half_x, half_y),
        Axis::Y => (half_y, half_x),
    };
    let walls = grooves.iter().flat_map(|groove| {
        let [left, right] = groove.walls();
        [(left, 0.0), (left, floor), (right, floor), (right, 0.0)]
    });
    let section = core::iter::once((-half, 0.0))
        .chain(walls)
        .chain([(half, 0.0)]);
    let vertices: Vec<DVec3> = section
        .flat_map(|(place, height)| {
            [-length, length].map(|along| match across {
                Axis::X => DVec3::new(place, along, height),
                Axis::Y => DVec3::new(-along, place, height),
            })
        })
        .collect();
    let strips = 0..u32::try_from(vertices.len() / 2 - 1).unwrap_or(u32::MAX);
    let triangles = strips.flat_map(|strip| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|corner| 2 * strip + corner);
        [[a, c, d], [a, d, b]]
    });
    TriangleMesh::new(vertices, triangles.collect())
        .map(Surface::from)
        .map_err(|error| ScanError::Scene(error.to_string()))
}
