//! The results of a calibration as a table.

use tem00_calibration::{Calibration, PARAMETERS};
use tem00_camera::RadialDistortion;
use tem00_report::{
    digits::number,
    report::{Column, Table},
};
use tem00_triangulation::{DVec2, DVec3};

use super::left_out::FoundPoints;

/// Returns the parameters of the camera that were estimated.
pub(super) fn parameters(calibration: &Calibration) -> Table {
    let columns = ["parameter", "value", "uncertainty", "unit"].map(Column::shown);
    let mut table = Table::new("Parameters of the camera", columns);
    for (i, value) in values(calibration).into_iter().enumerate() {
        let uncertainty = calibration
            .covariance()
            .map_or(0.0, |c| c.standard_uncertainty(i));
        if uncertainty > 0.0 {
            let (scale, unit) = shown_in(PARAMETERS[i].unit);
            table.row([
                PARAMETERS[i].name.into(),
                (scale * value).into(),
                (scale * uncertainty).into(),
                unit.into(),
            ]);
        }
    }
    table
}

/// Returns the values of the parameters of the camera, in the order of [`PARAMETERS`].
fn values(calibration: &Calibration) -> [f64; 8] {
    let camera = calibration.camera();
    let description = camera.description();
    let principal = description.axis_point();
    let tilt = description.tilt.angle * DVec2::from_angle(description.tilt.azimuth);
    let RadialDistortion { k1, k2, k3 } = description.distortion;
    let distance = camera.image_distance();
    [
        distance,
        principal.x,
        principal.y,
        tilt.x,
        tilt.y,
        k1,
        k2,
        k3,
    ]
}

/// Returns the factor and the unit in which a quantity is shown.
const fn shown_in(unit: &'static str) -> (f64, &'static str) {
    match unit.as_bytes() {
        b"m" => (1e3, "mm"),
        b"rad" => (180.0 / core::f64::consts::PI, "°"),
        _ => (1.0, unit),
    }
}

/// Returns the results that the table cannot show, one sentence per line.
pub(super) fn sentences(calibration: &Calibration, found: &FoundPoints) -> Vec<String> {
    let mut sentences = Vec::new();
    if let Some(quality) = calibration.quality() {
        sentences.push(format!(
            "{} corners on {} boards fit within {} pixel (rms).",
            quality.corners,
            quality.boards,
            number(quality.rms_reprojection)
        ));
        sentences.push(found.sentence(quality));
        sentences.push(format!(
            "They lie within {} µm (rms) of a plane.",
            number(1e6 * quality.rms_plane)
        ));
    }
    sentences.extend(height(calibration));
    sentences
}

/// Returns how well heights are known in the middle of the image.
fn height(calibration: &Calibration) -> Option<String> {
    let middle = calibration.camera().description().size() / 2.0;
    let point = calibration.triangulator().point(middle)?;
    let [_, down] = calibration.triangulator().derivatives(middle)?;
    let uncertainty = calibration.height_uncertainty(point, DVec3::Z)?;
    Some(format!(
        "In the middle of the image a pixel is {} µm of height above the first board, and the \
         calibration leaves {} µm uncertain.",
        number(1e6 * down.z.abs()),
        number(1e6 * uncertainty)
    ))
}
