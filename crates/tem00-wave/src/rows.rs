//! Work on rows, by all threads where the feature `parallel` allows it.

use tem00_numerics::Grid;

/// Calls `each(y, row)` for every row; rows never depend on each other.
pub(crate) fn for_each_row<T: Send>(grid: &mut Grid<T>, each: impl Fn(usize, &mut [T]) + Sync) {
    let width = grid.width();
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        grid.values_mut()
            .par_chunks_mut(width)
            .enumerate()
            .for_each(|(y, row)| each(y, row));
    }
    #[cfg(not(feature = "parallel"))]
    for (y, row) in grid.values_mut().chunks_mut(width).enumerate() {
        each(y, row);
    }
}
