use core::{error, fmt, num::NonZero};
use std::{fs, thread};

/// Less memory is available than is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryError {
    /// Number of bytes needed.
    pub needed: u64,
    /// Number of bytes available.
    pub available: u64,
}

impl fmt::Display for MemoryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{} MiB of memory are needed, and {} MiB are available",
            self.needed.div_ceil(1 << 20),
            self.available >> 20
        )
    }
}

impl error::Error for MemoryError {}

/// Checks that `needed` bytes are available. Always passes where the system does not report its
/// memory (all systems but Linux).
///
/// # Errors
///
/// Returns an error if fewer bytes are available.
pub fn check_memory(needed: u64) -> Result<(), MemoryError> {
    check_against(needed, available_memory())
}

fn check_against(needed: u64, available: Option<u64>) -> Result<(), MemoryError> {
    match available {
        Some(available) if needed > available => Err(MemoryError { needed, available }),
        _ => Ok(()),
    }
}

/// Returns the number of bytes that the system can provide without swapping and that the limits of
/// the process (`ulimit -v`) allow; `None` where the system does not report it (all systems but
/// Linux).
///
/// Many systems grant any request for memory and end the program when it uses the memory, so a
/// caller should ask before a large allocation. A container may have less memory than its system.
pub fn available_memory() -> Option<u64> {
    let read = |path| fs::read_to_string(path).ok();
    let system = read("/proc/meminfo").and_then(|text| bytes_of(&text, "MemAvailable:"));
    let limit = read("/proc/self/limits").and_then(|text| address_space_limit(&text));
    let taken = || read("/proc/self/status").and_then(|text| bytes_of(&text, "VmSize:"));
    let threads = || thread::available_parallelism().map_or(1, NonZero::get) as u64 + 1;
    let process = limit.and_then(|limit| Some(left(limit, taken()?, threads())));
    [system, process].into_iter().flatten().min()
}

/// The number of bytes that a line of `text` states in kibibytes after `name`.
fn bytes_of(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kibibytes = line.trim().strip_suffix("kB")?.trim_end();
    kibibytes.parse::<u64>().ok()?.checked_mul(1024)
}

/// The size of the address space, in bytes, that a Linux system's description of limits allows a
/// process.
fn address_space_limit(limits: &str) -> Option<u64> {
    let mut lines = limits.lines();
    let line = lines.find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// The address space, in bytes, that the C library of Linux systems reserves for the small
/// allocations of a thread.
const ARENA: u64 = 64 << 20;

/// Memory, in bytes, reserved for allocations too small to be checked.
const SMALL: u64 = 16 << 20;

/// Memory, in bytes, that a limit leaves after the reservations of `threads`, of as many threads as
/// can reserve.
fn left(limit: u64, taken: u64, threads: u64) -> u64 {
    let free = limit.saturating_sub(taken);
    let shared = free - threads.min(free / ARENA) * ARENA;
    shared.saturating_sub(SMALL)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_available_memory_is_read_where_it_is_told() {
        let described = "MemTotal:       24000000 kB\nMemAvailable:   20000001 kB\nBuffers: 5 kB\n";
        let available = |text| bytes_of(text, "MemAvailable:");
        assert_eq!(available(described), Some(20_000_001 * 1024));
        for other in [
            "",
            "MemTotal: 5 kB",
            "MemAvailable: many kB",
            "MemAvailable: 5 MB",
            "MemAvailable: 18446744073709551615 kB",
        ] {
            assert_eq!(available(other), None, "{other}");
        }
    }

    #[test]
    fn a_limit_of_the_process_is_read_where_there_is_one() {
        let limits = |soft: &str| {
            format!(
                "Limit                     Soft Limit           Hard Limit           Units\n\
                 Max resident set          unlimited            unlimited            bytes\n\
                 Max address space         {soft}            unlimited            bytes\n"
            )
        };
        assert_eq!(address_space_limit(&limits("307200000")), Some(307_200_000));
        assert_eq!(address_space_limit(&limits("unlimited")), None);
        assert_eq!(address_space_limit(""), None);
        assert_eq!(left(400 << 20, 100 << 20, 3), 92 << 20);
        assert_eq!(left(200 << 20, 100 << 20, 3), 20 << 20);
        // A thread's possible reservation is subtracted, even where the small allocations need it.
        assert_eq!(left(170 << 20, 100 << 20, 3), 0);
        assert_eq!(left(163 << 20, 100 << 20, 3), 47 << 20);
        assert_eq!(left(800, 900, 3), 0);
    }

    #[test]
    fn more_than_what_is_available_is_refused() {
        assert!(check_against(5 << 20, Some(5 << 20)).is_ok(), "all of it");
        assert!(check_against(u64::MAX, None).is_ok(), "nothing is known");
        let error = check_against((5 << 20) + 1, Some(5 << 20));
        assert_eq!(
            error.map_err(|error| error.to_string()),
            Err("6 MiB of memory are needed, and 5 MiB are available".to_owned())
        );
    }
}
