use super::source::INCLUDE;

/// A kind of file that is read section by section.
#[derive(Clone, Copy, Debug)]
pub struct Format {
    /// What such a file describes, as messages name it: "scene".
    pub noun: &'static str,
    /// The keys that it may have outside of its sections. `"include"` among them lets it name files
    /// that belong to it.
    pub keys: &'static [&'static str],
    /// What to say when there is no such file.
    pub help: &'static str,
}

/// Scenes.
///
/// The last four sections are for what becomes of the image: they are not read with the scene.
pub(super) const SCENE: Format = Format {
    noun: "scene",
    keys: &[
        "camera",
        "laser",
        "surface",
        "lamp",
        "render",
        "speckle",
        INCLUDE,
        "sensor",
        "detector",
        "calibration",
        "scan",
    ],
    help: "scenes/spot.toml is one, and docs/scene_file.md tells how to write them",
};
