use core::{error::Error, fmt};

/// What a graphics card did not do.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum GpuError {
    /// There is no adapter to compute with; the text is that of the search.
    NoAdapter(String),
    /// The adapter gave no device.
    NoDevice(String),
    /// The device refused an order, or was lost on the way.
    Device(String),
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
        }
    }
}

impl Error for GpuError {}
