//! The files of one rendered frame.

use std::path::{Path, PathBuf};

use tem00_numerics::Grid;
use tem00_report::{
    failure::Failure,
    image::{Layer, Window, write_exr, write_rgb_png},
    output,
};
use tem00_tracer::{Frame, LaserLayers, Scene};

use crate::{preview::Picture, summary::Exposure};

/// Checks, before the work starts, that memory is available for the frames of the scene in a file:
/// for their layers, for a second copy of these while they are written, and for the picture.
///
/// # Errors
///
/// Returns a failure if the system reports less memory than is needed.
pub fn check_room(path: &Path, scene: &Scene) -> Result<(), Failure> {
    let camera = &scene.camera;
    let whole = [camera.width(), camera.height()];
    let [width, height] = scene
        .render
        .crop
        .map_or(whole, |crop| [crop.width, crop.height]);
    let values = 2 * (5 * scene.lasers.len() as u64 + 8) + 10;
    let bytes = (width as u64 * height as u64).saturating_mul(values * size_of::<f32>() as u64);
    output::check_room(
        &path.display().to_string(),
        bytes,
        "--crop renders a part of the image; `resolution` in [camera] makes it smaller",
    )
}

/// The paths of the files of a frame.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct FramePaths {
    /// The preview.
    pub(crate) preview: PathBuf,
    /// The layers.
    pub(crate) layers: PathBuf,
    /// The record that the other files are complete; for a single frame it is the summary.
    pub(crate) record: PathBuf,
}

impl FramePaths {
    /// Names the files of frame `frame` of `frames` after the scene, with a number if there are
    /// several.
    pub(crate) fn new(folder: &Path, scene_name: &str, frame: u32, frames: u32) -> Self {
        let stem = if frames == 1 {
            scene_name.to_owned()
        } else {
            format!("{scene_name}_{frame:04}")
        };
        Self {
            preview: folder.join(format!("{stem}.png")),
            layers: folder.join(format!("{stem}.exr")),
            record: folder.join(format!("{stem}.json")),
        }
    }

    /// Returns the name of a file without its folder.
    pub(crate) fn name_of(path: &Path) -> String {
        path.file_name()
            .map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }
}

/// Returns the picture that the eye would see.
pub(crate) fn picture_of(frame: &Frame) -> Picture {
    let mut picture = laser_picture_of(frame);
    picture.add_white(&frame.lights);
    picture
}

/// Returns the picture in the light of the lasers alone.
fn laser_picture_of(frame: &Frame) -> Picture {
    let mut picture = Picture::dark(frame.lights.width(), frame.lights.height());
    for laser in &frame.lasers {
        picture.add_laser(&laser.radiance, laser.wavelength);
    }
    picture
}

/// Chooses the white level for the light of the lasers, or for all light if no laser is seen.
///
/// A thin line covers few of the pixels that another light illuminates: if all of these counted,
/// the line would be overexposed.
pub(crate) fn automatic_exposure(frame: &Frame) -> Exposure {
    let lasers = laser_picture_of(frame);
    if lasers.is_dark() {
        Exposure::for_all_light(picture_of(frame).automatic_white_level())
    } else {
        Exposure::for_laser_light(lasers.automatic_white_level())
    }
}

/// Writes the preview with the radiance `white` shown as white.
pub(crate) fn write_preview(
    path: &Path,
    picture: &Picture,
    white: f32,
    description: &str,
) -> Result<(), Failure> {
    let text = [
        ("Description", description.to_owned()),
        (
            "Exposure",
            format!("white is the radiance {white:e} W/(m² sr)"),
        ),
    ];
    output::save(path, |file| {
        write_rgb_png(file, &picture.exposed(white), &text)
    })
}

/// Writes all layers of a frame whose whole image has `size` pixels: the picture in linear sRGB,
/// the layers of each laser and of the lights, depth, normal and sample count.
pub(crate) fn write_layers(
    path: &Path,
    frame: &Frame,
    picture: &Picture,
    size: [usize; 2],
) -> Result<(), Failure> {
    let colours = [0, 1, 2].map(|component| picture.component(component));
    let layers = layers_of(frame, &colours);
    let window = Window {
        origin: frame.origin,
        image: size,
    };
    output::save(path, |file| write_exr(file, &layers, Some(window)))
}

fn layers_of<'a>(frame: &'a Frame, [red, green, blue]: &'a [Grid<f32>; 3]) -> Vec<Layer<'a>> {
    let [x, y, z] = &frame.normal;
    let (light, variance) = (&frame.lights, &frame.lights_variance);
    let picture = [("R", red), ("G", green), ("B", blue)];
    let lights = [("radiance", light), ("variance", variance)];
    let depth = [("Z", &frame.depth)];
    let normal = [("X", x), ("Y", y), ("Z", z)];
    let samples = [("count", &frame.samples)];
    let of_lights = "radiance of the lights in W/(m^2 sr), and its variance";
    let distance = "distance along the axis in metres; 0: nothing";
    let picture = layer(
        "picture",
        "all light in linear sRGB, in W/(m^2 sr)",
        picture,
    );
    let lights = layer("lights", of_lights, lights);
    let depth = layer("depth", distance, depth);
    let normal = layer("normal", "unit normal in world axes; 0: nothing", normal);
    let samples = layer("samples", "camera samples of the pixel", samples);
    let lasers = frame.lasers.iter().enumerate().map(laser_layer);
    core::iter::once(picture)
        .chain(lasers)
        .chain([lights, depth, normal, samples])
        .collect()
}

fn laser_layer((index, laser): (usize, &LaserLayers)) -> Layer<'_> {
    Layer {
        wavelength: Some(laser.wavelength),
        ..layer(
            &format!("laser_{index}"),
            "radiance in W/(m^2 sr): single and multiple after one rough surface or more, before \
             speckle, a factor with mean 1; radiance with it; variance is that of radiance",
            [
                ("single", &laser.single),
                ("multiple", &laser.multiple),
                ("speckle", &laser.speckle),
                ("radiance", &laser.radiance),
                ("variance", &laser.variance),
            ],
        )
    }
}

fn layer<'a, const N: usize>(
    name: &str,
    comments: &str,
    channels: [(&'static str, &'a Grid<f32>); N],
) -> Layer<'a> {
    Layer {
        name: name.into(),
        wavelength: None,
        comments: comments.into(),
        channels: channels.to_vec(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tem00_report::image::{Reading, read_image};

    #[test]
    fn a_bright_light_does_not_burn_out_a_thin_line() {
        let line = Grid::from_fn(100, 100, |_, y| if y == 50 { 3.0 } else { 0.0 });
        let dark = Grid::filled(100, 100, 0.0);
        let mut frame = Frame {
            lasers: vec![LaserLayers {
                speckle: Grid::filled(100, 100, 1.0),
                radiance: line.clone(),
                ..laser_of(&dark, line)
            }],
            lights: Grid::filled(100, 100, 0.2),
            ..empty(&dark)
        };
        let white = automatic_exposure(&frame).white_level;
        assert!((white - 3.0).abs() < 1e-6, "white level {white}");
        frame.lasers[0].radiance = dark;
        let white = automatic_exposure(&frame).white_level;
        assert!(
            (white - 0.2).abs() < 1e-6,
            "white level {white} of the light"
        );
    }

    fn empty(dark: &Grid<f32>) -> Frame {
        Frame {
            lasers: Vec::new(),
            lights: dark.clone(),
            lights_variance: dark.clone(),
            depth: dark.clone(),
            normal: [dark.clone(), dark.clone(), dark.clone()],
            samples: dark.clone(),
            origin: [0, 0],
            rays: 0,
        }
    }

    fn laser_of(dark: &Grid<f32>, single: Grid<f32>) -> LaserLayers {
        LaserLayers {
            wavelength: 650e-9,
            single,
            speckle: dark.clone(),
            radiance: dark.clone(),
            multiple: dark.clone(),
            variance: dark.clone(),
            power_on_target: 1e-3,
            power_error: 0.0,
        }
    }

    /// A frame of 6 × 4 pixels whose layers all differ.
    fn frame() -> Frame {
        let layer = |k: f32| Grid::from_fn(6, 4, |x, y| k + (x + 6 * y) as f32);
        Frame {
            lasers: vec![LaserLayers {
                speckle: layer(2.0),
                radiance: layer(3.0),
                multiple: layer(4.0),
                variance: layer(5.0),
                ..laser_of(&layer(0.0), layer(1.0))
            }],
            lights: layer(0.5),
            lights_variance: layer(6.0),
            depth: layer(7.0),
            normal: [layer(8.0), layer(9.0), layer(10.0)],
            samples: layer(11.0),
            origin: [3, 2],
            rays: 0,
        }
    }

    #[test]
    fn files_are_named_after_the_scene() {
        let folder = Path::new("out");
        let single = FramePaths::new(folder, "spot", 0, 1);
        assert_eq!(single.preview, Path::new("out/spot.png"));
        let third = FramePaths::new(folder, "spot", 2, 5);
        assert_eq!(third.layers, Path::new("out/spot_0002.exr"));
    }

    #[test]
    fn every_layer_can_be_read_back() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.exr");
        let frame = frame();
        write_layers(&path, &frame, &picture_of(&frame), [20, 10]).expect("written");
        let read = |name| {
            let reading = Reading {
                channel: Some(name),
                ..Reading::default()
            };
            read_image(&path, &reading)
                .expect("the channel is there")
                .values
        };
        let laser = &frame.lasers[0];
        for (name, layer) in [
            ("laser_0.single", &laser.single),
            ("laser_0.speckle", &laser.speckle),
            ("laser_0.radiance", &laser.radiance),
            ("laser_0.multiple", &laser.multiple),
            ("laser_0.variance", &laser.variance),
            ("lights.radiance", &frame.lights),
            ("lights.variance", &frame.lights_variance),
            ("depth.Z", &frame.depth),
            ("normal.X", &frame.normal[0]),
            ("normal.Y", &frame.normal[1]),
            ("normal.Z", &frame.normal[2]),
            ("samples.count", &frame.samples),
        ] {
            assert_eq!(read(name), *layer, "{name}");
        }
        // Red laser light and lights: (3 + i) + (0.5 + i) at pixel i; blue holds no laser light.
        let [red, blue] = ["picture.R", "picture.B"].map(|name| read(name)[(2, 0)]);
        assert!((red - 7.5).abs() < 1e-5, "red is all light: {red}");
        assert!((blue - 2.5).abs() < 1e-5, "blue is the lights': {blue}");
    }

    #[test]
    fn the_preview_shows_the_white_level_as_white() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.png");
        write_preview(&path, &picture_of(&frame()), 17.0, "").expect("written");
        let reading = Reading {
            channel: Some("R"),
            ..Reading::default()
        };
        let red = read_image(&path, &reading).expect("a preview").values;
        // 17 W/(m² sr) first reached where 3.5 + 2 i ≥ 17, at i = 7; half a step of 2.27/65535.
        assert!((red[(0, 0)] - 3.5 / 17.0).abs() < 2e-5, "{}", red[(0, 0)]);
        assert!(
            red[(0, 1)] < 1.0 && red[(1, 1)] >= 1.0,
            "white begins at the white level"
        );
    }
}
