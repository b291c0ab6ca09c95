//! Scene files: TOML in, a validated [`Scene`] or one placed message out.

mod assets;
mod camera;
mod document;
mod error;
mod filter;
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
use document::Document;
use error::Problem;
pub use error::SceneError;
use section::Section;
use source::Sources;

use crate::Scene;

/// Reads a scene file, and with it the files that it includes.
///
/// The format is TOML. Lengths, angles and powers are numbers in SI units, or strings with a unit.
/// Files are looked for beside the one that names them.
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
    /// Everything that was read: the scene file, the files that it includes, then meshes and
    /// environments, each once.
    pub files: Vec<PathBuf>,
}

impl SceneFile {
    /// Reads a scene file, as [`read_scene`] does, and keeps the names of all files that it took.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`read_scene`].
    pub fn read(path: &Path) -> Result<Self, SceneError> {
        let sources = Sources::of_file(path)?;
        let mut files = sources.files();
        let mut assets = Assets::default();
        let scene = scene(&sources, &mut assets).map_err(|problem| sources.locate(problem))?;
        files.extend(assets.into_files());
        Ok(Self { scene, files })
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
    let sources = Sources::of_text(text.to_owned(), None, base_directory)?;
    scene(&sources, &mut Assets::default()).map_err(|problem| sources.locate(problem))
}

fn scene(sources: &Sources, assets: &mut Assets) -> Result<Scene, Problem> {
    let parsed = sources
        .in_order()
        .map(|source| Ok((source, source.parse()?)));
    let parsed: Vec<_> = parsed.collect::<Result<_, Problem>>()?;
    let files = parsed
        .iter()
        .map(|(source, document)| Section::root(document.get_ref(), source));
    let root = Document::new(files.collect::<Result<_, _>>()?);
    let camera = camera::read(&root)?;
    let lasers = laser::read(&root)?;
    Ok(Scene {
        render: settings::render(&root, &camera.camera)?,
        camera: camera.camera,
        camera_trajectory: camera.trajectory,
        surfaces: surface::read(&root, assets, &lasers)?,
        lasers,
        lamps: light::read(&root, assets)?,
        speckle: settings::speckle(&root)?,
    })
}
