//! The picture of an image with its lines.

use tem00_numerics::{Grid, cast::to_usize};
use tem00_triangulation::{LinePoint, Validity};

/// The colours of the lines, in linear sRGB; further lines begin again with the first.
const COLOURS: [[f32; 3]; 4] = [
    [1.0, 0.05, 0.02],
    [0.0, 0.6, 1.0],
    [1.0, 0.7, 0.0],
    [0.1, 0.9, 0.1],
];

/// The colour of points that cannot be trusted.
const DOUBTFUL: [f32; 3] = [0.9, 0.0, 0.9];

/// Returns the image in grey, its brightest pixel white, with a coloured pixel for each point.
pub(crate) fn picture(
    image: &Grid<f32>,
    (found, rows): (&[Vec<LinePoint>], bool),
) -> Grid<[f32; 3]> {
    let brightest = image.values().iter().copied().fold(0.0, f32::max);
    let white = if brightest > 0.0 { brightest } else { 1.0 };
    let mut picture = image.map(|&value| [value / white; 3]);
    for (index, points) in found.iter().enumerate() {
        // Positions before the image have no pixel.
        for point in points.iter().filter(|point| point.position >= 0.0) {
            let place = to_usize(point.position);
            let (x, y) = if rows { (place, index) } else { (index, place) };
            if x < picture.width() && y < picture.height() {
                picture[(x, y)] = colour(point);
            }
        }
    }
    picture
}

fn colour(point: &LinePoint) -> [f32; 3] {
    match point.validity {
        Validity::Valid => COLOURS[point.line % COLOURS.len()],
        _ => DOUBTFUL,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Colours are drawn as they are, not computed.
    fn is(pixel: [f32; 3], colour: [f32; 3]) -> bool {
        pixel.iter().zip(colour).all(|(a, b)| (a - b).abs() < 1e-6)
    }

    fn point(position: f64, line: usize, validity: Validity) -> LinePoint {
        LinePoint {
            position,
            width: 2.0,
            peak: 1.0,
            integral: 1.0,
            background: 0.0,
            validity,
            line,
        }
    }

    #[test]
    fn points_are_drawn_where_they_are() {
        let image = Grid::from_fn(3, 4, |x, y| (x + y) as f32);
        let (near, far) = (
            point(1.99, 0, Validity::Valid),
            point(-0.2, 1, Validity::Valid),
        );
        let (bad, out) = (
            point(3.0, 1, Validity::Saturated),
            point(4.0, 0, Validity::Valid),
        );
        let found = [vec![near, far], vec![], vec![bad, out]];
        let across = picture(&image, (&found, false));
        assert!(is(across[(0, 1)], COLOURS[0]), "the first line");
        assert!(is(across[(2, 3)], DOUBTFUL), "a saturated point");
        let pixels = across.values().iter();
        let untouched = pixels.filter(|&&pixel| is(pixel, [pixel[0]; 3])).count();
        assert_eq!(untouched, 10, "what lies outside is left out");
        assert!(is(across[(1, 3)], [0.8; 3]), "5 is white, and 4 is not");

        let down = picture(&image, (&found, true));
        assert!(is(down[(1, 0)], COLOURS[0]), "turned");
    }

    #[test]
    fn darkness_is_black() {
        let dark = picture(&Grid::filled(2, 2, 0.0), (&[], false));
        assert!(dark.values().iter().flatten().all(|&v| v == 0.0), "black");
    }
}
