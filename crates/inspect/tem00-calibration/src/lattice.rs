use std::collections::HashMap;

use glam::DVec2;

/// Largest distance of a corner from the position that its neighbours predict, in squares.
const TOLERANCE: f64 = 0.3;

/// The number of points with which a lattice begins.
const SEED_CELLS: usize = 3;

/// The sine of the minimum angle between the two directions of a lattice.
const MIN_SINE: f64 = 0.5;

/// The positions of a lattice: the number of each point by column and row.
type Cells = HashMap<(i32, i32), usize>;

/// Orders points that form a lattice of `columns × rows`: row by row from the upper left, so that
/// rows run to the right as seen in the image.
///
/// The lattice grows from a point and its nearest neighbours: each next point is sought where the
/// points before it lead. Points that fit into no lattice are left out.
///
/// # Errors
///
/// Returns the number of points of the largest lattice if none has the requested size.
pub(super) fn ordered(points: &[DVec2], corners: [usize; 2]) -> Result<Vec<DVec2>, usize> {
    let mut largest = 0;
    let mut covered = vec![false; points.len()];
    for seed in 0..points.len() {
        // From within a lattice that does not fit, the same one would grow.
        if covered[seed] {
            continue;
        }
        let cells = grown(points, seed);
        if cells.len() > SEED_CELLS {
            cells.values().for_each(|&point| covered[point] = true);
        }
        if let Some(positions) = placed(points, &cells, corners) {
            return Ok(positions);
        }
        largest = largest.max(cells.len());
    }
    Err(largest)
}

/// Returns the lattice about a point.
fn grown(points: &[DVec2], seed: usize) -> Cells {
    let mut cells = Cells::new();
    let Some([right, down]) = directions(points, seed) else {
        return cells;
    };
    cells.extend([((0, 0), seed), ((1, 0), right), ((0, 1), down)]);
    let mut used = vec![false; points.len()];
    [seed, right, down].into_iter().for_each(|i| used[i] = true);
    loop {
        let known: Vec<_> = cells.keys().copied().collect();
        let before = cells.len();
        for cell in known {
            for step in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                if let Some((next, point)) = neighbour(points, &cells, &used, (cell, step)) {
                    cells.insert(next, point);
                    used[point] = true;
                }
            }
        }
        if cells.len() == before {
            return cells;
        }
    }
}

/// Returns the nearest point and the nearest in another direction.
fn directions(points: &[DVec2], seed: usize) -> Option<[usize; 2]> {
    let offset = |i: &usize| points[*i] - points[seed];
    let nearest = |candidates: &mut dyn Iterator<Item = usize>| {
        candidates.min_by(|i, j| offset(i).length().total_cmp(&offset(j).length()))
    };
    let first = nearest(&mut (0..points.len()).filter(|i| *i != seed))?;
    let along = offset(&first).normalize_or_zero();
    let across = |i: &usize| {
        let direction = offset(i).normalize_or_zero();
        along.perp_dot(direction).abs() > MIN_SINE
    };
    let second = nearest(&mut (0..points.len()).filter(across))?;
    Some([first, second])
}

/// Returns the cell one step on and the point in it, if the cell is free and a point is there.
fn neighbour(
    points: &[DVec2],
    cells: &Cells,
    used: &[bool],
    (cell, step): ((i32, i32), (i32, i32)),
) -> Option<((i32, i32), usize)> {
    let next = (cell.0 + step.0, cell.1 + step.1);
    if cells.contains_key(&next) {
        return None;
    }
    let position = |cell: (i32, i32)| cells.get(&cell).map(|&i| points[i]);
    let here = position(cell)?;
    let straight = position((cell.0 - step.0, cell.1 - step.1)).map(|before| here - before);
    let beside = |side: i32| {
        let shift = (side * step.1, side * step.0);
        let from = position((cell.0 + shift.0, cell.1 + shift.1))?;
        let to = position((next.0 + shift.0, next.1 + shift.1))?;
        Some(to - from)
    };
    let offset = straight.or_else(|| beside(1)).or_else(|| beside(-1))?;
    let expected = here + offset;
    let free = (0..points.len()).filter(|&i| !used[i]);
    let distance = |i: &usize| points[*i].distance(expected);
    free.min_by(|i, j| distance(i).total_cmp(&distance(j)))
        .filter(|i| distance(i) < TOLERANCE * offset.length())
        .map(|point| (next, point))
}

/// Returns the points of a full lattice of the right size, in order.
fn placed(points: &[DVec2], cells: &Cells, [columns, rows]: [usize; 2]) -> Option<Vec<DVec2>> {
    let low = (
        cells.keys().map(|c| c.0).min()?,
        cells.keys().map(|c| c.1).min()?,
    );
    let high = (
        cells.keys().map(|c| c.0).max()?,
        cells.keys().map(|c| c.1).max()?,
    );
    let size = [high.0 - low.0 + 1, high.1 - low.1 + 1].map(|n| usize::try_from(n).unwrap_or(0));
    if cells.len() != columns * rows || size[0] * size[1] != cells.len() {
        return None;
    }
    let at = |i: usize, j: usize| {
        let along = |low: i32, i: usize| i32::try_from(i).ok().map(|i| low + i);
        let cell = (along(low.0, i)?, along(low.1, j)?);
        cells.get(&cell).map(|&point| points[point])
    };
    let turns = (0..8_u8).filter_map(|turn| {
        let of_cell = |column: usize, row: usize| {
            let (i, j) = if turn & 1 == 0 {
                (column, row)
            } else {
                (row, column)
            };
            let i = if turn & 2 == 0 {
                i
            } else {
                size[0].checked_sub(1 + i)?
            };
            let j = if turn & 4 == 0 {
                j
            } else {
                size[1].checked_sub(1 + j)?
            };
            at(i, j)
        };
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        cells
            .map(|(column, row)| of_cell(column, row))
            .collect::<Option<Vec<_>>>()
    });
    // The rows lie below each other where the columns run to the right; of the lattices that are
    // left, the one that runs most to the right.
    let right = |positions: &[DVec2]| positions[columns - 1] - positions[0];
    let down = |positions: &[DVec2]| positions[(rows - 1) * columns] - positions[0];
    turns
        .filter(|positions| right(positions).perp_dot(down(positions)) > 0.0)
        .max_by(|one, two| {
            let cosine = |positions: &[DVec2]| right(positions).normalize_or_zero().x;
            cosine(one).total_cmp(&cosine(two))
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lattice in perspective, turned by `angle`.
    fn lattice([columns, rows]: [u32; 2], angle: f64) -> Vec<DVec2> {
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let position = |(column, row): (u32, u32)| {
            let flat = DVec2::new(f64::from(column), f64::from(row)) * 20.0;
            let nearer = 1.0 + 0.002 * flat.x + 0.003 * flat.y;
            DVec2::from_angle(angle).rotate(flat / nearer) + DVec2::splat(300.0)
        };
        cells.map(position).collect()
    }

    #[test]
    fn a_lattice_is_ordered_from_the_upper_left() {
        for angle in [-0.6, 0.0, 0.6] {
            let expected = lattice([7, 5], angle);
            let mut mixed = expected.clone();
            mixed.sort_by(|a, b| (a.x * 7.3).sin().total_cmp(&(b.x * 7.3).sin()));
            // Two strays.
            mixed.extend([DVec2::new(10.0, 10.0), expected[8] + DVec2::new(9.0, 8.0)]);
            assert_eq!(ordered(&mixed, [7, 5]), Ok(expected), "{angle}");
        }
    }

    #[test]
    fn a_board_upside_down_is_turned() {
        let positions = lattice([7, 5], core::f64::consts::PI);
        let found = ordered(&positions, [7, 5]).unwrap();
        let reversed: Vec<_> = positions.into_iter().rev().collect();
        assert_eq!(found, reversed);
    }

    #[test]
    fn a_board_on_its_side_keeps_its_columns() {
        let positions = lattice([7, 5], 1.6);
        let length = |size: [usize; 2]| {
            let found = ordered(&positions, size).unwrap();
            found[size[0] - 1].x - found[0].x
        };
        assert!(length([5, 7]) > 40.0, "rows of five run right");
        assert!(length([7, 5]).abs() < 40.0, "rows of seven stand");
    }

    #[test]
    fn another_size_and_missing_corners_are_refused() {
        let mut positions = lattice([7, 5], 0.1);
        assert_eq!(ordered(&positions, [8, 5]), Err(35));
        positions.remove(12);
        assert_eq!(ordered(&positions, [7, 5]), Err(34));
        assert_eq!(ordered(&[], [7, 5]), Err(0));
        assert_eq!(ordered(&[DVec2::ONE], [7, 5]), Err(0));
    }
}
