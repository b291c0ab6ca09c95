//! Calibrations as JSON files.

use std::path::Path;

use serde::{Deserialize, Serialize};
use tem00_calibration::{Calibration, CalibrationCovariance, CalibrationQuality, PARAMETERS};
use tem00_camera::{Camera, CameraDescription};
use tem00_config::{MAX_TEXT_BYTES, read_input, without_byte_order_mark};
use tem00_report::{failure::Failure, output};
use tem00_triangulation::{LaserPlane, TriangulationError};

/// The format of the file, with its version.
const FORMAT: &str = "tem00 calibration 1";

/// The rows of a covariance.
type Rows = [[f64; PARAMETERS.len()]; PARAMETERS.len()];

/// The content of the file: SI units, radians, positions in pixels.
#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct CalibrationRecord {
    format: String,
    camera: CameraDescription,
    plane: PlaneRecord,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    covariance: Option<CovarianceRecord>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    quality: Option<CalibrationQuality>,
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct PlaneRecord {
    point: [f64; 3],
    normal: [f64; 3],
}

#[derive(Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct CovarianceRecord {
    origin: [f64; 3],
    parameters: Vec<String>,
    rows: Rows,
}

/// Writes a calibration as JSON, completely or not at all.
pub(crate) fn write_calibration(path: &Path, calibration: &Calibration) -> Result<(), Failure> {
    let record = CalibrationRecord::of(calibration);
    output::save(path, |writer| {
        serde_json::to_writer_pretty(writer, &record).map_err(std::io::Error::other)
    })
}

/// Reads a calibration that `tem00-inspect calibrate` wrote.
pub(crate) fn read_calibration(path: &Path) -> Result<Calibration, Failure> {
    let refused = |problem: String| {
        Failure::input(
            format!("{} is not a calibration: {problem}", path.display()),
            "`tem00-inspect calibrate FOLDER … -o FILE.json` writes one",
        )
    };
    let content = read_input(path, MAX_TEXT_BYTES).map_err(|error| {
        Failure::unavailable(
            format!("cannot read {}: {error}", path.display()),
            "a calibration is a JSON file of `tem00-inspect calibrate`",
        )
    })?;
    let record: CalibrationRecord = serde_json::from_slice(without_byte_order_mark(&content))
        .map_err(|error| refused(error.to_string()))?;
    record.calibration().map_err(refused)
}

impl CalibrationRecord {
    /// Returns the content of the file of a calibration.
    pub(crate) fn of(calibration: &Calibration) -> Self {
        let plane = calibration.plane();
        Self {
            format: FORMAT.into(),
            camera: *calibration.camera().description(),
            plane: PlaneRecord {
                point: plane.point().to_array(),
                normal: plane.normal().to_array(),
            },
            covariance: calibration.covariance().map(CovarianceRecord::of),
            quality: calibration.quality().copied(),
        }
    }

    fn calibration(&self) -> Result<Calibration, String> {
        if self.format != FORMAT {
            return Err(format!(
                "its format is \"{}\", not \"{FORMAT}\"",
                self.format
            ));
        }
        let words = |error: TriangulationError| error.to_string();
        let camera = Camera::new(self.camera).map_err(|error| error.to_string())?;
        let plane = LaserPlane::new(self.plane.point.into(), self.plane.normal.into());
        let mut calibration = Calibration::exact(camera, plane.map_err(words)?);
        if let Some(covariance) = &self.covariance {
            let covariance = covariance.covariance()?;
            calibration = calibration.with_covariance(covariance).map_err(words)?;
        }
        Ok(match &self.quality {
            Some(quality) => calibration.with_quality(*quality),
            None => calibration,
        })
    }
}

impl CovarianceRecord {
    fn of(covariance: &CalibrationCovariance) -> Self {
        let row = |i| core::array::from_fn(|j| covariance.between(i, j));
        Self {
            origin: covariance.origin().to_array(),
            parameters: names(),
            rows: core::array::from_fn(row),
        }
    }

    fn covariance(&self) -> Result<CalibrationCovariance, String> {
        if self.parameters != names() {
            return Err(format!("its parameters must be {}", names().join(", ")));
        }
        CalibrationCovariance::new(self.origin.into(), &self.rows)
            .map_err(|error| error.to_string())
    }
}

fn names() -> Vec<String> {
    let name = |parameter: &tem00_calibration::Parameter| parameter.name.to_owned();
    PARAMETERS.iter().map(name).collect()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use glam::{DVec2, DVec3};
    use tem00_camera::{RadialDistortion, SensorTilt};

    use super::*;

    fn calibration() -> Calibration {
        let camera = Camera::new(CameraDescription {
            position: DVec3::new(0.0, -0.1, 0.3),
            up: DVec3::Z,
            principal_point: Some(DVec2::new(321.5, 238.1)),
            tilt: SensorTilt {
                angle: 0.02,
                azimuth: 0.1,
            },
            distortion: RadialDistortion {
                k1: -0.3,
                k2: 0.1,
                k3: 0.0,
            },
            ..CameraDescription::default()
        })
        .expect("the camera is possible");
        let plane = LaserPlane::new(DVec3::ZERO, DVec3::new(0.01, 1.0, 0.02));
        let mut rows: Rows = [[0.0; PARAMETERS.len()]; PARAMETERS.len()];
        (0..18_u32)
            .zip(&mut rows)
            .for_each(|(i, row)| row[i as usize] = 1e-9 * f64::from(i));
        let covariance = CalibrationCovariance::new(1e-3 * DVec3::X, &rows).expect("is possible");
        Calibration::exact(camera, plane.expect("has a normal"))
            .with_covariance(covariance)
            .expect("the camera may differ")
            .with_quality(CalibrationQuality {
                boards: 8,
                corners: 432,
                rms_reprojection: 0.03,
                line_points: 4000,
                outliers: 3,
                rms_plane: 2e-6,
            })
    }

    #[test]
    fn a_calibration_comes_back_from_its_file() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("calibration.json");
        let calibration = calibration();
        write_calibration(&path, &calibration).expect("the file is written");
        // As an editor may save it, with a byte order mark.
        let text = fs::read_to_string(&path).expect("it is text");
        fs::write(&path, format!("\u{feff}{text}")).expect("the file is written");
        let back = read_calibration(&path).expect("the file is read");
        // Reading rounds the last digit, and a normal is normalised again.
        let close = |a: f64, b: f64| (a - b).abs() <= 1e-15 * a.abs();
        assert_eq!(back.camera(), calibration.camera());
        assert_eq!(back.quality(), calibration.quality());
        let [one, two] = [&back, &calibration].map(|c| c.covariance().expect("it has one"));
        assert!(close(one.origin().x, two.origin().x), "{one:?}");
        for (i, j) in (0..18).flat_map(|i| (0..18).map(move |j| (i, j))) {
            assert!(close(one.between(i, j), two.between(i, j)), "{i}, {j}");
        }
        let normals = [back.plane().normal(), calibration.plane().normal()];
        assert!(normals[0].distance(normals[1]) < 1e-15, "{normals:?}");
    }

    #[test]
    fn what_is_no_calibration_is_refused_in_words() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("calibration.json");
        let text = serde_json::to_string(&CalibrationRecord::of(&calibration())).expect("is JSON");
        for [from, to, part] in tem00_testkit::rows(
            r#"tem00 calibration 1 => tem00 calibration 9 => format
            "focal_length":0.025 => "focal_length":-1.0 => focal_length
            "focal_length" => "focal_lenght" => focal_lenght
            "normal":[ => "normal":[0.0, => not a calibration
            "image distance" => "distance" => parameters
            { => => not a calibration"#,
        ) {
            assert!(text.contains(&from), "{from} is in {text}");
            fs::write(&path, text.replacen(&from, &to, 1)).expect("the file is written");
            let failure = read_calibration(&path).expect_err(&to);
            assert_eq!(failure.exit_code(), 2, "{to}");
            let report = failure.report().unwrap_or_default();
            assert!(report.contains(&part), "{to}: {report}");
        }
        let missing = read_calibration(&folder.path().join("none.json"));
        assert!(missing.is_err(), "a missing file");
    }
}
