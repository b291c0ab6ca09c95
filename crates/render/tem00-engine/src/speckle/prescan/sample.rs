use glam::DVec3;
use tem00_decorrelation::ImagingGeometry;
use tem00_geometry::Intersector;
use tem00_shading::{LightPath, SpeckleShift};

use super::{FrameNeeds, LaserGroups, first_ray, pixels_of, region::Region};
use crate::speckle::{
    SpecklePoint,
    change::{Change, ReferencePoint},
    multiple::MultipleMap,
};

/// Sample of a group of surfaces in one frame.
#[derive(Clone, Debug)]
pub(super) struct FrameSample {
    pub region: Region,
    /// The smallest and the largest motion of the pupil over the speckle, in pupil diameters.
    pub shifts: [f64; 2],
    pub pupil_shifts: Region,
    /// The point where it is largest.
    pub farthest: Option<SpecklePoint>,
    /// Sample in the reference frame, if the theory has a value.
    pub reference_point: Option<ReferencePoint>,
    /// Points that are spread over the image.
    pub kept: Vec<ReferencePoint>,
}

/// Samples one frame with `side` rays per image side, and keeps the point of the middle ray of
/// every `stride` rays along each side.
pub(super) fn frame_samples(
    laser_groups: LaserGroups<'_>,
    intersector: &Intersector,
    change: &Change,
    [side, stride]: [u32; 2],
) -> Vec<Vec<FrameSample>> {
    let none = FrameSample {
        region: Region::NONE,
        shifts: [f64::INFINITY, 0.0],
        pupil_shifts: Region::NONE,
        farthest: None,
        reference_point: None,
        kept: Vec::new(),
    };
    let mut samples = vec![vec![none; laser_groups.count()]; laser_groups.geometries.len()];
    let first = first_ray(change, side);
    for (index, pixel) in (0..).zip(pixels_of(change.camera(), side, first)) {
        let is_kept = [index % side, index / side].map(|i| i % stride) == [stride / 2; 2];
        let Some(hit) = intersector.intersect(&change.camera().ray(pixel)) else {
            continue;
        };
        let Some(&group) = laser_groups.groups.get(hit.surface) else {
            continue;
        };
        let point = SpecklePoint::of_hit(pixel, &hit);
        for (laser, geometry) in laser_groups.geometries.iter().enumerate() {
            if change.laser(laser).next_event(hit.position).is_some() {
                let sample = &mut samples[laser][group];
                sample.add_point(change, (laser, geometry), &point);
                let kept = is_kept.then(|| change.reference_point_along(&point, DVec3::ZERO));
                sample.kept.extend(kept.flatten());
            }
        }
    }
    samples
}

/// Adds the requirements of the speckle of light that has met several surfaces, where this light is
/// not faint.
pub(super) fn add_multiple_light(
    samples: &mut [Vec<FrameSample>],
    laser_groups: LaserGroups<'_>,
    map: &MultipleMap,
    change: &Change,
) {
    for (laser, geometry) in laser_groups.geometries.iter().enumerate() {
        for ((_, surface), light) in map.bright().filter(|((of, _), _)| *of == laser) {
            let point = &light.point;
            let fraction = light.fraction_beside(light.single);
            let single = change.speckle_shift(laser, geometry, point);
            let carried = change.known_shift(laser, geometry, point, LightPath::Carried);
            let shift = match carried {
                Some(carried) if !change.is_reference() => light.shift([single, carried], fraction),
                _ => single,
            };
            if let Some(&group) = laser_groups.groups.get(surface) {
                samples[laser][group].add(change, point, &shift);
            }
        }
    }
}

impl FrameSample {
    /// Adds a point and the shift of its speckle.
    pub(super) fn add_point(
        &mut self,
        change: &Change,
        (laser, geometry): (usize, &ImagingGeometry),
        point: &SpecklePoint,
    ) {
        self.add(change, point, &change.speckle_shift(laser, geometry, point));
    }

    fn add(&mut self, change: &Change, point: &SpecklePoint, shift: &SpeckleShift) {
        let origin = change.perspective().point(point.pixel) - shift.displacement;
        self.region = self.region.joined(Region::of(origin));
        self.pupil_shifts = self.pupil_shifts.joined(Region::of(shift.pupil_vector()));
        let [smallest, largest] = &mut self.shifts;
        *smallest = smallest.min(shift.pupil);
        if self.farthest.is_none() || shift.pupil > *largest {
            *largest = shift.pupil;
            self.farthest = Some(*point);
        }
    }

    /// Returns the requirements of the frame on a side of the reference frame, if anything was
    /// seen.
    pub(super) fn needs(&self, side: f64) -> Option<FrameNeeds> {
        let [smallest, largest] = self.shifts;
        let span = if side > 0.0 {
            [smallest, largest]
        } else {
            [-largest, -smallest]
        };
        self.farthest.map(|_| FrameNeeds {
            region: self.region,
            span,
            pupil_shifts: self.pupil_shifts,
        })
    }
}
