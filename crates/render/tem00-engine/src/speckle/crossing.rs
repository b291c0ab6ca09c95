//! Motions that slices along one line cannot follow.

use core::fmt;
use std::collections::BTreeSet;

use glam::DVec2;
use tem00_decorrelation::{ImagingGeometry, pupil_overlap_correlation};
use tem00_shading::{Bandwidth, LightPath};
use tem00_tracer::{Scene, Spectrum};

use super::{
    change::{Change, ReferencePoint},
    prescan::{FrameNeeds, MotionPrescan},
};

/// Two frames whose rendered speckle has another correlation than the law predicts.
///
/// Either the pupil moves over the speckle in two directions while bodies share a stack or points
/// move apart, or the law has no value from the reference frame. The `Display` of the note is one
/// line that says so.
#[derive(Clone, Debug, PartialEq)]
pub struct CorrelationNote {
    /// The name of the surface.
    pub surface: String,
    /// The index of the laser.
    pub laser: usize,
    /// The frames.
    pub frames: [u32; 2],
    /// The correlation of intensity with which a point of the surface is rendered, apart from its
    /// displacement in the image.
    pub rendered: f64,
    /// Correlation by the law.
    pub law: f64,
}

impl fmt::Display for CorrelationNote {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (surface, laser, [first, second]) = (&self.surface, self.laser, self.frames);
        let (rendered, law) = (self.rendered, self.law);
        write!(
            f,
            "surface `{surface}`, laser {laser}: speckle of frames {first} and {second} correlates \
             by {rendered:.2} where the law has {law:.2}; slices cannot follow its change"
        )
    }
}

/// The method by which slices along a line follow a motion of the pupil.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Following {
    /// Coordinate by the length of the displacement, to either side of the reference frame.
    #[default]
    Length,
    /// Coordinate by the component of the displacement along an axis, on a separate line for each
    /// frame, in the middle of the displacements of its points.
    Axis(DVec2),
}

impl Following {
    pub(super) fn axis(self) -> Option<DVec2> {
        match self {
            Self::Length => None,
            Self::Axis(axis) => Some(axis),
        }
    }
}

/// Assignment of slices to the motion of a group of surfaces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Followed {
    pub following: Following,
    /// The frames whose correlation errs most.
    worst: Option<FramePair>,
}

/// Two frames: the correlation with which a surface is rendered, and the correlation by the law.
#[derive(Clone, Copy, Debug)]
struct FramePair {
    surface: usize,
    frames: [u32; 2],
    rendered: f64,
    law: f64,
}

impl FramePair {
    fn error(&self) -> f64 {
        (self.rendered - self.law).abs()
    }
}

impl Followed {
    fn error(&self) -> f64 {
        self.worst.as_ref().map_or(0.0, FramePair::error)
    }

    /// Returns a note if a correlation errs by more than [`MAX_ERROR`].
    pub(super) fn note(&self, scene: &Scene, laser: usize) -> Option<CorrelationNote> {
        let pair = self.worst.filter(|pair| pair.error() > MAX_ERROR)?;
        Some(CorrelationNote {
            surface: scene.surfaces[pair.surface].name.clone(),
            laser,
            frames: pair.frames,
            rendered: pair.rendered,
            law: pair.law,
        })
    }
}

/// The largest error of a correlation that is accepted: it needs neither another method to follow
/// the motion nor a note.
const MAX_ERROR: f64 = 0.05;

/// The number of evenly spread frames that are compared, each together with the next frame.
const SPREAD: u32 = 32;

/// The number of frames with which a frame is compared, out of those where the pupil has moved
/// about as far.
const NEIGHBOURS: usize = 64;

/// The number of points that are followed, in addition to the middle of the points that each frame
/// sees where displacements differ by less than `ALIKE`, in pupil diameters.
const POINTS: usize = 4;
const ALIKE: f64 = 0.1;

/// The displacements of the pupil over the speckle of some points, of surfaces that move alike, in
/// some frames.
pub(super) struct Tracks {
    frames: Vec<u32>,
    /// The middle of the displacements of all points that each of the frames sees.
    middles: Vec<DVec2>,
    /// The axis along which the displacements in a frame differ most.
    axis: DVec2,
    /// The displacements of each point, in the frames that see it.
    points: Vec<Vec<PupilShift>>,
}

/// The displacement of the pupil over the speckle of a point.
#[derive(Clone, Copy, Debug)]
struct PupilShift {
    /// The index of the frame in the tracks.
    frame: usize,
    vector: DVec2,
    /// Its length, negative on the other side of the reference frame.
    length: f64,
    /// The displacement since the previous frame, by the law from that frame.
    step: Option<DVec2>,
}

/// The waves of a line on a surface.
pub(super) struct Waves<'a> {
    surface: usize,
    spectrum: Option<(&'a Spectrum, Bandwidth)>,
    /// Their covariance without a motion.
    variance: f64,
}

impl Tracks {
    /// Follows points of a group of surfaces under a laser.
    pub(super) fn new(
        scene: &Scene,
        (laser, geometry): (usize, &ImagingGeometry),
        prescan: &MotionPrescan,
    ) -> Self {
        let frames = compared(prescan, scene.frames);
        let changes = frames.iter().map(|&frame| {
            let before = frame.saturating_sub(1);
            [scene.reference_frame, before].map(|from| Change::between(scene, [from, frame]))
        });
        let changes: Vec<_> = changes.collect();
        let shift = |point: &ReferencePoint, frame: usize| {
            let [change, since] = &changes[frame];
            let seen = change.seen(laser, point)?;
            let shift = change.speckle_shift(laser, geometry, &seen);
            let side = change.side(laser, geometry, prescan.reference_point.as_ref());
            let step = since.known_shift(laser, geometry, &seen, LightPath::Direct);
            Some(PupilShift {
                frame,
                vector: shift.pupil_vector(),
                length: side * shift.pupil,
                step: step.map(|shift| shift.pupil_vector()),
            })
        };
        let shifts = |point| (0..changes.len()).filter_map(|f| shift(point, f)).collect();
        let stride = prescan.points.len().div_ceil(POINTS).max(1);
        let points = prescan.points.iter().step_by(stride).map(shifts);
        let needs = frames.iter().map(|&f| &prescan.frames[f as usize]);
        let middle = needs.clone().zip(0..);
        let middle = middle.filter_map(|(needs, frame)| PupilShift::in_the_middle(needs, frame));
        Self {
            points: points.chain([middle.collect()]).collect(),
            middles: needs.map(|needs| needs.pupil_shifts.middle()).collect(),
            axis: prescan.widest_axis(),
            frames,
        }
    }

    /// Returns how slices can follow the points: by the length of the motion, and by the best
    /// method.
    pub(super) fn followed(&self, waves: &[Waves<'_>]) -> [Followed; 2] {
        let follow = |following: Following| {
            let pairs = waves
                .iter()
                .filter_map(|waves| self.worst(following, waves));
            Followed {
                following,
                worst: pairs.max_by(|a, b| a.error().total_cmp(&b.error())),
            }
        };
        let by_length = follow(Following::Length);
        if by_length.error() <= MAX_ERROR {
            return [by_length; 2];
        }
        let widest = waves.iter().max_by(|a, b| a.reach().total_cmp(&b.reach()));
        let tilt = widest.filter(|waves| waves.spectrum.is_some());
        let along = follow(Following::Axis(tilt.map_or(self.axis, Waves::axis)));
        let is_better = along.error() < by_length.error();
        [by_length, if is_better { along } else { by_length }]
    }

    /// Returns the two frames whose correlation errs most in some waves.
    fn worst(&self, following: Following, waves: &Waves<'_>) -> Option<FramePair> {
        let axis = following.axis().unwrap_or(waves.axis());
        let place = |shift: &PupilShift| match following {
            Following::Length => shift.length * axis,
            Following::Axis(_) => {
                let middle = self.middles[shift.frame].dot(axis.perp());
                shift.vector.dot(axis) * axis + middle * axis.perp()
            }
        };
        let pair = |one: &PupilShift, other: &PupilShift| {
            let frames = [one, other].map(|shift| self.frames[shift.frame]);
            let step = other.step.filter(|_| frames[1] == frames[0] + 1);
            FramePair {
                surface: waves.surface,
                frames,
                rendered: waves.correlation(place(other) - place(one), axis),
                law: waves.correlation(step.unwrap_or(other.vector - one.vector), waves.axis()),
            }
        };
        let shifts = self.points.iter();
        let pairs = shifts.flat_map(|shifts| {
            let firsts = shifts.iter().enumerate();
            firsts.flat_map(move |(i, one)| shifts[i + 1..].iter().map(move |other| (one, other)))
        });
        pairs
            .map(|(one, other)| pair(one, other))
            .max_by(|a, b| a.error().total_cmp(&b.error()))
    }
}

/// Returns the frames that are compared: evenly spread frames and the two frames that slices along
/// one line confuse most, each with the next frame.
fn compared(prescan: &MotionPrescan, count: u32) -> Vec<u32> {
    let spread = (0..SPREAD).map(|i| i * (count - 1) / (SPREAD - 1));
    let frames = spread.chain(most_confused(prescan, count));
    let frames: BTreeSet<_> = frames
        .flat_map(|frame| [frame, (frame + 1).min(count - 1)])
        .collect();
    frames.into_iter().collect()
}

/// Returns two frames in which the pupil has moved about as far, but to different places.
fn most_confused(prescan: &MotionPrescan, count: u32) -> [u32; 2] {
    let middle = |frame: u32| {
        let middle = PupilShift::in_the_middle(&prescan.frames[frame as usize], 0);
        Some((frame, middle?))
    };
    let mut shifts: Vec<_> = (0..count).filter_map(middle).collect();
    shifts.sort_by(|(_, a), (_, b)| a.length.total_cmp(&b.length));
    let mut max = ([0; 2], 0.0);
    for (i, (first, one)) in shifts.iter().enumerate() {
        let near = shifts[i + 1..].iter().take(NEIGHBOURS);
        for (second, other) in near.take_while(|(_, other)| other.length - one.length < 1.0) {
            let rendered = pupil_overlap_correlation(other.length - one.length);
            let law = pupil_overlap_correlation((other.vector - one.vector).length());
            if rendered - law > max.1 {
                max = ([*first, *second], rendered - law);
            }
        }
    }
    max.0
}

impl PupilShift {
    /// Returns the displacement in the middle of the range of a frame, if all its points move about
    /// alike.
    fn in_the_middle(needs: &FrameNeeds, frame: usize) -> Option<Self> {
        let is_alike = needs.pupil_shifts.size().length() < ALIKE;
        is_alike.then(|| Self {
            frame,
            vector: needs.pupil_shifts.middle(),
            length: 0.5 * (needs.span[0] + needs.span[1]),
            step: None,
        })
    }
}

impl<'a> Waves<'a> {
    /// Light of one wavelength.
    pub(super) fn single(surface: usize) -> Self {
        Self {
            surface,
            spectrum: None,
            variance: 1.0,
        }
    }

    pub(super) fn of(spectrum: &'a Spectrum, surface: usize, bandwidth: Bandwidth) -> Self {
        let mut waves = Self {
            spectrum: Some((spectrum, bandwidth)),
            ..Self::single(surface)
        };
        waves.variance = waves.correlation(DVec2::ZERO, DVec2::X);
        waves
    }

    /// Returns the direction in which the waves displace the pupil.
    fn axis(&self) -> DVec2 {
        self.spectrum.as_ref().map_or(DVec2::X, |(_, b)| b.axis)
    }

    fn reach(&self) -> f64 {
        self.spectrum.as_ref().map_or(0.0, |(_, b)| b.reach)
    }

    /// Returns the correlation of intensities after the pupil has moved by `shift`, in diameters,
    /// where the waves displace it along an axis.
    pub(super) fn correlation(&self, shift: DVec2, axis: DVec2) -> f64 {
        let Some((spectrum, bandwidth)) = &self.spectrum else {
            return pupil_overlap_correlation(shift.length());
        };
        bandwidth.covariance(spectrum, shift, axis) / self.variance
    }
}
