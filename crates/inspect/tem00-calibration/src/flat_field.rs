use glam::DVec2;
use nalgebra::{DMatrix, DVector};
use tem00_numerics::{Grid, cast::to_f32};

/// The minimum illumination that an image is divided by, as a fraction of its mean on the board.
const MIN: f64 = 0.1;

/// Minimum number of bright squares per coefficient of the illumination.
const SQUARES_PER_COEFFICIENT: usize = 2;

/// Returns the image divided by the illumination of a board in it, whose ordered corners are
/// approximately known.
///
/// The illumination is a polynomial in the position, of the second or first degree, depending on
/// the number of bright squares; the mean on the board stays. With too few bright squares the image
/// stays as it is.
///
/// A slope of the illumination would move the saddles of the corners:
///
/// ```text
/// δ = π σ² g Ī / ΔI      g: relative slope per pixel, σ: smoothing, Ī, ΔI: mean and contrast
/// ```
pub(super) fn flattened(
    image: &Grid<f32>,
    [columns, rows]: [usize; 2],
    corners: &[DVec2],
) -> Grid<f32> {
    let square = |(i, j): (usize, usize)| {
        let first = j * columns + i;
        let around = [first, first + 1, first + columns, first + columns + 1];
        let middle = around.map(|corner| corners[corner]).iter().sum::<DVec2>() / 4.0;
        Some((middle, value_at(image, middle)?))
    };
    let of_parity = |parity: usize| -> Vec<(DVec2, f64)> {
        let squares = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| (i, j)));
        squares
            .filter(|(i, j)| (i + j) % 2 == parity)
            .filter_map(square)
            .collect()
    };
    let mean = |squares: &[(DVec2, f64)]| {
        squares.iter().map(|square| square.1).sum::<f64>() / squares.len() as f64
    };
    let [even, odd] = [of_parity(0), of_parity(1)];
    let bright = if mean(&even) > mean(&odd) { even } else { odd };
    let level = mean(&bright);
    let size = DVec2::new(image.width() as f64, image.height() as f64);
    let Some(coefficients) = fitted(&bright, size) else {
        return image.clone();
    };
    Grid::from_fn(image.width(), image.height(), |x, y| {
        let position = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let terms = terms(position / size);
        let light: f64 = coefficients
            .iter()
            .zip(terms)
            .map(|(c, term)| c * term)
            .sum();
        let relative = (light / level).max(MIN);
        to_f32(f64::from(image[(x, y)]) / relative)
    })
}

/// The mean of the 3 × 3 pixels about a position, or `None` if they are not in the image.
fn value_at(image: &Grid<f32>, position: DVec2) -> Option<f64> {
    let inside = |at: f64, size: usize| (1..size.saturating_sub(1)).find(|&i| at < i as f64 + 1.0);
    let (x, y) = (
        inside(position.x, image.width())?,
        inside(position.y, image.height())?,
    );
    let pixels = (0..9).map(|i| f64::from(image[(x + i % 3 - 1, y + i / 3 - 1)]));
    Some(pixels.sum::<f64>() / 9.0)
}

/// Returns the coefficients of least squares, in the order of [`terms`].
fn fitted(squares: &[(DVec2, f64)], size: DVec2) -> Option<Vec<f64>> {
    let number = [6, 3]
        .into_iter()
        .find(|n| squares.len() >= n * SQUARES_PER_COEFFICIENT)?;
    let row = |i: usize| terms(squares[i].0 / size);
    let matrix = DMatrix::from_fn(squares.len(), number, |i, j| row(i)[j]);
    let right = DVector::from_fn(squares.len(), |i, _| squares[i].1);
    let found = matrix.svd(true, true).solve(&right, 1e-12).ok()?;
    found
        .iter()
        .all(|c| c.is_finite())
        .then(|| found.iter().copied().collect())
}

fn terms(DVec2 { x, y }: DVec2) -> [f64; 6] {
    [1.0, x, y, x * x, x * y, y * y]
}

#[cfg(test)]
mod tests {
    use tem00_testkit::assert_relative;

    use super::*;

    #[test]
    fn uneven_light_is_divided_out() {
        let light = |x: f64, y: f64| 100.0 + 0.3 * x - 0.2 * y - 0.002 * x * y;
        let image = Grid::from_fn(120, 100, |x, y| {
            let even = (x / 20 + y / 20) % 2 == 0;
            let light = light(x as f64 + 0.5, y as f64 + 0.5);
            to_f32(if even { light } else { 0.2 * light })
        });
        let corner = |i: u32| 20.0 * DVec2::new((1 + i % 5).into(), (1 + i / 5).into());
        let corners: Vec<_> = (0..20).map(corner).collect();
        let flat = flattened(&image, [5, 4], &corners);
        let bright = flat[(50, 50)].into();
        for (x, y) in [(10, 10), (90, 90), (30, 70)] {
            // Six bright squares fit the three terms of a plane; the product leaves 0.002 · 50² / 4
            // of 100.
            assert_relative(flat[(x, y)].into(), bright, 0.05);
        }
    }
}
