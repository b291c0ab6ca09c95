//! The table of all points of an image.

use std::io::{self, Write};

use glam::{DVec2, DVec3};
use tem00_calibration::Calibration;
use tem00_triangulation::{LinePoint, Validity};

use super::summary::LineSummary;

/// The points of an image and what is known about them.
pub(super) struct Places<'a> {
    pub(super) found: &'a [Vec<LinePoint>],
    /// `true` if a line has a position in each row instead of in each column.
    pub(super) rows: bool,
    pub(super) lines: &'a [LineSummary],
    pub(super) calibration: Option<&'a Calibration>,
}

impl Places<'_> {
    /// Writes the points as a table with commas, in the order of the columns and from the top.
    ///
    /// With a calibration they have their positions in space, in metres, and the standard
    /// uncertainties of these: of the calibration and of the line's scatter together. Where there
    /// is no point or no scatter is known, cells are empty.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let along = if self.rows { "row" } else { "column" };
        write!(
            out,
            "{along},line,position_px,width_px,peak_DN,integral_DN,background_DN,valid,reason"
        )?;
        if self.calibration.is_some() {
            write!(out, ",x_m,y_m,z_m,u_x_m,u_y_m,u_z_m")?;
        }
        writeln!(out)?;
        for (index, points) in self.found.iter().enumerate() {
            for point in points {
                write_point(out, index, point)?;
                if let Some(calibration) = self.calibration {
                    self.write_space(out, calibration, (index, point))?;
                }
                writeln!(out)?;
            }
        }
        Ok(())
    }

    fn write_space(
        &self,
        out: &mut impl Write,
        calibration: &Calibration,
        (index, point): (usize, &LinePoint),
    ) -> io::Result<()> {
        let pixel = DVec2::new(index as f64 + 0.5, point.position);
        let line = self.lines.iter().find(|line| line.line == point.line);
        let noise = line.and_then(|line| line.noise);
        let Some((position, uncertainty)) = in_space(calibration, pixel, noise) else {
            return write!(out, ",,,,,,");
        };
        let DVec3 { x, y, z } = position;
        write!(out, ",{x:.9},{y:.9},{z:.9}")?;
        match uncertainty {
            Some(DVec3 { x, y, z }) => write!(out, ",{x:.3e},{y:.3e},{z:.3e}"),
            None => write!(out, ",,,"),
        }
    }
}

/// Returns the point of the laser plane at an image point and, if the scatter of the line is known,
/// the standard uncertainties of its coordinates.
fn in_space(
    calibration: &Calibration,
    pixel: DVec2,
    noise: Option<f64>,
) -> Option<(DVec3, Option<DVec3>)> {
    let triangulator = calibration.triangulator();
    let position = triangulator.point(pixel)?;
    let uncertainty = noise.and_then(|noise| {
        let own = triangulator
            .point_with_uncertainty(pixel, noise)?
            .uncertainty;
        let common = calibration.point_covariance(pixel)?;
        let variances = DVec3::new(common.x_axis.x, common.y_axis.y, common.z_axis.z);
        Some((own * own + variances).map(f64::sqrt))
    });
    Some((position, uncertainty))
}

fn write_point(out: &mut impl Write, index: usize, point: &LinePoint) -> io::Result<()> {
    let (valid, reason) = match point.validity {
        Validity::Valid => (1, ""),
        other => (0, other.name()),
    };
    write!(
        out,
        "{index},{},{:.6},{:.6},{},{},{},{valid},{reason}",
        point.line, point.position, point.width, point.peak, point.integral, point.background
    )
}

#[cfg(test)]
mod tests {
    use tem00_camera::{Camera, CameraDescription};
    use tem00_triangulation::LaserPlane;

    use super::*;

    const PITCH: f64 = 5e-6;
    const DISTANCE: f64 = 0.3;
    const ANGLE: f64 = 0.5;

    /// A camera that looks at the origin under an angle from the laser plane y = 0, at
    /// magnification 1/11.
    fn calibration() -> Calibration {
        let camera = Camera::new(CameraDescription {
            position: DISTANCE * DVec3::new(0.0, -ANGLE.sin(), ANGLE.cos()),
            up: DVec3::Z,
            focal_length: DISTANCE / 12.0,
            focus_distance: DISTANCE,
            pixel_pitch: PITCH,
            resolution: [40, 30],
            ..CameraDescription::default()
        });
        let plane = LaserPlane::new(DVec3::ZERO, DVec3::Y);
        Calibration::exact(camera.expect("a camera"), plane.expect("a plane"))
    }

    fn table(
        lines: &[LineSummary],
        found: &[Vec<LinePoint>],
        calibration: Option<&Calibration>,
    ) -> String {
        let places = Places {
            found,
            rows: false,
            lines,
            calibration,
        };
        let mut out = Vec::new();
        places.write(&mut out).expect("memory can be written");
        String::from_utf8(out).expect("text")
    }

    /// A line in the middle of the image that jumps up and down by 0.1 pixels.
    fn zigzag() -> Vec<Vec<LinePoint>> {
        let point = |x: usize| LinePoint {
            position: if x.is_multiple_of(2) { 15.1 } else { 14.9 },
            width: 6.0,
            peak: 500.0,
            integral: 2_000.0,
            background: 20.0,
            validity: [Validity::Cut, Validity::Valid][x.min(1)],
            line: 0,
        };
        (0..40).map(|x| vec![point(x)]).collect()
    }

    #[test]
    fn points_have_their_places_in_space_and_their_uncertainties() {
        let mut found = zigzag();
        // Far below the image, where lines of sight never meet the plane.
        found[3][0].position = 1e6;
        let lines = LineSummary::of_all(&found);
        let noise = lines[0].noise.expect("there are enough columns");
        let table = table(&lines, &found, Some(&calibration()));
        let row = |column: usize| table.lines().nth(column + 1).expect("a column");
        let beyond = row(3);
        assert!(beyond.ends_with(",,,,,,"), "{beyond}");
        assert_eq!(beyond.matches(',').count(), 14, "{beyond}");
        let cells = row(20).split(',').map(|cell| cell.parse().unwrap_or(0.0));
        let cells: Vec<f64> = cells.collect();
        // Half a column from the middle, and 0.1 rows below it, at the magnification 1/11 to first
        // order.
        let (x, z) = (0.5 * PITCH * 11.0, -0.1 * PITCH * 11.0 / ANGLE.sin());
        let [.., got_x, got_y, got_z, u_x, u_y, u_z] = cells[..] else {
            panic!("{cells:?}")
        };
        // The second order is z cos θ / L of the first, 2e-5; places have nine digits behind the
        // point.
        assert!((got_x - x).abs() < 2e-9, "x = {got_x} for {x}");
        assert!((got_z - z).abs() < 2e-9, "z = {got_z} for {z}");
        assert!(got_y.abs() < 1e-9, "in the laser plane: {got_y}");
        let expected = noise * PITCH * 11.0 / ANGLE.sin();
        // Four digits are written.
        assert!((u_z / expected - 1.0).abs() < 6e-4, "u(z) = {u_z}");
        assert!(u_x < 1e-3 * u_z && u_y < 1e-12, "{u_x}, {u_y}");
    }

    #[test]
    fn what_is_not_valid_says_why() {
        let found = zigzag();
        let table = table(&LineSummary::of_all(&found), &found, None);
        let rows: Vec<&str> = table.lines().take(3).collect();
        assert!(rows[0].ends_with("background_DN,valid,reason"), "{table}");
        assert_eq!(rows[1], "0,0,15.100000,6.000000,500,2000,20,0,cut");
        assert_eq!(rows[2], "1,0,14.900000,6.000000,500,2000,20,1,");
    }
}
