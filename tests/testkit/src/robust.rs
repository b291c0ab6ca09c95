use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

use crate::Numbers;

/// Places in a file that are changed, spread evenly.
const PLACES: usize = 400;

/// Asserts that no bytes make a reader panic: good files cut short, with bytes changed, removed
/// and inserted, and noise.
///
/// The reader returns what it likes, an error as a rule.
pub fn robust<T>(read: impl Fn(&[u8]) -> T, seeds: &[&[u8]]) {
    let attempt = |change: &str, bytes: &[u8]| {
        if let Err(panic) = catch_unwind(AssertUnwindSafe(|| drop(read(bytes)))) {
            complain(change, bytes);
            resume_unwind(panic);
        }
    };
    let mut numbers = Numbers::new(1);
    for seed in seeds {
        attempt("as it is", seed);
        for at in (0..seed.len()).step_by(seed.len().div_ceil(PLACES).max(1)) {
            attempt("cut short", &seed[..at]);
            let mut changed = seed.to_vec();
            for byte in [0, 0xff, seed[at] ^ 1, seed[at] ^ 0x80, b'9'] {
                changed[at] = byte;
                attempt("one byte changed", &changed);
            }
            changed.truncate(at);
            changed.extend(noise(&mut numbers, 8));
            changed.extend(seed.iter().skip(at + 4));
            attempt("bytes inserted", &changed);
        }
    }
    for length in 0..PLACES {
        attempt("noise", &noise(&mut numbers, length));
    }
}

#[expect(clippy::print_stderr, reason = "shown if the test fails")]
fn complain(change: &str, bytes: &[u8]) {
    let start = &bytes[..bytes.len().min(200)];
    eprintln!(
        "the reader panics, {change}, {} bytes: {}",
        bytes.len(),
        start.escape_ascii()
    );
}

fn noise(numbers: &mut Numbers, length: usize) -> Vec<u8> {
    (0..length).map(|_| numbers.bits() as u8).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A length, and as many bytes.
    fn careful(bytes: &[u8]) -> Option<&[u8]> {
        let (length, rest) = bytes.split_first()?;
        rest.get(..usize::from(*length))
    }

    #[test]
    fn careful_readers_pass() {
        robust(
            |bytes| careful(bytes).map(<[u8]>::len),
            &[&[], &[3, 1, 2, 3]],
        );
    }

    #[test]
    #[should_panic(expected = "range end index")]
    fn readers_that_trust_a_length_fail() {
        robust(
            |bytes| {
                bytes
                    .split_first()
                    .map(|(n, rest)| rest[..usize::from(*n)].len())
            },
            &[&[1, 5]],
        );
    }
}
