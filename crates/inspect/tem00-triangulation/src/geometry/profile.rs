use glam::DVec2;

use super::{Triangulator, UncertainPoint};
use crate::{LinePoint, Validity};

/// A point of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfilePoint {
    /// The column of the image in which the line was found, counted from 0.
    pub column: usize,
    /// The line of the image that the point belongs to, as [`LinePoint::line`].
    pub line: usize,
    /// The image point, in pixels.
    pub pixel: DVec2,
    /// The point in space, with the uncertainty from the position of the line.
    pub point: UncertainPoint,
    /// The full width of the line between the points of 1/e² in the image, in pixels.
    pub width: f64,
    /// The grey values above the background, summed over the line: in proportion to the light that
    /// the surface sends to the camera.
    pub reflectance: f64,
    /// The validity of the position of the line.
    pub validity: Validity,
}

impl Triangulator {
    /// Returns the profile that the lines found in an image draw, by column and from the top: the
    /// points of the laser plane at `(column + 0.5, position)`.
    ///
    /// `uncertainty` gives the standard uncertainty of the position of a point along its column, in
    /// pixels. Points at which the camera does not see the laser plane, above its horizon, are left
    /// out.
    pub fn profile(
        &self,
        columns: &[Vec<LinePoint>],
        uncertainty: impl Fn(usize, &LinePoint) -> f64,
    ) -> Vec<ProfilePoint> {
        let point = &|column: usize, found: &LinePoint| {
            let pixel = DVec2::new(column as f64 + 0.5, found.position);
            let point = self.point_with_uncertainty(pixel, uncertainty(column, found))?;
            Some(ProfilePoint {
                column,
                line: found.line,
                pixel,
                point,
                width: found.width,
                reflectance: found.integral,
                validity: found.validity,
            })
        };
        columns
            .iter()
            .enumerate()
            .flat_map(|(column, found)| found.iter().filter_map(move |found| point(column, found)))
            .collect()
    }
}
