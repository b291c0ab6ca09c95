use crate::cast::to_usize;

/// A rectangle of pixels: a part of an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// The first column.
    pub x: usize,
    /// The first row.
    pub y: usize,
    /// The number of columns, at least 1.
    pub width: usize,
    /// The number of rows, at least 1.
    pub height: usize,
}

impl Crop {
    /// Returns whether the rectangle lies in an image of this width and height, in pixels.
    pub fn lies_in(&self, [width, height]: [usize; 2]) -> bool {
        let inside = |start: usize, length: usize, size: usize| {
            start.checked_add(length).is_some_and(|end| end <= size)
        };
        inside(self.x, self.width, width) && inside(self.y, self.height, height)
    }

    /// Returns the number of the pixel at a point of the image, in pixels, row by row in the
    /// rectangle, if it is there.
    pub fn pixel_at(&self, [x, y]: [f64; 2]) -> Option<usize> {
        let [x, y] = [x - self.x as f64, y - self.y as f64];
        let is_behind = x >= 0.0 && y >= 0.0;
        let (x, y) = (to_usize(x), to_usize(y));
        (is_behind && x < self.width && y < self.height).then_some(y * self.width + x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_numbered_inside_alone() {
        let crop = Crop {
            x: 9,
            y: 5,
            width: 7,
            height: 4,
        };
        for (point, pixel) in [
            ([9.0, 5.0], Some(0)),
            ([15.9, 6.5], Some(13)),
            ([8.9, 5.0], None),
            ([9.0, 4.9], None),
            ([16.0, 5.0], None),
            ([9.0, 9.0], None),
            ([f64::NAN, 5.0], None),
        ] {
            assert_eq!(crop.pixel_at(point), pixel, "{point:?}");
        }
        assert!(crop.lies_in([16, 9]), "its own corner");
        assert!(!crop.lies_in([15, 9]) && !crop.lies_in([16, 8]), "smaller");
    }
}
