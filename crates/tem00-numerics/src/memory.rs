use std::fs;

/// Returns the bytes that the system can give without swapping, where it says so (Linux).
///
/// Many systems grant any memory that is asked for and end the program when it is used, so whoever is
/// about to use much asks first. A container may have less than its system.
pub fn available_memory() -> Option<u64> {
    available(&fs::read_to_string("/proc/meminfo").ok()?)
}

/// The bytes available by a Linux system's description of its memory.
fn available(described: &str) -> Option<u64> {
    let line = described
        .lines()
        .find_map(|line| line.strip_prefix("MemAvailable:"))?;
    let kibibytes = line.trim().strip_suffix("kB")?.trim_end();
    kibibytes.parse::<u64>().ok()?.checked_mul(1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_available_memory_is_read_where_it_is_told() {
        let described = "MemTotal:       24000000 kB\nMemAvailable:   20000001 kB\nBuffers: 5 kB\n";
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
}
