use super::{
    LineDetector, LinePoint,
    column::{Column, Sighting},
    profile::Profile,
};

/// The change of a pixel, as a fraction of the peak, over which differences are taken. They err by
/// its square, and by the rounding of the positions divided by it.
const CHANGE: f64 = 1e-4;

impl LineDetector {
    /// Returns by how much the position of the line at `point` moves per grey value of each pixel
    /// of the column, in pixels per grey value: the sensitivities of its uncertainty.
    ///
    /// ```text
    /// δŷ = Σ g_i δI_i      to first order, for noise δI_i of the pixels; Σ g_i = 0
    /// ```
    ///
    /// The window follows the maximum of the smoothed column: as it moves, light at one of its ends
    /// comes in and at the other goes out, which counts where a line has wings or is cut. The pixel
    /// that a three-point method looks at and the part of the column that is background do not
    /// change. Pixels of the background count equally, as in a mean: they share the negative sum
    /// over the window. (Their median scatters 1.25 times as much as a mean.) Methods that use
    /// neighbouring columns treat the column as one of many equal columns.
    ///
    /// `point` is one that [`detect_column`](Self::detect_column) finds in `column`; the
    /// sensitivities are those of the nearest line. A column without lines has no sensitivities:
    /// all are zero. The same holds for a position that could not be estimated.
    pub fn sensitivities(&self, column: &[f32], point: &LinePoint) -> Vec<f64> {
        let mut sensitivities = vec![0.0; column.len()];
        let mut found = Column::of(column, &self.settings);
        let distance = |line: &Sighting| (line.centre as f64 + 0.5 - point.position).abs();
        let nearest = found
            .lines
            .iter()
            .min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let Some(line) = nearest.cloned() else {
            return sensitivities;
        };
        for i in self.within_reach(&line, point.position) {
            if column[i].is_finite() {
                sensitivities[i] = self.derivative(&mut found.above, &line, i);
            }
        }
        let by_window = self.by_window(&found.above, &line);
        for (i, motion) in found.smooth.motion(line.centre) {
            sensitivities[i] += by_window * motion;
        }
        let per_pixel = sensitivities.iter().sum::<f64>() / found.background_pixels.len() as f64;
        for i in found.background_pixels {
            sensitivities[i] -= per_pixel;
        }
        sensitivities
    }

    /// The motion of the position per pixel that the window moves: the central difference; 0 if it
    /// cannot be estimated.
    fn by_window(&self, above: &[f64], line: &Sighting) -> f64 {
        let half = self.settings.window / 2;
        let position = |centre: usize| {
            let line = &line.about(centre, half, above.len());
            let estimate = Profile { above, line }.estimate(&self.settings.method)?;
            Some(estimate.position)
        };
        let before = line.centre.checked_sub(1).and_then(position);
        let positions = before.zip(position(line.centre + 1));
        positions.map_or(0.0, |(before, after)| 0.5 * (after - before))
    }

    /// The pixels that an estimate may look at: the window, also if it was moved onto its result.
    fn within_reach(&self, line: &Sighting, position: f64) -> impl Iterator<Item = usize> {
        let reach = self.settings.window as f64 / 2.0 + 1.0;
        let window = line.window.clone();
        line.zone
            .clone()
            .filter(move |i| window.contains(i) || (*i as f64 + 0.5 - position).abs() <= reach)
    }

    /// The central difference of the position by one pixel; 0 if it cannot be estimated.
    fn derivative(&self, above: &mut [f64], line: &Sighting, i: usize) -> f64 {
        let kept = above[i];
        let change = CHANGE * above[line.greatest];
        let mut position = |value: f64| {
            above[i] = value;
            let estimate = Profile { above, line }.estimate(&self.settings.method)?;
            Some(estimate.position)
        };
        let positions = position(kept + change).zip(position(kept - change));
        above[i] = kept;
        positions.map_or(0.0, |(more, less)| (more - less) / (2.0 * change))
    }
}
