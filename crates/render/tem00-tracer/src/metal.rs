mod tables;

use core::ops::RangeInclusive;

use self::tables::{
    ALUMINIUM, BRASS, CHROMIUM, COPPER, GOLD, IRON, NICKEL, PLATINUM, SILVER, STAINLESS_STEEL,
    TITANIUM, TUNGSTEN, Table,
};
use crate::{TracerError, error::check};

/// A metal, by its measured complex refractive index `n + ik`.
///
/// The index is interpolated linearly between the measured wavelengths. Plain steel reflects much
/// like [`Iron`](Self::Iron).
///
/// # Validity
///
/// Vacuum wavelengths from 368 nm to 1088 nm. The tables are for clean, smooth surfaces, mostly
/// films: oxide, alloying and the way a film is made change the reflectance. Where two laboratories
/// measured a metal, their reflectances in red differ by 1 % of the light for the best mirrors and
/// by up to 9 % for chromium, platinum and titanium.
///
/// # Examples
///
/// Gold is yellow because it hardly reflects blue:
///
/// ```
/// use tem00_tracer::Metal;
///
/// assert!(Metal::Gold.normal_reflectance(650e-9)? > 0.95);
/// assert!(Metal::Gold.normal_reflectance(450e-9)? < 0.42);
/// # Ok::<(), tem00_tracer::TracerError>(())
/// ```
///
/// # References
///
/// - P. B. Johnson and R. W. Christy, *Optical Constants of the Noble Metals*, 1972.
/// - P. B. Johnson and R. W. Christy, *Optical Constants of Transition Metals: Ti, V, Cr, Mn, Fe,
///   Co, Ni, and Pd*, 1974.
/// - B. Karlsson and C. G. Ribbing, *Optical Constants and Spectral Selectivity of Stainless Steel
///   and Its Oxides*, 1982.
/// - M. R. Querry, *Optical Constants*, report CRDC-CR-85034, 1985.
/// - A. D. Rakić, *Algorithm for the Determination of Intrinsic Optical Constants of Metal Films:
///   Application to Aluminum*, 1995.
/// - A. D. Rakić et al., *Optical Properties of Metallic Films for Vertical-Cavity Optoelectronic
///   Devices*, 1998.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Metal {
    /// Aluminium (Rakić 1995).
    Aluminium,
    /// Silver (Johnson and Christy 1972).
    Silver,
    /// Gold (Johnson and Christy 1972).
    Gold,
    /// Copper (Johnson and Christy 1972).
    Copper,
    /// Iron (Johnson and Christy 1974).
    Iron,
    /// Chromium (Johnson and Christy 1974).
    Chromium,
    /// Nickel (Johnson and Christy 1974).
    Nickel,
    /// Titanium (Johnson and Christy 1974).
    Titanium,
    /// Tungsten (Rakić et al. 1998).
    Tungsten,
    /// Platinum (Rakić et al. 1998).
    Platinum,
    /// Brass of 70 % copper and 30 % zinc (Querry 1985).
    Brass,
    /// Ferritic stainless steel with 13.5 % chromium (Karlsson and Ribbing 1982).
    StainlessSteel,
    /// A metal with the same index at every wavelength.
    Custom {
        /// The real part of the index.
        n: f64,
        /// The imaginary part of the index, the extinction coefficient.
        k: f64,
    },
}

impl Metal {
    /// The metals that were measured, by the names that scene files use.
    pub const NAMED: &'static [(&'static str, Self)] = &[
        ("aluminium", Self::Aluminium),
        ("silver", Self::Silver),
        ("gold", Self::Gold),
        ("copper", Self::Copper),
        ("iron", Self::Iron),
        ("chromium", Self::Chromium),
        ("nickel", Self::Nickel),
        ("titanium", Self::Titanium),
        ("tungsten", Self::Tungsten),
        ("platinum", Self::Platinum),
        ("brass", Self::Brass),
        ("stainless_steel", Self::StainlessSteel),
    ];

    /// Returns who measured the metal: the authors and the year of the source, with what was
    /// measured where the name leaves it open.
    pub const fn source(self) -> &'static str {
        match self {
            Self::Aluminium => "Rakić 1995",
            Self::Silver | Self::Gold | Self::Copper => "Johnson and Christy 1972",
            Self::Iron | Self::Chromium | Self::Nickel | Self::Titanium => {
                "Johnson and Christy 1974"
            }
            Self::Tungsten | Self::Platinum => "Rakić et al. 1998",
            Self::Brass => "Querry 1985: 70 % copper, 30 % zinc",
            Self::StainlessSteel => "Karlsson and Ribbing 1982: ferritic, 13.5 % chromium",
            Self::Custom { .. } => "given",
        }
    }

    /// Returns `n` and `k` at a vacuum wavelength in metres.
    ///
    /// # Errors
    ///
    /// Returns an error if the wavelength is outside the measured range, or if a custom metal has
    /// an `n` that is not between 1e-6 and 1e6 or a `k` that is not between 0 and 1e6.
    pub fn refractive_index(self, wavelength: f64) -> Result<(f64, f64), TracerError> {
        self.check_index()?;
        self.check_wavelength(wavelength)?;
        Ok(self.nearest_refractive_index(wavelength))
    }

    /// Returns the fraction of power that a polished surface reflects at normal incidence, at a
    /// vacuum wavelength in metres.
    ///
    /// ```text
    /// R = ((n − 1)² + k²) / ((n + 1)² + k²)
    /// ```
    ///
    /// # Errors
    ///
    /// Returns the errors of [`refractive_index`](Self::refractive_index).
    pub fn normal_reflectance(self, wavelength: f64) -> Result<f64, TracerError> {
        let index = self.refractive_index(wavelength)?;
        Ok(fresnel_reflectance(1.0, index))
    }

    /// Checks that the index of a custom metal is possible.
    pub(crate) fn check_index(self) -> Result<(), TracerError> {
        let Self::Custom { n, k } = self else {
            return Ok(());
        };
        check("n", n, 1e-6..=1e6, "between 1e-6 and 1e6")?;
        check("k", k, 0.0..=1e6, "between 0 and 1e6")
    }

    /// Checks that the metal was measured at a wavelength.
    pub(crate) fn check_wavelength(self, wavelength: f64) -> Result<(), TracerError> {
        if matches!(self, Self::Custom { .. }) || MEASURED.contains(&wavelength) {
            return Ok(());
        }
        let allowed = "from 368e-9 m to 1088e-9 m, where the metal was measured";
        Err(TracerError::out_of_range("wavelength", wavelength, allowed))
    }

    /// Returns `n` and `k` at the wavelength of the table that is nearest to `wavelength`.
    pub(crate) fn nearest_refractive_index(self, wavelength: f64) -> (f64, f64) {
        let table = match self {
            Self::Aluminium => &ALUMINIUM,
            Self::Silver => &SILVER,
            Self::Gold => &GOLD,
            Self::Copper => &COPPER,
            Self::Iron => &IRON,
            Self::Chromium => &CHROMIUM,
            Self::Nickel => &NICKEL,
            Self::Titanium => &TITANIUM,
            Self::Tungsten => &TUNGSTEN,
            Self::Platinum => &PLATINUM,
            Self::Brass => &BRASS,
            Self::StainlessSteel => &STAINLESS_STEEL,
            Self::Custom { n, k } => return (n, k),
        };
        interpolate(table, wavelength * 1e9)
    }
}

/// Returns the fraction of unpolarised power that a conductor of index `n + ik` reflects, at the
/// cosine of the angle of incidence.
///
/// The average of the Fresnel reflectances of both polarisations, without approximation. With
/// s = sin θ, c = cos θ:
///
/// ```text
/// a² + b² = √((n² − k² − s²)² + 4n²k²)       2a² = a² + b² + n² − k² − s²
/// R_s = (a² + b² − 2ac + c²) / (a² + b² + 2ac + c²)
/// R_p = R_s (c²(a² + b²) − 2acs² + s⁴) / (c²(a² + b²) + 2acs² + s⁴)
/// ```
///
/// # References
///
/// - M. Born and E. Wolf, *Principles of Optics*, §14.2 (metals) with §1.5 (Fresnel's formulae).
pub(crate) fn fresnel_reflectance(cosine: f64, (n, k): (f64, f64)) -> f64 {
    let c2 = cosine * cosine;
    let s2 = 1.0 - c2;
    let real = n * n - k * k - s2;
    let modulus = (real * real + 4.0 * n * n * k * k).sqrt();
    let a = (0.5 * (modulus + real)).max(0.0).sqrt();
    let cross = 2.0 * a * cosine;
    let perpendicular = (modulus + c2 - cross) / (modulus + c2 + cross);
    let ratio = (c2 * modulus + s2 * s2 - cross * s2) / (c2 * modulus + s2 * s2 + cross * s2);
    // An index of 1 reflects nothing. Rounding may give less, and along the surface both
    // polarisations are 0/0: `max` answers 0 to both.
    (0.5 * perpendicular * (1.0 + ratio)).max(0.0)
}

fn interpolate(table: &Table, nanometres: f64) -> (f64, f64) {
    let measured = table.nanometres;
    let above = measured.partition_point(|&at| at < nanometres);
    let (low, high) = (above.max(1) - 1, above.clamp(1, measured.len() - 1));
    let fraction = (nanometres - measured[low]) / (measured[high] - measured[low]);
    let fraction = fraction.clamp(0.0, 1.0);
    let between = |column: &[f64]| column[low] + fraction * (column[high] - column[low]);
    (between(table.n), between(table.k))
}

/// The vacuum wavelengths, in metres, that all tables contain.
const MEASURED: RangeInclusive<f64> = 368e-9..=1088e-9;

#[cfg(test)]
mod tests;
