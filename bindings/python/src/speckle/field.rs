use numpy::Complex32;
use pyo3::{exceptions::PyTypeError, prelude::*};
use tem00_numerics::{
    Grid,
    cast::to_usize,
    check,
    seed::{Purpose, derived},
};
use tem00_speckle::{self as physics, Phasors, PupilField as Field, SpeckleError};

use super::{
    images::{View, check_room, view},
    pattern::{SpeckleField, SpecklePattern},
    pupil::Pupil,
};
use crate::{
    arguments::{choices, optional},
    arrays::{Floats, LIMIT, Numbers, map_complex},
    error::{OrRaise, refused},
    pickling::{Recipe, by_constructor},
};

class! {
    /// A field on the lattice of pupil points, random or measured, seen through the pupil.
    ///
    /// A pupil of C lattice points in diameter selects the points about its centre; their Fourier
    /// transform, with the sign exp(-2 pi i k r / Q), is the speckle field on Q x Q samples.
    ///
    /// Parameters
    /// ----------
    /// size : int
    ///     Side Q of the pattern in samples.
    /// diameter : int
    ///     Diameter C of the pupil in lattice points, 8 to size / 2. Speckles are Q / C samples
    ///     wide.
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    "tem00.speckle" PupilField(Field)
}

choices! {
    Phasors: "unit" = Self::Unit, "gaussian" = Self::Gaussian;
    Purpose: "laser" = Self::Laser, "body" = Self::Body;
}

methods! {
    impl PupilField as this: this.0;

    /// Return the exact amplitude correlation of two samples.
    ///
    /// Parameters
    /// ----------
    /// x, y : array_like
    ///     Distance of the samples along x and y, in samples.
    ///
    /// Returns
    /// -------
    /// complex or ndarray of complex
    ///     Correlation in the common shape of the arguments, 1 at no distance.
    call amplitude_correlation(py; x: Numbers<'py>, y: Numbers<'py>) -> Bound<'py, PyAny> = {
        map_complex(py, columns!(LIMIT; x, y), |lag| {
            this.0.amplitude_correlation(lag)
        })
    };

    /// Return the intensity behind the pupil.
    ///
    /// Parameters
    /// ----------
    /// offset : (float, float), optional
    ///     Displacement of the pupil in its diameters.
    /// defocus : float, optional
    ///     In axial decorrelation lengths: at 1 the correlation first vanishes. Turns of phase from
    ///     the centre of the pupil to its rim.
    /// image_drift : (float, float), optional
    ///     Drift of the pattern over the sensor during an exposure, in speckle sizes.
    /// pupil_drift : (float, float), optional
    ///     Drift of the light over the pupil during an exposure, in pupil diameters.
    #[pyo3(signature = (offset = None, defocus = 0.0, *, image_drift = None, pupil_drift = None))]
    call pattern(py;
        offset: Option<Bound<'py, PyAny>>, defocus: f64, image_drift: Option<Bound<'py, PyAny>>,
        pupil_drift: Option<Bound<'py, PyAny>>
    ) -> SpecklePattern = {
        let offset = optional(offset, "offset")?.unwrap_or_default();
        let defocus = finite("defocus", defocus)?;
        if image_drift.is_none() && pupil_drift.is_none() {
            check_room(this.0.size(), 4)?;
            return Ok(py.detach(|| this.0.pattern_at(offset, defocus)).into());
        }
        let image_drift = optional(image_drift, "image_drift")?.unwrap_or_default();
        let pupil_drift = optional(pupil_drift, "pupil_drift")?.unwrap_or_default();
        let exposure = physics::Exposure::default().with_image_drift(image_drift);
        let exposure = exposure.or_raise_renamed(&["drift"], "image_drift")?;
        let exposure = exposure.with_pupil_drift(pupil_drift);
        let exposure = exposure.or_raise_renamed(&["drift"], "pupil_drift")?;
        // Two patterns, their spectrum and what it is summed to.
        check_room(this.0.size(), 2 * 4 + 3 * 8)?;
        Ok(py
            .detach(|| exposure.pattern_at(&this.0, offset, defocus))
            .into())
    };

    /// Return the complex amplitude behind the pupil.
    ///
    /// Parameters
    /// ----------
    /// offset : (float, float), optional
    ///     Displacement of the pupil in its diameters.
    /// defocus : float, optional
    ///     As for ``pattern``.
    #[pyo3(signature = (offset = None, defocus = 0.0))]
    call field(py; offset: Option<Bound<'py, PyAny>>, defocus: f64) -> SpeckleField = {
        let offset = optional(offset, "offset")?.unwrap_or_default();
        let defocus = finite("defocus", defocus)?;
        check_room(this.0.size(), 8)?;
        Ok(SpeckleField(py.detach(|| this.0.speckle(offset, defocus))))
    };

    /// Constructor that pickle calls.
    #[staticmethod]
    build _restored(_py;
        layout: ([usize; 2], f64, Option<usize>), random: (Option<u64>, Option<Bound<'py, PyAny>>),
        samples: Option<Bound<'py, PyAny>>, pupil: Bound<'py, PyAny>
    ) = {
        take!(pupil: physics::Pupil);
        let random = (random.0, optional(random.1, "phasors")?);
        let field = restored(layout, random, optional(samples, "samples")?, pupil);
        Ok(Self(field.or_raise()?))
    };

    make new(size: usize, diameter: usize, seed: u64) = Field::new(size, diameter, seed);

    /// Return a field of unit phasors behind a circular pupil, for speckles of a given size.
    ///
    /// Without a lens a lit area takes the place of the pupil: of the width w it makes speckles of
    /// the wavelength times the distance over w, and ``with_pupil`` gives its shape. The law is
    /// ``tem00.statistics.ObjectiveSpeckle``.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// speckle_size : float
    ///     Speckle size in samples, from 2 to an eighth of the shorter side.
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    make from_speckle_size(size: [usize; 2], speckle_size: f64, seed: u64) =
        Field::from_speckle_size(size, speckle_size, seed);

    /// Return an external field: a measured or computed amplitude in the pupil plane.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like of complex, shape (rows, columns)
    ///     Amplitude at the lattice points; sample [rows // 2, columns // 2] is the origin. They
    ///     are copied as complex64.
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// speckle_size : float
    ///     Speckle size in samples: for a pupil of C samples in diameter, width / C.
    make from_samples(samples: Grid<Complex32>, size: [usize; 2], speckle_size: f64) = {
        let is_lit = samples.values().iter().any(|z| z.norm_sqr() > 0.0);
        check::that(is_lit, "samples", 0.0, "", "other than 0 somewhere")
            .map_err(SpeckleError::from)
            .and_then(|()| Field::from_samples(samples, size, speckle_size))
    };

    /// Return the same field behind a pupil of another shape.
    try with_pupil(pupil: physics::Pupil) -> PupilField = this.0.clone().with_pupil(pupil);

    /// Return the same field behind a pupil of another diameter.
    ///
    /// Parameters
    /// ----------
    /// speckle_size : float
    ///     Speckle size in samples, from 2 to an eighth of the shorter side.
    try with_speckle_size(speckle_size: f64) -> PupilField =
        this.0.clone().with_speckle_size(speckle_size);

    /// Return the same pupil with another law of phasors; external samples stay as they are.
    ///
    /// Parameters
    /// ----------
    /// phasors : {"unit", "gaussian"}
    ///     Magnitude 1, or circular complex Gaussian with mean square 1.
    fn with_phasors(phasors: Phasors) -> PupilField = this.0.clone().with_phasors(phasors);

    /// Return the same pupil with another, independent set of phasors; external samples stay as
    /// they are.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    fn with_seed(seed: u64) -> PupilField = this.0.clone().with_seed(seed);

    /// Return fields of as many independent patterns: this one, then the same with seeds made from
    /// its own.
    ///
    /// Parameters
    /// ----------
    /// patterns : int
    ///     Number of patterns, 1 to 1024.
    try independent(patterns: usize) -> Vec<PupilField> = {
        let fields = this.0.independent(patterns);
        fields.map(|fields| fields.into_iter().map(PupilField).collect::<Vec<_>>())
    };

    /// Law of the phasors, "unit" or "gaussian", or None for external samples.
    get phasors -> Option<&'static str> = this.0.phasors().map(|phasors| match phasors {
        Phasors::Unit => "unit",
        Phasors::Gaussian => "gaussian",
    });

    /// Width and height of the pattern in samples.
    get size -> (usize, usize);

    /// Nominal pupil diameter along x and y in lattice points.
    get diameter -> (f64, f64);

    /// Speckle size Q / C in samples.
    get speckle_size -> f64;

    /// Shape of the pupil.
    get pupil -> Pupil = this.0.pupil().clone();

    /// Seed, or None for external samples.
    get seed -> Option<u64>;

    /// Number N of lattice points inside the pupil.
    get phasor_count -> usize;

    /// Number of phasors of equal weight that fluctuate as the pupil's do.
    get effective_phasor_count -> f64;

    /// Diameter in lattice points of the disc whose area is the pupil's.
    get effective_diameter -> f64;
}

#[pymethods]
impl PupilField {
    /// External samples, complex64 [row, column], a read-only view; None for random phasors.
    #[getter]
    fn samples<'py>(slf: &Bound<'py, Self>) -> PyResult<View<'py, Complex32>> {
        view(slf, |this| this.0.samples())
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let names = ["size", "speckle_size", "seed", "phasors", "pupil"];
        Ok(format!(
            "<PupilField: {}>",
            crate::pickling::shown(slf, &names)?
        ))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Recipe<'py>> {
        let field = &slf.get().0;
        // The constructors round the diameter or the speckle size.
        let layout = [Some(to_usize(field.diameter()[0])), None]
            .map(|diameter| (field.size(), field.speckle_size(), diameter))
            .into_iter()
            .find(|layout| {
                let random = (field.seed(), field.phasors());
                restored(
                    *layout,
                    random,
                    field.samples().cloned(),
                    field.pupil().clone(),
                )
                .as_ref()
                    == Ok(field)
            });
        let Some(layout) = layout else {
            let message = "the field of a stack on a straight path cannot be pickled: its lattice \
                           is closed; pickle the field that the stack was made of";
            return Err(PyTypeError::new_err(message));
        };
        let random = (field.seed(), slf.get().phasors());
        let arguments = (layout, random, Self::samples(slf)?, slf.get().pupil());
        by_constructor::<Self>(slf.py(), "_restored", arguments)
    }
}

/// Makes a field again of what it was made of.
fn restored(
    (size, speckle_size, diameter): ([usize; 2], f64, Option<usize>),
    (seed, phasors): (Option<u64>, Option<Phasors>),
    samples: Option<Grid<Complex32>>,
    pupil: physics::Pupil,
) -> Result<Field, SpeckleError> {
    let seed = seed.unwrap_or(0);
    let field = match (samples, diameter) {
        (Some(samples), _) => Field::from_samples(samples, size, speckle_size)?,
        (None, Some(diameter)) => Field::new(size[0], diameter, seed)?,
        (None, None) => Field::from_speckle_size(size, speckle_size, seed)?,
    };
    field
        .with_phasors(phasors.unwrap_or_default())
        .with_pupil(pupil)
}

/// Refuses what is not a finite number.
fn finite(name: &str, x: f64) -> PyResult<f64> {
    if x.is_finite() {
        return Ok(x);
    }
    Err(refused(name, format!("{name} must be finite, got {x}")))
}

functions! {
    /// Return the seed of one of several lasers or bodies, from a seed that they share: as ``tem00
    /// render`` derives it.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the scene for lasers, or of a laser for the bodies in its light, 0 to 2**64 - 1.
    /// purpose : str
    ///     "laser" or "body".
    /// index : int
    ///     Number of the laser or of the body, from 0. The first body has the seed of the laser
    ///     itself.
    ///
    /// Returns
    /// -------
    /// int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    try derived_seed(seed: u64, purpose: Purpose, index: u64) -> u64 =
        PyResult::Ok(derived(seed, purpose, index));

    /// Return the fractions of the light in independent speckle patterns whose intensities add.
    ///
    /// Parameters
    /// ----------
    /// patterns : int
    ///     Number of equal patterns.
    /// polarisation : float
    ///     Degree of polarisation of the light that reaches the sensor, 0 to 1.
    /// weights : array_like, shape (n,)
    ///     Mean intensities in any unit of the parts of each: of several lasers, or of the coherent
    ///     modes of a broad spectrum.
    ///
    /// Returns
    /// -------
    /// ndarray
    ///     Fractions of sum 1, float64, at most 1024 of them.
    try incoherent_fractions(patterns: usize, polarisation: f64, weights: Vec<f64>) -> Floats =
        physics::incoherent_fractions(patterns, polarisation, &weights);
}
