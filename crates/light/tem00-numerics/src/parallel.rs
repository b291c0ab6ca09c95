//! Independent pieces of work, shared by the threads of the current rayon pool with the feature
//! `parallel`, and done by the calling thread without it.
//!
//! No result depends on the number of threads. All functions end in one compiled loop, so that they
//! cost their callers little to compile.

use std::sync::{Mutex, MutexGuard, PoisonError};

/// The number of runs of items for each thread: threads that finish early take runs of others.
const RUNS: usize = 64;

/// The number of values in a piece of [`map_pieces`].
const PIECE: usize = 1 << 14;

/// Returns the number of threads that share work.
pub fn thread_count() -> usize {
    #[cfg(feature = "parallel")]
    return rayon::current_num_threads();
    #[cfg(not(feature = "parallel"))]
    1
}

/// Calls `task(index)` for every index below `count`, in any order.
fn for_each(count: usize, task: &(dyn Fn(usize) + Sync)) {
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        (0..count).into_par_iter().for_each(task);
    }
    #[cfg(not(feature = "parallel"))]
    (0..count).for_each(task);
}

/// Returns `map(index)` for every index below `count`, in order.
///
/// # Examples
///
/// ```
/// use tem00_numerics::parallel;
///
/// assert_eq!(parallel::map(4, |index| index * index), [0, 1, 4, 9]);
/// ```
pub fn map<R: Send>(count: usize, map: impl Fn(usize) -> R + Sync) -> Vec<R> {
    map_with(count, |(), index| map(index))
}

/// Returns `map(state, index)` for every index below `count`, in order.
///
/// A state is working memory: it begins as the default, and no two calls have the same at once.
/// There are about as many as threads, and each serves many calls in turn.
pub fn map_with<S: Default + Send, R: Send>(
    count: usize,
    map: impl Fn(&mut S, usize) -> R + Sync,
) -> Vec<R> {
    let length = count.div_ceil(RUNS * thread_count()).max(1);
    let states = Mutex::new(Vec::new());
    let mut runs: Vec<Vec<R>> = Vec::new();
    runs.resize_with(count.div_ceil(length), Vec::new);
    for_each_chunk(&mut runs, 1, |run, results| {
        let mut state: S = lock(&states).pop().unwrap_or_default();
        let indices = run * length..count.min((run + 1) * length);
        results[0] = indices.map(|index| map(&mut state, index)).collect();
        lock(&states).push(state);
    });
    runs.into_iter().flatten().collect()
}

/// Returns `map(state, index, item)` for every item, in order, with states as in [`map_with`].
pub fn map_items_with<S: Default + Send, T: Send, R: Send>(
    items: Vec<T>,
    map: impl Fn(&mut S, usize, T) -> R + Sync,
) -> Vec<R> {
    let items: Vec<_> = items
        .into_iter()
        .map(|item| Mutex::new(Some(item)))
        .collect();
    let results = map_with(items.len(), |state, index| {
        let item = lock(&items[index]).take();
        item.map(|item| map(state, index, item))
    });
    results.into_iter().flatten().collect()
}

/// Returns `map(start, piece)` for every piece of 2¹⁴ values, in order.
///
/// The sum of the results has the same bits for any number of threads.
///
/// # Examples
///
/// ```
/// use tem00_numerics::parallel::map_pieces;
///
/// let values = vec![1.0_f32; 100_000];
/// let sums = map_pieces(&values, |_, piece| piece.iter().map(|&x| f64::from(x)).sum::<f64>());
/// assert_eq!(sums.len(), 7);
/// assert_eq!(sums.iter().sum::<f64>(), 100_000.0);
/// ```
pub fn map_pieces<T: Sync, R: Send>(
    values: &[T],
    map_piece: impl Fn(usize, &[T]) -> R + Sync,
) -> Vec<R> {
    map(values.len().div_ceil(PIECE), |index| {
        let start = index * PIECE;
        map_piece(start, &values[start..values.len().min(start + PIECE)])
    })
}

/// Calls `each(index, chunk)` for every chunk of `length` values; the last may be shorter.
///
/// # Panics
///
/// Panics if `length` is zero.
///
/// # Examples
///
/// ```
/// use tem00_numerics::parallel;
///
/// let mut values = [0; 5];
/// parallel::for_each_chunk(&mut values, 2, |index, chunk| chunk.fill(index));
/// assert_eq!(values, [0, 0, 1, 1, 2]);
/// ```
pub fn for_each_chunk<T: Send>(
    values: &mut [T],
    length: usize,
    each: impl Fn(usize, &mut [T]) + Sync,
) {
    let chunks: Vec<_> = values.chunks_mut(length).map(Mutex::new).collect();
    for_each(chunks.len(), &|index| {
        each(index, &mut lock(&chunks[index]));
    });
}

/// What is locked here is intact even if a thread has panicked.
pub(crate) fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    value.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use tem00_testkit::on_threads;

    use super::*;

    #[test]
    fn items_are_mapped_once_and_in_order() {
        for (threads, count) in [(1, 0), (1, 5), (3, 5), (3, 10_000)] {
            let items: Vec<usize> = (0..count).map(|item| 7 * item).collect();
            let mapped = on_threads(threads, || {
                map_items_with(items, |calls: &mut Vec<usize>, index, item| {
                    calls.push(index);
                    (calls.len(), item - 6 * index)
                })
            });
            assert!(
                mapped.iter().map(|&(_, value)| value).eq(0..count),
                "{threads}, {count}"
            );
            let states = mapped.iter().filter(|&&(calls, _)| calls == 1).count();
            assert!(states <= threads, "{states} states of {threads} threads");
        }
    }
}
