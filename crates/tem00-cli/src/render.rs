//! `tem00 render`: from a scene file to images.

use std::{
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

use rayon::{ThreadPool, ThreadPoolBuilder};
use tem00_tracer::{
    Formulas, Frame, RenderError, RenderOptions, Scene, SceneError, SpeckleModel, SpecklePlan,
    TracerError, read_scene, render_frame,
};

use crate::{
    args::RenderArgs,
    atomic::{create_writable_folder, write_atomically},
    colour::xyz_of_wavelength,
    failure::Failure,
    frame_files::{FramePaths, automatic_exposure, picture_of, write_layers, write_preview},
    interrupt,
    progress::{Progress, si_prefixed},
    summary::{Exposure, FrameLaser, FrameSummary, LaserSummary, Summary},
};

/// Renders a scene and prints the names of the files that were written.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written or the user ends it.
pub(crate) fn run(args: &RenderArgs, out: &mut impl Write) -> Result<(), Failure> {
    let mut scene = read_scene(&args.scene).map_err(|error| scene_failure(&args.scene, &error))?;
    scene.render.samples_per_pixel = args.spp.unwrap_or(scene.render.samples_per_pixel);
    scene.render.seed = args.seed.unwrap_or(scene.render.seed);
    let render = Render::new(args, scene)?;
    let pool = thread_pool(args.threads)?;
    let summary = pool.install(|| render.frames())?;
    report(&summary);
    render.hint_at_what_is_not_seen(&summary);
    let path = render.summary_path();
    write_summary(&path, &summary)?;
    let files = summary
        .frames
        .iter()
        .flat_map(|frame| [&frame.preview, &frame.layers]);
    for file in files {
        writeln!(out, "{}", render.folder.join(file).display())
            .map_err(|error| Failure::stdout(&error))?;
    }
    writeln!(out, "{}", path.display()).map_err(|error| Failure::stdout(&error))
}

/// A render that is set up.
struct Render<'a> {
    args: &'a RenderArgs,
    scene: Scene,
    name: String,
    folder: PathBuf,
    options: RenderOptions,
    plan: Option<SpecklePlan>,
}

impl<'a> Render<'a> {
    fn new(args: &'a RenderArgs, scene: Scene) -> Result<Self, Failure> {
        let name = args.scene.file_stem().map_or_else(
            || "scene".to_owned(),
            |stem| stem.to_string_lossy().into_owned(),
        );
        let folder = args
            .output
            .clone()
            .unwrap_or_else(|| Path::new("out").join(&name));
        let options = RenderOptions {
            formulas: if args.paper {
                Formulas::AsPrinted
            } else {
                Formulas::Derived
            },
            ..RenderOptions::from(&scene.render)
        };
        let plan = if args.no_speckle {
            None
        } else {
            let plan = SpecklePlan::new(&scene, options.formulas, options.seed);
            Some(plan.map_err(|error| tracer_failure(&args.scene, &error))?)
        };
        create_writable_folder(&folder).map_err(|error| {
            Failure::input(
                format!("cannot write into the folder {}: {error}", folder.display()),
                "name a folder that may be written with -o",
            )
        })?;
        let render = Self {
            args,
            scene,
            name,
            folder,
            options,
            plan,
        };
        render.check_paths()?;
        Ok(render)
    }

    /// Makes sure, before the work, that no folder stands where a file will go.
    fn check_paths(&self) -> Result<(), Failure> {
        let frames = self.scene.render.frames;
        let of_frames = (0..frames).flat_map(|number| {
            let paths = FramePaths::new(&self.folder, &self.name, number, frames);
            [paths.preview, paths.layers]
        });
        match of_frames
            .chain([self.summary_path()])
            .find(|path| path.is_dir())
        {
            Some(path) => Err(Failure::input(
                format!("cannot write {}: it is a folder", path.display()),
                "name another folder with -o",
            )),
            None => Ok(()),
        }
    }

    fn summary_path(&self) -> PathBuf {
        self.folder.join(format!("{}.json", self.name))
    }

    /// Renders and writes all frames.
    fn frames(&self) -> Result<Summary, Failure> {
        self.note_invisible_lasers();
        let model = self.speckle()?;
        let frames = self.scene.render.frames;
        let (mut exposure, mut summaries) = (None, Vec::new());
        let mut elapsed = Duration::ZERO;
        for number in 0..frames {
            let start = Instant::now();
            let frame = self.frame(number, model.as_ref())?;
            elapsed += start.elapsed();
            summaries.push(self.write(number, &frame, &mut exposure)?);
        }
        let samples = u64::from(frames) * self.samples_per_frame();
        Ok(self.summary(summaries, exposure, samples, elapsed))
    }

    fn note_invisible_lasers(&self) {
        for (index, laser) in self.scene.lasers.iter().enumerate() {
            if xyz_of_wavelength(laser.wavelength()).is_none() {
                note(&format!(
                    "preview: laser {index}: light of {:.1} nm is invisible and shown in grey",
                    1e9 * laser.wavelength()
                ));
            }
        }
    }

    /// Where a laser lights nothing in the image, tells where things stand.
    fn hint_at_what_is_not_seen(&self, summary: &Summary) {
        let unseen = |frame: &FrameSummary| {
            frame
                .lasers
                .iter()
                .any(|laser| laser.power_on_target_w <= 0.0)
        };
        if !summary.frames.iter().any(unseen) {
            return;
        }
        note("hint: the camera sees no light of a laser; the surfaces stand at");
        for surface in &self.scene.surfaces {
            let (low, high) = surface.shape.bounds();
            let span = |low: f64, high: f64| format!("{:.1} … {:.1} mm", 1e3 * low, 1e3 * high);
            note(&format!(
                "  {}: x {}, y {}, z {}",
                surface.name,
                span(low.x, high.x),
                span(low.y, high.y),
                span(low.z, high.z)
            ));
        }
    }

    fn speckle(&self) -> Result<Option<SpeckleModel>, Failure> {
        let Some(plan) = &self.plan else {
            note("speckle: left out, as asked");
            return Ok(None);
        };
        for line in plan.to_string().lines() {
            note(&format!("speckle: {line}"));
        }
        let model = SpeckleModel::generate(&self.scene, plan)
            .map_err(|error| tracer_failure(&self.args.scene, &error))?;
        interrupt::check()?;
        Ok(Some(model))
    }

    fn frame(&self, number: u32, model: Option<&SpeckleModel>) -> Result<Frame, Failure> {
        let message = match self.scene.render.frames {
            1 => self.name.clone(),
            frames => format!("{} {} of {frames}", self.name, number + 1),
        };
        let progress = Progress::of_samples(self.samples_per_frame(), message);
        let done = AtomicU64::new(0);
        let advance = |samples| {
            progress.set(samples + done.fetch_add(samples, Ordering::Relaxed));
        };
        let flag = interrupt::flag();
        render_frame(&self.scene, model, number, &self.options, advance, flag).map_err(|error| {
            match error {
                RenderError::Cancelled => Failure::Interrupted,
                RenderError::Scene(error) => tracer_failure(&self.args.scene, &error),
                other => Failure::running(other.to_string()),
            }
        })
    }

    fn write(
        &self,
        number: u32,
        frame: &Frame,
        exposure: &mut Option<Exposure>,
    ) -> Result<FrameSummary, Failure> {
        let paths = FramePaths::new(&self.folder, &self.name, number, self.scene.render.frames);
        let picture = picture_of(frame);
        // The first frame sets the exposure of all, so that they can be compared.
        let exposure = exposure.get_or_insert_with(|| match self.args.white_level {
            Some(level) => Exposure::asked(level),
            None => automatic_exposure(frame),
        });
        write_preview(
            &paths.preview,
            &picture,
            exposure.white_level,
            &self.description(),
        )?;
        write_layers(&paths.layers, frame, &picture).inspect_err(|_| {
            // Half a result is none; that the preview may be gone already is no matter.
            let _ = fs::remove_file(&paths.preview);
        })?;
        let plans = self.plan.as_ref().map(SpecklePlan::patterns);
        let lasers = frame.lasers.iter().zip(&self.scene.lasers).enumerate();
        Ok(FrameSummary {
            preview: file_name(&paths.preview),
            layers: file_name(&paths.layers),
            lasers: lasers
                .map(|(index, (layers, laser))| {
                    let plan = plans.and_then(|plans| plans.get(index));
                    let samples = self.options.samples_per_pixel;
                    FrameLaser::measure(layers, laser.power(), plan, samples)
                })
                .collect(),
        })
    }

    fn summary(
        &self,
        frames: Vec<FrameSummary>,
        exposure: Option<Exposure>,
        samples: u64,
        elapsed: Duration,
    ) -> Summary {
        let seconds = elapsed.as_secs_f64();
        #[expect(clippy::cast_precision_loss, reason = "shown to a few digits")]
        let samples_per_second = samples as f64 / seconds.max(1e-9);
        Summary {
            program: concat!("tem00 ", env!("CARGO_PKG_VERSION")),
            scene: self.args.scene.display().to_string(),
            formulas: self.formulas(),
            seed: self.options.seed,
            samples_per_pixel: self.options.samples_per_pixel,
            width: self.scene.camera.width(),
            height: self.scene.camera.height(),
            lasers: LaserSummary::of_scene(&self.scene, self.plan.as_ref()),
            exposure: exposure.unwrap_or(Exposure::for_all_light(1.0)),
            frames,
            threads: rayon::current_num_threads(),
            samples,
            seconds,
            samples_per_second,
        }
    }

    fn samples_per_frame(&self) -> u64 {
        self.scene.samples_per_frame(&self.options)
    }

    const fn formulas(&self) -> &'static str {
        match self.options.formulas {
            Formulas::Derived => "derived",
            Formulas::AsPrinted => "as printed in Bergmann et al. 2016",
        }
    }

    fn description(&self) -> String {
        format!(
            "{}: {} samples per pixel, seed {}, formulas {}, speckle {}",
            self.name,
            self.options.samples_per_pixel,
            self.options.seed,
            self.formulas(),
            if self.plan.is_some() { "on" } else { "off" }
        )
    }
}

fn thread_pool(threads: Option<u16>) -> Result<ThreadPool, Failure> {
    ThreadPoolBuilder::new()
        .num_threads(threads.map_or(0, usize::from))
        .build()
        .map_err(|error| Failure::running(format!("cannot start the threads: {error}")))
}

fn scene_failure(path: &Path, error: &SceneError) -> Failure {
    let help = error.help().map(str::to_owned);
    match error.span() {
        Some(span) => Failure::input_at(error.message(), help, (path, error.source_text()), span),
        None => Failure::input(
            format!("{}: {}", path.display(), error.message()),
            help.unwrap_or_else(|| "a scene needs a laser, a camera and a surface".into()),
        ),
    }
}

fn tracer_failure(path: &Path, error: &TracerError) -> Failure {
    let help = match error {
        TracerError::PatternMemory { .. } | TracerError::Speckle(_) => {
            "[speckle] in the scene file can set memory, size, diameter and half_period"
        }
        _ => "docs/scene_file.md lists what is allowed",
    };
    Failure::input(format!("{}: {error}", path.display()), help)
}

fn write_summary(path: &Path, summary: &Summary) -> Result<(), Failure> {
    write_atomically(path, |file| {
        serde_json::to_writer_pretty(&mut *file, summary)?;
        writeln!(file)
    })
    .map_err(|error: io::Error| Failure::writing(path, error))
}

/// Tells on standard error what was found.
fn report(summary: &Summary) {
    for frame in &summary.frames {
        for (index, laser) in frame.lasers.iter().enumerate() {
            let ratio = 100.0 * laser.power_ratio;
            let watts = laser.power_on_target_w;
            note(&format!(
                "{}: laser {index}: {watts:.4e} W on target, {ratio:.2} % of its power",
                frame.preview
            ));
            if let Some(contrast) = laser.contrast {
                note(&format!(
                    "{}: laser {index}: speckle contrast {:.3} ± {:.3}, expected {:.3}",
                    frame.preview, contrast.measured, contrast.standard_error, contrast.expected
                ));
            }
        }
    }
    note(&format!(
        "exposure: white is {:.4e} W/(m² sr), {}",
        summary.exposure.white_level, summary.exposure.chosen_by
    ));
    note(&format!(
        "{:.2} s on {} threads, {}samples/s",
        summary.seconds,
        summary.threads,
        si_prefixed(summary.samples_per_second)
    ));
}

/// Writes a line to standard error, if there is anybody to read it.
fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{text}");
}

fn file_name(path: &Path) -> String {
    path.file_name()
        .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
