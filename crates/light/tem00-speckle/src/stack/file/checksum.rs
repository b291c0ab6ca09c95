//! A checksum over words of 64 bits.

/// The state after some words.
///
/// Each step maps one to one, the state and the word alike: a change within one word always changes
/// the result, and others go unnoticed once in 2⁶⁴.
#[derive(Clone, Copy, Debug)]
pub(super) struct Checksum(u64);

/// 2⁶⁴ over the golden ratio, odd.
const FACTOR: u64 = 0x9E37_79B9_7F4A_7C15;

impl Default for Checksum {
    fn default() -> Self {
        Self(FACTOR)
    }
}

impl Checksum {
    #[inline]
    pub(super) const fn add(&mut self, word: u64) {
        self.0 = (self.0 ^ word).wrapping_mul(FACTOR).rotate_left(29);
    }

    /// Adds bytes, eight to a word; the last word is filled up with zeros.
    pub(super) fn add_bytes(&mut self, bytes: &[u8]) {
        let (words, rest) = bytes.as_chunks();
        for word in words {
            self.add(u64::from_le_bytes(*word));
        }
        if !rest.is_empty() {
            let mut last = [0; 8];
            last[..rest.len()].copy_from_slice(rest);
            self.add(u64::from_le_bytes(last));
        }
    }

    pub(super) const fn value(self) -> u64 {
        self.0
    }
}
