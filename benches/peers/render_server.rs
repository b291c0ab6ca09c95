//! Does a task of a renderer for every line of the input and answers with the seconds it took.
//!
//! ```text
//! load scene.toml   reads a scene
//! lights scene.toml  reads a scene and leaves its lasers out
//! even | adaptive   from now on, how samples are shared among the pixels
//! render 64 1       renders it without speckle: samples per pixel, and seed
//! connect 64 1      the same, but lights count only where surfaces are connected to them
//! write image.raw   writes what was rendered as rows of 32-bit floats: the sum of all light
//! peak              no time: the most memory the process has had, in MiB (Linux)
//! ```

#![expect(clippy::print_stdout, reason = "the answers")]

use std::{
    error::Error,
    fs::{read_to_string, write},
    io::stdin,
    path::Path,
    sync::atomic::AtomicBool,
    time::Instant,
};

use tem00::engine::render_frame;
use tem00::scene::read_scene;
use tem00::tracer::{Frame, LightEvents, RenderOptions, Sampling, Scene};

#[derive(Default)]
struct Server {
    scene: Option<Scene>,
    frame: Option<Frame>,
    sampling: Sampling,
}

impl Server {
    fn perform(&mut self, task: &str, arguments: &str) -> Result<(), Box<dyn Error>> {
        match task {
            "load" => self.scene = Some(read_scene(Path::new(arguments))?),
            "lights" => {
                let mut scene = read_scene(Path::new(arguments))?;
                scene.lasers.clear();
                self.scene = Some(scene);
            }
            "even" => self.sampling = Sampling::Even,
            "adaptive" => self.sampling = Sampling::Adaptive,
            "render" => self.frame = Some(self.render(arguments, LightEvents::Both)?),
            "connect" => self.frame = Some(self.render(arguments, LightEvents::NextEvent)?),
            "write" => write(arguments, self.image()?)?,
            _ => return Err(format!("unknown task {task}").into()),
        }
        Ok(())
    }

    fn render(&self, arguments: &str, light_events: LightEvents) -> Result<Frame, Box<dyn Error>> {
        let scene = self.scene.as_ref().ok_or("no scene")?;
        let (samples, seed) = arguments.split_once(' ').ok_or("samples and a seed")?;
        let options = RenderOptions {
            samples_per_pixel: samples.parse()?,
            seed: seed.parse()?,
            light_events,
            sampling: self.sampling,
            ..scene.render
        };
        let never = AtomicBool::new(false);
        Ok(render_frame(scene, None, 0, &options, &|_| (), &never)?)
    }

    /// The radiance of all light, row by row, as bytes.
    fn image(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let frame = self.frame.as_ref().ok_or("no frame")?;
        let mut sum = frame.lights.values().to_vec();
        for laser in &frame.lasers {
            for (sum, value) in sum.iter_mut().zip(laser.radiance.values()) {
                *sum += value;
            }
        }
        Ok(sum.into_iter().flat_map(f32::to_le_bytes).collect())
    }
}

/// The most memory this process has had, in MiB.
fn peak() -> Result<f64, Box<dyn Error>> {
    let status = read_to_string("/proc/self/status")?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kibibytes = line.and_then(|line| line.split_whitespace().next());
    Ok(kibibytes.ok_or("no VmHWM")?.parse::<f64>()? / 1_024.0)
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut server = Server::default();
    for line in stdin().lines() {
        let line = line?;
        let (task, arguments) = line.split_once(' ').unwrap_or((&line, ""));
        if task == "peak" {
            println!("{}", peak()?);
            continue;
        }
        let start = Instant::now();
        server.perform(task, arguments)?;
        println!("{}", start.elapsed().as_secs_f64());
    }
    Ok(())
}
