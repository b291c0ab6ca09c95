use glam::DVec3;
use tem00_geometry::Segment;
use tem00_tracer::LocalFrame;

use crate::walk::Met;

/// The path of light between a laser and the camera, over surfaces that may have moved.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurveyedPath {
    /// The optical length, in metres.
    pub length: f64,
    /// The length minus the length of the same path in the reference frame.
    pub change: f64,
    /// The degree of polarisation that the rough surfaces leave.
    pub polarisation: f64,
    /// The last point: now, and in the reference frame.
    pub last: [DVec3; 2],
}

/// A point of a rough surface that the light of a laser has met, and its path there.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathPoint<'a> {
    pub met: Met<'a>,
    pub path: SurveyedPath,
}

impl SurveyedPath {
    /// Continues to a point, now and in the reference frame, through a medium of this index.
    pub(super) fn on_to(self, here: [DVec3; 2], index: f64) -> Self {
        let [now, before] = self.distances(here);
        Self {
            length: self.length + index * now,
            change: self.change + index * (now - before),
            last: here,
            ..self
        }
    }

    /// The distances from the last point: now, and in the reference frame.
    fn distances(&self, here: [DVec3; 2]) -> [f64; 2] {
        [0, 1].map(|time| here[time].distance(self.last[time]))
    }
}

impl PathPoint<'_> {
    /// Returns the irradiance that the point sends to another across the direction between them, in
    /// W/m², as if its path were the only one, and the unit direction towards it.
    pub(super) fn irradiance_at(&self, point: DVec3, wavelength: f64) -> Option<(f64, DVec3)> {
        let hit = &self.met.vertex.hit;
        let between = point - hit.position;
        let out = between.try_normalize()?;
        let axes = LocalFrame::from_normal(hit.normal_seen_from(out));
        let intensity = self.met.walker.carries * self.met.sent(out, &axes, wavelength);
        let irradiance = intensity / between.length_squared();
        (irradiance > 0.0 && irradiance.is_finite()).then_some((irradiance, -out))
    }

    /// Returns the path of the light continued to a point, which stood at `origin` in the reference
    /// frame.
    pub(super) fn path_to(&self, point: DVec3, origin: DVec3) -> SurveyedPath {
        let [now, before] = self.path.distances([point, origin]);
        SurveyedPath {
            length: self.path.length + now,
            change: self.path.change + now - before,
            ..self.path
        }
    }

    /// Returns the segment from the point to another.
    pub(super) const fn segment_to(&self, point: DVec3) -> Segment {
        self.met.vertex.segment_to(point)
    }
}
