use glam::DVec3;
use tem00_geometry::Segment;
use tem00_tracer::{Laser, LocalFrame};

use super::{
    LightGroup, LightSelection, LightTracer,
    splats::{Splat, Splats},
};
use crate::{
    sampler::{DrawKey, Draws},
    speckle::{SpeckleFrame, SpecklePoint},
    walk::Met,
};

/// Follows the light of one laser, group by group, and connects the surfaces that it meets to the
/// camera.
#[derive(Debug)]
pub(super) struct Connector<'a> {
    tracer: &'a LightTracer<'a>,
    /// The index of the laser in the scene.
    index: usize,
    /// The laser as it stands in the frame.
    laser: Laser,
}

/// Light that reaches the camera unless something stands in the way.
struct Connection<'a> {
    met: &'a Met<'a>,
    /// Image point and surface point of the connection.
    point: SpecklePoint,
    /// The number of the pixel in the part of the image that is rendered.
    index: usize,
    /// In W/(m² sr).
    radiance: f64,
    /// The power on the first rough surface, on the side that the camera sees, in watts.
    power: f64,
}

impl<'a> Connector<'a> {
    pub(super) fn new(tracer: &'a LightTracer<'a>, index: usize) -> Self {
        Self {
            tracer,
            index,
            laser: tracer.scene.lasers[index].in_frame(tracer.frame),
        }
    }

    /// Follows a group of `paths` light paths and returns their contribution to the image.
    pub(super) fn group(&self, group: u64, paths: usize) -> Splats {
        let tracer = self.tracer;
        let group = LightGroup {
            scene: tracer.scene,
            intersector: tracer.intersector,
            laser: &self.laser,
            max_depth: tracer.max_depth,
            key: DrawKey {
                seed: tracer.seed,
                frame: tracer.frame,
                laser: self.index,
                group,
            },
            paths,
        };
        let mut splats = Splats::default();
        group.follow(|depth, met, draws| {
            if depth == 1 && tracer.selection == LightSelection::SpecularFirst {
                met.retain(|met| met.vertex.is_specular());
            }
            self.connect(met, draws, &mut splats);
        });
        splats.merge();
        splats
    }

    /// Adds the light that goes straight from rough surfaces to the camera.
    fn connect(&self, met: &[Met<'a>], draws: &mut Draws, splats: &mut Splats) {
        let (mut connections, mut segments) = (Vec::new(), Vec::new());
        for met in met.iter().filter(|met| !met.vertex.is_specular()) {
            let lens = draws.uniform_2d();
            let is_single = self.laser.spectrum().is_monochromatic();
            let wave = if is_single { 0.5 } else { draws.uniform() };
            if let Some((connection, segment)) = self.connection(met, lens, wave) {
                connections.push(connection);
                segments.push(segment);
            }
        }
        let mut visible = vec![false; segments.len()];
        let intersector = self.tracer.intersector;
        intersector.visible_batch(&segments, &mut visible);
        for (connection, _) in connections.iter().zip(visible).filter(|&(_, free)| free) {
            self.add(connection, splats);
        }
    }

    fn connection<'v>(
        &self,
        met: &'v Met<'a>,
        lens: [f64; 2],
        wave: f64,
    ) -> Option<(Connection<'v>, Segment)> {
        let hit = &met.vertex.hit;
        let seen = self.tracer.camera.connect(hit.position, lens)?;
        let index = self.tracer.area.pixel_at(seen.pixel.into())?;
        let towards = (seen.lens_point - hit.position).try_normalize()?;
        let axes = LocalFrame::from_normal(hit.normal_seen_from(towards));
        let sent = met.sent(towards, &axes, self.laser.wavelength());
        let radiance = met.walker.carries * sent * seen.importance;
        let power = met.power_seen_from(towards);
        let connection = Connection {
            met,
            point: SpecklePoint {
                pixel: seen.pixel,
                position: hit.position,
                normal: axes.normal() * axes.normal().dot(towards).signum(),
                surface: hit.surface,
                wave,
            },
            index,
            radiance,
            power,
        };
        // Power counts on black surfaces, too.
        let segment = met.vertex.segment_to(seen.lens_point);
        (radiance > 0.0 || power > 0.0).then_some((connection, segment))
    }

    fn add(&self, connection: &Connection<'_>, splats: &mut Splats) {
        let radiance = connection.radiance;
        let is_single = connection.met.walker.rough == 0;
        let speckle = self.tracer.speckle;
        let factor = |speckle: &SpeckleFrame<'_>| speckle.factor(self.index, &connection.point);
        splats.push(Splat {
            pixel: connection.index,
            single: if is_single { radiance } else { 0.0 },
            multiple: if is_single { 0.0 } else { radiance },
            radiance: radiance * speckle.map_or(1.0, factor),
        });
        if is_single {
            splats.power += connection.power;
        }
    }
}

impl Met<'_> {
    /// Returns the power, in watts, of light that has met no rough surface before, on the side that
    /// is seen from the unit direction `out`.
    fn power_seen_from(&self, out: DVec3) -> f64 {
        let is_lit = self.vertex.cosine * out.dot(self.vertex.hit.normal) > 0.0;
        if is_lit && self.walker.rough == 0 {
            self.walker.carries
        } else {
            0.0
        }
    }
}
