//! Numbers in a row, little-endian.

use num_complex::Complex;

use super::StackFileError;

/// Writes numbers one after the other.
#[derive(Debug, Default)]
pub(super) struct Writer {
    pub(super) bytes: Vec<u8>,
}

impl Writer {
    pub(super) fn u32(&mut self, value: u32) -> &mut Self {
        self.bytes.extend(value.to_le_bytes());
        self
    }

    pub(super) fn u64(&mut self, value: u64) -> &mut Self {
        self.bytes.extend(value.to_le_bytes());
        self
    }

    pub(super) fn i64(&mut self, value: i64) -> &mut Self {
        self.bytes.extend(value.to_le_bytes());
        self
    }

    pub(super) fn f64(&mut self, value: f64) -> &mut Self {
        self.u64(value.to_bits())
    }

    pub(super) fn f32(&mut self, value: f32) -> &mut Self {
        self.u32(value.to_bits())
    }

    pub(super) fn complex(&mut self, values: &[Complex<f32>]) -> &mut Self {
        self.bytes.extend(values.iter().flat_map(to_bytes));
        self
    }
}

/// Reads numbers one after the other.
#[derive(Clone, Debug)]
pub(super) struct Reader<'a> {
    rest: &'a [u8],
}

impl<'a> Reader<'a> {
    pub(super) const fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], StackFileError> {
        let (first, rest) = self
            .rest
            .split_first_chunk()
            .ok_or(StackFileError::Truncated)?;
        self.rest = rest;
        Ok(*first)
    }

    pub(super) fn u32(&mut self) -> Result<u32, StackFileError> {
        self.take().map(u32::from_le_bytes)
    }

    pub(super) fn u64(&mut self) -> Result<u64, StackFileError> {
        self.take().map(u64::from_le_bytes)
    }

    pub(super) fn i64(&mut self) -> Result<i64, StackFileError> {
        self.take().map(i64::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Result<f64, StackFileError> {
        self.take().map(f64::from_le_bytes)
    }

    pub(super) fn complex(&mut self, count: usize) -> Result<Vec<Complex<f32>>, StackFileError> {
        (0..count).map(|_| self.take().map(from_bytes)).collect()
    }

    /// Leaves out `count` bytes.
    pub(super) fn skip(&mut self, count: usize) -> Result<(), StackFileError> {
        self.rest = self.rest.get(count..).ok_or(StackFileError::Truncated)?;
        Ok(())
    }
}

/// Real part first, each little-endian.
pub(super) fn to_bytes(z: &Complex<f32>) -> [u8; 8] {
    word(z).to_le_bytes()
}

pub(super) fn word(z: &Complex<f32>) -> u64 {
    u64::from(z.re.to_bits()) | u64::from(z.im.to_bits()) << 32
}

pub(super) fn from_bytes(bytes: [u8; 8]) -> Complex<f32> {
    let [a, b, c, d, e, f, g, h] = bytes;
    Complex::new(
        f32::from_le_bytes([a, b, c, d]),
        f32::from_le_bytes([e, f, g, h]),
    )
}
