use numpy::Complex32;
use tem00_numerics::{Grid, cast::to_usize};
use tem00_speckle::{Phasors, Pupil, PupilField, SpeckleError};

/// Arguments that make a field again.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    pub(super) size: [usize; 2],
    pub(super) speckle_size: f64,
    /// Lattice points across the pupil, if they and not the speckle size were given.
    pub(super) diameter: Option<usize>,
    pub(super) source: Source,
    pub(super) pupil: Pupil,
}

/// Origin of the values at the lattice points.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Seeded(u64, Phasors),
    Measured(Grid<Complex32>),
}

impl Parts {
    /// The parts of a field, or none if its lattice is closed, as no constructor makes it.
    pub(super) fn of(field: &PupilField) -> Option<Self> {
        let source = match (field.seed(), field.samples()) {
            (_, Some(samples)) => Source::Measured(samples.clone()),
            (seed, None) => Source::Seeded(seed?, field.phasors()?),
        };
        let parts = |diameter| Self {
            size: field.size(),
            speckle_size: field.speckle_size(),
            diameter,
            source: source.clone(),
            pupil: field.pupil().clone(),
        };
        // The constructors round the diameter or the speckle size.
        [Some(to_usize(field.diameter()[0])), None]
            .map(parts)
            .into_iter()
            .find(|parts| parts.clone().build().as_ref() == Ok(field))
    }

    pub(super) fn build(self) -> Result<PupilField, SpeckleError> {
        let Self {
            size,
            speckle_size,
            diameter,
            source,
            pupil,
        } = self;
        let field = match (source, diameter) {
            (Source::Measured(samples), _) => {
                PupilField::from_samples(samples, size, speckle_size)?
            }
            (Source::Seeded(seed, phasors), Some(diameter)) => {
                PupilField::new(size[0], diameter, seed)?.with_phasors(phasors)
            }
            (Source::Seeded(seed, phasors), None) => {
                PupilField::from_speckle_size(size, speckle_size, seed)?.with_phasors(phasors)
            }
        };
        field.with_pupil(pupil)
    }
}
