//! A measurement of a scene.

use std::path::Path;

use tem00_cli::{Inspection, check_room, frames, tracer_failure};
use tem00_engine::{SpeckleChange, SpeckleModel, SpecklePlan, samples_per_frame};
use tem00_report::{
    args::IndexRange, failure::Failure, interrupt, output, progress::FrameProgress,
};
use tem00_scan::{
    Averaging, HeightMap, MeasuredFrame, MeasuredPoint, Measurement, MeasurementScene, Scan,
    ScanError,
};

use super::{
    files::Files,
    frame::{FrameRecord, point_counts},
    refusal::Refusal,
    terms::Terms,
};
use crate::args::TriangulateArgs;

/// A measurement that is ready to start.
pub(super) struct Job<'a> {
    pub(super) args: &'a TriangulateArgs,
    pub(super) measurement: Measurement,
    pub(super) frames: IndexRange,
    pub(super) name: String,
    pub(super) files: Files,
    /// Notes about omitted parts of meshes.
    pub(super) notes: Vec<String>,
}

/// The results of a measurement.
pub(super) struct ScanResult {
    pub(super) frames: Vec<FrameRecord>,
    pub(super) profiles: Vec<Vec<MeasuredPoint>>,
    /// The heights of several profiles.
    pub(super) map: Option<HeightMap>,
    /// The frame that the report shows, from the middle of the scan.
    pub(super) shown: Option<MeasuredFrame>,
    pub(super) effective_frames: Option<f64>,
    /// The change of speckle from frame to frame, where there is any.
    pub(super) speckle_change: Option<SpeckleChange>,
    /// The terms of the height uncertainty, or the reason why there are none.
    pub(super) terms: Result<Terms, Refusal>,
}

impl<'a> Job<'a> {
    pub(super) fn new(
        args: &'a TriangulateArgs,
        mut scene: MeasurementScene,
        notes: Vec<String>,
    ) -> Result<Self, Failure> {
        let name = output::name(&args.common.scene, "scene");
        let folder = output::folder(args.common.output.as_deref(), &name);
        args.common.overrule(&mut scene.scene.render);
        let raw = scene.scan.raw;
        check_room(&args.common.scene, &scene.scene)?;
        let measurement = Measurement::new(scene)
            .map_err(|error| measurement_failure(&args.common.scene, &error))?;
        Ok(Self {
            args,
            frames: frames(args.common.frames, measurement.scene().frames)?,
            measurement,
            name,
            files: Files::new(folder, raw)?,
            notes,
        })
    }

    /// Warns, before the work starts, about lasers whose light the camera will not see.
    pub(super) fn warn_of_darkness(&self) -> Result<(), Failure> {
        let found = Inspection::new(self.measurement.scene(), self.frames)
            .map_err(|error| tracer_failure(&self.args.common.scene, &error))?;
        found.warnings().iter().for_each(|line| output::note(line));
        Ok(())
    }

    pub(super) fn progress(&self) -> FrameProgress {
        let scene = self.measurement.scene();
        let samples_per_frame = samples_per_frame(scene, &scene.render);
        let frames = u64::from(self.frames.last - self.frames.first) + 1;
        FrameProgress::new(frames, samples_per_frame)
    }

    /// Measures all frames, writing raw frames on the way.
    pub(super) fn measure(&self) -> Result<ScanResult, Failure> {
        let speckle = self.speckle()?;
        let progress = self.progress();
        let mut scan = Scan::new(&self.measurement);
        let (mut frames, mut shown) = (Vec::new(), None);
        let middle = u32::midpoint(self.frames.first, self.frames.last);
        for number in self.frames.first..=self.frames.last {
            let frame = self.frame(number, speckle.as_ref(), &progress)?;
            let file = self.files.write_raw(&frame, &self.name)?;
            frames.push(FrameRecord::of(&frame, file));
            if number == middle {
                shown = Some(frame.clone());
            }
            scan.add(frame);
        }
        let part = scan.finish();
        let profiles = part.profiles().to_vec();
        let terms = Terms::of(&profiles, self.measurement.settings().height)
            .filter(|_| !point_counts(&frames).are_too_many());
        let has_map = profiles.len() > 1 && terms.is_some();
        let map = has_map.then(|| part.height_map()).transpose();
        Ok(ScanResult {
            map: map.map_err(|error| measurement_failure(&self.args.common.scene, &error))?,
            shown,
            effective_frames: part.effective_frames(),
            speckle_change: part.speckle_change().copied(),
            terms: terms.ok_or_else(|| Refusal::of(&frames)),
            frames,
            profiles,
        })
    }

    pub(super) fn speckle(&self) -> Result<Option<SpeckleModel>, Failure> {
        if self.args.common.no_speckle {
            return Ok(None);
        }
        let scene = self.measurement.scene();
        let refused = |error| tracer_failure(&self.args.common.scene, &error);
        let plan = SpecklePlan::new(scene, scene.render.seed).map_err(refused)?;
        for line in plan.correlation_notes() {
            output::note(&format!("speckle: {line}"));
        }
        let model = SpeckleModel::generate(scene, &plan).map_err(refused)?;
        interrupt::check()?;
        Ok(Some(model))
    }

    pub(super) fn frame(
        &self,
        number: u32,
        speckle: Option<&SpeckleModel>,
        progress: &FrameProgress,
    ) -> Result<MeasuredFrame, Failure> {
        let advance = progress.begin(format!(
            "{} frame {number} of {}..{}",
            self.name, self.frames.first, self.frames.last
        ));
        self.measurement
            .measure(speckle, number, &advance, interrupt::flag())
            .map_err(|error| measurement_failure(&self.args.common.scene, &error))
    }
}

impl ScanResult {
    /// The change of speckle from frame to frame as a sentence; `None` where it is not known.
    pub(super) fn speckle_sentence(&self, average: Averaging) -> Option<String> {
        let change = self.speckle_change.as_ref()?;
        let worth = match self.effective_frames {
            Some(worth) if average.frames > 1 => format!(
                "; a mean over {} frames is worth {worth:.1} of independent speckle",
                average.frames
            ),
            _ => String::new(),
        };
        Some(format!(
            "Speckle from frame to frame: {}{worth}.",
            in_words(change)
        ))
    }
}

/// The motion of speckle and the correlation that is left, in words.
pub(super) fn in_words(change: &SpeckleChange) -> String {
    // Adding 0 takes the sign off −0.
    let [right, down] = change
        .displacement
        .to_array()
        .map(|pixels| (100.0 * pixels).round() / 100.0 + 0.0);
    format!(
        "{right:+.2} pixels to the right, {down:+.2} down; correlation {:.2}",
        change.correlation
    )
}

/// The help for a scene that cannot be measured.
const HELP: &str = "docs/scene_file.md lists what is allowed";

pub(super) fn measurement_failure(path: &Path, error: &ScanError) -> Failure {
    match error {
        ScanError::Cancelled => Failure::Interrupted,
        ScanError::Tracer(error) => tracer_failure(path, error),
        ScanError::Triangulation(error) => crate::measuring(path, error, HELP),
        error => Failure::input(format!("{}: {error}", path.display()), HELP),
    }
}
