//! The threads that work for a call from C.

use rayon::ThreadPoolBuilder;

use crate::status::{Failure, Status};

/// The largest number of threads that may be asked for.
const MAX_THREADS: u32 = 1024;

/// Runs `work` on so many threads of its own, or on all cores of the machine for 0.
pub(crate) fn on_threads<T: Send>(
    threads: u32,
    work: impl FnOnce() -> T + Send,
) -> Result<T, Failure> {
    if threads == 0 {
        return Ok(work());
    }
    if threads > MAX_THREADS {
        let message = format!("threads must be 0 to {MAX_THREADS}, got {threads}");
        return Err(Failure::argument("threads", message));
    }
    let pool = ThreadPoolBuilder::new()
        .num_threads(threads as usize)
        .build()
        .map_err(|error| {
            let message = format!("threads: {threads} of them cannot be had: {error}");
            Failure::new(Status::Memory, "threads", message)
        })?;
    Ok(pool.install(work))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_has_as_many_threads_as_were_asked_for() {
        for threads in [1, 3, 8] {
            let found = on_threads(threads, rayon::current_num_threads);
            assert_eq!(found, Ok(threads as usize), "{threads}");
        }
        let all = on_threads(0, rayon::current_num_threads);
        assert_eq!(all, Ok(rayon::current_num_threads()), "all cores");
    }

    #[test]
    fn more_threads_than_the_limit_are_refused() {
        let refused = on_threads(MAX_THREADS + 1, || ()).unwrap_err();
        assert_eq!(refused.parameter, "threads", "{}", refused.message);
        assert_eq!(refused.message, "threads must be 0 to 1024, got 1025");
    }
}
