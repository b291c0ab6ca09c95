use core::{error, fmt};

use crate::{CoherentBackground, Exposure, IncoherentSum, PixelArray, PupilField};

/// Why a pupil field or a stack could not be constructed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SpeckleError {
    /// A side of the pattern, in samples, is above [`PupilField::MAX_SIZE`].
    Size(usize),
    /// The speckle size, in samples, is below 2 or leaves the pupil less than
    /// [`PupilField::MIN_DIAMETER`] lattice points.
    SpeckleSize {
        /// The rejected speckle size, in samples.
        speckle_size: f64,
        /// The largest speckle size of a pattern of that size, in samples.
        largest: f64,
    },
    /// The pupil diameter, in lattice points, is below [`PupilField::MIN_DIAMETER`] or above half
    /// the pattern size.
    Diameter {
        /// The rejected diameter, in lattice points.
        diameter: usize,
        /// The pattern size, in samples.
        size: usize,
    },
    /// The inner diameter of an annulus, in units of the outer one, is not inside (0, 1).
    InnerDiameter(f64),
    /// The height of a rectangle, in units of its width, is not inside (0, 1].
    Height(f64),
    /// The radius of a Gaussian pupil, in units of its diameter, is not a positive finite number.
    GaussianRadius(f64),
    /// An amplitude transmission is not inside [0, 1].
    Transmission(f32),
    /// A sample of a field from outside is not finite.
    Sample {
        /// The column of the sample.
        x: usize,
        /// The row of the sample.
        y: usize,
    },
    /// The pupil holds fewer phasors, or as many of unlike weight, than
    /// [`PupilField::MIN_PHASORS`] of equal weight.
    PhasorCount(usize),
    /// Half the number of slices is zero or above [`SlicePath::MAX_HALF_PERIOD`].
    ///
    /// [`SlicePath::MAX_HALF_PERIOD`]: crate::SlicePath::MAX_HALF_PERIOD
    HalfPeriod(usize),
    /// The length of a straight path, in pupil diameters, is below 2 or above
    /// [`SlicePath::MAX_LENGTH`].
    ///
    /// [`SlicePath::MAX_LENGTH`]: crate::SlicePath::MAX_LENGTH
    PathLength(usize),
    /// A stack takes more memory than [`StackOptions::memory_limit`] allows.
    ///
    /// [`StackOptions::memory_limit`]: crate::StackOptions::memory_limit
    MemoryLimit {
        /// The bytes that the stack takes.
        needed: u64,
        /// The bytes that it may take.
        limit: u64,
    },
    /// The machine refused the memory of a stack.
    ///
    /// On Linux so is what exceeds the memory that the system has available.
    Memory {
        /// The bytes that were asked for.
        bytes: u64,
    },
    /// A side of the image for which a stack is planned, in pixels, is not a positive finite number.
    Image(f64),
    /// A side of the region in which a stack is looked up, in pixels, is not a positive finite number.
    Region(f64),
    /// The speckle size on the sensor, in pixels, is not a positive finite number.
    SpeckleSizeInPixels(f64),
    /// The largest motion of the pupil, in its diameters, is negative or not finite.
    Motion(f64),
    /// The number of patterns in a sum is zero or above [`IncoherentSum::MAX_PATTERNS`].
    PatternCount(usize),
    /// A weight of a sum is negative or not finite.
    Weight {
        /// Which of the weights it is.
        index: usize,
        /// The rejected weight.
        weight: f64,
    },
    /// Independent patterns were asked of a field without a seed, made of samples.
    NoSeed,
    /// The degree of polarisation is not inside [0, 1].
    Polarisation(f64),
    /// The wavelength, in metres, is not a positive finite number.
    Wavelength(f64),
    /// The linewidth is negative or broader than a tenth of the wavelength.
    Linewidth {
        /// The rejected linewidth, in metres.
        linewidth: f64,
        /// The largest linewidth at that wavelength, in metres.
        maximum: f64,
    },
    /// The standard deviation of the optical path, in metres, is negative or not finite.
    PathSpread(f64),
    /// The beam ratio of a coherent background is not inside
    /// [0, [`CoherentBackground::MAX_BEAM_RATIO`]].
    BeamRatio(f64),
    /// The phase of a coherent background, in radians, is not finite.
    Phase(f64),
    /// The drift over the sensor, in speckle sizes, exceeds [`Exposure::MAX_IMAGE_DRIFT`].
    ImageDrift(f64),
    /// The drift over the pupil, in its diameters, exceeds [`Exposure::MAX_PUPIL_DRIFT`].
    PupilDrift(f64),
    /// The number of pixels along an axis is zero or above [`PixelArray::MAX_COUNT`].
    PixelCount(usize),
    /// The pixel pitch, in samples, is not positive, or all pixels together exceed
    /// [`PixelArray::MAX_LENGTH`].
    PixelPitch(f64),
    /// The pixel size, in samples, is not inside [0, [`PixelArray::MAX_LENGTH`]].
    PixelSize(f64),
    /// The place of the first pixel, in samples, exceeds [`PixelArray::MAX_LENGTH`].
    PixelOrigin(f64),
    /// The number of scatterers is zero or exceeds the number of lattice points in the pupil.
    ScattererCount {
        /// The rejected number.
        count: usize,
        /// The number of lattice points in the pupil.
        largest: usize,
    },
    /// The distance of the screen, in metres, is not a positive finite number.
    Distance(f64),
    /// A length of the lit area, in metres, is not a positive finite number.
    LitSize(f64),
    /// The pitch of the samples on the screen, in metres, is not a positive finite number.
    SamplePitch(f64),
}

impl SpeckleError {
    /// Returns the name of the argument that was refused, as the function that refused it calls it.
    ///
    /// A variant may belong to arguments of several functions: a diameter that is too small can
    /// follow from a [speckle size](Self::SpeckleSize) that is too large. The name is then that of the
    /// argument which the variant is about. [`Memory`](Self::Memory) is about none: its name is "memory".
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{Pupil, PupilField};
    ///
    /// let field = PupilField::new(64, 16, 1)?;
    /// let error = field.with_pupil(Pupil::Annulus { inner: 1.5 }).unwrap_err();
    /// assert_eq!(error.parameter(), "inner");
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub const fn parameter(&self) -> &'static str {
        match self {
            Self::Size(..) | Self::PixelSize(..) => "size",
            Self::SpeckleSize { .. } | Self::SpeckleSizeInPixels(..) => "speckle_size",
            Self::Diameter { .. } => "diameter",
            Self::InnerDiameter(..) => "inner",
            Self::Height(..) => "height",
            Self::GaussianRadius(..) => "radius",
            Self::Transmission(..) => "amplitude",
            Self::Sample { .. } => "samples",
            Self::PhasorCount(..) => "pupil",
            Self::HalfPeriod(..) => "half_period",
            Self::PathLength(..) => "length",
            Self::MemoryLimit { .. } => "memory_limit",
            Self::Memory { .. } => "memory",
            Self::Image(..) => "image",
            Self::Region(..) => "region",
            Self::Motion(..) => "motion",
            Self::PatternCount(..) | Self::PixelCount(..) | Self::ScattererCount { .. } => "count",
            Self::Weight { .. } => "weights",
            Self::NoSeed => "field",
            Self::Polarisation(..) => "degree",
            Self::Wavelength(..) => "wavelength",
            Self::Linewidth { .. } => "linewidth",
            Self::PathSpread(..) => "path_spread",
            Self::BeamRatio(..) => "beam_ratio",
            Self::Phase(..) => "phase",
            Self::ImageDrift(..) | Self::PupilDrift(..) => "drift",
            Self::PixelPitch(..) => "pitch",
            Self::PixelOrigin(..) => "origin",
            Self::Distance(..) => "distance",
            Self::LitSize(..) => "area",
            Self::SamplePitch(..) => "sample_pitch",
        }
    }
}

impl fmt::Display for SpeckleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size(got) => write!(
                f,
                "size must be at most {} samples, got {got}",
                PupilField::MAX_SIZE
            ),
            Self::SpeckleSize {
                speckle_size,
                largest,
            } => write!(
                f,
                "speckle size must be 2 to {largest} samples in a pattern of that size, got \
                 {speckle_size}"
            ),
            Self::Diameter { diameter, size } => write!(
                f,
                "diameter must be at least {} and at most half the size, {} of {size} samples, \
                 got {diameter}",
                PupilField::MIN_DIAMETER,
                size / 2
            ),
            Self::InnerDiameter(got) => write!(
                f,
                "inner diameter must lie between 0 and 1 of the outer diameter, got {got}"
            ),
            Self::Height(got) => write!(
                f,
                "height must be positive and at most 1 of the width, got {got}"
            ),
            Self::GaussianRadius(got) => write!(
                f,
                "Gaussian radius must be positive and finite, in units of the diameter, got {got}"
            ),
            Self::Transmission(got) => {
                write!(f, "transmission must lie between 0 and 1, got {got}")
            }
            Self::Sample { x, y } => {
                write!(
                    f,
                    "samples must be finite, got another at column {x} of row {y}"
                )
            }
            Self::PhasorCount(got) => write!(
                f,
                "phasor count must be at least {}, got {got}: enlarge the diameter or open the \
                 pupil",
                PupilField::MIN_PHASORS
            ),
            Self::HalfPeriod(got) => write!(
                f,
                "half period must be 1 to {} slices, got {got}",
                crate::SlicePath::MAX_HALF_PERIOD
            ),
            Self::PathLength(got) => write!(
                f,
                "path length must be 2 to {} pupil diameters, got {got}",
                crate::SlicePath::MAX_LENGTH
            ),
            Self::MemoryLimit { needed, limit } => write!(
                f,
                "memory for the stack must be at most {limit} bytes, got {needed}: take fewer \
                 slices or a smaller pattern"
            ),
            Self::Memory { bytes } => write!(
                f,
                "memory for the stack refused: {bytes} bytes are more than the machine has to give"
            ),
            Self::Image(side) => write!(
                f,
                "a side of the image must be a positive finite number of pixels, got {side}"
            ),
            Self::Region(side) => write!(
                f,
                "a side of the region must be a positive finite number of pixels, got {side}"
            ),
            Self::SpeckleSizeInPixels(speckle_size) => write!(
                f,
                "speckle size must be a positive finite number of pixels, got {speckle_size}"
            ),
            Self::Motion(motion) => write!(
                f,
                "motion must be a finite number of pupil diameters, at least 0, got {motion}"
            ),
            Self::PatternCount(got) => write!(
                f,
                "pattern count must be 1 to {}, got {got}",
                IncoherentSum::MAX_PATTERNS
            ),
            Self::Weight { index, weight } => write!(
                f,
                "weights must be finite and not negative, got {weight} at index {index}"
            ),
            Self::NoSeed => write!(
                f,
                "field must have a seed for independent patterns, got one of samples"
            ),
            Self::Polarisation(got) => write!(
                f,
                "degree of polarisation must lie between 0 and 1, got {got}"
            ),
            Self::Wavelength(got) => write_length(f, "wavelength", *got),
            Self::Linewidth { linewidth, maximum } => {
                write!(
                    f,
                    "linewidth must be 0 to {maximum:e} m, got {linewidth:e} m"
                )
            }
            Self::PathSpread(got) => {
                write!(
                    f,
                    "path spread must be finite and not negative, got {got:e} m"
                )
            }
            Self::BeamRatio(got) => write!(
                f,
                "beam ratio must be 0 to {:e}, got {got}",
                CoherentBackground::MAX_BEAM_RATIO
            ),
            Self::Phase(got) => write!(f, "phase must be finite, got {got} rad"),
            Self::ImageDrift(got) => write!(
                f,
                "image drift must be within ±{:e} speckle sizes, got {got}",
                Exposure::MAX_IMAGE_DRIFT
            ),
            Self::PupilDrift(got) => write!(
                f,
                "pupil drift must be within ±{} diameters, got {got}",
                Exposure::MAX_PUPIL_DRIFT
            ),
            Self::PixelCount(got) => write!(
                f,
                "pixel count must be 1 to {}, got {got}",
                PixelArray::MAX_COUNT
            ),
            Self::PixelPitch(got) => write!(
                f,
                "pixel pitch must be positive, all pixels together at most {:e} samples, got {got}",
                PixelArray::MAX_LENGTH
            ),
            Self::PixelSize(got) => write!(
                f,
                "pixel size must be 0 to {:e} samples, got {got}",
                PixelArray::MAX_LENGTH
            ),
            Self::PixelOrigin(got) => write!(
                f,
                "pixel origin must be within ±{:e} samples, got {got}",
                PixelArray::MAX_LENGTH
            ),
            Self::ScattererCount { count, largest } => {
                write!(f, "scatterer count must be 1 to {largest}, got {count}")
            }
            Self::Distance(got) => write_length(f, "distance", *got),
            Self::LitSize(got) => write_length(f, "length of the lit area", *got),
            Self::SamplePitch(got) => write_length(f, "sample pitch", *got),
        }
    }
}

fn write_length(f: &mut fmt::Formatter<'_>, name: &str, got: f64) -> fmt::Result {
    write!(f, "{name} must be positive and finite, got {got:e} m")
}

impl error::Error for SpeckleError {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{LitArea, ObjectiveSpeckle, Pupil, SlicePath};

    #[test]
    fn messages_name_the_parameter_the_value_and_what_is_allowed() {
        let linewidth = SpeckleError::Linewidth {
            linewidth: 2e-7,
            maximum: 6.5e-8,
        };
        let scatterers = SpeckleError::ScattererCount {
            count: 0,
            largest: 49,
        };
        let weight = SpeckleError::Weight {
            index: 3,
            weight: -1.5,
        };
        for (error, parts) in [
            (
                SpeckleError::PatternCount(0),
                ["pattern count", "1024", "0"],
            ),
            (weight, ["weights", "not negative", "-1.5 at index 3"]),
            (SpeckleError::NoSeed, ["seed", "independent", "samples"]),
            (
                SpeckleError::Polarisation(1.5),
                ["polarisation", "0 and 1", "1.5"],
            ),
            (
                SpeckleError::Wavelength(-1e-7),
                ["wavelength", "positive", "-1e-7 m"],
            ),
            (linewidth, ["linewidth", "6.5e-8 m", "2e-7 m"]),
            (
                SpeckleError::PathSpread(-2.0),
                ["path spread", "not negative", "-2e0 m"],
            ),
            (SpeckleError::BeamRatio(-3.0), ["beam ratio", "1e12", "-3"]),
            (
                SpeckleError::Phase(f64::INFINITY),
                ["phase", "finite", "inf rad"],
            ),
            (
                SpeckleError::ImageDrift(2e6),
                ["image drift", "1e6", "2000000"],
            ),
            (
                SpeckleError::PupilDrift(129.0),
                ["pupil drift", "128", "129"],
            ),
            (
                SpeckleError::PixelCount(0),
                ["pixel count", "32768", "got 0"],
            ),
            (
                SpeckleError::PixelPitch(-1.0),
                ["pixel pitch", "positive", "-1"],
            ),
            (SpeckleError::PixelSize(-1.0), ["pixel size", "1e12", "-1"]),
            (
                SpeckleError::PixelOrigin(2e12),
                ["pixel origin", "1e12", "2000000000000"],
            ),
            (SpeckleError::Image(0.0), ["image", "positive", "got 0"]),
            (SpeckleError::Region(-1.0), ["region", "positive", "-1"]),
            (
                SpeckleError::SpeckleSizeInPixels(-2.0),
                ["speckle size", "pixels", "-2"],
            ),
            (SpeckleError::Motion(-3.0), ["motion", "at least 0", "-3"]),
            (scatterers, ["scatterer count", "49", "got 0"]),
            (
                SpeckleError::Distance(0.0),
                ["distance", "positive", "0e0 m"],
            ),
            (
                SpeckleError::LitSize(0.0),
                ["lit area", "positive", "0e0 m"],
            ),
            (
                SpeckleError::SamplePitch(0.0),
                ["sample pitch", "positive", "0e0 m"],
            ),
        ] {
            let message = error.to_string();
            for part in parts {
                assert!(message.contains(part), "no '{part}' in '{message}'");
            }
        }
    }
    #[test]
    fn parameters_are_named_as_the_functions_that_refuse_them_call_them() {
        let field = PupilField::new(64, 32, 0).unwrap();
        let sum = |weights: &[f64]| IncoherentSum::weighted(weights).unwrap_err();
        let thin = field.clone().with_pupil(Pupil::Rectangle { height: 0.01 });
        let path = SlicePath::Straight {
            half_period: 4,
            length: 1,
        };
        let lit = LitArea::Disc { diameter: -1.0 };
        for (error, name) in [
            (PupilField::new(1 << 20, 32, 0).unwrap_err(), "size"),
            (PupilField::new(64, 33, 0).unwrap_err(), "diameter"),
            (thin.unwrap_err(), "pupil"),
            (path.check().unwrap_err(), "length"),
            (sum(&[]), "count"),
            (sum(&[-1.0]), "weights"),
            (
                IncoherentSum::partially_polarised(2.0).unwrap_err(),
                "degree",
            ),
            (
                Exposure::default()
                    .with_pupil_drift([f64::NAN; 2])
                    .unwrap_err(),
                "drift",
            ),
            (ObjectiveSpeckle::new(1.0, 1.0, lit).unwrap_err(), "area"),
            (PixelArray::new([1; 2], [0.0; 2]).unwrap_err(), "pitch"),
        ] {
            assert_eq!(error.parameter(), name, "{error}");
        }
    }
}
