//! `tem00 render`: from a scene file to images.

mod record;
mod report;
mod sequence;

use std::{
    io::Write,
    path::{Path, PathBuf},
};

use tem00_scene::SceneFile;
use tem00_tracer::{
    Formulas, Method, RenderOptions, Scene, SpeckleModel, SpecklePlan, TracerError,
};

use self::{
    record::{Fingerprint, write_json},
    report::{note_invisible_lasers, note_missing_light, note_roughness, report},
    sequence::Sequence,
};
use crate::{
    args::{FrameRange, RenderArgs},
    failure::Failure,
    folder_lock::FolderLock,
    frame_files::{FramePaths, check_room},
    image::check_inside,
    inspection::Inspection,
    interrupt,
    kind::{Kind, wrong_or},
    output::{self, note},
    summary::{LaserSummary, Summary},
};

/// Renders a scene and prints the names of the files that it is in.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written or the user ends it.
pub(crate) fn run(args: &RenderArgs, out: &mut impl Write) -> Result<(), Failure> {
    let read = SceneFile::read_with(
        &args.common.scene,
        args.common.files.reading(),
        |document, _| Ok(document.text().to_owned()),
    );
    let (SceneFile { scene, files, .. }, text) = read.map_err(|error| {
        wrong_or(&args.common.scene, Kind::Scene, || {
            let needed = "a scene needs a laser, a camera and a surface";
            Failure::file(&args.common.scene, &error, needed)
        })
    })?;
    let scene = overruled(scene, args)?;
    if args.check {
        return check(args, &scene, out);
    }
    let render = Render::new(args, scene, (&text, &files))?;
    note_invisible_lasers(&render.scene);
    note_missing_light(&render.scene);
    render.warn_of_darkness()?;
    let pool = output::thread_pool(args.common.threads)?;
    let sequence = pool.install(|| render.sequence())?;
    let summary = pool.install(|| render.summary(sequence));
    report(&summary);
    let path = render.summary_path();
    write_json(&path, &summary)?;
    let asked = |number: u32| (render.frames.first..=render.frames.last).contains(&number);
    let frames = summary.frames.iter().filter(|frame| asked(frame.number));
    for file in frames.flat_map(|frame| [&frame.preview, &frame.layers]) {
        writeln!(out, "{}", render.folder.join(file).display())
            .map_err(|error| Failure::stdout(&error))?;
    }
    writeln!(out, "{}", path.display()).map_err(|error| Failure::stdout(&error))
}

/// Says what the camera will see of the lasers, and draws the scene.
fn check(args: &RenderArgs, scene: &Scene, out: &mut impl Write) -> Result<(), Failure> {
    let frames = frames(args.common.frames, scene.render.frames)?;
    let found = Inspection::new(scene, frames)
        .map_err(|error| tracer_failure(&args.common.scene, &error))?;
    let name = output::name(&args.common.scene, "scene");
    let folder = output::folder(args.common.output.as_deref(), &name);
    output::prepare(&folder)?;
    let drawing = format!("{name}_overview");
    found.draw(&folder, &drawing)?;
    let mut lines = found.lines();
    lines.push(folder.join(format!("{drawing}.svg")).display().to_string());
    writeln!(out, "{}", lines.join("\n")).map_err(|error| Failure::stdout(&error))?;
    if found.sees_all_lasers() {
        Ok(())
    } else {
        Err(Failure::no_result(
            "the camera will see no light of a laser",
            "the lines above say which, and why",
        ))
    }
}

/// Returns the scene with what the command line overrules.
fn overruled(mut scene: Scene, args: &RenderArgs) -> Result<Scene, Failure> {
    let settings = &mut scene.render;
    args.common.overrule(settings);
    settings.method = args.method.map_or(settings.method, Into::into);
    settings.max_depth = args.max_depth.or(settings.max_depth);
    settings.target_error = args.target_error.or(settings.target_error);
    settings.crop = args.crop.or(settings.crop);
    if let Some(crop) = settings.crop {
        check_inside(crop, [scene.camera.width(), scene.camera.height()]).map_err(|error| {
            Failure::input(
                error.to_string(),
                "the first two numbers are the upper left pixel, the others the size",
            )
        })?;
    }
    Ok(scene)
}

/// A render that is set up.
struct Render<'a> {
    args: &'a RenderArgs,
    scene: Scene,
    /// The frames that were asked for.
    frames: FrameRange,
    name: String,
    folder: PathBuf,
    options: RenderOptions,
    plan: Option<SpecklePlan>,
    fingerprint: Fingerprint,
    _lock: FolderLock,
}

impl<'a> Render<'a> {
    fn new(
        args: &'a RenderArgs,
        scene: Scene,
        (text, files): (&str, &[PathBuf]),
    ) -> Result<Self, Failure> {
        let name = output::name(&args.common.scene, "scene");
        let folder = output::folder(args.common.output.as_deref(), &name);
        let options = options(args, &scene);
        let plan = (!args.common.no_speckle)
            .then(|| SpecklePlan::new(&scene, options.formulas, options.seed))
            .transpose()
            .map_err(|error| tracer_failure(&args.common.scene, &error))?;
        // The text as well: standard input is none of the files.
        let changes = args.common.files.reading().changes;
        let choices = (options, plan.is_some(), args.white_level, text, changes);

        let frames = frames(args.common.frames, scene.render.frames)?;
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
            options,
            plan,
        };
        render.check_targets()?;
        Ok(render)
    }

    /// Makes sure, before the work, that no folder stands where a file goes.
    fn check_targets(&self) -> Result<(), Failure> {
        let frames = self.scene.render.frames;
        let of_frames = (self.frames.first..=self.frames.last).flat_map(|number| {
            let paths = FramePaths::new(&self.folder, &self.name, number, frames);
            [paths.preview, paths.layers, paths.record]
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

    /// Says, before the work, of which lasers the camera will see no light, and draws the scene then.
    fn warn_of_darkness(&self) -> Result<(), Failure> {
        let found = Inspection::new(&self.scene, self.frames)
            .map_err(|error| tracer_failure(&self.args.common.scene, &error))?;
        let warnings = found.warnings();
        if warnings.is_empty() {
            return Ok(());
        }
        warnings.iter().for_each(|line| note(line));
        let name = format!("{}_overview", self.name);
        note(&format!(
            "drawn in {}",
            self.folder.join(format!("{name}.svg")).display()
        ));
        found.draw(&self.folder, &name)
    }

    fn speckle(&self) -> Result<Option<SpeckleModel>, Failure> {
        let Some(plan) = &self.plan else {
            note("speckle: left out, as asked");
            return Ok(None);
        };
        for line in plan.to_string().lines() {
            note(&format!("speckle: {line}"));
        }
        let notes = self.scene.roughness_notes();
        note_roughness(&notes.map_err(|error| tracer_failure(&self.args.common.scene, &error))?);
        let model = SpeckleModel::generate(&self.scene, plan)
            .map_err(|error| tracer_failure(&self.args.common.scene, &error))?;
        interrupt::check()?;
        Ok(Some(model))
    }

    fn summary(&self, sequence: Sequence) -> Summary {
        let frames = sequence.finished;
        let seconds: f64 = frames.iter().map(|frame| frame.seconds).sum();
        let samples: u64 = frames.iter().map(|frame| frame.samples).sum();
        let rays: u64 = frames.iter().map(|frame| frame.rays).sum();
        let per_second = |count: u64| count as f64 / seconds.max(1e-9);
        Summary {
            program: concat!("tem00 ", env!("CARGO_PKG_VERSION")),
            scene: self.args.common.scene.display().to_string(),
            fingerprint: self.fingerprint.to_string(),
            formulas: self.formulas(),
            seed: self.options.seed,
            samples_per_pixel: self.options.samples_per_pixel,
            method: match self.options.method {
                Method::Path => "path",
                Method::Light => "light",
            },
            max_depth: self.options.max_depth,
            target_error: self.options.target_error,
            width: self.scene.camera.width(),
            height: self.scene.camera.height(),
            crop: self
                .options
                .crop
                .map(|crop| [crop.x, crop.y, crop.width, crop.height]),
            lasers: LaserSummary::of_scene(&self.scene, self.plan.as_ref()),
            exposure: sequence.exposure,
            frames,
            threads: rayon::current_num_threads(),
            samples,
            rays,
            seconds,
            samples_per_second: per_second(samples),
            rays_per_second: per_second(rays),
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

fn options(args: &RenderArgs, scene: &Scene) -> RenderOptions {
    RenderOptions {
        formulas: if args.paper {
            Formulas::AsPrinted
        } else {
            Formulas::Derived
        },
        ..RenderOptions::from(&scene.render)
    }
}

/// Returns the frames that the command line asks for, of the `count` that the scene has; all of them if
/// it asks for none.
pub(crate) fn frames(asked: Option<FrameRange>, count: u32) -> Result<FrameRange, Failure> {
    let last = count.saturating_sub(1);
    let asked = asked.unwrap_or(FrameRange { first: 0, last });
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

pub(crate) fn tracer_failure(path: &Path, error: &TracerError) -> Failure {
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
    Failure::input(format!("{}: {error}", path.display()), help)
}

/// A number of bytes in KiB, or MiB where those are many, rounded up.
fn binary(bytes: u64) -> String {
    match bytes.div_ceil(1 << 10) {
        few @ ..16_384 => format!("{few} KiB"),
        many => format!("{} MiB", many.div_ceil(1 << 10)),
    }
}
