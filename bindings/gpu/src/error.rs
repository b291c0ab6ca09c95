use core::{error::Error, fmt};

use tem00_speckle::{PupilField, SpeckleError};

/// Error of a graphics card.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter to compute with; the text is that of the search.
    NoAdapter(String),
    /// The adapter gave no device.
    NoDevice(String),
    /// The device refused an order, or was lost on the way.
    Device(String),
    /// A side of a pattern has a prime factor above 5: its samples.
    Size(usize),
    /// The device has no buffer that holds something.
    TooLarge {
        /// Content of the buffer.
        what: &'static str,
        /// Its bytes.
        needed: u64,
        /// The bytes of the largest buffer that a kernel reads.
        allowed: u64,
    },
    /// The path or the memory limit of a stack.
    Speckle(SpeckleError),
}

impl fmt::Display for GpuError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoAdapter(reason) => write!(
                f,
                "no graphics adapter: {reason}; without a card a software adapter will do, \
                 on Debian that of the package mesa-vulkan-drivers"
            ),
            Self::NoDevice(reason) => write!(f, "the graphics adapter gives no device: {reason}"),
            Self::Device(reason) => write!(f, "the graphics device failed: {reason}"),
            Self::Size(side) => write!(
                f,
                "size must have no prime factor above 5 on a graphics card and be at most {}, got \
                 {side}: {} is the next",
                PupilField::MAX_SIZE,
                next_size(*side),
            ),
            Self::TooLarge {
                what,
                needed,
                allowed,
            } => write!(
                f,
                "a buffer of the graphics device must be at most {allowed} bytes, got {needed} for \
                 {what}: take fewer slices or a smaller pattern"
            ),
            Self::Speckle(error) => error.fmt(f),
        }
    }
}

impl Error for GpuError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Speckle(error) => Some(error),
            _ => None,
        }
    }
}

impl From<SpeckleError> for GpuError {
    fn from(error: SpeckleError) -> Self {
        Self::Speckle(error)
    }
}

/// The next side that is transformed.
fn next_size(side: usize) -> usize {
    let allowed = |&side: &usize| {
        [2, 3, 5].into_iter().fold(side, |mut rest, prime| {
            while rest > 1 && rest.is_multiple_of(prime) {
                rest /= prime;
            }
            rest
        }) == 1
    };
    (side.max(1)..=PupilField::MAX_SIZE)
        .find(allowed)
        .unwrap_or(PupilField::MAX_SIZE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refusals_say_what_would_do() {
        let limit = GpuError::TooLarge {
            what: "the stack",
            needed: 9,
            allowed: 8,
        };
        for (error, parts) in [
            (
                GpuError::NoAdapter("none".into()),
                ["none", "mesa-vulkan-drivers"],
            ),
            (GpuError::Size(2047), ["got 2047", "2048 is the next"]),
            (
                GpuError::Size(32_769),
                ["at most 32768", "32768 is the next"],
            ),
            (limit, ["at most 8 bytes", "got 9 for the stack"]),
        ] {
            let text = error.to_string();
            assert!(parts.iter().all(|part| text.contains(part)), "{text}");
        }
    }
}
