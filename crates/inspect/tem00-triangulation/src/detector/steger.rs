use core::f64::consts::{FRAC_1_SQRT_2, TAU};

use tem00_numerics::Grid;

use super::{method::kernel_radius, profile::Profile};

/// A Gaussian and its first two derivatives, each integrated over the pixels about its middle.
///
/// The first and the last pixel hold everything beyond, so that the sums equal the integrals of the
/// functions: 1, 0 and 0.
pub(super) struct Kernels {
    radius: isize,
    /// For each pixel from −radius to radius the Gaussian and its derivatives.
    weights: Vec<[f64; 3]>,
}

/// The ridge along the columns and the derivatives across, about one pixel.
#[derive(Clone, Copy, Default)]
struct Derivatives {
    x: f64,
    y: f64,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Kernels {
    pub(super) fn new(sigma: f64) -> Self {
        let radius = kernel_radius(sigma).cast_signed();
        let edges: Vec<[f64; 3]> = (-radius..=radius + 1)
            .map(|i| {
                if i == -radius {
                    return [0.0, 0.0, 0.0];
                }
                if i > radius {
                    return [1.0, 0.0, 0.0];
                }
                let u = (i as f64 - 0.5) / sigma;
                let density = (-0.5 * u * u).exp() / (TAU.sqrt() * sigma);
                let cumulative = 0.5 * libm::erfc(-u * FRAC_1_SQRT_2);
                [cumulative, density, -u / sigma * density]
            })
            .collect();
        let weights = edges.windows(2).map(|pair| {
            let [before, after] = [pair[0], pair[1]];
            [0, 1, 2].map(|order| after[order] - before[order])
        });
        Self {
            radius,
            weights: weights.collect(),
        }
    }

    /// The weights of a pixel for the value at a position `distance` pixels after it.
    fn at(&self, distance: isize) -> [f64; 3] {
        let index = usize::try_from(distance + self.radius).ok();
        index
            .and_then(|index| self.weights.get(index))
            .copied()
            .unwrap_or([0.0; 3])
    }
}

/// The ridge of a column by itself.
pub(super) fn in_column(profile: &Profile<'_>, sigma: f64) -> Option<f64> {
    let kernels = Kernels::new(sigma);
    let pixels: Vec<[f64; 3]> = profile.pixels().map(|(_, v)| [v, 0.0, 0.0]).collect();
    ridge(profile, &pixels, &kernels)
}

/// The ridge of a column among its neighbours: `columns` holds each column as a row, the line is in
/// the column `x`.
pub(super) fn in_image(
    profile: &Profile<'_>,
    columns: &Grid<f32>,
    position: (usize, f64),
    kernels: &Kernels,
) -> Option<f64> {
    let (x, background) = position;
    let window = profile.line.window.clone();
    let mut pixels = vec![[0.0; 3]; window.len()];
    for offset in -kernels.radius..=kernels.radius {
        // The first and the last column continue beyond the image.
        let neighbour = x.saturating_add_signed(offset).min(columns.height() - 1);
        let weights = kernels.at(-offset);
        for (sums, &value) in pixels
            .iter_mut()
            .zip(&columns.row(neighbour)[window.clone()])
        {
            if value.is_finite() {
                let above = f64::from(value) - background;
                (0..3).for_each(|order| sums[order] += weights[order] * above);
            }
        }
    }
    ridge(profile, &pixels, kernels)
}

/// The position of the strongest ridge of the window, along the column, as a distance from the
/// greatest pixel; `pixels` holds for each pixel its smoothed value and the derivatives of this
/// value along x.
fn ridge(profile: &Profile<'_>, pixels: &[[f64; 3]], kernels: &Kernels) -> Option<f64> {
    let rows = (0_isize..).take(pixels.len());
    let derivatives = |row: isize| {
        let mut sum = Derivatives::default();
        for (i, &[value, along, twice_along]) in (0_isize..).zip(pixels) {
            let [smooth, first, second] = kernels.at(row - i);
            sum.x += smooth * along;
            sum.y += first * value;
            sum.xx += smooth * twice_along;
            sum.xy += first * along;
            sum.yy += second * value;
        }
        sum
    };
    let first = profile.line.window.start as f64 - profile.line.greatest as f64;
    rows.filter_map(|row| {
        let (strength, offset) = derivatives(row).ridge()?;
        Some((strength, first + row as f64 + offset))
    })
    .max_by(|a, b| a.0.total_cmp(&b.0))
    .map(|(_, position)| position)
}

impl Derivatives {
    /// The strength of a ridge through this pixel, and the distance along the column at which it
    /// crosses the middle of the pixel's column.
    ///
    /// With the unit normal n, the eigenvector of the most negative second derivative:
    ///
    /// ```text
    /// t = −(r_x n_x + r_y n_y) / (r_xx n_x² + 2 r_xy n_x n_y + r_yy n_y²)   to the ridge, along n
    /// y = t / n_y                                                           along the column
    /// ```
    ///
    /// The ridge belongs to this pixel if it crosses the column there.
    fn ridge(self) -> Option<(f64, f64)> {
        /// Half a pixel and a little: a ridge on the edge of two pixels must be in one of them.
        const IN_PIXEL: f64 = 0.6;
        let mean = 0.5 * (self.xx + self.yy);
        let curvature = mean - (0.5 * (self.xx - self.yy)).hypot(self.xy);
        if curvature >= 0.0 {
            return None;
        }
        // The first row of (H − λ) n = 0. Both vanish for a line along the column, which never
        // crosses.
        let (nx, ny) = (self.xy, curvature - self.xx);
        let length = nx.hypot(ny);
        let t = -(self.x * nx + self.y * ny) / (length * curvature);
        let crosses = t * length / ny;
        (crosses.abs() <= IN_PIXEL).then_some((-curvature, crosses))
    }
}
