use tem00_engine::SpeckleChange;
use tem00_triangulation::TriangulationError;

use crate::ScanError;
use crate::{
    average::averaged_profile,
    frame::{MeasuredFrame, MeasuredPoint},
    frame_correlation::FrameCorrelation,
    height_map::HeightMap,
    measurement::Measurement,
};

/// Combines measured frames into profiles, and profiles into the map of a part.
#[derive(Clone, Debug)]
pub struct Scan<'a> {
    part: ScannedPart<'a>,
    /// The frames of the profile that is not complete.
    pending: Vec<MeasuredFrame>,
}

/// The profiles of a part.
#[derive(Clone, Debug)]
pub struct ScannedPart<'a> {
    measurement: &'a Measurement,
    profiles: Vec<Vec<MeasuredPoint>>,
    /// Correlation of the frames of the first profile with valid points.
    correlation: Option<FrameCorrelation>,
    /// Change of the speckle from the first frame to the next.
    speckle_change: Option<SpeckleChange>,
}

impl<'a> Scan<'a> {
    /// Starts a scan without frames.
    pub const fn new(measurement: &'a Measurement) -> Self {
        Self {
            part: ScannedPart {
                measurement,
                profiles: Vec::new(),
                correlation: None,
                speckle_change: None,
            },
            pending: Vec::new(),
        }
    }

    /// Adds the next frame; frames come in their order.
    pub fn add(&mut self, frame: MeasuredFrame) {
        let measurement = self.part.measurement;
        let is_followed = frame.frame + 1 < measurement.scene().frames;
        if self.part.speckle_change.is_none() && is_followed {
            self.part.speckle_change = measurement.speckle_change(&frame, 1);
        }
        self.pending.push(frame);
        if self.pending.len() >= measurement.settings().average.frames as usize {
            self.complete();
        }
    }

    /// Returns the profiles; the last profile has fewer frames if too few are left.
    pub fn finish(mut self) -> ScannedPart<'a> {
        if !self.pending.is_empty() {
            self.complete();
        }
        self.part
    }

    /// Averages the frames that are pending.
    fn complete(&mut self) {
        let measurement = self.part.measurement;
        let averaging = measurement.settings().average;
        let frames = core::mem::take(&mut self.pending);
        let profile = match &frames[..] {
            [frame] if averaging.columns == 1 => frame.points.clone(),
            _ => {
                let correlation = measurement.frame_correlation(&frames[0], averaging.frames);
                let profile = averaged_profile(&frames, averaging, |columns, later| {
                    correlation.between(columns, later)
                });
                if !profile.is_empty() {
                    self.part.correlation.get_or_insert(correlation);
                }
                profile
            }
        };
        self.part.profiles.push(profile);
    }
}

impl ScannedPart<'_> {
    /// Returns the profiles, in the order of the frames.
    pub fn profiles(&self) -> &[Vec<MeasuredPoint>] {
        &self.profiles
    }

    /// Returns how many profiles of independent speckle the first profile with valid points is
    /// worth: 1 without averaging over frames, and the number of frames if each frame has its own
    /// speckle; `None` if no profile has valid points.
    pub fn effective_frames(&self) -> Option<f64> {
        let frames = self.measurement.settings().average.frames;
        if frames > 1 {
            let correlation = self.correlation.as_ref();
            return correlation.map(|correlation| correlation.effective_frames(frames));
        }
        let mut points = self.profiles.iter().flatten();
        points.any(MeasuredPoint::is_valid).then_some(1.0)
    }

    /// Returns the change of the speckle of the line from one frame to the next: for the first
    /// frame for which the law has a value, or `None` without speckle and without such a frame.
    pub const fn speckle_change(&self) -> Option<&SpeckleChange> {
        self.speckle_change.as_ref()
    }

    /// Returns the heights on a grid: of squares of the part if the scan has a pitch, otherwise of
    /// columns and profiles.
    ///
    /// # Errors
    ///
    /// Returns an error if nothing was measured or if the pitch is too small.
    pub fn height_map(&self) -> Result<HeightMap, ScanError> {
        let [across, along, height] = self.measurement.axes();
        let settings = self.measurement.settings();
        let valid = self.profiles.iter().flatten().any(MeasuredPoint::is_valid);
        if !valid {
            let empty = TriangulationError::TooFew {
                what: "valid points for a height map",
                got: 0,
                needed: 1,
            };
            return Err(empty.into());
        }
        match settings.pitch {
            Some(pitch) => Ok(HeightMap::of_points(
                &self.profiles,
                [across, along, height],
                pitch,
            )?),
            None => {
                let columns = self.measurement.scene().camera.width();
                let size = [columns, settings.average.columns];
                Ok(HeightMap::of_profiles(&self.profiles, height, size))
            }
        }
    }
}
