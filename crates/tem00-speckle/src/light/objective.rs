use crate::{Pupil, PupilField, SpeckleError};

/// Speckle without a lens: what a lit area of a rough surface makes on a screen or sensor.
///
/// The lit area takes the place of the pupil: the field at the distance z is its Fourier transform,
/// with phasors that belong to the surface.
///
/// ```text
/// h = λ z / W          speckle size, W the width of the lit area
/// ```
///
/// Lengths are in metres.
///
/// # Motion
///
/// A surface that moves in its plane under a light that stands still brings new phasors into the lit
/// area: [`offset`](Self::offset) gives the displacement of the pupil for [`PupilField::pattern_at`].
/// Such speckle boils without moving, up to the curvature of the wavefront on the surface, which is
/// left out. Turning the surface and the light by small angles moves the pattern as a whole, by the
/// way the reflected beam takes on the screen.
///
/// # Validity
///
/// A screen parallel to the surface, near the axis, many widths away. The intensity is that of the
/// far field: constant on average over a region small against λz over the size of the scatterers.
///
/// # Examples
///
/// A red laser spot of 1 mm on a wall makes speckles of 1.3 mm at 2 m, here on 0.5 mm pixels:
///
/// ```
/// use tem00_speckle::{LitArea, ObjectiveSpeckle};
///
/// let spot = ObjectiveSpeckle::new(650e-9, 2.0, LitArea::Disc { diameter: 1e-3 })?;
/// assert!((spot.speckle_size() - 1.3e-3).abs() < 1e-12);
///
/// let field = spot.field([256, 192], 0.5e-3, 1)?;
/// assert!((field.speckle_size() - 2.6).abs() < 1e-9);
/// let before = field.pattern();
/// // The wall moves by a tenth of the spot.
/// let after = field.pattern_at(spot.offset([0.1e-3, 0.0]), 0.0);
/// assert_ne!(before, after);
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
///
/// # References
///
/// - J. W. Goodman, *Statistical properties of laser speckle patterns*, in *Laser Speckle and
///   Related Phenomena*, ed. J. C. Dainty, 1975, §2.4.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectiveSpeckle {
    wavelength: f64,
    distance: f64,
    area: LitArea,
}

/// The area of a rough surface that is lit, with lengths in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LitArea {
    /// A uniformly lit disc.
    Disc {
        /// Its diameter.
        diameter: f64,
    },
    /// A uniformly lit ring.
    Ring {
        /// Its outer diameter.
        outer: f64,
        /// Its inner diameter.
        inner: f64,
    },
    /// A uniformly lit rectangle, longer along x than along y or as long.
    Rectangle {
        /// Its length along x.
        width: f64,
        /// Its length along y.
        height: f64,
    },
    /// A Gaussian spot, cut off at 2.5 of its radii, with 4e−6 of its power.
    GaussianSpot {
        /// The radius at which the irradiance has fallen to 1/e².
        radius: f64,
    },
}

/// The diameter at which a Gaussian spot is cut off, in its radii.
const GAUSSIAN_CUT: f64 = 5.0;

impl LitArea {
    /// W, the extent along x.
    fn width(self) -> f64 {
        match self {
            Self::Disc { diameter } => diameter,
            Self::Ring { outer, .. } => outer,
            Self::Rectangle { width, .. } => width,
            Self::GaussianSpot { radius } => GAUSSIAN_CUT * radius,
        }
    }

    /// The shape, in units of W.
    fn pupil(self) -> Pupil {
        match self {
            Self::Disc { .. } => Pupil::Circle,
            Self::Ring { outer, inner } => Pupil::Annulus {
                inner: inner / outer,
            },
            Self::Rectangle { width, height } => Pupil::Rectangle {
                height: height / width,
            },
            Self::GaussianSpot { .. } => Pupil::Gaussian {
                radius: GAUSSIAN_CUT.recip(),
            },
        }
    }
}

impl ObjectiveSpeckle {
    /// Creates the speckle from the wavelength λ and the distance z of the screen, in metres, and the
    /// lit area.
    ///
    /// # Errors
    ///
    /// Returns an error unless the wavelength, the distance and all lengths of the area are positive
    /// and finite, the inner diameter of a ring is below the outer one and the height of a rectangle at
    /// most its width.
    pub fn new(wavelength: f64, distance: f64, area: LitArea) -> Result<Self, SpeckleError> {
        check_length("wavelength", wavelength)?;
        check_length("distance", distance)?;
        let lengths = match area {
            LitArea::Disc { diameter } => [diameter; 2],
            LitArea::Ring { outer, inner } => [outer, inner],
            LitArea::Rectangle { width, height } => [width, height],
            LitArea::GaussianSpot { radius } => [radius; 2],
        };
        lengths
            .into_iter()
            .try_for_each(|length| check_length("area", length))?;
        area.pupil().check()?;
        Ok(Self {
            wavelength,
            distance,
            area,
        })
    }

    /// Returns the wavelength, in metres.
    pub const fn wavelength(&self) -> f64 {
        self.wavelength
    }

    /// Returns the distance of the screen, in metres.
    pub const fn distance(&self) -> f64 {
        self.distance
    }

    /// Returns the lit area.
    pub const fn area(&self) -> LitArea {
        self.area
    }

    /// Returns the speckle size `λ z / W`, in metres: the period of the finest fringes along x.
    ///
    /// W is the diameter, the width or, of a Gaussian spot, five radii: that is where it is cut off.
    /// The speckles of a Gaussian spot look as large as those of a disc of two radii.
    pub fn speckle_size(&self) -> f64 {
        self.wavelength / self.area.width() * self.distance
    }

    /// Returns the field on a screen of `size` = [W, H] samples, `sample_pitch` metres apart.
    ///
    /// The pattern repeats beyond the screen.
    ///
    /// # Errors
    ///
    /// Returns an error unless `sample_pitch` is positive and finite and at most half the
    /// [speckle size](Self::speckle_size), and the screen at least eight speckle sizes wide and high;
    /// those of [`PupilField::from_speckle_size`] and [`PupilField::with_pupil`].
    pub fn field(
        &self,
        size: [usize; 2],
        sample_pitch: f64,
        seed: u64,
    ) -> Result<PupilField, SpeckleError> {
        check_length("sample_pitch", sample_pitch)?;
        PupilField::from_speckle_size(size, self.speckle_size() / sample_pitch, seed)?
            .with_pupil(self.area.pupil())
    }

    /// Returns the displacement of the pupil, in its diameters, when the surface has moved by
    /// `displacement`, in metres, through the light: `−displacement / W`.
    pub fn offset(&self, displacement: [f64; 2]) -> [f64; 2] {
        displacement.map(|length| -length / self.area.width())
    }
}

fn check_length(parameter: &'static str, length: f64) -> Result<(), SpeckleError> {
    if length > 0.0 && length.is_finite() {
        return Ok(());
    }
    let allowed = "a positive finite number of metres";
    Err(SpeckleError::out_of_range(parameter, length, allowed))
}

#[cfg(test)]
mod tests;
