use std::path::{Path, PathBuf};

use tem00_config::{
    ConfigError, Document, FileAccess, Format, Problem, Reading, parse_document, read_document,
};
use tem00_tracer::Scene;

use crate::{assets::Assets, camera, laser, light, settings, surface};

/// Files of scenes.
///
/// The last four sections concern the use of the image: they are not read with the scene.
const SCENE: Format = Format {
    noun: "scene",
    keys: &[
        "camera",
        "laser",
        "surface",
        "light",
        "render",
        "speckle",
        "include",
        "sensor",
        "detector",
        "calibration",
        "scan",
    ],
    uncertain: &[],
    help: "examples/scenes/spot.toml is one, and docs/scene_file.md tells how to write them",
};

/// Reads a scene file, and with it the files that it includes.
///
/// The format is TOML. Lengths, angles and powers are numbers in SI units, or strings with a unit.
/// File names are relative to the file that states them; included files lie below its folder, see
/// [`FileAccess::WithinFolder`].
///
/// # Errors
///
/// Returns an error if a file cannot be read, is not valid TOML, or if the files do not describe a
/// scene. The error names key, value and what is allowed, and knows its location in its file.
pub fn read_scene(path: &Path) -> Result<Scene, ConfigError> {
    SceneFile::read(path).map(|file| file.scene)
}

/// A scene and the files that it was read from.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// Everything that was read: the scene file unless it was standard input, the files that it
    /// includes, then meshes and environments, each once.
    pub files: Vec<PathBuf>,
    /// Notes about omitted or doubtful parts of meshes: sentences that begin with the name of a
    /// file.
    pub notes: Vec<String>,
}

impl SceneFile {
    /// Reads a scene file, as [`read_scene`] does, and keeps the names of all files that were read.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read_scene`].
    pub fn read(path: &Path) -> Result<Self, ConfigError> {
        Self::read_with(path, FileAccess::WithinFolder, |_, _| Ok(())).map(|(file, ())| file)
    }

    /// Reads a scene file, and with `further` its sections on the use of the image: `[sensor]`,
    /// `[detector]`, `[calibration]` and `[scan]`. The path `-` is standard input.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read_scene`], and the errors of `further`, placed in the file.
    pub fn read_with<'a, T>(
        path: &Path,
        reading: impl Into<Reading<'a>>,
        further: impl FnOnce(&Document<'_>, &Scene) -> Result<T, Problem>,
    ) -> Result<(Self, T), ConfigError> {
        read_document(path, reading, SCENE, |root| {
            let mut assets = Assets::new(root.folder());
            let scene = scene(root, &mut assets)?;
            let further = further(root, &scene)?;
            let mut files = root.paths();
            let (of_assets, notes) = assets.into_files_and_notes();
            files.extend(of_assets);
            let file = Self {
                scene,
                files,
                notes,
            };
            Ok((file, further))
        })
    }
}

/// Reads a scene from text in the format of scene files; other files are looked for in
/// `base_directory`.
///
/// # Errors
///
/// Returns an error if the text is not valid TOML, does not describe a scene or names a file that
/// cannot be read.
///
/// # Examples
///
/// A laser, a camera and a surface are all that a scene needs:
///
/// ```
/// use std::path::Path;
/// use tem00_scene::parse_scene;
///
/// let scene = parse_scene(
///     r#"
///     [camera]
///     position = ["0 mm", "0 mm", "300 mm"]
///
///     [[laser]]
///     wavelength = "650 nm"
///     power = "5 mW"
///     position = ["100 mm", "0 mm", "200 mm"]
///     spot.waist_radius = "0.5 mm"
///
///     [[surface]]
///     rectangle.size = ["40 mm", "30 mm"]
///     "#,
///     Path::new("."),
/// )?;
/// assert_eq!(scene.lasers.len(), 1);
///
/// let error = parse_scene("[camera]\nfocal_lenght = \"25 mm\"", Path::new(".")).unwrap_err();
/// assert_eq!(error.line_column(), Some((2, 1)));
/// assert!(error.message().contains("did you mean `focal_length`?"));
/// # Ok::<(), tem00_config::ConfigError>(())
/// ```
pub fn parse_scene(text: &str, base_directory: &Path) -> Result<Scene, ConfigError> {
    parse_document(text, base_directory, SCENE, |root| {
        scene(root, &mut Assets::new(root.folder()))
    })
}

fn scene(root: &Document<'_>, assets: &mut Assets) -> Result<Scene, Problem> {
    let camera = camera::read(root)?;
    let mut scene = Scene {
        camera_trajectory: camera.trajectory,
        lasers: laser::read(root)?,
        ..Scene::new(camera.camera)
    };
    settings::render(root, &mut scene)?;
    scene.surfaces = surface::read(root, assets, &scene.lasers)?;
    scene.lights = light::read(root, assets)?;
    scene.speckle = settings::speckle(root)?;
    Ok(scene)
}
