//! `tem00 render`: from a scene file to images.

mod job;
mod record;
mod report;
mod sequence;

use std::io::Write;

use tem00_scene::SceneFile;
use tem00_tracer::{Method, Scene};

pub(crate) use self::job::{frames, tracer_failure};
use self::{
    job::Render,
    record::write_json,
    report::{note_invisible_lasers, note_missing_light, report},
    sequence::Sequence,
};
use crate::{
    args::RenderArgs,
    failure::Failure,
    image::check_inside,
    inspection::Inspection,
    kind::{Kind, wrong_or},
    output,
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
    let summary = pool.install(|| summary(&render, sequence));
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

/// Sums up the frames of a render.
fn summary(render: &Render<'_>, sequence: Sequence) -> Summary {
    let frames = sequence.finished;
    let seconds: f64 = frames.iter().map(|frame| frame.seconds).sum();
    let samples: u64 = frames.iter().map(|frame| frame.samples).sum();
    let rays: u64 = frames.iter().map(|frame| frame.rays).sum();
    let per_second = |count: u64| count as f64 / seconds.max(1e-9);
    Summary {
        program: concat!("tem00 ", env!("CARGO_PKG_VERSION")),
        scene: render.args.common.scene.display().to_string(),
        fingerprint: render.fingerprint.to_string(),
        formulas: render.formulas(),
        seed: render.options.seed,
        samples_per_pixel: render.options.samples_per_pixel,
        method: match render.options.method {
            Method::Path => "path",
            Method::Light => "light",
        },
        max_depth: render.options.max_depth,
        target_error: render.options.target_error,
        width: render.scene.camera.width(),
        height: render.scene.camera.height(),
        crop: render
            .options
            .crop
            .map(|crop| [crop.x, crop.y, crop.width, crop.height]),
        lasers: LaserSummary::of_scene(&render.scene, render.plan.as_ref()),
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
