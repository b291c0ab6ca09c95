//! Scene files: TOML in, a validated [`Scene`] or one placed message out.

mod assets;
mod camera;
mod change;
mod document;
mod error;
mod filter;
mod format;
mod laser;
mod light;
mod material;
mod motion;
mod placement;
mod quantity;
mod section;
mod settings;
mod shape;
mod source;
mod surface;
#[cfg(test)]
mod tests;
mod value;

use std::path::{Path, PathBuf};

use assets::Assets;
use format::SCENE;
use source::Sources;

pub use change::{Change, Reading};
pub use document::Document;
pub use error::{Problem, SceneError};
pub use format::{DocumentKind, Format, kind_of_document};
pub use material::MATERIALS;
pub use quantity::{ANGLE, DURATION, Dimension, LENGTH, MEMORY, NUMBER, POWER, RADIANCE};
pub use section::{Choice, Section};
pub(crate) use source::SceneFolder;
pub use value::Value;

use crate::{Scene, input_file::FileAccess};

/// Reads a scene file, and with it the files that it includes.
///
/// The format is TOML. Lengths, angles and powers are numbers in SI units, or strings with a unit.
/// Files are looked for beside the one that names them; those that it includes lie below its folder, see
/// [`FileAccess::WithinFolder`].
///
/// # Errors
///
/// Returns an error if a file cannot be read, is not valid TOML, or if they do not describe a scene.
/// It names key, value and what is allowed, and knows its place in its file.
pub fn read_scene(path: &Path) -> Result<Scene, SceneError> {
    SceneFile::read(path).map(|file| file.scene)
}

/// A scene and the files that it was read from.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SceneFile {
    /// The scene.
    pub scene: Scene,
    /// Everything that was read: the scene file unless it was standard input, the files that it includes,
    /// then meshes and environments, each once.
    pub files: Vec<PathBuf>,
}

impl SceneFile {
    /// Reads a scene file, as [`read_scene`] does, and keeps the names of all files that it took.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read_scene`].
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        Self::read_with(path, FileAccess::WithinFolder, |_, _| Ok(())).map(|(file, ())| file)
    }

    /// Reads a scene file, and with `further` those of its sections that say what becomes of the image:
    /// `[sensor]`, `[detector]`, `[calibration]` and `[scan]`. The path `-` is standard input.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read_scene`], and those of `further`, placed in the file.
    pub fn read_with<'a, T>(
        path: &Path,
        reading: impl Into<Reading<'a>>,
        further: impl FnOnce(&Document<'_>, &Scene) -> Result<T, Problem>,
    ) -> Result<(Self, T), SceneError> {
        let sources = Sources::of_file(path, reading.into(), SCENE)?;
        let mut files = sources.files();
        let mut assets = Assets::new(sources.folder());
        let read = with_document(&sources, |root| {
            let scene = scene(root, &mut assets)?;
            let further = further(root, &scene)?;
            Ok((scene, further))
        });
        let (scene, further) = read.map_err(|problem| sources.locate(problem))?;
        files.extend(assets.into_files());
        Ok((Self { scene, files }, further))
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
/// use tem00_tracer::parse_scene;
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
/// # Ok::<(), tem00_tracer::SceneError>(())
/// ```
pub fn parse_scene(text: &str, base_directory: &Path) -> Result<Scene, SceneError> {
    let place = (base_directory, FileAccess::WithinFolder);
    let sources = Sources::of_text(text.to_owned(), None, place, SCENE)?;
    with_document(&sources, |root| {
        scene(root, &mut Assets::new(sources.folder()))
    })
    .map_err(|problem| sources.locate(problem))
}

/// Reads a file of another kind, in the syntax and with the units of scene files. The path `-` is standard
/// input.
///
/// # Errors
///
/// Returns an error if the file cannot be read or is not valid TOML, if it has a key that its `format`
/// does not know, and the errors of `read`, placed in the file.
pub fn read_document<'a, T>(
    path: &Path,
    reading: impl Into<Reading<'a>>,
    format: Format,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, SceneError> {
    let sources = Sources::of_file(path, reading.into(), format)?;
    with_document(&sources, read).map_err(|problem| sources.locate(problem))
}

/// Reads text as [`read_document`] reads a file; other files are looked for in `base_directory`.
///
/// # Errors
///
/// Returns the errors of [`read_document`].
pub fn parse_document<T>(
    text: &str,
    base_directory: &Path,
    format: Format,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, SceneError> {
    let place = (base_directory, FileAccess::WithinFolder);
    let sources = Sources::of_text(text.to_owned(), None, place, format)?;
    with_document(&sources, read).map_err(|problem| sources.locate(problem))
}

fn with_document<T>(
    sources: &Sources,
    read: impl FnOnce(&Document<'_>) -> Result<T, Problem>,
) -> Result<T, Problem> {
    let parsed = sources
        .in_order()
        .map(|source| Ok((source, source.parse()?)));
    let parsed: Vec<_> = parsed.collect::<Result<_, Problem>>()?;
    let files = parsed
        .iter()
        .map(|(source, document)| Section::root(document.get_ref(), source, sources.format()));
    read(&Document::new(files.collect::<Result<_, _>>()?))
}

fn scene(root: &Document<'_>, assets: &mut Assets) -> Result<Scene, Problem> {
    let camera = camera::read(root)?;
    let lasers = laser::read(root)?;
    Ok(Scene {
        render: settings::render(root, &camera.camera)?,
        camera: camera.camera,
        camera_trajectory: camera.trajectory,
        surfaces: surface::read(root, assets, &lasers)?,
        lasers,
        lamps: light::read(root, assets)?,
        speckle: settings::speckle(root)?,
    })
}
