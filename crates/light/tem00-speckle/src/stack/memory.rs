//! Memory of a stack, which is checked before it is used.

use num_complex::Complex;
use tem00_numerics::{Grid, available_memory};

use crate::{SlicePath, SpeckleError, pupil::not_a_side};

/// Options of a [`SpeckleStack`](crate::SpeckleStack).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StackOptions {
    /// The memory limit of the slices, in bytes; [`u64::MAX`] by default.
    ///
    /// Many systems grant any request for memory and end the program when it uses the memory. Where
    /// the system reports its available memory (Linux), a stack that needs more is an error even
    /// without a limit. Elsewhere, and in a container that may have less memory, only a limit
    /// prevents a stack that is too large.
    pub memory_limit: u64,
}

impl Default for StackOptions {
    fn default() -> Self {
        Self {
            memory_limit: u64::MAX,
        }
    }
}

pub(crate) const fn check_limit(needed: u64, limit: u64) -> Result<(), SpeckleError> {
    if needed > limit {
        return Err(SpeckleError::MemoryLimit { needed, limit });
    }
    Ok(())
}

/// Reserves memory for the slices along `path`, or returns an error if it does not suffice for all
/// of them.
///
/// The memory is only used, and taken from the machine, when the slices are filled.
pub(crate) fn reserve(
    path: SlicePath,
    size: [usize; 2],
) -> Result<Vec<Vec<Complex<f32>>>, SpeckleError> {
    reserve_of(path, size, available_memory())
}

/// Reserves memory on a machine with `available` bytes, if known.
fn reserve_of(
    path: SlicePath,
    size: [usize; 2],
    available: Option<u64>,
) -> Result<Vec<Vec<Complex<f32>>>, SpeckleError> {
    let bytes = path.memory_bytes(size);
    if available.is_some_and(|available| bytes > available) {
        return Err(SpeckleError::Memory { bytes });
    }
    let samples = size[0].saturating_mul(size[1]);
    let room = |_| {
        let mut values = Vec::new();
        values.try_reserve_exact(samples).map(|()| values)
    };
    let rooms: Result<_, _> = (0..path.slice_count()).map(room).collect();
    rooms.map_err(|_| SpeckleError::Memory { bytes })
}

/// A dark slice in `room`.
pub(crate) fn dark(
    mut room: Vec<Complex<f32>>,
    [width, height]: [usize; 2],
) -> Result<Grid<Complex<f32>>, SpeckleError> {
    room.resize(width * height, Complex::new(0.0, 0.0));
    Grid::from_vec(width, height, room).map_err(|_| not_a_side(width.min(height)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_the_machine_has_is_refused_before_it_is_used() {
        let path = SlicePath::Circle { half_period: 2 };
        let bytes = 4 * 16 * 8 * 8;
        let room = |available| reserve_of(path, [16, 8], available);
        assert_eq!(room(Some(bytes - 1)), Err(SpeckleError::Memory { bytes }));
        for enough in [Some(bytes), None] {
            let room = room(enough).map(|rooms| rooms.len());
            assert_eq!(room, Ok(4), "with {enough:?} bytes");
        }
    }
}
