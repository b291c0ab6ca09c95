//! The values of a NumPy file, there and back.

use num_complex::Complex;

/// A value that files hold and grids keep.
pub(super) trait Element: Copy {
    /// The type as a file names it that is written.
    const WRITTEN: &'static str;
    /// The types that are read, in words.
    const READABLE: &'static str;

    /// The bytes of one value of that type, and the value that they stand for.
    fn decoder(element_type: ElementType) -> Option<(usize, impl Fn(&[u8]) -> Self)>;

    fn encode(&self, bytes: &mut Vec<u8>);
}

/// A type that is understood, and whether its bytes begin with the highest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ElementType {
    /// One number.
    Real(Number, bool),
    /// Two numbers, the real part first.
    Complex(Number, bool),
}

/// Number types of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    /// `float16`.
    Half,
    /// `float32`.
    Single,
    /// `float64`.
    Double,
    /// `uint8` to `uint64`, and `bool`, of so many bytes.
    Unsigned(usize),
    /// `int8` to `int64`, of so many bytes.
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
        let real = |number| Some(Self::Real(number, highest_first));
        match kind {
            "f2" => real(Number::Half),
            "f4" => real(Number::Single),
            "f8" => real(Number::Double),
            "b1" | "u1" => real(Number::Unsigned(1)),
            "u2" => real(Number::Unsigned(2)),
            "u4" => real(Number::Unsigned(4)),
            "u8" => real(Number::Unsigned(8)),
            "i1" => real(Number::Signed(1)),
            "i2" => real(Number::Signed(2)),
            "i4" => real(Number::Signed(4)),
            "i8" => real(Number::Signed(8)),
            "c8" => Some(Self::Complex(Number::Single, highest_first)),
            "c16" => Some(Self::Complex(Number::Double, highest_first)),
            _ => None,
        }
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

    /// The number that `bytes` stand for, which are as many as it takes.
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

/// Returns the number that the bits of a `float16` stand for: IEEE 754 binary16, whose exponent has 5 bits and the
/// bias 15, its fraction 10 bits.
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

    fn decoder(element_type: ElementType) -> Option<(usize, impl Fn(&[u8]) -> Self)> {
        let ElementType::Real(number, highest_first) = element_type else {
            return None;
        };
        let decode = move |bytes: &[u8]| number.value(bytes, highest_first);
        Some((number.bytes(), decode))
    }

    fn encode(&self, bytes: &mut Vec<u8>) {
        bytes.extend(self.to_le_bytes());
    }
}

impl Element for Complex<f32> {
    const WRITTEN: &'static str = "<c8";
    const READABLE: &'static str = "complex64 or complex128";

    fn decoder(element_type: ElementType) -> Option<(usize, impl Fn(&[u8]) -> Self)> {
        let ElementType::Complex(number, highest_first) = element_type else {
            return None;
        };
        let decode = move |bytes: &[u8]| {
            let (re, im) = bytes.split_at(number.bytes());
            Self::new(
                number.value(re, highest_first),
                number.value(im, highest_first),
            )
        };
        Some((2 * number.bytes(), decode))
    }

    fn encode(&self, bytes: &mut Vec<u8>) {
        self.re.encode(bytes);
        self.im.encode(bytes);
    }
}
