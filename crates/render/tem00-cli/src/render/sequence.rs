//! The frames of a render, one after the other.

use std::{path::Path, time::Instant};

use tem00_engine::render_frame;
use tem00_numerics::cast::to_usize;
use tem00_report::{failure::Failure, interrupt, output::note, progress::FrameProgress};
use tem00_tracer::{
    Filter, Frame, Method, RenderError, Sampling, SurfaceSpeckle, render_reference,
};

use super::{
    job::{Patterns, Render, tracer_failure},
    record::{Found, Record, forget, hash_of_file},
};
use crate::{
    frame_files::{FramePaths, automatic_exposure, picture_of, write_layers, write_preview},
    summary::{Exposure, FrameLaser, FrameSummary},
};

/// The frames of a finished render.
#[derive(Debug)]
pub(super) struct Sequence {
    /// The exposure that all frames share.
    pub(super) exposure: Exposure,
    /// Finished frames of the render, from this run or an earlier one, in order.
    pub(super) finished: Vec<FrameSummary>,
}

impl Render<'_> {
    /// Renders and writes all requested frames that are not finished.
    ///
    /// # Errors
    ///
    /// Returns a failure if a frame cannot be rendered or written, if the render is to resume in a
    /// folder with frames of another render, or if the user interrupts it.
    pub(super) fn sequence(&self) -> Result<Sequence, Failure> {
        let missing = self.missing()?;
        let mut exposure = self.known_exposure();
        if missing.is_empty() {
            note("nothing to do: all frames are finished");
        } else {
            self.render_missing(&missing, &mut exposure)
                .inspect_err(|failure| self.note_how_to_go_on(failure))?;
        }
        Ok(Sequence {
            exposure: exposure.unwrap_or(Exposure::for_all_light(1.0)),
            finished: self.finished(),
        })
    }

    fn render_missing(
        &self,
        missing: &[u32],
        exposure: &mut Option<Exposure>,
    ) -> Result<(), Failure> {
        let model = self.speckle()?;
        let needs_first = exposure.is_none() && missing.first() != Some(&0);
        let count = missing.len() as u64 + u64::from(needs_first);
        let progress = FrameProgress::new(count, self.samples_per_frame());
        if needs_first {
            note(
                "exposure: frame 0, which sets that of all, is rendered for it; --white-level \
                 saves the time",
            );
            let frame = self.frame(0, model.as_ref(), &progress)?;
            *exposure = Some(automatic_exposure(&frame));
        }
        for &number in missing {
            let start = Instant::now();
            let frame = self.frame(number, model.as_ref(), &progress)?;
            let seconds = start.elapsed().as_secs_f64();
            self.write(number, &frame, seconds, exposure)?;
        }
        Ok(())
    }

    /// Returns the frames to render: the requested frames, without the finished ones if the render
    /// resumes.
    fn missing(&self) -> Result<Vec<u32>, Failure> {
        let asked = self.frames.first..=self.frames.last;
        if !self.args.resume {
            return Ok(asked.collect());
        }
        let finished = self.finished();
        if finished.is_empty()
            && let Some(path) = self.foreign_record()
        {
            return Err(Failure::input(
                format!(
                    "cannot go on: {} belongs to another render; the scene, a file of it, the \
                     options or the program have changed",
                    path.display()
                ),
                "leave out --resume to begin anew, or name another folder with -o",
            ));
        }
        let is_finished =
            |number: &u32| finished.binary_search_by_key(number, |f| f.number).is_ok();
        Ok(asked.filter(|number| !is_finished(number)).collect())
    }

    /// Returns the finished frames of this render that the folder holds, in order.
    fn finished(&self) -> Vec<FrameSummary> {
        let frame = |number| match self.find(number) {
            Found::Ours { frame, .. } if belong_to(&frame, &self.paths(number)) => Some(frame),
            _ => None,
        };
        (0..self.scene.frames).filter_map(frame).collect()
    }

    fn foreign_record(&self) -> Option<std::path::PathBuf> {
        let foreign = |&number: &u32| matches!(self.find(number), Found::Foreign);
        let number = (0..self.scene.frames).find(foreign)?;
        Some(self.paths(number).record)
    }

    fn find(&self, number: u32) -> Found {
        Record::find(&self.paths(number).record, number, &self.fingerprint)
    }

    /// Returns the requested exposure, or the exposure that frame 0 of this render set before.
    ///
    /// If frame 0 is to be rendered again, it sets the same exposure again.
    fn known_exposure(&self) -> Option<Exposure> {
        match (self.scene.render.white_level, self.find(0)) {
            (Some(level), _) => Some(Exposure::asked(level)),
            (None, Found::Ours { exposure, .. }) => Some(exposure),
            _ => None,
        }
    }

    fn paths(&self, number: u32) -> FramePaths {
        FramePaths::new(&self.folder, &self.name, number, self.scene.frames)
    }

    fn frame(
        &self,
        number: u32,
        patterns: Option<&Patterns>,
        progress: &FrameProgress,
    ) -> Result<Frame, Failure> {
        let advance = progress.begin(match self.scene.frames {
            1 => self.name.clone(),
            frames => format!("{} frame {number} of 0..{}", self.name, frames - 1),
        });
        let flag = interrupt::flag();
        let (scene, options) = (&self.scene, &self.scene.render);
        let frame = match patterns {
            Some(Patterns::Reference(speckle)) => {
                render_reference(scene, Some(speckle), number, options, &advance, flag)
            }
            None if self.args.reference => {
                render_reference(scene, None, number, options, &advance, flag)
            }
            Some(Patterns::Engine(model)) => {
                render_frame(scene, Some(model), number, options, &advance, flag)
            }
            None => render_frame(scene, None, number, options, &advance, flag),
        };
        frame.map_err(|error| match error {
            RenderError::Cancelled => Failure::Interrupted,
            RenderError::Scene(error) => tracer_failure(&self.args.common.scene, &error),
            other => Failure::running(other.to_string()),
        })
    }

    /// Writes the images of a frame, then the record that marks them as complete.
    fn write(
        &self,
        number: u32,
        frame: &Frame,
        seconds: f64,
        exposure: &mut Option<Exposure>,
    ) -> Result<(), Failure> {
        let paths = self.paths(number);
        let picture = picture_of(frame);
        // The first frame sets the exposure of all, so that they can be compared.
        let exposure = exposure.get_or_insert_with(|| automatic_exposure(frame));
        forget(&paths.record)?;
        let white = exposure.white_level;
        write_preview(&paths.preview, &picture, white, &self.description())?;
        let camera = &self.scene.camera;
        let size = [camera.width(), camera.height()];
        write_layers(&paths.layers, frame, &picture, size).inspect_err(|_| {
            // An incomplete result is removed; the preview may be gone already.
            let _ = std::fs::remove_file(&paths.preview);
        })?;
        let record = Record {
            fingerprint: self.fingerprint.clone(),
            exposure: exposure.clone(),
            frames: vec![self.measure(number, frame, seconds, &paths)?],
        };
        record.write(&paths.record)
    }

    fn measure(
        &self,
        number: u32,
        frame: &Frame,
        seconds: f64,
        paths: &FramePaths,
    ) -> Result<FrameSummary, Failure> {
        let plans = self.plan.as_ref().filter(|_| self.knows_contrast());
        let plans = plans.map(|plan| plan.patterns());
        let lasers = frame.lasers.iter().zip(&self.scene.lasers).enumerate();
        let lasers = lasers.map(|(index, (layers, laser))| {
            let plan = plans.and_then(|plans| plans.get(index));
            let plan = plan.filter(|_| laser.spectrum().is_monochromatic());
            FrameLaser::measure(
                layers,
                laser.power(),
                plan,
                self.scene.render.samples_per_pixel,
            )
        });
        let hash = |path: &Path| {
            hash_of_file(path).map_err(|error| {
                Failure::running(format!("cannot read {}: {error}", path.display()))
            })
        };
        Ok(FrameSummary {
            number,
            preview: FramePaths::name_of(&paths.preview),
            layers: FramePaths::name_of(&paths.layers),
            preview_fnv1a: hash(&paths.preview)?,
            layers_fnv1a: hash(&paths.layers)?,
            lasers: lasers.collect(),
            samples: self.samples_of(frame),
            rays: frame.rays,
            seconds,
        })
    }

    /// Returns whether the expected contrast is known: the contrast of one pattern, averaged over
    /// the area of a pixel by a fixed number of camera samples.
    fn knows_contrast(&self) -> bool {
        let mut surfaces = self.scene.surfaces.iter();
        self.scene.render.method == Method::Path
            && self.scene.render.sampling == Sampling::Even
            && self.scene.render.filter == Filter::default()
            && surfaces.all(|surface| surface.speckle == SurfaceSpeckle::default())
    }

    /// Returns the number of samples of a frame. If the number depends on the light, it counts the
    /// samples in the pixels.
    fn samples_of(&self, frame: &Frame) -> u64 {
        match self.scene.render.sampling {
            Sampling::Even => self.samples_per_frame(),
            Sampling::Adaptive | Sampling::TargetError(_) => {
                let counts = frame.samples.values().iter();
                counts.map(|&count| to_usize(count.into()) as u64).sum()
            }
        }
    }

    /// Notes the finished frames after an interruption.
    fn note_how_to_go_on(&self, failure: &Failure) {
        let frames = self.scene.frames;
        if frames > 1 && matches!(failure, Failure::Interrupted) {
            note(&format!(
                "{} of {frames} frames are finished; the same command with --resume goes on",
                self.finished().len()
            ));
        }
    }
}

/// Returns whether the images next to a record are the images that it was written for.
fn belong_to(frame: &FrameSummary, paths: &FramePaths) -> bool {
    let is = |path: &Path, hash: &String| hash_of_file(path).is_ok_and(|found| found == *hash);
    is(&paths.preview, &frame.preview_fnv1a) && is(&paths.layers, &frame.layers_fnv1a)
}
