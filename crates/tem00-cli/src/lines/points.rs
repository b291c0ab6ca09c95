//! The table of all points of an image.

use std::io::{self, Write};

use glam::{DVec2, DVec3};
use tem00_triangulation::{Calibration, LinePoint, Validity};

use super::{Found, LineSummary};

/// The points of an image and what is known about them.
pub(super) struct Places<'a> {
    pub(super) found: &'a Found,
    /// Whether each row tells the place of a line instead of each column.
    pub(super) rows: bool,
    pub(super) lines: &'a [LineSummary],
    pub(super) calibration: Option<&'a Calibration>,
}

impl Places<'_> {
    /// Writes the points as a table with commas, in the order of the columns and from the top.
    ///
    /// With a calibration they have their places in space, in metres, and the standard uncertainties of
    /// these: of the calibration and of the line's scatter together. Where there is no point or no
    /// scatter is known, cells are empty.
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
        #[expect(
            clippy::cast_precision_loss,
            reason = "an image has at most 2²⁸ columns"
        )]
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

/// Returns the point of the laser plane at an image point and, if the scatter of the line is known, the
/// standard uncertainties of its coordinates.
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
