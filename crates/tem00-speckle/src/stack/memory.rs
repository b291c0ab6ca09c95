//! The memory of a stack: asked for before it is used.

use tem00_numerics::Grid;

use crate::{Interpolation, SlicePath, SpeckleError};

/// How a [`SpeckleStack`](crate::SpeckleStack) is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StackOptions {
    /// How look-ups interpolate in the plane.
    pub interpolation: Interpolation,
    /// The bytes that the slices may take, [`u64::MAX`] by default.
    ///
    /// Many systems grant any memory that is asked for and end the program when it is used: only a
    /// limit keeps a stack that is too large from that.
    pub memory_limit: u64,
}

impl Default for StackOptions {
    fn default() -> Self {
        Self {
            interpolation: Interpolation::default(),
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

/// Room for the slices along `path`, or an error if there is none for all of them.
///
/// It is only used, and taken from the machine, when the slices are filled in.
pub(crate) fn reserve<T>(path: SlicePath, size: [usize; 2]) -> Result<Vec<Vec<T>>, SpeckleError> {
    let samples = size[0].saturating_mul(size[1]);
    let room = |_| {
        let mut values = Vec::new();
        values.try_reserve_exact(samples).map(|()| values)
    };
    let rooms: Result<_, _> = (0..path.slice_count()).map(room).collect();
    rooms.map_err(|_| SpeckleError::Memory {
        bytes: path.memory_bytes(size) / 8 * size_of::<T>() as u64,
    })
}

/// A grid of one value in `room`.
pub(crate) fn filled<T: Clone>(
    mut room: Vec<T>,
    [width, height]: [usize; 2],
    value: T,
) -> Result<Grid<T>, SpeckleError> {
    room.resize(width * height, value);
    Grid::from_vec(width, height, room).map_err(|_| SpeckleError::Size(width.min(height)))
}
