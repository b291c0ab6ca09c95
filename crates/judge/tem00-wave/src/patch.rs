use glam::{DMat3, DVec3};
use num_complex::Complex;
use tem00_numerics::check;

use crate::{
    Refusal,
    length::{axes_from, checked_direction, checked_length, checked_position},
    random::{Purpose, Random},
};

/// A point that scatters light equally in all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scatterer {
    /// Position, in metres.
    pub position: DVec3,
    /// Scattered amplitude at 1 m for an incident amplitude of 1, in metres.
    pub amplitude: Complex<f64>,
}

/// A rectangle of rough surface, for [`RoughSurface::patch`](crate::RoughSurface::patch).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchDescription {
    /// Centre of the rectangle, in metres.
    pub centre: DVec3,
    /// Normal, of any length.
    pub normal: DVec3,
    /// Direction of the first side, of any length; its component perpendicular to the normal is
    /// used.
    pub along: DVec3,
    /// Lengths of the sides, in metres: `along`, and along normal × `along`.
    pub size: [f64; 2],
    /// Number of scatterers along each side.
    pub scatterers: [usize; 2],
    /// Arrangement of the scatterers.
    pub arrangement: Arrangement,
    /// Cause of the random phases of the scatterers.
    pub roughness: Roughness,
    /// Seed of all randomness. The same seed gives the same surface.
    pub seed: u64,
}

/// Arrangement of scatterers on a patch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Arrangement {
    /// One scatterer in the centre of each cell of a lattice.
    #[default]
    Lattice,
    /// One scatterer at random in each cell of a lattice.
    Stratified,
    /// Scatterers at independent random positions.
    Random,
}

/// Cause of the random phases of scattered light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Roughness {
    /// Independent random phases, as of a surface much rougher than the wavelength.
    ///
    /// They do not depend on wavelength and direction; only the paths do.
    FullyDeveloped(Amplitudes),
    /// Scatterers of equal amplitude, displaced along the normal by a Gaussian random height with
    /// the autocorrelation `exp(−d² / correlation_length²)`.
    ///
    /// The phases follow from the paths, so that they change with wavelength and direction. A
    /// correlation length below half the spacing of the scatterers gives independent heights.
    Heights {
        /// Root mean square height, in metres.
        rms: f64,
        /// Distance at which the correlation of the heights falls to 1/e, in metres.
        correlation_length: f64,
    },
}

/// Random amplitudes of independent scatterers, and the bias of a finite number of scatterers.
///
/// With N scatterers in a resolution cell, the squared contrast of the speckle, and with it every
/// correlation of intensities, has the error
///
/// | amplitudes | [`Lattice`](Arrangement::Lattice) | [`Random`](Arrangement::Random) |
/// |---|---|---|
/// | `ComplexGaussian` | 0 | +2/N |
/// | `Unit` | −1/N | +1/N |
///
/// For [`Stratified`](Arrangement::Stratified) positions the random offsets add some 2/N² to the
/// values of the lattice. N follows from the amplitude `h` of a point's image, with n scatterers
/// per area: `1/N = ∫|h|⁴ / (n (∫|h|²)²)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Amplitudes {
    /// Complex Gaussian numbers: the field is exactly Gaussian, for any number of scatterers.
    #[default]
    ComplexGaussian,
    /// Magnitude 1 and uniform phase.
    Unit,
}

/// The largest number of scatterers.
const MAX_SCATTERERS: usize = 1 << 28;
/// Condition on numbers of scatterers.
pub(crate) const COUNT: &str = "from 1 to 2²⁸ in all";

/// The checked frame of a patch.
pub(crate) struct PatchFrame {
    pub(crate) centre: DVec3,
    /// Columns: along the first side, along the second, normal.
    pub(crate) axes: DMat3,
    pub(crate) size: [f64; 2],
    /// Distance between neighbouring scatterers along each side.
    pub(crate) spacing: [f64; 2],
}

impl PatchFrame {
    pub(crate) fn new(patch: &PatchDescription) -> Result<Self, Refusal> {
        let [columns, rows] = patch.scatterers;
        let count = columns.checked_mul(rows);
        let holds = count.is_some_and(|count| (1..=MAX_SCATTERERS).contains(&count));
        let count = columns as f64 * rows as f64;
        check::that(holds, "scatterers", count, "", COUNT)?;
        for side in patch.size {
            checked_length(side, "size")?;
        }
        checked_direction(patch.normal, "normal")?;
        let spacing = [0, 1].map(|i| patch.size[i] / patch.scatterers[i] as f64);
        Ok(Self {
            centre: checked_position(patch.centre, "centre")?,
            axes: axes_from(patch.along, patch.normal).ok_or_else(|| {
                let allowed = "finite, not zero and not along the normal";
                Refusal::new("along", patch.along.to_array(), allowed)
            })?,
            size: patch.size,
            spacing,
        })
    }

    /// The scatterers on the plane, all with the same amplitude.
    pub(crate) fn arranged(&self, patch: &PatchDescription) -> Vec<Scatterer> {
        let mut random = Random::new(patch.seed, Purpose::Positions);
        let [columns, rows] = patch.scatterers;
        let amplitude = Complex::new((self.spacing[0] * self.spacing[1]).sqrt(), 0.0);
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| [column, row]));
        cells
            .map(|cell| {
                let at =
                    [0, 1].map(|i| self.coordinate(i, cell[i], patch.arrangement, &mut random));
                Scatterer {
                    position: self.point(at),
                    amplitude,
                }
            })
            .collect()
    }

    /// The coordinate along side `i` of a scatterer in the given column or row.
    fn coordinate(
        &self,
        i: usize,
        cell: usize,
        arrangement: Arrangement,
        random: &mut Random,
    ) -> f64 {
        let start = cell as f64 * self.spacing[i];
        let from_edge = match arrangement {
            Arrangement::Stratified => start + random.uniform() * self.spacing[i],
            Arrangement::Lattice => start + 0.5 * self.spacing[i],
            Arrangement::Random => random.uniform() * self.size[i],
        };
        from_edge - 0.5 * self.size[i]
    }

    /// The point of the plane with these coordinates.
    pub(crate) fn point(&self, [x, y]: [f64; 2]) -> DVec3 {
        self.centre + self.axes * DVec3::new(x, y, 0.0)
    }
}
