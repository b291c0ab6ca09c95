//! The values of a NumPy file, read and written.

use num_complex::Complex;

/// A value of one or two numbers that files hold and grids keep.
pub(super) trait Element: Copy {
    /// The type as a written file names it.
    const WRITTEN: &'static str;
    /// The types that are read, in words.
    const READABLE: &'static str;
    /// The numbers of a value.
    const NUMBERS: usize;

    /// Returns the value of some numbers.
    fn of(number: impl Fn(usize) -> f32) -> Self;

    fn encode(&self, bytes: &mut Vec<u8>);
}

/// A type that is understood.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ElementType {
    number: Number,
    /// The numbers of a value, the real part first.
    pub(super) numbers: usize,
    /// Whether numbers are big-endian.
    highest_first: bool,
}

/// Number types of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    /// `float16`.
    Half,
    /// `float32`.
    Single,
    /// `float64`.
    Double,
    /// `uint8` to `uint64`, and `bool`, with the number of bytes.
    Unsigned(usize),
    /// `int8` to `int64`, with the number of bytes.
    Signed(usize),
}

impl ElementType {
    /// Understands a name such as `<c8`.
    pub(super) fn from_name(name: &str) -> Option<Self> {
        let (order, kind) = name.split_at_checked(1)?;
        let highest_first = match order {
            "<" | "|" => false,
            ">" => true,
            _ => return None,
        };
        let number = match kind {
            "f2" => Number::Half,
            "f4" | "c8" => Number::Single,
            "f8" | "c16" => Number::Double,
            "b1" | "u1" => Number::Unsigned(1),
            "u2" => Number::Unsigned(2),
            "u4" => Number::Unsigned(4),
            "u8" => Number::Unsigned(8),
            "i1" => Number::Signed(1),
            "i2" => Number::Signed(2),
            "i4" => Number::Signed(4),
            "i8" => Number::Signed(8),
            _ => return None,
        };
        Some(Self {
            number,
            numbers: if kind.starts_with('c') { 2 } else { 1 },
            highest_first,
        })
    }

    /// Returns the bytes of a value.
    pub(super) const fn bytes(self) -> usize {
        self.numbers * self.number.bytes()
    }

    /// Returns the value of its bytes.
    pub(super) fn decode<T: Element>(self, bytes: &[u8]) -> T {
        let each = self.number.bytes();
        T::of(|index| {
            self.number
                .value(&bytes[index * each..][..each], self.highest_first)
        })
    }
}

impl Number {
    const fn bytes(self) -> usize {
        match self {
            Self::Unsigned(bytes) | Self::Signed(bytes) => bytes,
            Self::Half => 2,
            Self::Single => 4,
            Self::Double => 8,
        }
    }

    /// Returns the number that `bytes` stand for; their count fits the type.
    #[expect(clippy::cast_possible_truncation, reason = "grids keep f32")]
    fn value(self, bytes: &[u8], highest_first: bool) -> f32 {
        let mut word = [0; 8];
        let bytes_read = &mut word[..bytes.len().min(8)];
        bytes_read.copy_from_slice(&bytes[..bytes_read.len()]);
        if highest_first {
            bytes_read.reverse();
        }
        let bits = u64::from_le_bytes(word);
        match self {
            Self::Unsigned(_) => bits as f32,
            Self::Signed(bytes) => {
                let unused = 64 - 8 * bytes;
                ((bits << unused).cast_signed() >> unused) as f32
            }
            Self::Half => half(bits as u16),
            Self::Single => f32::from_bits(bits as u32),
            Self::Double => f64::from_bits(bits) as f32,
        }
    }
}

/// Returns the number that the bits of a `float16` stand for: IEEE 754 binary16, whose exponent has
/// 5 bits and the bias 15, its fraction 10 bits.
fn half(bits: u16) -> f32 {
    let [exponent, fraction] = [(bits >> 10) & 31, bits & 1023].map(u32::from);
    let magnitude = match exponent {
        0 => fraction as f32 / 16_777_216.0,
        31 => f32::from_bits(0xff << 23 | fraction << 13),
        _ => f32::from_bits((exponent + 112) << 23 | fraction << 13),
    };
    if bits >> 15 == 1 {
        -magnitude
    } else {
        magnitude
    }
}

impl Element for f32 {
    const WRITTEN: &'static str = "<f4";
    const READABLE: &'static str = "float16, float32, float64, bool, or integers of 8 to 64 bits";
    const NUMBERS: usize = 1;

    fn of(number: impl Fn(usize) -> Self) -> Self {
        number(0)
    }

    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for Complex<f32> {
    const WRITTEN: &'static str = "<c8";
    const READABLE: &'static str = "complex64 or complex128";
    const NUMBERS: usize = 2;

    fn of(number: impl Fn(usize) -> f32) -> Self {
        Self::new(number(0), number(1))
    }

    fn encode(&self, bytes: &mut Vec<u8>) {
        self.re.encode(bytes);
        self.im.encode(bytes);
    }
}
