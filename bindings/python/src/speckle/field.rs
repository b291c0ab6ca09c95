use numpy::{Complex32, PyArray2};
use pyo3::{exceptions::PyTypeError, prelude::*, types::PyComplex};
use tem00_speckle as physics;

use super::{
    arguments::{PHASORS, choice, counts, finite, finite_pair, name_of},
    images::{check_room, view},
    pattern::{SpeckleField, SpecklePattern},
    pupil::Pupil,
};
use crate::{
    arrays::{ComplexImage, Numbers, Whole, map_many},
    error::OrRaise,
    pickling::{Recipe, by_constructor},
};

mod parts;

use parts::{Parts, Source};

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
///     Diameter C of the pupil in lattice points, 8 to size / 2. Speckles are Q / C samples wide.
/// seed : int
///     Seed of the phasors, 0 to 2**64 - 1.
#[pyclass(frozen, eq, module = "tem00.speckle")]
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PupilField(pub(super) physics::PupilField);

#[pymethods]
impl PupilField {
    /// The largest side of a pattern in samples.
    #[classattr]
    const MAX_SIZE: usize = physics::PupilField::MAX_SIZE;
    /// The smallest pupil diameter in lattice points.
    #[classattr]
    const MIN_DIAMETER: usize = physics::PupilField::MIN_DIAMETER;
    /// The smallest number of phasors.
    #[classattr]
    const MIN_PHASORS: usize = physics::PupilField::MIN_PHASORS;

    #[new]
    fn new(size: Whole<'_>, diameter: Whole<'_>, seed: Whole<'_>) -> PyResult<Self> {
        let (size, diameter) = (size.unsigned("size")?, diameter.unsigned("diameter")?);
        let field = physics::PupilField::new(size, diameter, seed.unsigned("seed")?);
        Ok(Self(field.or_raise()?))
    }

    /// Return a field of unit phasors behind a circular pupil, for speckles of a given size.
    ///
    /// Without a lens a lit area takes the place of the pupil: of the width w it makes speckles of the wavelength
    /// times the distance over w, and ``with_pupil`` gives its shape. The law is ``tem00.statistics.ObjectiveSpeckle``.
    ///
    /// Parameters
    /// ----------
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// speckle_size : float
    ///     Speckle size in samples, from 2 to an eighth of the shorter side.
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    #[staticmethod]
    fn from_speckle_size(
        size: [Whole<'_>; 2],
        speckle_size: f64,
        seed: Whole<'_>,
    ) -> PyResult<Self> {
        let (size, seed) = (counts("size", &size)?, seed.unsigned("seed")?);
        let field = physics::PupilField::from_speckle_size(size, speckle_size, seed);
        Ok(Self(field.or_raise()?))
    }

    /// Return an external field: a measured or computed amplitude in the pupil plane.
    ///
    /// Parameters
    /// ----------
    /// samples : array_like of complex, shape (rows, columns)
    ///     Amplitude at the lattice points; sample [rows // 2, columns // 2] is the origin. They are
    ///     copied as complex64.
    /// size : (int, int)
    ///     Width and height of the pattern in samples.
    /// speckle_size : float
    ///     Speckle size in samples: for a pupil of C samples in diameter, width / C.
    #[staticmethod]
    fn from_samples(
        samples: ComplexImage<'_>,
        size: [Whole<'_>; 2],
        speckle_size: f64,
    ) -> PyResult<Self> {
        let (samples, size) = (samples.grid("samples")?, counts("size", &size)?);
        let field = physics::PupilField::from_samples(samples, size, speckle_size);
        Ok(Self(field.or_raise()?))
    }

    /// Return the same field behind a pupil of another shape.
    fn with_pupil(&self, pupil: &Pupil) -> PyResult<Self> {
        let field = self.0.clone().with_pupil(pupil.0.clone());
        Ok(Self(field.or_raise()?))
    }

    /// Return the same field behind a pupil of another diameter.
    ///
    /// Parameters
    /// ----------
    /// speckle_size : float
    ///     Speckle size in samples, from 2 to an eighth of the shorter side.
    fn with_speckle_size(&self, speckle_size: f64) -> PyResult<Self> {
        let field = self.0.clone().with_speckle_size(speckle_size);
        Ok(Self(field.or_raise()?))
    }

    /// Return the same pupil with another law of phasors; external samples stay as they are.
    ///
    /// Parameters
    /// ----------
    /// phasors : {"unit", "gaussian"}
    ///     Magnitude 1, or circular complex Gaussian with mean square 1.
    fn with_phasors(&self, phasors: &str) -> PyResult<Self> {
        let phasors = choice("phasors", &PHASORS, phasors)?;
        Ok(Self(self.0.clone().with_phasors(phasors)))
    }

    /// Return the same pupil with another, independent set of phasors; external samples stay as
    /// they are.
    ///
    /// Parameters
    /// ----------
    /// seed : int
    ///     Seed of the phasors, 0 to 2**64 - 1.
    fn with_seed(&self, seed: Whole<'_>) -> PyResult<Self> {
        Ok(Self(self.0.clone().with_seed(seed.unsigned("seed")?)))
    }

    /// Return fields of as many independent patterns: this one, then the same with seeds made from its own.
    ///
    /// Parameters
    /// ----------
    /// patterns : int
    ///     Number of patterns, 1 to 1024.
    fn independent(&self, patterns: Whole<'_>) -> PyResult<Vec<Self>> {
        let fields = self
            .0
            .independent(patterns.unsigned("patterns")?)
            .or_raise()?;
        Ok(fields.into_iter().map(Self).collect())
    }

    /// External samples, complex64 [row, column], a read-only view; None for random phasors.
    #[getter]
    fn samples<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray2<Complex32>>>> {
        let samples = slf.get().0.samples();
        // SAFETY: the samples belong to this object, which is frozen.
        let array = samples.map(|samples| unsafe { view(slf.clone().into_any(), samples) });
        array.transpose()
    }

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
    fn amplitude_correlation<'py>(
        &self,
        py: Python<'py>,
        x: Numbers<'py>,
        y: Numbers<'py>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let [re, im] = map_many(py, [("x", &x), ("y", &y)], |lag| {
            let correlation = self.0.amplitude_correlation(lag);
            [correlation.re, correlation.im]
        })?;
        re.add(im.mul(PyComplex::from_doubles(py, 0.0, 1.0))?)
    }

    /// Return the amplitude correlation of the field and that of the displaced pupil, counted on the
    /// lattice.
    ///
    /// Parameters
    /// ----------
    /// shift : (int, int)
    ///     Displacement of the pupil in lattice points.
    ///
    /// Returns
    /// -------
    /// complex
    ///     Fraction of the lattice points that both pupils hold, unless they are weighted.
    fn overlap<'py>(
        &self,
        py: Python<'py>,
        shift: [Whole<'py>; 2],
    ) -> PyResult<Bound<'py, PyComplex>> {
        let [x, y] = shift;
        let overlap = self.0.overlap([x.signed("shift")?, y.signed("shift")?]);
        Ok(PyComplex::from_doubles(py, overlap.re, overlap.im))
    }

    /// Return the intensity behind the undisplaced pupil in focus.
    fn pattern(&self, py: Python<'_>) -> PyResult<SpecklePattern> {
        self.pattern_at(py, [0.0; 2], 0.0)
    }

    /// Return the intensity behind the displaced pupil, out of focus.
    ///
    /// Parameters
    /// ----------
    /// offset : (float, float)
    ///     Displacement of the pupil in its diameters.
    /// defocus : float
    ///     In axial decorrelation lengths: at 1 the correlation first vanishes. Turns of phase from the
    ///     centre of the pupil to its rim.
    fn pattern_at(
        &self,
        py: Python<'_>,
        offset: [f64; 2],
        defocus: f64,
    ) -> PyResult<SpecklePattern> {
        let (offset, defocus) = (finite_pair("offset", offset)?, finite("defocus", defocus)?);
        check_room(self.0.size(), 4)?;
        let pattern = py.detach(|| self.0.pattern_at(offset, defocus));
        Ok(SpecklePattern(pattern))
    }

    /// Return the complex amplitude behind the undisplaced pupil in focus.
    fn field(&self, py: Python<'_>) -> PyResult<SpeckleField> {
        self.speckle(py, [0.0; 2], 0.0)
    }

    /// Return the complex amplitude behind the displaced pupil, out of focus.
    ///
    /// Parameters
    /// ----------
    /// offset : (float, float)
    ///     Displacement of the pupil in its diameters.
    /// defocus : float
    ///     In axial decorrelation lengths: at 1 the correlation first vanishes. Turns of phase from the
    ///     centre of the pupil to its rim.
    fn speckle(&self, py: Python<'_>, offset: [f64; 2], defocus: f64) -> PyResult<SpeckleField> {
        let (offset, defocus) = (finite_pair("offset", offset)?, finite("defocus", defocus)?);
        check_room(self.0.size(), 8)?;
        Ok(SpeckleField(py.detach(|| self.0.speckle(offset, defocus))))
    }

    pub(super) fn __repr__(&self) -> String {
        let pupil = self.pupil().__repr__();
        let seeded = self
            .0
            .seed()
            .and_then(|seed| Some((seed, Parts::of(&self.0)?)));
        let Some((seed, parts)) = seeded else {
            let (size, diameter) = (self.size(), self.diameter());
            return format!("<PupilField: size={size:?}, diameter={diameter:?}, pupil={pupil}>");
        };
        let ([width, height], speckle_size) = (parts.size, parts.speckle_size);
        let mut made = match parts.diameter {
            Some(diameter) => {
                format!("PupilField(size={width}, diameter={diameter}, seed={seed})")
            }
            None => format!(
                "PupilField.from_speckle_size(size=({width}, {height}), \
                 speckle_size={speckle_size:?}, seed={seed})"
            ),
        };
        if let Some(phasors) = self.phasors().filter(|&phasors| phasors != "unit") {
            made += &format!(".with_phasors('{phasors}')");
        }
        if *self.0.pupil() != physics::Pupil::Circle {
            made += &format!(".with_pupil({pupil})");
        }
        made
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Recipe<'py>> {
        let Some(parts) = Parts::of(&slf.get().0) else {
            let message = "the field of a stack on a straight path cannot be pickled: its lattice \
                           is closed; pickle the field that the stack was made of";
            return Err(PyTypeError::new_err(message));
        };
        let arguments = (
            (parts.size, parts.speckle_size, parts.diameter),
            (slf.get().0.seed(), slf.get().phasors()),
            Self::samples(slf)?,
            slf.get().pupil(),
        );
        by_constructor::<Self>(slf.py(), "_restore", arguments)
    }

    /// Make a field again of what it was made of.
    #[staticmethod]
    fn _restore(
        layout: ([usize; 2], f64, Option<usize>),
        random: (Option<u64>, Option<String>),
        samples: Option<ComplexImage<'_>>,
        pupil: &Pupil,
    ) -> PyResult<Self> {
        let ((size, speckle_size, diameter), (seed, phasors)) = (layout, random);
        let phasors = phasors.map(|name| choice("phasors", &PHASORS, &name));
        let seeded = Source::Seeded(seed.unwrap_or(0), phasors.transpose()?.unwrap_or_default());
        let samples = samples.map(|samples| samples.grid("samples"));
        let parts = Parts {
            size,
            speckle_size,
            diameter,
            source: samples.transpose()?.map_or(seeded, Source::Measured),
            pupil: pupil.0.clone(),
        };
        Ok(Self(parts.build().or_raise()?))
    }
}

methods! {
    impl PupilField as this: this.0;

    /// Law of the phasors, "unit" or "gaussian", or None for external samples.
    get phasors -> Option<&'static str> =
        this.0.phasors().map(|phasors| name_of(&PHASORS, phasors));

    /// Width and height of the pattern in samples.
    get size -> (usize, usize);

    /// Nominal pupil diameter along x and y in lattice points.
    get diameter -> (f64, f64);

    /// Speckle size Q / C in samples.
    get speckle_size -> f64;

    /// Shape of the pupil.
    get pupil -> Pupil = Pupil(this.0.pupil().clone());

    /// Seed, or None for external samples.
    get seed -> Option<u64>;

    /// Number N of lattice points inside the pupil.
    get phasor_count -> usize;

    /// Number of phasors of equal weight that fluctuate as the pupil's do.
    get effective_phasor_count -> f64;

    /// Diameter in lattice points of the disc whose area is the pupil's.
    get effective_diameter -> f64;
}
