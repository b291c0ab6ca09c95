use std::path::Path;

use tem00_calibration::{CalibrationSettings, read_calibration};
use tem00_config::{ConfigError, Reading};
use tem00_scene::SceneFile;
use tem00_tracer::Scene;
use tem00_triangulation::{DetectorSettings, SensorDescription, read_detector, read_sensor};

use crate::{ScanSettings, section::read_scan};

/// A scene and the sensor that measures it.
#[derive(Clone, Debug)]
pub struct MeasurementScene {
    /// The scene in front of the camera.
    pub scene: Scene,
    /// The sensor of the camera.
    pub sensor: SensorDescription,
    /// The settings by which lines are found in its frames.
    pub detector: DetectorSettings,
    /// The settings by which camera and laser plane are calibrated.
    pub calibration: CalibrationSettings,
    /// The settings by which the frames are put together.
    pub scan: ScanSettings,
}

impl MeasurementScene {
    /// Reads a scene file with the sections `[sensor]`, `[detector]`, `[calibration]` and `[scan]`,
    /// and returns [what was left out](SceneFile::notes) of its meshes.
    ///
    /// # Errors
    ///
    /// Returns an error if a file cannot be read or does not describe a scene and a sensor. The
    /// error names key, value and what is allowed, and knows its location in its file.
    pub fn read<'a>(
        path: &Path,
        reading: impl Into<Reading<'a>>,
    ) -> Result<(Self, Vec<String>), ConfigError> {
        let (file, sections) = SceneFile::read_with(path, reading, |document, scene| {
            let pitch = scene.camera.description().pixel_pitch;
            Ok((
                read_sensor(document, pitch)?,
                read_detector(document)?,
                read_calibration(document)?,
                read_scan(document, scene)?,
            ))
        })?;
        let (sensor, detector, calibration, scan) = sections;
        let measurement = Self {
            scene: file.scene,
            sensor,
            detector,
            calibration,
            scan,
        };
        Ok((measurement, file.notes))
    }
}
