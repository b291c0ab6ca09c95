use core::mem::take;

use glam::DVec2;
use tem00_camera::Ray;
use tem00_geometry::{Hit, Intersector, Segment};
use tem00_shading::LaserEventBatch;
use tem00_tracer::{
    SpeckleBelow,
    film::{LaserSample, Sample},
};

use super::PathRules;
use crate::{
    sampler::Stream,
    speckle::{SpeckleFrame, SpecklePoint},
    vertex::Vertex,
};

/// Camera samples that are traced together, and the state of their paths.
///
/// A sample's result does not depend on the others of its batch. The memory is kept from batch to
/// batch.
#[derive(Debug, Default)]
pub(crate) struct Batch<'a> {
    pub samples: Vec<CameraSample>,
    /// For each sample, its image point, in pixels.
    pub pixels: Vec<DVec2>,
    /// For each sample, its position in the pupil, as a pair of numbers in [0, 1).
    pub(super) lens: Vec<[f64; 2]>,
    /// For each sample, the solid angle that a pixel sees along its ray, in steradian.
    pub(super) solid_angles: Vec<f64>,
    /// For each sample, its values for each laser.
    pub(super) laser_samples: Vec<LaserSample>,
    /// The paths that continue, with the ray and the surface point of each.
    pub(super) paths: Vec<Path>,
    pub(super) rays: Vec<Ray>,
    pub(super) hits: Vec<Option<Hit>>,
    pub(super) vertices: Vec<Vertex<'a>>,
    /// For each sample, the ratio of the radiance at the camera to the radiance at the end of its
    /// path, by wavelength.
    pub(super) throughput: Vec<f64>,
    pub(super) connections: Connections,
    pub(super) lit: LaserEventBatch,
    pub(super) speckle: SpeckleLookUps,
    /// The rays followed since they were counted last.
    pub(super) rays_followed: u64,
}

/// A position in the image and in the pupil, and the light found there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CameraSample {
    /// The number of the pixel, among those that are sampled together.
    pub slot: usize,
    pub stream: Stream,
    pub found: Sample,
}

/// A path on its way from the camera.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    /// The index of the camera sample in the batch.
    pub sample: usize,
    /// The number of surfaces met.
    pub depth: u32,
    /// The number of rough surfaces left behind.
    pub rough: u32,
    /// The factor by which refraction has changed radiance without changing power.
    pub compression: f64,
    /// The density with which the ray's direction was drawn, per steradian; `None` at the camera
    /// and behind a mirror or glass.
    pub scattering_pdf: Option<f64>,
}

impl Path {
    pub(super) const fn of_sample(sample: usize) -> Self {
        Self {
            sample,
            depth: 0,
            rough: 0,
            compression: 1.0,
            scattering_pdf: None,
        }
    }
}

impl Batch<'_> {
    /// Forgets all samples.
    pub(crate) fn clear(&mut self) {
        self.samples.clear();
        self.pixels.clear();
        self.lens.clear();
    }

    /// Returns the number of rays followed, shadow rays included, since the last call.
    pub(crate) const fn take_ray_count(&mut self) -> u64 {
        core::mem::replace(&mut self.rays_followed, 0)
    }

    /// Returns the samples, each with its values for each laser.
    pub(crate) fn results(
        &self,
        lasers: usize,
    ) -> impl Iterator<Item = (&CameraSample, &[LaserSample])> {
        let values = move |index: usize| &self.laser_samples[index * lasers..][..lasers];
        let samples = self.samples.iter().enumerate();
        samples.map(move |(index, sample)| (sample, values(index)))
    }

    /// Makes room for the results of the samples.
    pub(super) fn prepare(&mut self, lasers: usize, wavelengths: usize) {
        let samples = self.samples.len();
        self.paths.clear();
        self.rays.clear();
        self.speckle.clear();
        self.laser_samples.clear();
        self.laser_samples
            .resize(samples * lasers, LaserSample::DARK);
        self.throughput.clear();
        self.throughput.resize(samples * wavelengths, 1.0);
    }
}

/// Pending shadow rays, and what each adds if it is unoccluded.
#[derive(Debug, Default)]
pub(super) struct Connections {
    segments: Vec<Segment>,
    arrivals: Vec<Arrival>,
    visible: Vec<bool>,
}

/// Light that arrives at the camera over a connection.
#[derive(Clone, Copy, Debug)]
pub(super) enum Arrival {
    /// Light of a laser.
    Laser {
        /// The index of the sample's values for the laser.
        slot: usize,
        radiance: f64,
        /// The power on the area that the sample covers.
        power: f64,
        /// True if the light has met one rough surface.
        is_single: bool,
    },
    /// Light of a laser from below the first rough surface.
    Below { slot: usize, radiance: f64 },
    /// Radiance of a light that is no laser.
    Light { sample: usize, radiance: f64 },
}

impl Arrival {
    fn add_to(&self, lasers: &mut [LaserSample], samples: &mut [CameraSample]) {
        match *self {
            Self::Laser {
                slot,
                radiance,
                power,
                is_single,
            } => {
                lasers[slot].add(radiance, is_single);
                lasers[slot].power += power;
            }
            Self::Below { slot, radiance } => lasers[slot].add_below(radiance),
            Self::Light { sample, radiance } => samples[sample].found.lights += radiance,
        }
    }
}

impl Connections {
    /// The maximum number of pending shadow rays.
    const CAPACITY: usize = 4096;

    pub(super) const fn is_full(&self) -> bool {
        self.segments.len() >= Self::CAPACITY
    }
}

impl Batch<'_> {
    /// Adds a shadow ray and the light that arrives if it is unoccluded.
    #[inline(always)]
    pub(super) fn connect(&mut self, segment: Segment, arrival: Arrival) {
        self.connections.segments.push(segment);
        self.connections.arrivals.push(arrival);
    }

    /// Adds the light of all unoccluded shadow rays, and clears the list.
    pub(super) fn resolve_connections(&mut self, intersector: &Intersector) {
        let connections = &mut self.connections;
        connections
            .visible
            .resize(connections.segments.len(), false);
        intersector.visible_batch(&connections.segments, &mut connections.visible);
        self.rays_followed += connections.segments.len() as u64;
        let arrivals = connections.arrivals.iter().zip(&connections.visible);
        for (arrival, _) in arrivals.filter(|(_, visible)| **visible) {
            arrival.add_to(&mut self.laser_samples, &mut self.samples);
        }
        connections.segments.clear();
        connections.arrivals.clear();
    }
}

/// The points where speckle is looked up, in the order in which paths have met them, with the
/// sample of each.
#[derive(Debug, Default)]
pub(super) struct SpeckleLookUps {
    samples: Vec<usize>,
    points: Vec<SpecklePoint>,
    /// Look-ups of one laser at a time.
    of_laser: LaserLookUps,
}

/// The points where the speckle of a laser is looked up, with the index of each sample's values for
/// it.
#[derive(Debug, Default)]
struct LaserLookUps {
    slots: Vec<usize>,
    points: Vec<SpecklePoint>,
    /// The radiance of the light that has met only the surface of each point.
    singles: Vec<f64>,
    /// The speckle of each light from below the surface.
    below: Vec<SpeckleBelow>,
    factors: Vec<f64>,
}

impl SpeckleLookUps {
    pub(super) fn clear(&mut self) {
        self.samples.clear();
        self.points.clear();
    }

    pub(super) fn push(&mut self, sample: usize, point: SpecklePoint) {
        self.samples.push(sample);
        self.points.push(point);
    }
}

impl LaserLookUps {
    fn clear(&mut self) {
        self.slots.clear();
        self.points.clear();
        self.singles.clear();
        self.below.clear();
    }

    /// Returns the factors of a laser at the points, each with its slot.
    fn look_up(
        &mut self,
        speckle: &SpeckleFrame<'_>,
        laser: usize,
    ) -> impl Iterator<Item = (usize, f64)> {
        self.factors.clear();
        self.factors.resize(self.points.len(), 1.0);
        speckle.factors(laser, &self.points, &self.singles, &mut self.factors);
        let slots = self.slots.iter().copied();
        slots.zip(self.factors.iter().copied())
    }
}

impl Batch<'_> {
    /// Leaves the light of the samples as it is.
    pub(super) fn settle_without_speckle(&mut self) {
        for laser in &mut self.laser_samples {
            laser.settle(1.0);
        }
    }

    /// Gives the light of the samples its speckle, and those without light a factor where `rules`
    /// want it.
    pub(super) fn settle(&mut self, speckle: &SpeckleFrame<'_>, rules: &PathRules) {
        let lasers = self.laser_samples.len() / self.samples.len().max(1);
        let SpeckleLookUps {
            samples,
            points,
            of_laser: look_ups,
        } = &mut self.speckle;
        for laser in 0..lasers {
            look_ups.clear();
            for (sample, point) in samples.iter().zip(&*points) {
                let slot = sample * lasers + laser;
                let light = &self.laser_samples[slot];
                if rules.speckle_in_the_dark || !light.is_dark() {
                    look_ups.slots.push(slot);
                    look_ups.points.push(*point);
                    look_ups.singles.push(light.single);
                }
            }
            for (slot, factor) in look_ups.look_up(speckle, laser) {
                self.laser_samples[slot].settle(factor);
            }
            look_ups.clear();
            for (sample, point) in samples.iter().zip(&*points) {
                let slot = sample * lasers + laser;
                let light = self.laser_samples[slot].below;
                let below = speckle.below(laser, point.surface);
                if let (true, Some(below)) = (light > 0.0, below) {
                    look_ups.slots.push(slot);
                    look_ups.points.push(SpecklePoint {
                        pixel: below.pixel(point.pixel),
                        wave: 0.5,
                        ..*point
                    });
                    look_ups.singles.push(light);
                    look_ups.below.push(*below);
                }
            }
            let below = take(&mut look_ups.below);
            for ((slot, factor), below) in look_ups.look_up(speckle, laser).zip(&below) {
                self.laser_samples[slot].settle_below(below.factor(factor));
            }
            look_ups.below = below;
        }
    }
}
