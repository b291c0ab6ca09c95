use glam::{DMat2, DVec2};
use tem00_numerics::{Grid, Refusal};

use crate::{Checkerboard, flat_field::flattened, lattice::ordered, ring::corner_candidates};
use tem00_triangulation::TriangulationError;

/// The standard deviation of the first Gaussian that smooths a corner, in sides of a square: the
/// next edges are more than five standard deviations away.
const SMOOTHING: f64 = 0.18;

/// Standard deviation of the last smoothing, in squares. The error due to uneven light and curved
/// edges grows with its square.
const LAST_SMOOTHING: f64 = 0.06;

/// The minimum standard deviation of the last smoothing, in pixels: steps between pixels hardly
/// show in it.
const MIN_SMOOTHING: f64 = 2.0;

/// The reach of the smoothing window, in standard deviations.
const WINDOW: f64 = 4.0;

/// Maximum number of refinements of a position.
const MAX_STEPS: usize = 30;

/// The change of a position, in pixels, below which the refinement ends.
const MIN_STEP: f64 = 1e-4;

/// The minimum size of an image, in pixels, that is searched.
const MIN_SIZE: usize = 16;

/// Maximum number of times that the image is halved if its corners are too blurred for the ring.
const HALVINGS: u32 = 3;

/// Finds the inner corners of a checkerboard in an image, in pixels: row by row from the upper
/// left, to a small fraction of a pixel.
///
/// Corners are found by the bright and dark quarters around them, in the image and in coarser ones,
/// and put in order by their neighbours. Their positions are the saddles of the image smoothed by a
/// Gaussian, first over about a third of a square, then over a third of that width: by the symmetry
/// of a corner neither blur nor contrast moves them. Uneven light would move them: it is estimated
/// from the bright squares and divided out. Its remainder moves a position, and so does a lens that
/// bends the edges:
///
/// ```text
/// σ_x = √(π/8) σ_I / ΔI      by noise: σ_I of a pixel, ΔI bright less dark
/// δ   = π σ² g Ī / ΔI        by light of the relative slope g per pixel, Ī the mean of bright and
///                            dark
/// δ   = 2 σ² k₁ r / d²       by distortion, at the distance r from the axis, d the image distance
///                            in pixels
/// ```
///
/// The first, per axis, follows from the slope of the noise and the curvature ΔI / (π σ²) of a
/// smoothed corner; it does not depend on the smoothing σ. The others depend on its square.
///
/// # Validity
///
/// Squares are at least about 12 pixels wide, and the whole board is seen. The grey values are in
/// proportion to the light, or nearly so.
///
/// # Errors
///
/// Returns an error if a value is not finite or if the image does not show exactly this board.
///
/// # References
///
/// - L. Lucchese and S. K. Mitra, *Using Saddle Points for Subpixel Feature Detection in Camera
///   Calibration Targets*, 2002.
pub fn find_corners(
    image: &Grid<f32>,
    board: &Checkerboard,
) -> Result<Vec<DVec2>, TriangulationError> {
    if let Some(value) = image.values().iter().find(|value| !value.is_finite()) {
        return Err(Refusal::new("grey value", f64::from(*value), "finite").into());
    }
    let mut coarse = image.clone();
    let mut found = 0;
    for halving in 0..=HALVINGS {
        let candidates = corner_candidates(&coarse, board.corner_count());
        match ordered(&candidates, board.corners()) {
            Ok(positions) => {
                let scale = f64::from(1_u32 << halving);
                let positions: Vec<_> = positions
                    .into_iter()
                    .map(|position| scale * position)
                    .collect();
                let flat = flattened(image, board.corners(), &positions);
                return refined(&flat, board, &positions);
            }
            Err(number) => found = found.max(number),
        }
        if coarse.width().min(coarse.height()) < 2 * MIN_SIZE {
            break;
        }
        coarse = halved(&coarse);
    }
    Err(TriangulationError::NoBoard {
        corners: board.corners(),
        found,
    })
}

/// Returns the mean of each four pixels.
fn halved(image: &Grid<f32>) -> Grid<f32> {
    Grid::from_fn(image.width() / 2, image.height() / 2, |x, y| {
        let (x, y) = (2 * x, 2 * y);
        let sum = image[(x, y)] + image[(x + 1, y)] + image[(x, y + 1)] + image[(x + 1, y + 1)];
        0.25 * sum
    })
}

/// Moves the positions to the saddles near them.
fn refined(
    image: &Grid<f32>,
    board: &Checkerboard,
    positions: &[DVec2],
) -> Result<Vec<DVec2>, TriangulationError> {
    let [columns, _] = board.corners();
    let side = |i: usize| {
        let beside = if i.is_multiple_of(columns) {
            i + 1
        } else {
            i - 1
        };
        let above = if i < columns {
            i + columns
        } else {
            i - columns
        };
        let to = |j: usize| positions[i].distance(positions[j]);
        to(beside).min(to(above))
    };
    let of_position = |(i, position): (usize, &DVec2)| {
        let side = side(i);
        let about = saddle(image, *position, SMOOTHING * side)?;
        let last = (LAST_SMOOTHING * side).max(MIN_SMOOTHING);
        saddle(image, about, last.min(SMOOTHING * side))
    };
    let refined: Vec<_> = positions
        .iter()
        .enumerate()
        .filter_map(of_position)
        .collect();
    if refined.len() < positions.len() {
        return Err(TriangulationError::NoBoard {
            corners: board.corners(),
            found: refined.len(),
        });
    }
    Ok(refined)
}

/// Returns the position near `start` at which the image, smoothed by a Gaussian of the standard
/// deviation `sigma`, has a saddle, or `None` if there is none within two standard deviations.
///
/// ```text
/// q ← q − H⁻¹ g      g, H: gradient and second derivatives of G ∗ I at q
/// ```
fn saddle(image: &Grid<f32>, start: DVec2, sigma: f64) -> Option<DVec2> {
    let mut position = start;
    for _ in 0..MAX_STEPS {
        let (gradient, second) = derivatives(image, position, sigma);
        let step = -(second.inverse() * gradient);
        let near = (position + step).distance(start) < 2.0 * sigma;
        if second.determinant() >= 0.0 || !step.is_finite() || !near {
            return None;
        }
        position += step;
        if step.length() < MIN_STEP {
            return Some(position);
        }
    }
    Some(position)
}

/// Returns gradient and second derivatives of the smoothed image at a position, except for a common
/// factor.
///
/// Beyond its edges the image is continued by its mean.
fn derivatives(image: &Grid<f32>, position: DVec2, sigma: f64) -> (DVec2, DMat2) {
    let pixels = || pixels(image, position, sigma);
    let (sum, weights) = pixels().fold((0.0, 0.0), |(sum, weights), (_, weight, value)| {
        (sum + weight * value, weights + weight)
    });
    let mean = sum / weights;
    let mut gradient = DVec2::ZERO;
    let mut second = DMat2::ZERO;
    for (offset, weight, value) in pixels() {
        let value = weight * (value - mean);
        gradient += value * offset;
        let outer = DMat2::from_cols(offset * offset.x, offset * offset.y);
        second += value * (outer - DMat2::IDENTITY);
    }
    (gradient, second * (1.0 / sigma))
}

/// Returns the pixels about a position: their offsets in units of `sigma`, their weights and
/// values.
fn pixels(
    image: &Grid<f32>,
    position: DVec2,
    sigma: f64,
) -> impl Iterator<Item = (DVec2, f64, f64)> {
    let range = move |at: f64, size: usize| {
        let (low, high) = (at - WINDOW * sigma, at + WINDOW * sigma);
        (0..size).filter(move |&i| (low..=high).contains(&(i as f64 + 0.5)))
    };
    let columns: Vec<_> = range(position.x, image.width()).collect();
    let all = range(position.y, image.height())
        .flat_map(move |y| columns.clone().into_iter().map(move |x| (x, y)));
    all.map(move |(x, y)| {
        let offset = (DVec2::new(x as f64 + 0.5, y as f64 + 0.5) - position) / sigma;
        let weight = (-0.5 * offset.length_squared()).exp();
        (offset, weight, f64::from(image[(x, y)]))
    })
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use rand_chacha::ChaCha8Rng;
    use rand_core::SeedableRng;
    use rand_distr::{Distribution, Normal};
    use tem00_numerics::cast::to_f32;
    use tem00_testkit::assert_absolute;

    use super::*;

    fn board() -> Checkerboard {
        Checkerboard::new([5, 4], 1.0).unwrap()
    }

    /// Returns the position of a corner in the image: squares of 20 pixels, turned and in
    /// perspective.
    fn position(board: DVec2) -> DVec2 {
        let flat = 20.0 * DVec2::from_angle(0.2).rotate(board);
        let nearer = 1.0 + 0.001 * flat.x - 0.0015 * flat.y;
        flat / nearer + DVec2::new(52.3, 38.9)
    }

    /// The point of the board at an image point.
    fn on_board(image: DVec2) -> DVec2 {
        let offset = image - DVec2::new(52.3, 38.9);
        // flat = offset · nearer, which is linear in flat.
        let nearer = 1.0 / (1.0 - 0.001 * offset.x + 0.0015 * offset.y);
        DVec2::from_angle(-0.2).rotate(offset * nearer) / 20.0
    }

    /// The means of 8 × 8 points per pixel.
    fn image(noise: f64, blur: f64) -> Grid<f32> {
        let grey = |point: DVec2| {
            let on_board = on_board(point);
            let inside = on_board.cmpgt(DVec2::splat(-1.0)).all()
                && on_board.cmplt(DVec2::new(5.0, 4.0)).all();
            let even = (on_board.x.floor() + on_board.y.floor()).rem_euclid(2.0) < 0.5;
            if inside && even { 20.0 } else { 200.0 }
        };
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let normal = Normal::new(0.0, noise).unwrap();
        let mut image = Grid::from_fn(170, 140, |x, y| {
            let sums = (0..64_u32).map(|i| {
                let inside = DVec2::new(f64::from(i % 8), f64::from(i / 8)) / 8.0 + 0.0625;
                let position = DVec2::new(x as f64, y as f64) + 0.5 + (1.0 + blur) * (inside - 0.5);
                grey(position)
            });
            to_f32(sums.sum::<f64>() / 64.0)
        });
        let values = image.values_mut().iter_mut();
        values.for_each(|value| *value += to_f32(normal.sample(&mut rng)));
        image
    }

    fn greatest_error(image: &Grid<f32>) -> f64 {
        let found = find_corners(image, &board()).unwrap();
        let corner = |i: u32| position(DVec2::new((i % 5).into(), (i / 5).into()));
        let distances = found
            .iter()
            .zip(0..)
            .map(|(found, i)| found.distance(corner(i)));
        distances.fold(0.0, f64::max)
    }

    #[test]
    fn corners_are_found_to_a_fraction_of_a_pixel() {
        // 8 × 8 points locate an edge to a uniform 1/8 pixel, 0.036 of standard deviation; over the
        // 2 √π σ = 7 pixels of a smoothing by 2 pixels 0.014 per axis, and three times that for the
        // worst of 20.
        let error = greatest_error(&image(0.0, 0.0));
        assert!(error < 0.042, "{error}");
        // √(π/8) · 2/180 = 0.007 pixel per axis; four and a half of them more for the worst of 20.
        let error = greatest_error(&image(2.0, 0.0));
        assert!(error < 0.05, "{error}");
        // A box of 5 pixels, a quarter of a square, of 8 × 8 points.
        let error = greatest_error(&image(0.0, 4.0));
        assert!(error < 0.05, "{error}");
    }

    #[test]
    fn uneven_light_moves_corners_by_little() {
        // Too few bright squares to determine the light.
        let board = Checkerboard::new([3, 3], 1.0).unwrap();
        let turned = DVec2::from_angle(0.2);
        let middle = DVec2::new(52.3, 48.9);
        let slope = 2e-3;
        let image = Grid::from_fn(110, 100, |x, y| {
            let sums = (0..256_u32).map(|i| {
                let inside = DVec2::new(f64::from(i % 16), f64::from(i / 16)) / 16.0 + 0.03125;
                let offset = DVec2::new(x as f64, y as f64) + inside - middle;
                let squares = (DVec2::from_angle(-0.2).rotate(offset) / 20.0 + 1.0).floor();
                let inside = squares.cmpge(DVec2::splat(-1.0)).all()
                    && squares.cmplt(DVec2::splat(3.0)).all();
                let even = (squares.x + squares.y).rem_euclid(2.0) < 0.5;
                let grey = if inside && even { 20.0 } else { 200.0 };
                grey * (1.0 + slope * offset.x)
            });
            to_f32(sums.sum::<f64>() / 256.0)
        });
        let found = find_corners(&image, &board).unwrap();
        let corners = (0..9_u32).map(|i| DVec2::new(f64::from(i % 3), f64::from(i / 3)) - 1.0);
        // Where bright and dark are swapped, so is the shift.
        let shifts = found
            .iter()
            .zip(corners)
            .zip([1.0, -1.0].into_iter().cycle());
        let shifts = shifts
            .map(|((found, corner), sign)| sign * (*found - middle - 20.0 * turned.rotate(corner)));
        let mean = shifts.sum::<DVec2>() / 9.0;
        // π σ² g Ī/ΔI with a σ of 2 pixels. Points of 1/16 pixel alias by 0.007 per corner, a third
        // of that in the mean.
        let expected = PI * 4.0 * slope * 110.0 / 180.0;
        assert_absolute(mean.length(), expected, 0.005);
    }

    #[test]
    fn images_without_the_board_are_refused() {
        let refused = |image: &Grid<f32>, corners| {
            let board = Checkerboard::new(corners, 1.0).unwrap();
            find_corners(image, &board).unwrap_err()
        };
        let none = |found, corners| TriangulationError::NoBoard { corners, found };
        assert_eq!(refused(&image(0.0, 0.0), [6, 4]), none(20, [6, 4]));
        for (width, height) in [(100, 80), (1, 1)] {
            let flat = Grid::filled(width, height, 7.0);
            assert_eq!(refused(&flat, [5, 4]), none(0, [5, 4]), "{width}");
        }
        let holes = refused(&Grid::filled(100, 80, f32::NAN), [5, 4]);
        assert_eq!(holes.parameter(), Some("grey value"));
    }
}
