//! From camera samples to radiance: paths, all samples of a few pixels together, stage by stage.

mod batch;
mod lasers;
mod lights;
mod lit_points;
mod rules;
mod weights;

use core::mem::take;

use glam::DVec3;
use tem00_camera::{Camera, Ray};
use tem00_geometry::{Hit, Intersector};
use tem00_tracer::{Laser, Light, RenderOptions, Scene, film::Seen};

use self::{batch::Path, lit_points::LitPoints, rules::Bands};
pub(crate) use self::{
    batch::{Batch, CameraSample},
    rules::{PathRules, is_plate},
};
use crate::{
    sampler::{DrawKey, Sequence, Stream, Use, sample_counts},
    speckle::{SpeckleFrame, SpecklePoint},
    vertex::Vertex,
    walk::Roulette,
};

/// Russian roulette: a path always leaves this number of surfaces before it may end by chance. In a
/// box of albedo 0.6 a second one takes 0.62 of the variance for 1.3 times the time.
const ROULETTE: Roulette = Roulette { certain: 2 };

/// Everything that one frame needs to turn camera samples into radiance.
#[derive(Debug)]
pub(crate) struct Integrator<'a> {
    scene: &'a Scene,
    camera: Camera,
    /// The direction in which the camera looks.
    camera_axis: DVec3,
    lasers: Vec<Laser>,
    /// Points that each laser lights, if surfaces are connected to them.
    lit_points: Vec<LitPoints<'a>>,
    intersector: &'a Intersector,
    /// True if a surface is translucent.
    has_bodies: bool,
    speckle: Option<&'a SpeckleFrame<'a>>,
    rules: PathRules,
    roulette: Roulette,
    /// One point sequence per possible sample count.
    sequences: Vec<Sequence>,
    bands: Bands,
    /// The lights that rays can meet, in the order of their shapes behind the surfaces.
    light_shapes: Vec<usize>,
    /// The lights that rays meet where they meet nothing else.
    environments: Vec<usize>,
}

impl<'a> Integrator<'a> {
    /// Prepares a frame of a scene.
    pub(crate) fn new(
        scene: &'a Scene,
        frame: u32,
        intersector: &'a Intersector,
        options: &RenderOptions,
    ) -> Self {
        let lights = |is_meant: fn(&Light) -> bool| {
            let lights = scene.lights.iter().enumerate();
            lights
                .filter(|(_, light)| is_meant(light))
                .map(|(index, _)| index)
                .collect()
        };
        let mut rules = PathRules::from(options);
        if is_plate(scene) {
            rules.max_depth = rules.max_depth.min(1);
        }
        let camera = scene.camera_at(frame);
        let lasers: Vec<_> = scene
            .lasers
            .iter()
            .map(|laser| laser.in_frame(frame))
            .collect();
        let counts = sample_counts(options);
        // All lasers draw the same numbers: a laser alone gives the same bits as a laser among
        // others.
        let key = DrawKey {
            seed: options.seed,
            frame,
            laser: 0,
            group: u64::MAX,
        };
        let max = counts[counts.len() - 1];
        let lit_by = |laser| LitPoints::new(scene, laser, key, intersector, max);
        let lit_points = if rules.connects_to_lit_points() {
            lasers.iter().map(lit_by).collect()
        } else {
            Vec::new()
        };
        // Where all light comes from lasers, the first vertices have found most of it by their
        // connections.
        let roulette = match scene.lights.is_empty() && !lit_points.is_empty() {
            true => Roulette { certain: 0 },
            false => ROULETTE,
        };
        Self {
            scene,
            camera,
            camera_axis: -camera.axes().z_axis,
            lasers,
            lit_points,
            intersector,
            has_bodies: (scene.surfaces.iter()).any(|surface| surface.material.below().is_some()),
            speckle: None,
            rules,
            roulette,
            sequences: counts.into_iter().map(Sequence::new).collect(),
            bands: Bands::new(&scene.lasers, &scene.lights),
            light_shapes: lights(|light| matches!(light, Light::Area { .. })),
            environments: lights(|light| matches!(light, Light::Environment(_))),
        }
    }

    /// Multiplies coherent light by the speckle of the frame.
    pub(crate) fn with_speckle(mut self, speckle: Option<&'a SpeckleFrame<'a>>) -> Self {
        self.speckle = speckle;
        self
    }

    /// Returns the camera of the frame.
    pub(crate) fn camera(&self) -> &Camera {
        &self.camera
    }

    /// Returns the random numbers of a pixel.
    pub(crate) fn sequence(&self, stream: Stream) -> &Sequence {
        &self.sequences[usize::from(stream.level)]
    }

    /// Returns the wavelengths of the lasers, in metres.
    pub(crate) fn laser_wavelengths(&self) -> impl Iterator<Item = f64> {
        self.lasers.iter().map(Laser::wavelength)
    }

    /// Returns the number of lasers.
    pub(crate) fn laser_count(&self) -> usize {
        self.lasers.len()
    }
}

impl<'a> Integrator<'a> {
    /// Traces the paths of all camera samples of a batch.
    pub(crate) fn trace(&self, batch: &mut Batch<'a>) {
        self.start(batch);
        while !batch.paths.is_empty() {
            // Find the surfaces that the rays meet, and take the radiance of lights met by chance.
            self.arrive(batch);
            // Connect the surfaces to all sources of light.
            self.connect_to_lasers(batch);
            self.connect_to_lit_points(batch);
            self.connect_to_lights(batch);
            // Remember the first rough surface of each path: all light of the path has its speckle.
            self.note_speckle(batch);
            // Choose how the paths continue.
            self.scatter(batch);
        }
        match self.speckle {
            Some(speckle) => batch.settle(speckle, &self.rules),
            None => batch.settle_without_speckle(),
        }
    }

    /// Draws positions in the pupil for the samples that have none yet, starting with the sample of
    /// the stream `first`; a pinhole has only its centre.
    pub(crate) fn draw_lens(&self, first: Stream, batch: &mut Batch<'a>) {
        let drawn = batch.lens.len();
        batch.lens.resize(batch.samples.len(), [0.5, 0.5]);
        if self.camera.description().depth_of_field {
            let lens = &mut batch.lens[drawn..];
            self.sequence(first).pairs(first, Use::Lens, lens);
        }
    }

    /// Sends a ray from the camera for each sample.
    fn start(&self, batch: &mut Batch<'a>) {
        const NONE: Ray = Ray {
            origin: DVec3::ZERO,
            direction: DVec3::Z,
        };
        batch.prepare(self.lasers.len(), self.bands.wavelengths.len());
        let samples = batch.samples.len();
        batch.paths.extend((0..samples).map(Path::of_sample));
        batch.rays.resize(samples, NONE);
        batch.solid_angles.resize(samples, 0.0);
        self.camera.sample_rays(
            &batch.pixels,
            &batch.lens,
            &mut batch.rays,
            &mut batch.solid_angles,
        );
    }

    /// Moves every path to the surface that its ray meets; ends those that meet a light or nothing.
    fn arrive(&self, batch: &mut Batch<'a>) {
        batch.hits.resize(batch.rays.len(), None);
        self.intersector
            .intersect_batch(&batch.rays, &mut batch.hits);
        batch.rays_followed += batch.rays.len() as u64;
        batch.vertices.clear();
        let hits = take(&mut batch.hits);
        let mut kept = 0;
        for (index, hit) in hits.iter().map(Option::as_ref).enumerate() {
            let (mut path, ray) = (batch.paths[index], batch.rays[index]);
            // The radiance that a ray meets by chance: the radiance of lights and of sampled
            // lasers.
            self.meet_lights(&path, &ray, hit, batch);
            self.meet_lasers(&path, &ray, hit, batch);
            let Some(vertex) = hit.and_then(|hit| self.vertex(&ray, hit)) else {
                self.see_light(&path, &ray, hit, batch);
                continue;
            };
            path.depth += 1;
            if path.depth == 1 {
                batch.samples[path.sample].found.seen =
                    Some(self.seen(vertex.hit.position, vertex.seen_normal()));
            }
            if path.depth <= self.rules.max_depth {
                batch.vertices.push(vertex);
                batch.paths[kept] = path;
                batch.rays[kept] = ray;
                kept += 1;
            }
        }
        batch.hits = hits;
        batch.paths.truncate(kept);
        batch.rays.truncate(kept);
    }

    /// Returns the surface point that a ray meets, or `None` where it meets a light.
    fn vertex(&self, ray: &Ray, hit: &Hit) -> Option<Vertex<'a>> {
        let surface = self.scene.surfaces.get(hit.surface)?;
        Vertex::seen(ray, hit, &surface.material)
    }

    fn seen(&self, position: DVec3, normal: DVec3) -> Seen {
        let depth = (position - self.camera.position()).dot(self.camera_axis);
        Seen { depth, normal }
    }

    /// Records the position of a light that the camera sees.
    fn see_light(&self, path: &Path, ray: &Ray, hit: Option<&Hit>, batch: &mut Batch<'a>) {
        if let Some(hit) = hit.filter(|_| path.depth == 0) {
            let normal = -hit.normal * hit.normal.dot(ray.direction).signum();
            batch.samples[path.sample].found.seen = Some(self.seen(hit.position, normal));
        }
    }

    /// Notes where paths meet their first rough surface.
    fn note_speckle(&self, batch: &mut Batch<'a>) {
        if self.speckle.is_none() {
            return;
        }
        for (path, vertex) in batch.paths.iter().zip(&batch.vertices) {
            if path.rough == 0 && !vertex.is_specular() {
                let point = SpecklePoint {
                    pixel: batch.pixels[path.sample],
                    position: vertex.hit.position,
                    normal: vertex.seen_normal(),
                    surface: vertex.hit.surface,
                    wave: self.drawn_wave(batch.samples[path.sample].stream),
                };
                batch.speckle.push(path.sample, point);
            }
        }
    }

    /// Draws the position within the spectra of the lasers, if one of them has a width.
    fn drawn_wave(&self, stream: Stream) -> f64 {
        let lasers = self.lasers.iter();
        let is_wide = lasers
            .map(|laser| laser.spectrum())
            .any(|line| !line.is_monochromatic());
        if is_wide {
            self.sequence(stream).uniform(stream, Use::Wave)
        } else {
            0.5
        }
    }

    /// Sends every path on in a direction drawn from its material, or ends it.
    fn scatter(&self, batch: &mut Batch<'a>) {
        let wavelengths = self.bands.wavelengths.len();
        let mut kept = 0;
        // All paths have met the same number of surfaces.
        let depth = batch.paths.first().map_or(0, |path| path.depth);
        let ends = depth == self.rules.max_depth && !self.meets_light(true);
        let paths = if ends { 0 } else { batch.paths.len() };
        for index in 0..paths {
            let (path, vertex) = (batch.paths[index], &batch.vertices[index]);
            let stream = batch.samples[path.sample].stream;
            let throughput = &mut batch.throughput[path.sample * wavelengths..][..wavelengths];
            if let Some((next, ray)) = self.scattered(path, vertex, stream, throughput) {
                batch.paths[kept] = next;
                batch.rays[kept] = ray;
                kept += 1;
            }
        }
        batch.paths.truncate(kept);
        batch.rays.truncate(kept);
    }

    fn scattered(
        &self,
        path: Path,
        vertex: &Vertex<'a>,
        stream: Stream,
        throughput: &mut [f64],
    ) -> Option<(Path, Ray)> {
        if path.depth == self.rules.max_depth && !self.meets_light(vertex.is_specular()) {
            return None;
        }
        // Choose the direction.
        let wavelengths = &self.bands.wavelengths;
        let u = self
            .sequence(stream)
            .pair(stream, Use::Scattering(path.depth));
        let event = vertex.sample(u, *wavelengths.first()?)?;
        // Weight each wavelength.
        let mut largest = 0.0_f64;
        for (throughput, &wavelength) in throughput.iter_mut().zip(wavelengths) {
            *throughput *= vertex.weight(&event, wavelength);
            largest = largest.max(*throughput);
        }
        // End long and dark paths by chance, without bias; glass makes a path dark only for a
        // while.
        let compression = path.compression * event.eta_squared;
        let sequence = self.sequence(stream);
        let draw = || sequence.uniform(stream, Use::Survival(path.depth));
        let survived = (self.roulette).survived(path.depth, largest * compression, draw)?;
        throughput.iter_mut().for_each(|value| *value /= survived);
        let next = Path {
            rough: path.rough + u32::from(!event.specular),
            compression,
            scattering_pdf: (!event.specular).then_some(event.pdf),
            ..path
        };
        let ray = vertex.leave(self.intersector, event.wi);
        (path.depth < self.rules.max_depth || self.finds_light(&ray)).then_some((next, ray))
    }

    /// Returns whether a ray can find light if no surface may follow.
    #[inline(never)] // It is rare beside what surrounds it.
    fn finds_light(&self, ray: &Ray) -> bool {
        self.may_meet_light(ray) || self.rays_meet_lasers()
    }

    /// Returns whether a ray from a surface can still find light where no surface may follow.
    fn meets_light(&self, specular: bool) -> bool {
        self.rays_meet_lights(specular) || self.rays_meet_lasers()
    }
}
