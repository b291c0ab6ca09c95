//! Work on rows and slices, by all threads where the feature `parallel` allows it.

use tem00_numerics::Grid;

use crate::SpeckleScratch;

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

/// Maps every item of a list, with one working memory per thread; items never depend on each other.
pub(crate) fn map_with_scratch<T: Send, R: Send>(
    items: Vec<T>,
    map: impl Fn(usize, T, &mut SpeckleScratch) -> R + Sync + Send,
) -> Vec<R> {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        let share = items.len().div_ceil(rayon::current_num_threads());
        items
            .into_par_iter()
            .enumerate()
            .with_min_len(share)
            .map_init(SpeckleScratch::default, |scratch, (index, item)| {
                map(index, item, scratch)
            })
            .collect()
    }
    #[cfg(not(feature = "parallel"))]
    {
        let mut scratch = SpeckleScratch::default();
        let items = items.into_iter().enumerate();
        items
            .map(|(index, item)| map(index, item, &mut scratch))
            .collect()
    }
}
