mod region;
mod sample;

use std::collections::BTreeMap;

use glam::DVec2;
use tem00_camera::Camera;
use tem00_decorrelation::ImagingGeometry;
use tem00_geometry::Intersector;
use tem00_numerics::cast::to_i64;
use tem00_numerics::parallel;
use tem00_shading::Perspective;
use tem00_speckle::StackPlan;
use tem00_tracer::{Scene, TracerError};

use self::{
    region::Region,
    sample::{FrameSample, add_multiple_light, frame_samples},
};
use super::{
    change::{Change, ReferencePoint, moves},
    multiple::MultipleMap,
};

/// Rays per image side with which a frame is sampled: fewer in a long sequence, whose frames share
/// [`RAYS`].
pub(super) const RAYS_PER_SIDE: u32 = 128;
const FEWEST_RAYS_PER_SIDE: u32 = 16;
const RAYS: u32 = 1 << 20;

/// The maximum number of frames in a sequence that is sampled.
const MAX_FRAMES: u32 = 1 << 18;

/// Points that are kept: `KEPT_PER_SIDE` per image side in each of `KEPT_FRAMES` frames, and in
/// each of `KEPT_FARTHEST` frames the point whose speckle has changed most. They show what one ray
/// of a frame misses: how the motion differs over a surface, and where a small part is.
const KEPT_FRAMES: u32 = 4;
const KEPT_PER_SIDE: u32 = 4;
const KEPT_FARTHEST: usize = 16;

/// The span of a frame, in pupil diameters, from which it counts as sharing slices with all others.
const LONG_SPAN: f64 = 64.0;

/// Requirements of the image and the motion in a scene on a pattern.
#[derive(Clone, Debug)]
pub(super) struct MotionPrescan {
    /// Width and height of the image, in pixels.
    pub image: DVec2,
    /// The corners of the region of the reference frame's image from which speckle is looked up, in
    /// pixels: the region of the image itself, and of the places where lit points of other frames
    /// were.
    region: Region,
    /// The largest motion of the pupil over the speckle to either side of the reference frame, in
    /// pupil diameters; the second is to the side of the farthest motion.
    pub shifts: [f64; 2],
    /// A point over whose speckle the pupil has moved farthest.
    pub reference_point: Option<ReferencePoint>,
    /// Points that were seen in some frames.
    pub points: Vec<ReferencePoint>,
    /// Requirements of the frames, one by one; empty where nothing moves.
    pub frames: Vec<FrameNeeds>,
}

/// Requirements of one frame on a pattern.
#[derive(Clone, Copy, Debug)]
pub(super) struct FrameNeeds {
    region: Region,
    /// The smallest and the largest motion of the pupil over the speckle, in pupil diameters,
    /// negative on the other side of the reference frame.
    pub span: [f64; 2],
    /// The displacements of the pupil over the speckle, to the right and up, in pupil diameters.
    pub pupil_shifts: Region,
}

/// Points of a group of surfaces that were seen in some frames.
struct SeenPoints {
    /// The one over whose speckle the pupil has moved farthest.
    farthest: Option<ReferencePoint>,
    all: Vec<ReferencePoint>,
}

impl MotionPrescan {
    fn of_image(camera: &Camera) -> Self {
        let [low, high] = Perspective::new(*camera).image();
        Self {
            image: high - low,
            region: Region { low, high },
            shifts: [0.0; 2],
            reference_point: None,
            points: Vec::new(),
            frames: Vec::new(),
        }
    }

    /// Returns width and height of the region from which speckle is looked up, in pixels.
    pub(super) fn region(&self) -> DVec2 {
        self.region.size()
    }

    /// Returns the axis of the pupil along which the displacements of the points of a frame differ
    /// most.
    pub(super) fn widest_axis(&self) -> DVec2 {
        let sizes = self.frames.iter().map(|frame| frame.pupil_shifts.size());
        let size = sizes.fold(DVec2::ZERO, DVec2::max);
        if size.y > size.x { DVec2::Y } else { DVec2::X }
    }

    /// Returns width and height, in pixels, of the largest region from which frames look up shared
    /// slices, where each frame looks up its span of the path, in pupil diameters.
    pub(super) fn shared_region(&self, spans: &[[f64; 2]]) -> DVec2 {
        // Pupils that overlap stand in the same diameter of the path, or in neighbouring ones.
        let mut parts = BTreeMap::<i64, Region>::new();
        for (frame, [low, high]) in self.frames.iter().zip(spans) {
            if high - low > LONG_SPAN {
                return self.region();
            }
            for diameter in to_i64(low.floor())..=to_i64(high.floor()) {
                for part in [diameter, diameter + 1] {
                    let joined = parts.entry(part).or_insert(Region::NONE);
                    *joined = joined.joined(frame.region);
                }
            }
        }
        let sizes = parts.values().map(Region::size);
        sizes.fold(self.image, DVec2::max)
    }
}

/// The imaging geometries of the lasers, and the groups of surfaces with a pattern each.
#[derive(Clone, Copy, Debug)]
pub(super) struct LaserGroups<'a> {
    /// The imaging geometry of each laser.
    pub geometries: &'a [ImagingGeometry],
    /// The group of each surface.
    pub groups: &'a [usize],
}

/// Returns the multiple light in a frame, if it needs its own slices.
pub(crate) type SurveyOfFrame<'a> =
    dyn Fn(u32, &Intersector, &Change) -> Option<MultipleMap> + Sync + 'a;

/// Follows rays to the points that the lasers light, in all frames of the sequence, and returns
/// what each laser asks of the pattern of each group of surfaces.
///
/// Each frame is sampled on its own thread.
pub(super) fn prescan(
    scene: &Scene,
    laser_groups: LaserGroups<'_>,
    survey: &SurveyOfFrame<'_>,
) -> Result<Vec<Vec<MotionPrescan>>, TracerError> {
    let still = MotionPrescan::of_image(&scene.camera);
    let mut prescans = vec![vec![still; laser_groups.count()]; scene.lasers.len()];
    if !moves(scene) {
        return Ok(prescans);
    }
    if scene.frames > MAX_FRAMES {
        return Err(TracerError::OutOfRange {
            parameter: "frames",
            value: f64::from(scene.frames),
            allowed: "at most 262144 where something moves: split the sequence into scenes",
        });
    }
    let side = rays_per_side(scene.frames);
    let frames: Vec<u32> = (0..scene.frames).collect();
    let samples = parallel::map_items_with(frames.clone(), |(), _, frame| {
        let change = Change::new(scene, frame);
        let intersector = Intersector::build(&scene.shapes_at(frame))?;
        let keeps = frame.is_multiple_of(scene.frames.div_ceil(KEPT_FRAMES));
        let stride = if keeps { side / KEPT_PER_SIDE } else { side };
        let mut samples = frame_samples(laser_groups, &intersector, &change, [side, stride]);
        if let Some(map) = survey(frame, &intersector, &change) {
            add_multiple_light(&mut samples, laser_groups, &map, &change);
        }
        laser_groups.find_reference_points(&mut samples, &change);
        Ok(samples)
    });
    let samples: Vec<_> = samples.into_iter().collect::<Result<_, TracerError>>()?;
    let seen = laser_groups.seen_points(&samples);
    let samples = frames.into_iter().zip(samples).collect();
    let needs = parallel::map_items_with(samples, |(), _, (frame, mut samples)| {
        laser_groups.needs(&mut samples, &seen, &Change::new(scene, frame))
    });
    for (laser, prescans) in prescans.iter_mut().enumerate() {
        for (group, prescan) in prescans.iter_mut().enumerate() {
            let SeenPoints { farthest, all } = &seen[laser][group];
            (prescan.reference_point, prescan.points) = (*farthest, all.clone());
            needs
                .iter()
                .for_each(|frame| prescan.add(frame[laser][group]));
        }
    }
    Ok(prescans)
}

impl LaserGroups<'_> {
    fn count(&self) -> usize {
        self.groups.iter().max().map_or(0, |last| last + 1)
    }

    /// Finds where the farthest points of a frame were in the reference frame.
    fn find_reference_points(&self, samples: &mut [Vec<FrameSample>], change: &Change) {
        for (laser, geometry) in self.geometries.iter().enumerate() {
            for sample in &mut samples[laser] {
                let point = sample.farthest.as_ref();
                sample.reference_point =
                    point.and_then(|point| change.reference_point(laser, geometry, point));
            }
        }
    }

    /// Returns the points of each laser and group that were seen in some of the frames.
    fn seen_points(&self, frames: &[Vec<Vec<FrameSample>>]) -> Vec<Vec<SeenPoints>> {
        let seen = |laser: usize, group: usize| {
            let samples = frames.iter().map(|frame| &frame[laser][group]);
            let points = samples.clone();
            let points = points.filter_map(|s| Some((s.shifts[1], s.reference_point?)));
            let points: Vec<_> = points.collect();
            let moved = points.iter().filter(|(shift, _)| *shift > 0.0);
            let farthest = moved.reduce(|a, b| if b.0 > a.0 { b } else { a });
            let stride = points.len().div_ceil(KEPT_FARTHEST).max(1);
            let kept = samples.flat_map(|sample| sample.kept.iter().copied());
            let farthest_of_frames = points.iter().step_by(stride).map(|(_, point)| *point);
            SeenPoints {
                farthest: farthest.map(|(_, point)| *point),
                all: kept.chain(farthest_of_frames).collect(),
            }
        };
        let of_laser = |laser| (0..self.count()).map(|group| seen(laser, group)).collect();
        (0..self.geometries.len()).map(of_laser).collect()
    }

    /// Returns the requirements of a frame for each laser and group; nothing where the frame sees
    /// no surface of the group.
    fn needs(
        &self,
        samples: &mut [Vec<FrameSample>],
        seen: &[Vec<SeenPoints>],
        change: &Change,
    ) -> Vec<Vec<Option<FrameNeeds>>> {
        let lasers = self.geometries.iter().zip(samples).zip(seen).enumerate();
        lasers
            .map(|(laser, ((geometry, samples), seen))| {
                let groups = samples.iter_mut().zip(seen);
                groups
                    .map(|(sample, seen)| {
                        if sample.farthest.is_none() {
                            let points = seen.all.iter();
                            points
                                .filter_map(|point| change.seen(laser, point))
                                .for_each(|point| {
                                    sample.add_point(change, (laser, geometry), &point);
                                });
                        }
                        let side = change.side(laser, geometry, seen.farthest.as_ref());
                        sample.needs(side)
                    })
                    .collect()
            })
            .collect()
    }
}

impl MotionPrescan {
    /// Adds the requirements of the next frame on the pattern, if it has any.
    fn add(&mut self, needs: Option<FrameNeeds>) {
        let before = self.frames.last().copied().unwrap_or(FrameNeeds {
            region: Region::NONE,
            span: [0.0; 2],
            pupil_shifts: Region::of(DVec2::ZERO),
        });
        let needs = needs.unwrap_or(FrameNeeds {
            region: Region::NONE,
            ..before
        });
        self.frames.push(needs);
        self.region = self.region.joined(needs.region);
        let [low, high] = needs.span;
        self.shifts = [self.shifts[0].max(-low), self.shifts[1].max(high)];
    }
}

/// Returns the rays per image side for each of `frames` frames.
pub(super) fn rays_per_side(frames: u32) -> u32 {
    (RAYS / frames)
        .isqrt()
        .clamp(FEWEST_RAYS_PER_SIDE, RAYS_PER_SIDE)
}

/// Returns the position of the first ray of a frame, in distances between rays. It differs from
/// frame to frame, so that a part missed in some frames is met in others.
pub(super) fn first_ray(change: &Change, side: u32) -> DVec2 {
    let farther = match side {
        RAYS_PER_SIDE => 0.0,
        _ => change.frames(),
    };
    (DVec2::splat(0.5) + farther * DVec2::from_array(StackPlan::place(1))).rem_euclid(DVec2::ONE)
}

/// Returns image points evenly spread over the image, in pixels: `side` along each side, starting
/// at `first`, in distances between them.
pub(super) fn pixels_of(
    camera: &Camera,
    side: u32,
    first: DVec2,
) -> impl Iterator<Item = DVec2> + use<> {
    let size = DVec2::new(camera.width() as f64, camera.height() as f64);
    (0..side * side).map(move |index| {
        let place = DVec2::new(f64::from(index % side), f64::from(index / side));
        (place + first) / f64::from(side) * size
    })
}
