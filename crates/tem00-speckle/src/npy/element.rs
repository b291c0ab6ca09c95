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
    /// `float32`.
    Single,
    /// `float64`.
    Double,
    /// `uint8`.
    Byte,
    /// `uint16`.
    Word,
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
        match kind {
            "f4" => Some(Self::Real(Number::Single, highest_first)),
            "f8" => Some(Self::Real(Number::Double, highest_first)),
            "u1" => Some(Self::Real(Number::Byte, highest_first)),
            "u2" => Some(Self::Real(Number::Word, highest_first)),
            "c8" => Some(Self::Complex(Number::Single, highest_first)),
            "c16" => Some(Self::Complex(Number::Double, highest_first)),
            _ => None,
        }
    }
}

impl Number {
    const fn bytes(self) -> usize {
        match self {
            Self::Byte => 1,
            Self::Word => 2,
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
            Self::Byte | Self::Word => bits as u16 as f32,
            Self::Single => f32::from_bits(bits as u32),
            Self::Double => f64::from_bits(bits) as f32,
        }
    }
}

impl Element for f32 {
    const WRITTEN: &'static str = "<f4";
    const READABLE: &'static str = "float32, float64, uint8 or uint16";

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
