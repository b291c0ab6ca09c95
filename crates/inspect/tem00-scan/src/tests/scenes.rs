//! Scenes for tests.

use std::io::Write;

use tem00_config::{ConfigError, FileAccess};

use crate::MeasurementScene;

/// Two plates under a line, seen by a small camera.
pub(super) const SCENE: &str = r#"
[camera]
position = [0, "-150 mm", "259.8 mm"]
up = [0, 0, 1]
resolution = [32, 24]
[[laser]]
wavelength = "650 nm"
power = "5 mW"
position = [0, 0, "300 mm"]
line_direction = [1, 0, 0]
line = { fan_angle = "20 deg", thickness = "0.3 mm" }
[[surface]]
name = "low"
rectangle = { centre = ["-10 mm", 0, 0], size = ["20 mm", "20 mm"] }
[[surface]]
name = "high"
rectangle = { centre = ["10 mm", 0, "0.1 mm"], size = ["20 mm", "20 mm"] }
[sensor]
quantum_efficiency = 0.6
exposure = "0.1 ms"
[render]
samples_per_pixel = 4
"#;

/// Reads a scene from a file with this text.
pub(super) fn scene_of(text: &str) -> Result<MeasurementScene, ConfigError> {
    let mut file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    file.write_all(text.as_bytes()).unwrap();
    MeasurementScene::read(file.path(), FileAccess::WithinFolder).map(|(scene, _)| scene)
}

/// Reads a scene that is one.
pub(super) fn measured(text: &str) -> MeasurementScene {
    scene_of(text).unwrap()
}
