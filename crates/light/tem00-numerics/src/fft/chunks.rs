//! Work on the pieces of an array, by all threads with the feature `parallel`.

#[cfg(feature = "parallel")]
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Calls `each(state, index, chunk)` for every piece of `chunk` values; the last may be shorter.
///
/// Pieces are independent of each other. Each piece takes a state from `states`, or a new one, and
/// returns it afterwards for the next piece. Unless `threads` is set, the calling thread does all
/// the work.
pub(super) fn for_each_chunk<T: Send, S: Default + Send>(
    threads: bool,
    values: &mut [T],
    chunk: usize,
    states: &mut Vec<S>,
    each: impl Fn(&mut S, usize, &mut [T]) + Sync,
) {
    #[cfg(feature = "parallel")]
    if threads {
        use rayon::prelude::*;
        let states = Mutex::new(states);
        let chunks = values.par_chunks_mut(chunk).enumerate();
        chunks.for_each(|(index, chunk)| {
            let mut state = lock(&states).pop().unwrap_or_default();
            each(&mut state, index, chunk);
            lock(&states).push(state);
        });
        return;
    }
    #[cfg(not(feature = "parallel"))]
    let _ = threads;
    let mut state = states.pop().unwrap_or_default();
    for (index, chunk) in values.chunks_mut(chunk).enumerate() {
        each(&mut state, index, chunk);
    }
    states.push(state);
}

/// The number of threads that [`for_each_chunk`] works with.
pub(super) fn thread_count(threads: bool) -> usize {
    #[cfg(feature = "parallel")]
    if threads {
        return rayon::current_num_threads();
    }
    #[cfg(not(feature = "parallel"))]
    let _ = threads;
    1
}

/// The list of states is intact between two calls even if a thread has panicked.
#[cfg(feature = "parallel")]
fn lock<T>(states: &Mutex<T>) -> MutexGuard<'_, T> {
    states.lock().unwrap_or_else(PoisonError::into_inner)
}
