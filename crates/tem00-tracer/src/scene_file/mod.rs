//! Scene files: TOML in, a validated [`Scene`] or one placed message out.

mod camera;
mod error;
mod laser;
mod light;
mod material;
mod placement;
mod quantity;
mod section;
mod settings;
mod surface;
#[cfg(test)]
mod tests;
mod value;

use std::fs;
use std::path::Path;

use toml::de::DeTable;

use error::Problem;
pub use error::SceneError;
use section::Section;

use crate::Scene;

const KEYS: &[&str] = &["camera", "laser", "surface", "lamp", "render", "speckle"];

/// Reads a scene file; meshes are looked for beside it.
///
/// The format is TOML. Lengths, angles and powers are numbers in SI units, or strings with a unit.
///
/// # Errors
///
/// Returns an error if the file cannot be read, is not valid TOML, or does not describe a scene. It
/// names key, value and what is allowed, and knows its place in the file.
pub fn read_scene(path: &Path) -> Result<Scene, SceneError> {
    let text = read_text(path)?;
    scene(&text, path.parent().unwrap_or(Path::new("")))
        .map_err(|problem| SceneError::new(Some(path), &text, problem))
}

/// Reads a scene from text in the format of scene files; meshes are looked for in `base_directory`.
///
/// # Errors
///
/// Returns an error if the text is not valid TOML or does not describe a scene.
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
    scene(text, base_directory).map_err(|problem| SceneError::new(None, text, problem))
}

fn read_text(path: &Path) -> Result<String, SceneError> {
    let unreadable = |why: &dyn core::fmt::Display| {
        let problem = Problem::new(format!("the scene file cannot be read: {why}"));
        SceneError::new(Some(path), "", problem)
    };
    if path.is_dir() {
        return Err(unreadable(&"it is a directory"));
    }
    let bytes = fs::read(path).map_err(|why| unreadable(&why))?;
    String::from_utf8(bytes).map_err(|not_utf8| {
        let valid = not_utf8.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&not_utf8.as_bytes()[..valid]);
        let problem = Problem::new("the scene file must be text in UTF-8").at(valid..valid);
        SceneError::new(Some(path), &text, problem)
    })
}

fn scene(text: &str, base_directory: &Path) -> Result<Scene, Problem> {
    let document = DeTable::parse(text)?;
    let root = Section::root(document.get_ref(), text, KEYS)?;
    let camera = camera::read(&root)?;
    let lasers = laser::read(&root)?;
    Ok(Scene {
        camera: camera.camera,
        camera_trajectory: camera.trajectory,
        surfaces: surface::read(&root, base_directory, &lasers)?,
        lasers,
        lamps: light::read(&root)?,
        speckle: settings::speckle(&root)?,
        render: settings::render(&root)?,
    })
}
