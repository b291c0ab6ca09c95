//! `tem00 render`: from a scene file to images.

mod job;
mod record;
mod report;
mod sequence;

use std::io::Write;

use tem00_numerics::parallel;
use tem00_report::{
    digits::si_prefixed,
    failure::Failure,
    kind::{Kind, wrong_or},
    output,
    report::Report,
};
use tem00_scene::SceneFile;
use tem00_tracer::{Sampling, Scene};

pub use self::job::{frames, tracer_failure};
use self::{
    job::Render,
    report::{note_invisible_lasers, note_missing_light, of_frames},
    sequence::Sequence,
};
use crate::{
    args::RenderArgs,
    inspection::Inspection,
    summary::{FrameSummary, lasers},
};

/// Renders a scene and prints the names of its image files.
///
/// # Errors
///
/// Returns a failure if the input is not valid, a file cannot be written or the user interrupts the
/// render.
pub fn run(args: &RenderArgs, out: &mut impl Write) -> Result<(), Failure> {
    let files = args.common.files.with(args.crop.as_ref());
    let read = SceneFile::read_with(&args.common.scene, files.reading(), |document, _| {
        Ok(document.text().to_owned())
    });
    let (file, text) = read.map_err(|error| {
        wrong_or(&args.common.scene, Kind::Scene, || {
            let needed = "a scene needs a laser, a camera and a surface";
            Failure::file(&args.common.scene, &error, needed)
        })
    })?;
    let SceneFile {
        scene,
        files,
        notes,
        ..
    } = file;
    notes.iter().for_each(|line| output::note(line));
    let scene = overruled(scene, args);
    if args.check {
        return check(args, &scene, out);
    }
    let render = Render::new(args, scene, (&text, &files))?;
    note_invisible_lasers(&render.scene);
    note_missing_light(&render.scene);
    render.warn_of_darkness()?;
    let pool = output::thread_pool(args.common.threads)?;
    let sequence = pool.install(|| render.sequence())?;
    let mut report = pool.install(|| report(&render, &sequence));
    notes.into_iter().for_each(|line| report.note(line));
    report.tell_verdicts();
    let path = render.summary_path();
    report.save_json(&path)?;
    let asked = |number: u32| (render.frames.first..=render.frames.last).contains(&number);
    let frames = sequence.finished.iter().filter(|frame| asked(frame.number));
    for file in frames.flat_map(|frame| [&frame.preview, &frame.layers]) {
        writeln!(out, "{}", render.folder.join(file).display())
            .map_err(|error| Failure::stdout(&error))?;
    }
    writeln!(out, "{}", path.display()).map_err(|error| Failure::stdout(&error))
}

/// Says what the camera will see of the lasers, and draws the scene.
fn check(args: &RenderArgs, scene: &Scene, out: &mut impl Write) -> Result<(), Failure> {
    let frames = frames(args.common.frames, scene.frames)?;
    let found = Inspection::new(scene, frames)
        .map_err(|error| tracer_failure(&args.common.scene, &error))?;
    let name = output::name(&args.common.scene, "scene");
    let folder = output::folder(args.common.output.as_deref(), &name);
    output::prepare(&folder)?;
    let mut lines = found.lines();
    let drawing = found.draw(&folder, &format!("{name}_overview"))?;
    lines.push(drawing.display().to_string());
    writeln!(out, "{}", lines.join("\n")).map_err(|error| Failure::stdout(&error))?;
    if found.sees_all_lasers() {
        Ok(())
    } else {
        Err(Failure::no_result(
            "the camera will see no light of a laser",
            "the lines above give the laser and the reason",
        ))
    }
}

/// Returns the scene with the values that the command line overrides.
fn overruled(mut scene: Scene, args: &RenderArgs) -> Scene {
    let options = &mut scene.render;
    args.common.overrule(options);
    options.method = args.method.unwrap_or(options.method);
    options.max_depth = args.max_depth.or(options.max_depth);
    options.white_level = args.white_level.or(options.white_level);
    if let Some(error) = args.target_error {
        options.sampling = Sampling::TargetError(error);
    }
    scene
}

/// Returns the report of the frames of a render.
fn report(render: &Render<'_>, Sequence { exposure, finished }: &Sequence) -> Report {
    let (options, camera) = (&render.scene.render, &render.scene.camera);
    let mut report = Report::new(format!("{}: rendered", render.name));
    report.data("scene", render.args.common.scene.display().to_string());
    report.data("fingerprint", render.fingerprint.to_string());
    report.data("seed", options.seed);
    report.data("samples_per_pixel", options.samples_per_pixel);
    report.data("reference", render.args.reference);
    report.data("method", options.method.name());
    report.data("max_depth", options.max_depth);
    let target = match options.sampling {
        Sampling::TargetError(error) => Some(error),
        Sampling::Even | Sampling::Adaptive => None,
    };
    report.data("target_error", target);
    report.data("adaptive", options.sampling == Sampling::Adaptive);
    report.data("width", camera.width());
    report.data("height", camera.height());
    let crop = options.crop;
    report.data(
        "crop",
        crop.map(|crop| [crop.x, crop.y, crop.width, crop.height]),
    );
    report.data("lasers", lasers(&render.scene, render.plan.as_ref()));
    report.data("exposure", exposure);
    report.data("frames", finished);
    of_frames(finished)
        .into_iter()
        .for_each(|line| report.verdict(line));
    report.verdict(format!(
        "exposure: white is {:.4e} W/(m² sr), {}",
        exposure.white_level, exposure.chosen_by
    ));
    speed(&mut report, finished);
    report
}

/// Adds the numbers of samples and rays, and the time that they took.
fn speed(report: &mut Report, frames: &[FrameSummary]) {
    let seconds: f64 = frames.iter().map(|frame| frame.seconds).sum();
    let samples: u64 = frames.iter().map(|frame| frame.samples).sum();
    let rays: u64 = frames.iter().map(|frame| frame.rays).sum();
    let threads = parallel::thread_count();
    let [samples_per_second, rays_per_second] =
        [samples, rays].map(|count| count as f64 / seconds.max(1e-9));
    report.data("threads", threads);
    report.data("samples", samples);
    report.data("rays", rays);
    report.data("seconds", seconds);
    report.data("samples_per_second", samples_per_second);
    report.data("rays_per_second", rays_per_second);
    report.verdict(format!(
        "{seconds:.2} s on {threads} threads, {}samples/s, {}rays/s",
        si_prefixed(samples_per_second),
        si_prefixed(rays_per_second)
    ));
}
