//! The reference integrator: one camera sample at a time, from the lens to the light.
//!
//! It is written to be read, and to judge `tem00-engine`, which renders the same scenes fast: all
//! means are the same, and no code is shared beyond the scene itself. Here the beam of a laser
//! lights a point, and the speckle multiplies that light by a factor that has moved with the
//! surface.

mod below;
mod from_laser;
mod lights;
mod point;
mod random;
mod speckle;

use core::sync::atomic::{AtomicBool, Ordering};

use glam::{DVec2, DVec3};
use tem00_camera::{Camera, Ray};
use tem00_geometry::{Hit, Intersector};
use tem00_numerics::parallel;
use tem00_shading::{Laser, LaserEvent, SpeckleFrame};

pub use self::speckle::ReferenceSpeckle;
use self::{point::Point, random::Random};
use crate::{
    FilterSampler, Frame, LaserEvents, Method, RenderError, RenderOptions, Scene, SpeckleBelow,
    film::{Film, FilmLayout, LaserSample, PixelSums, Sample, Seen},
};

/// The wavelength of lights in metres: they are white, and materials grey under them.
const WHITE: f64 = 550e-9;

/// The number of surfaces after which a path may end by chance.
const CERTAIN_SURFACES: u32 = 2;

/// Renders one frame, sample by sample, on the threads of the current rayon pool.
///
/// Every pixel gets the same number of samples. Without `speckle` every factor is 1. `progress`
/// receives the number of samples done since its last call; once `cancel` is set, the render stops
/// after the rows in work. The result has the same bits for any number of threads, and its means
/// equal the means of the engine.
///
/// # Errors
///
/// Returns [`RenderError::Cancelled`] if `cancel` was set before the end, and an error if an option
/// is out of its range, if the geometry cannot be built, or if the memory for layers or patterns is
/// not available.
///
/// # Panics
///
/// Panics unless `frame < scene.frames` and `speckle` was prepared for the scene.
pub fn render_reference(
    scene: &Scene,
    speckle: Option<&ReferenceSpeckle>,
    frame: u32,
    options: &RenderOptions,
    progress: &(dyn Fn(u64) + Sync),
    cancel: &AtomicBool,
) -> Result<Frame, RenderError> {
    assert!(frame < scene.frames, "frame {frame} of {}", scene.frames);
    let reference = Reference::new(scene, speckle, frame, options)?;
    let area = options.area(&scene.camera)?;
    scene.check_bodies(options)?;
    let is_light_traced =
        scene.has_specular_surfaces() && !options.samples_beams() || !reference.finds_lasers();
    let wavelengths: Vec<f64> = reference.lasers.iter().map(Laser::wavelength).collect();
    let mut film = Film::new(&FilmLayout {
        wavelengths: &wavelengths,
        area,
        strips: area.height,
        has_pilot: false,
        light_traced: is_light_traced,
    })?;
    let rows = parallel::map(area.height, |row| {
        if cancel.load(Ordering::Relaxed) {
            return Err(RenderError::Cancelled);
        }
        let columns = area.x..area.x + area.width;
        let pixels = columns.map(|column| reference.pixel([column, area.y + row]));
        let pixels: Vec<_> = pixels.collect();
        progress(area.width as u64 * u64::from(options.samples_per_pixel));
        Ok(pixels)
    });
    for (row, pixels) in rows.into_iter().enumerate() {
        for (column, (sums, rays)) in pixels?.iter().enumerate() {
            film.write(row, [column, row], sums);
            film.count_rays(*rays);
        }
    }
    let mut rendered = film.into_frame();
    if is_light_traced {
        reference.add_light_from_lasers(area, &mut rendered, progress, cancel)?;
    }
    Ok(rendered)
}

/// A scene as it stands in one frame.
struct Reference<'a> {
    scene: &'a Scene,
    options: &'a RenderOptions,
    frame: u32,
    camera: Camera,
    lasers: Vec<Laser>,
    /// The speckle of each laser on each surface; `None` on a surface that the camera never sees.
    speckle: Vec<Vec<Option<SpeckleFrame>>>,
    below: Vec<Vec<Option<SpeckleBelow>>>,
    intersector: Intersector,
    filter: FilterSampler,
}

/// A path from the camera.
struct Path {
    ray: Ray,
    /// The ratio of the radiance at the camera to the radiance at the end of the path: for each
    /// laser, and behind them for lights.
    throughput: Vec<f64>,
    /// The number of surfaces met, and of rough surfaces left.
    depth: u32,
    rough: u32,
    /// The change of radiance by refraction, which is no loss of power.
    compression: f64,
    /// The density with which the direction was drawn; `None` at the camera and behind mirrors and
    /// glass.
    pdf: Option<f64>,
    rays: u64,
}

impl<'a> Reference<'a> {
    fn new(
        scene: &'a Scene,
        speckle: Option<&ReferenceSpeckle>,
        frame: u32,
        options: &'a RenderOptions,
    ) -> Result<Self, RenderError> {
        let lasers = (0..scene.lasers.len()).map(|laser| scene.laser_at(laser, frame));
        let intersector = Intersector::build(&scene.shapes_at(frame))?;
        Ok(Self {
            scene,
            options,
            frame,
            camera: scene.camera_at(frame),
            lasers: lasers.collect(),
            speckle: match speckle {
                Some(speckle) => speckle.in_frame(scene, frame)?,
                None => vec![vec![None; scene.surfaces.len()]; scene.lasers.len()],
            },
            below: SpeckleBelow::in_frame(scene, frame, &intersector)?,
            intersector,
            filter: FilterSampler::new(options.filter)?,
        })
    }

    /// Returns whether paths from the camera look for light of the lasers.
    fn finds_lasers(&self) -> bool {
        self.options.method == Method::Path
    }

    /// Returns the sums over the samples of a pixel, and the number of their rays.
    fn pixel(&self, at: [usize; 2]) -> (PixelSums, u64) {
        let mut random = Random::new(
            self.options.seed,
            [u64::from(self.frame), at[0] as u64, at[1] as u64],
        );
        let mut sums = PixelSums::new(self.lasers.len());
        let mut rays = 0;
        for _ in 0..self.options.samples_per_pixel {
            rays += self.sample(at, &mut random, &mut sums);
        }
        (sums, rays)
    }

    /// Follows one sample, adds what it finds to the sums of its pixel, and returns the number of
    /// its rays.
    fn sample(&self, [x, y]: [usize; 2], random: &mut Random, sums: &mut PixelSums) -> u64 {
        // A point of the image and one of the lens make a ray.
        let beside = self.filter.sample(random.pair());
        let pixel = DVec2::new(x as f64 + 0.5, y as f64 + 0.5) + beside.offset;
        let through_lens = self.camera.sample_ray(pixel, random.pair());
        let mut path = Path {
            ray: through_lens.ray,
            throughput: vec![1.0; self.lasers.len() + 1],
            depth: 0,
            rough: 0,
            compression: 1.0,
            pdf: None,
            rays: 0,
        };
        let mut sample = Sample {
            weight: beside.weight,
            lights: 0.0,
            seen: None,
        };
        let mut lasers = vec![LaserSample::DARK; self.lasers.len()];
        let mut first_rough = None;
        loop {
            let hit = self.intersector.intersect(&path.ray);
            path.rays += 1;
            // Light that the ray meets by chance.
            sample.lights += self.lights_met(&path, hit.as_ref());
            self.meet_lasers(&path, hit.as_ref(), &mut lasers);
            let Some(hit) = hit else { break };
            let point = self.point(&path.ray, &hit);
            if path.depth == 0 {
                sample.seen = Some(self.seen(&path.ray, &hit, point.as_ref()));
            }
            let Some(point) = point else { break };
            path.depth += 1;
            if self.options.max_depth.is_some_and(|max| path.depth > max) {
                break;
            }
            if !point.material.is_specular() {
                first_rough.get_or_insert((hit.surface, hit.position, point.seen_normal()));
                // Light that comes straight from a laser or a light.
                let solid_angle = through_lens.solid_angle;
                self.connect_to_lasers(&mut path, &point, solid_angle, random, &mut lasers);
                self.connect_below(&mut path, &point, random, &mut lasers);
                sample.lights += self.light_connected(&mut path, &point, random);
            }
            // Light that comes from elsewhere.
            if !self.scatter(&mut path, &point, random) {
                break;
            }
        }
        // All light of a laser carries the speckle of the first rough surface, seen from the
        // camera.
        for (laser, found) in lasers.iter_mut().enumerate() {
            let factor = first_rough.map_or(1.0, |(surface, position, normal)| {
                self.factor(laser, surface, pixel, position, normal)
            });
            found.settle(factor);
            if let (Some((surface, position, normal)), true) = (first_rough, found.below > 0.0) {
                let point = (pixel, position, normal);
                found.settle_below(self.factor_below(laser, surface, point));
            }
        }
        sums.add(&sample, &lasers);
        path.rays
    }

    /// Returns the speckle factor of a laser at a point that the sample at `pixel` sees: looked up
    /// where the point stood in the reference frame, in the slice that the motion since then leads
    /// to.
    fn factor(&self, laser: usize, surface: usize, pixel: DVec2, p: DVec3, n: DVec3) -> f64 {
        let frame = self.speckle[laser][surface].as_ref();
        frame.map_or(1.0, |frame| frame.factor_at(pixel, p, n))
    }

    /// Returns the surface point where a ray arrives; `None` at a light, and along a surface.
    fn point(&self, ray: &Ray, hit: &Hit) -> Option<Point<'a>> {
        let surface = self.scene.surfaces.get(hit.surface)?;
        Point::new(ray, hit, &surface.material)
    }

    fn seen(&self, ray: &Ray, hit: &Hit, point: Option<&Point<'_>>) -> Seen {
        let towards = self.camera.axes().z_axis;
        let facing = -hit.normal * hit.normal.dot(ray.direction).signum();
        Seen {
            depth: (self.camera.position() - hit.position).dot(towards),
            normal: point.map_or(facing, Point::seen_normal),
        }
    }

    /// Connects a rough point to every laser: along the mean energy flow of its beam, which has the
    /// irradiance of all of it, or along a direction drawn from those in which light arrives.
    fn connect_to_lasers(
        &self,
        path: &mut Path,
        point: &Point<'_>,
        solid_angle: f64,
        random: &mut Random,
        lasers: &mut [LaserSample],
    ) {
        for (index, laser) in self
            .lasers
            .iter()
            .enumerate()
            .filter(|_| self.finds_lasers())
        {
            let position = point.hit.position;
            let event = match self.options.laser_events {
                LaserEvents::Beam => laser.next_event(position).map(|event| (event, None)),
                LaserEvents::Sampled => {
                    let drawn = laser.next_event_sampled(position, random.pair());
                    drawn.map(|drawn| {
                        let (point, wi, e_perp) = (drawn.point, drawn.wi, drawn.value);
                        (LaserEvent { point, wi, e_perp }, Some(drawn.pdf))
                    })
                }
            };
            let Some((event, pdf)) = event else { continue };
            let Some(wi) = point.towards(event.wi) else {
                continue;
            };
            path.rays += 1;
            if !self
                .intersector
                .visible(position, point.hit.normal, event.point)
            {
                continue;
            }
            // A drawn direction could have been drawn by the material, too.
            let weight = pdf.map_or(1.0, |pdf| power_heuristic(pdf, point.pdf(wi)));
            let reflected = match path.rough {
                0 => point.reflected_by_boundary(wi, laser.wavelength()),
                _ => point.reflected(wi, laser.wavelength()),
            };
            let radiance = weight * path.throughput[index] * event.e_perp * reflected;
            lasers[index].add(radiance, path.rough == 0);
            if path.depth == 1 && wi.z * point.back.z > 0.0 {
                // The sample covers so much of the surface.
                let area = solid_angle * point.hit.distance.powi(2) / point.cosine.abs();
                let irradiance = event.e_perp * point.hit.normal.dot(event.wi).abs();
                lasers[index].power += irradiance * area;
            }
        }
    }

    /// Adds the light of sampled lasers whose beams a ray from a rough surface follows backwards.
    fn meet_lasers(&self, path: &Path, hit: Option<&Hit>, lasers: &mut [LaserSample]) {
        if !self.options.samples_beams() || !self.finds_lasers() || path.rough == 0 {
            return;
        }
        let Ray { origin, direction } = path.ray;
        for (index, laser) in self.lasers.iter().enumerate() {
            let Some(distance) = laser.aperture_distance(origin, direction) else {
                continue;
            };
            if hit.is_some_and(|hit| self.intersector.hides(hit, &path.ray, distance)) {
                continue;
            }
            let weight = path.pdf.map_or(1.0, |pdf| {
                power_heuristic(pdf, laser.next_event_pdf(origin, direction))
            });
            let radiance = weight * path.throughput[index] * laser.radiance(origin, direction);
            lasers[index].add(radiance, path.rough == 1);
        }
    }

    /// Sends a path on in a direction drawn from the material; returns whether it continues.
    fn scatter(&self, path: &mut Path, point: &Point<'_>, random: &mut Random) -> bool {
        let wavelengths = self.lasers.iter().map(Laser::wavelength).chain([WHITE]);
        let first = wavelengths.clone().next().unwrap_or(WHITE);
        let Some(drawn) = point.material.sample(point.back, random.pair(), first) else {
            return false;
        };
        let direction = point.axes.to_world(drawn.wi);
        if point.towards(direction).is_none() {
            return false;
        }
        for (throughput, wavelength) in path.throughput.iter_mut().zip(wavelengths) {
            *throughput *= point.material.reweighted(point.back, &drawn, wavelength);
        }
        path.compression *= drawn.eta_squared;
        // Long and dark paths end by chance; the paths that continue represent them.
        let largest = path.throughput.iter().copied().fold(0.0, f64::max);
        if path.depth > CERTAIN_SURFACES {
            let survival = (largest * path.compression).min(0.95);
            if random.number() >= survival {
                return false;
            }
            path.throughput
                .iter_mut()
                .for_each(|value| *value /= survival);
        }
        path.rough += u32::from(!drawn.specular);
        path.pdf = (!drawn.specular).then_some(drawn.pdf);
        path.ray = self
            .intersector
            .ray_from(point.hit.position, point.hit.normal, direction);
        largest > 0.0
    }
}

/// Returns the weight of a direction drawn with the density `pdf` that could have been drawn with
/// the density `other`, by the power heuristic of E. Veach, *Robust Monte Carlo Methods for Light
/// Transport Simulation*, 1997, § 9.2.4.
fn power_heuristic(pdf: f64, other: f64) -> f64 {
    let ratio = other / pdf;
    1.0 / (1.0 + ratio * ratio)
}
