use tem00_statistics::laws::{SpeckledLine, defocused_line_centroid_deviation};

use crate::{MeasuredFrame, Measurement};

/// The minimum width of a line after blur, in speckle sizes: a finer line has the noise of the
/// blur's rim.
const FINEST: f64 = 0.25;

impl Measurement {
    /// Returns the ratio of the speckle noise of a camera to the speckle noise of a frame; `None`
    /// without speckle or without points.
    ///
    /// A frame is a speckle pattern times the light of the line, which no diffraction blurs. In a
    /// camera the light interferes: lines below two speckles in full width have more noise, and so
    /// have lines that are narrower than their blur out of focus. The uncertainty that is stated
    /// for a point is the uncertainty in the frame.
    ///
    /// Both are laws of the centre of gravity of all light, at the middle point of the profile, for
    /// a single column.
    pub fn speckle_by_waves(&self, frame: &MeasuredFrame) -> Option<f64> {
        frame.reference_point.as_ref()?;
        let valid = frame.points.iter().filter(|point| point.is_valid());
        let mut points: Vec<_> = valid.map(|point| &point.seen).collect();
        let middle = *points.get(points.len() / 2)?;
        points.sort_by(|a, b| a.width.total_cmp(&b.width));
        let width = points[points.len() / 2].width;
        let camera = self.calibration().triangulator().camera();
        let wavelength = self.scene().lasers.first()?.wavelength();
        let geometry = camera.imaging_geometry_at(middle.pixel, wavelength).ok()?;
        let description = camera.description();
        let in_pixels = description.pixel_pitch * description.tilt.angle.cos();
        let speckle = geometry.speckle_size() / in_pixels;
        let to_point = middle.point.position - camera.position();
        let defocus = geometry.defocus_at(-camera.axes().z_axis.dot(to_point));
        let disc = geometry.pupil_diameter() * geometry.principal_distance() * defocus.abs();
        let blur = if description.depth_of_field {
            disc / in_pixels / speckle
        } else {
            0.0
        };
        // Across the disc of defocus 4σ is its diameter.
        let blurred = width / speckle;
        let sharp = (blurred * blurred - blur * blur)
            .max(FINEST * FINEST)
            .sqrt();
        let row_height = description.pixel_pitch / geometry.speckle_size();
        let rendered = SpeckledLine::new(0.5 * blurred, row_height).ok()?;
        let by_waves = defocused_line_centroid_deviation(0.5 * sharp, row_height, blur);
        Some(by_waves / rendered.centroid_deviation())
    }
}
