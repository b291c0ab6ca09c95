//! The orientation in which an image is to be shown.

/// The tag of the orientation in TIFF files and in EXIF entries.
pub(super) const TAG: u16 = 274;

/// Returns the orientation that an EXIF entry states, from 1 (as stored) to 8.
pub(super) fn of_exif(exif: &[u8]) -> Option<u16> {
    let is_little = exif.starts_with(b"II*\0");
    if !is_little && !exif.starts_with(b"MM\0*") {
        return None;
    }
    let two = |at: usize| {
        let bytes = exif.get(at..at.checked_add(2)?)?.try_into().ok()?;
        Some(if is_little {
            u16::from_le_bytes(bytes)
        } else {
            u16::from_be_bytes(bytes)
        })
    };
    let [first, second] = [two(4)?, two(6)?].map(usize::from);
    let start = if is_little {
        second << 16 | first
    } else {
        first << 16 | second
    };
    let entries = (0..usize::from(two(start)?)).map(|i| start + 2 + 12 * i);
    let entry = entries.into_iter().find(|&at| two(at) == Some(TAG))?;
    two(entry + 8)
}

/// Returns pixels of `components` values each, turned by the orientation, and their new size.
pub(super) fn turned(
    values: &[f32],
    [width, height]: [usize; 2],
    components: usize,
    orientation: u16,
) -> (Vec<f32>, [usize; 2]) {
    let (right, low) = (width - 1, height - 1);
    let stored = |x: usize, y: usize| match orientation {
        2 => [right - x, y],
        3 => [right - x, low - y],
        4 => [x, low - y],
        5 => [y, x],
        6 => [y, low - x],
        7 => [right - y, low - x],
        8 => [right - y, x],
        _ => [x, y],
    };
    let size = if matches!(orientation, 5..=8) {
        [height, width]
    } else {
        [width, height]
    };
    let mut shown = Vec::with_capacity(values.len());
    for y in 0..size[1] {
        for x in 0..size[0] {
            let [x, y] = stored(x, y);
            let start = components * (y * width + x);
            shown.extend_from_slice(&values[start..start + components]);
        }
    }
    (shown, size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_orientation_is_as_its_standard_says() {
        // The letter F: upright, and as each orientation stores it (EXIF, tag 274).
        let upright = "##\n#.\n##\n#.";
        for (orientation, stored) in [
            (1, "##\n#.\n##\n#."),
            (2, "##\n.#\n##\n.#"),
            (3, ".#\n##\n.#\n##"),
            (4, "#.\n##\n#.\n##"),
            (5, "####\n#.#."),
            (6, "#.#.\n####"),
            (7, ".#.#\n####"),
            (8, "####\n.#.#"),
        ] {
            let rows: Vec<&str> = stored.lines().collect();
            let values: Vec<f32> = rows.concat().bytes().map(f32::from).collect();
            let (turned, size) = turned(&values, [rows[0].len(), rows.len()], 1, orientation);
            let expected: Vec<f32> = upright
                .bytes()
                .filter(|b| *b != b'\n')
                .map(f32::from)
                .collect();
            assert_eq!((turned, size), (expected, [2, 4]), "{orientation}");
        }
    }
}
