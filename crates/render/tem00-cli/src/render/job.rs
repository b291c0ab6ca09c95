//! A render of a scene.

use std::path::{Path, PathBuf};

use tem00_engine::{SpeckleModel, SpecklePlan, cascade_notes, roughness_notes, samples_per_frame};
use tem00_report::{
    args::IndexRange,
    failure::Failure,
    folder_lock::FolderLock,
    interrupt,
    output::{self, note},
};
use tem00_speckle::SpeckleError;
use tem00_tracer::{ReferenceSpeckle, Scene, TracerError};

use super::{record::Fingerprint, report::note_roughness};
use crate::{
    args::RenderArgs,
    frame_files::{FramePaths, check_room},
    inspection::Inspection,
};

/// The patterns of a scene, for either integrator.
pub(super) enum Patterns {
    Engine(SpeckleModel),
    Reference(ReferenceSpeckle),
}

/// A render that is ready to start.
pub(super) struct Render<'a> {
    pub(super) args: &'a RenderArgs,
    pub(super) scene: Scene,
    /// The requested frames.
    pub(super) frames: IndexRange,
    pub(super) name: String,
    pub(super) folder: PathBuf,
    pub(super) plan: Option<SpecklePlan>,
    pub(super) fingerprint: Fingerprint,
    pub(super) _lock: FolderLock,
}

impl<'a> Render<'a> {
    pub(super) fn new(
        args: &'a RenderArgs,
        scene: Scene,
        (text, files): (&str, &[PathBuf]),
    ) -> Result<Self, Failure> {
        let name = output::name(&args.common.scene, "scene");
        let folder = output::folder(args.common.output.as_deref(), &name);
        let options = scene.render;
        let plan = (!args.common.no_speckle)
            .then(|| SpecklePlan::new(&scene, options.seed))
            .transpose()
            .map_err(|error| tracer_failure(&args.common.scene, &error))?;
        // The text is included, because standard input is not one of the files.
        let changes = args.common.files.reading().changes;
        let choices = (options, plan.is_some(), args.reference, text, changes);

        let frames = frames(args.common.frames, scene.frames)?;
        check_room(&args.common.scene, &scene)?;
        let fingerprint = Fingerprint::of(&scene, files, &choices)?;
        let lock = match args.common.frames {
            Some(_) => output::prepare_for_part(&folder, &fingerprint.to_string()),
            None => output::prepare(&folder),
        }?;
        let render = Self {
            args,
            frames,
            fingerprint,
            _lock: lock,
            scene,
            name,
            folder,
            plan,
        };
        render.check_targets()?;
        Ok(render)
    }

    /// Checks, before the work starts, that no folder has the name of an output file.
    pub(super) fn check_targets(&self) -> Result<(), Failure> {
        let frames = self.scene.frames;
        let of_frames = (self.frames.first..=self.frames.last).flat_map(|number| {
            let paths = FramePaths::new(&self.folder, &self.name, number, frames);
            [paths.preview, paths.layers, paths.record]
        });
        match of_frames
            .chain([self.summary_path()])
            .find(|path| path.is_dir())
        {
            Some(path) => Err(Failure::unavailable(
                format!("cannot write {}: it is a folder", path.display()),
                "name another folder with -o",
            )),
            None => Ok(()),
        }
    }

    pub(super) fn summary_path(&self) -> PathBuf {
        self.folder.join(format!("{}.json", self.name))
    }

    /// Warns, before the work starts, about lasers whose light the camera will not see, and in that
    /// case draws the scene.
    pub(super) fn warn_of_darkness(&self) -> Result<(), Failure> {
        let found = Inspection::new(&self.scene, self.frames)
            .map_err(|error| tracer_failure(&self.args.common.scene, &error))?;
        let warnings = found.warnings();
        if warnings.is_empty() {
            return Ok(());
        }
        warnings.iter().for_each(|line| note(line));
        let path = found.draw(&self.folder, &format!("{}_overview", self.name))?;
        note(&format!("drawn in {}", path.display()));
        Ok(())
    }

    pub(super) fn speckle(&self) -> Result<Option<Patterns>, Failure> {
        let Some(plan) = &self.plan else {
            note("speckle: disabled");
            return Ok(None);
        };
        for line in plan.to_string().lines() {
            note(&format!("speckle: {line}"));
        }
        let refused = |error| tracer_failure(&self.args.common.scene, &error);
        note_roughness(&roughness_notes(&self.scene).map_err(refused)?);
        for line in cascade_notes(&self.scene).map_err(refused)? {
            note(&format!("speckle: {line}"));
        }
        for line in plan.correlation_notes() {
            note(&format!("speckle: {line}"));
        }
        let model = match self.args.reference {
            true => ReferenceSpeckle::prepare(&self.scene, self.scene.render.seed)
                .map(Patterns::Reference),
            false => SpeckleModel::generate(&self.scene, plan).map(Patterns::Engine),
        };
        let model = model.map_err(refused)?;
        interrupt::check()?;
        Ok(Some(model))
    }

    pub(super) fn samples_per_frame(&self) -> u64 {
        samples_per_frame(&self.scene, &self.scene.render)
    }

    pub(super) fn description(&self) -> String {
        format!(
            "{}: {} samples per pixel, seed {}, speckle {}",
            self.name,
            self.scene.render.samples_per_pixel,
            self.scene.render.seed,
            if self.plan.is_some() { "on" } else { "off" }
        )
    }
}

/// Returns the frames that the command line selects of the `count` frames of the scene, or all of
/// them without a selection.
///
/// # Errors
///
/// Returns a failure if the scene has fewer frames than the selection needs.
pub fn frames(asked: Option<IndexRange>, count: u32) -> Result<IndexRange, Failure> {
    let last = count.saturating_sub(1);
    let asked = asked.unwrap_or(IndexRange { first: 0, last });
    if asked.last <= last {
        return Ok(asked);
    }
    Err(Failure::input(
        format!(
            "--frames {}..{}: the scene has the frames 0..{last}",
            asked.first, asked.last
        ),
        "`frames` in the section [render] of the scene says how many there are",
    ))
}

/// Returns the failure of a tracer, with advice on what to change.
pub fn tracer_failure(path: &Path, error: &TracerError) -> Failure {
    let help = match error {
        TracerError::PatternMemory { needed, allowed } => format!(
            "{} needed, {} allowed: `memory` in [speckle], which all lasers share, allows more; \
             `size` and `diameter` ask for smaller patterns; --no-speckle leaves them out",
            binary(*needed),
            binary(*allowed)
        ),
        TracerError::Speckle(_) => {
            "[speckle] in the scene file can set memory, size, diameter and half_period".into()
        }
        TracerError::FilmMemory { .. } => {
            "--crop renders a part of the image; `resolution` in [camera] makes it smaller".into()
        }
        _ => "docs/scene_file.md lists what is allowed".into(),
    };
    let message = format!("{}: {error}", path.display());
    let no_memory = matches!(
        error,
        TracerError::FilmMemory { .. } | TracerError::Speckle(SpeckleError::Memory { .. })
    );
    Failure::refused(no_memory, message, help)
}

/// Formats a number of bytes in KiB, or in MiB if there are many, rounded up.
pub(super) fn binary(bytes: u64) -> String {
    match bytes.div_ceil(1 << 10) {
        few @ ..16_384 => format!("{few} KiB"),
        many => format!("{} MiB", many.div_ceil(1 << 10)),
    }
}
