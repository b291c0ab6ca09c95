//! Work on slices, by all threads with the feature `parallel`.

use crate::SpeckleScratch;

/// Maps every item of a list, with one working memory per thread; items are independent of each
/// other.
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
