//! Work on the pieces of an array, by all threads where the feature `parallel` allows it.

/// Calls `each(state, index, chunk)` for every piece of `chunk` values; the last may be shorter.
///
/// Pieces never depend on each other. `state` is scratch memory, made once per thread. Unless
/// `threads`, the calling thread does it all.
pub(super) fn for_each_chunk<T: Send, S>(
    threads: bool,
    values: &mut [T],
    chunk: usize,
    state: impl Fn() -> S + Sync + Send,
    each: impl Fn(&mut S, usize, &mut [T]) + Sync + Send,
) {
    #[cfg(feature = "parallel")]
    if threads {
        use rayon::prelude::*;
        values
            .par_chunks_mut(chunk)
            .enumerate()
            .for_each_init(state, |state, (index, chunk)| each(state, index, chunk));
        return;
    }
    #[cfg(not(feature = "parallel"))]
    let _ = threads;
    let mut state = state();
    for (index, chunk) in values.chunks_mut(chunk).enumerate() {
        each(&mut state, index, chunk);
    }
}
