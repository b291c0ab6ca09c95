//! The keys of the sections of set-up files.

use super::sensor;
use crate::SetupQuantity;

pub(super) const LASER: &[&str] = &[
    "wavelength",
    "linewidth",
    "source_half_angle",
    "spectrum",
    "lines",
    "power",
    "line_thickness",
    "line_length",
    "offset",
    "tilt",
];
pub(super) const CAMERA: &[&str] = &[
    "focal_length",
    "f_number",
    "pixel_pitch",
    "resolution",
    "distance",
    "angle",
    "principal_row",
    "scheimpflug",
];
pub(super) const SURFACE: &[&str] = &[
    "reflectance",
    "patterns",
    "polarisation",
    "rms_height",
    "correlation_length",
];
pub(super) const ENVIRONMENT: &[&str] =
    &["temperature_change", "base_expansion", "mount_expansion"];
/// The keys of all quantities that may be uncertain.
pub(super) const UNCERTAIN: &[&str] = &uncertain();

const fn uncertain() -> [&'static str; SetupQuantity::ALL.len()] {
    let mut keys = [""; SetupQuantity::ALL.len()];
    let mut index = 0;
    while index < keys.len() {
        [_, keys[index]] = SetupQuantity::ALL[index].path();
        index += 1;
    }
    keys
}

/// Returns the keys of a section whose values may be uncertain.
pub(super) fn section_keys(section: &str) -> &'static [&'static str] {
    match section {
        "laser" => LASER,
        "camera" => CAMERA,
        "surface" => SURFACE,
        "environment" => ENVIRONMENT,
        _ => sensor::KEYS,
    }
}
