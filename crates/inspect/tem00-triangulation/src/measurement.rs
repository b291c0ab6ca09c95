//! A height and its uncertainty, where quantities of the set-up are uncertain themselves.

mod virtual_experiment;

use glam::DVec2;
use tem00_uncertainty::{
    Correlation, Decomposition, DecompositionOptions, Distribution, FirstOrder, Input, Inputs,
    Propagation, PropagationOptions, UncertaintyError,
};

pub use self::virtual_experiment::VirtualExperiment;
use crate::{
    Budget, BudgetTerm, ErrorDistribution, QuantityUnit, Setup, SetupDescription, SetupQuantity,
    TriangulationError, Triangulator, UncertaintySource,
    setup::{
        camera,
        unit::{LINE_PIXELS, MICROMETRES},
        within,
    },
};

/// Uncertain values of a set-up, and the height that is measured with it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetupUncertainty {
    /// The height, in metres; the greatest of the measuring range without one.
    pub height: Option<f64>,
    /// The uncertain quantities, each once, in SI units.
    pub quantities: Vec<(SetupQuantity, Input)>,
    /// The correlations between them, by their positions in the list.
    pub correlations: Vec<Correlation>,
}

impl SetupUncertainty {
    /// Returns whether a height is stated, or its uncertainty follows from the uncertainty of a
    /// quantity.
    pub const fn states_height(&self) -> bool {
        self.height.is_some() || !self.quantities.is_empty()
    }
}

/// Input quantity of a measured height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasurementInput {
    /// A quantity of the set-up.
    Quantity(SetupQuantity),
    /// The error of the position of the line, or of the height, by a term of the budget.
    Term(UncertaintySource),
}

impl MeasurementInput {
    /// Returns the unit that it is usually read in.
    pub fn unit(self) -> &'static QuantityUnit {
        match self {
            Self::Quantity(quantity) => quantity.unit(),
            Self::Term(UncertaintySource::Calibration) => &MICROMETRES,
            Self::Term(_) => &LINE_PIXELS,
        }
    }

    /// Returns a measure that lowers its contribution.
    pub const fn remedy(self) -> &'static str {
        use SetupQuantity::{
            Angle, BaseExpansion, Distance, FocalLength, LaserOffset, LaserTilt, MountExpansion,
            PixelPitch, PrincipalRow, TemperatureChange,
        };
        match self {
            Self::Term(source) => source.remedy(),
            Self::Quantity(PrincipalRow | LaserOffset) => {
                "it shifts all heights alike; measure it on a flat plate at height zero"
            }
            Self::Quantity(Distance | Angle | FocalLength | PixelPitch | LaserTilt) => {
                "it scales heights; measure it with a step of known height or a calibration board"
            }
            Self::Quantity(TemperatureChange | BaseExpansion | MountExpansion) => {
                "a steadier temperature, or a base and a mount that expand less, lower it"
            }
            Self::Quantity(_) => "a more accurate value reduces it",
        }
    }
}

/// The measurement of a height with a set-up whose quantities are uncertain.
///
/// The measurement model, in the words of JCGM 100, gives the height as a function of its inputs:
///
/// ```text
/// z = g(v + Σ eₖ − Δs; L, θ, f, p, v₀, y₀, τ) + e_c
/// ```
///
/// `v` is the row at which the set-up as it is described sees the height, known exactly; the `eₖ`
/// are the errors of that position by the terms of the [`Budget`], of mean zero; `e_c` is the error
/// of the calibration. `g` meets the line of sight with the laser plane. Distance, angle, focal
/// length, pixel pitch and principal row, and the offset and tilt of the laser plane, change the
/// scale of heights, or shift all of them; so does a change of temperature where it expands base or
/// mount. Heights count from the point of the laser plane that the optical axis is to meet: where
/// distance and angle change, the camera still looks at it.
///
/// A quantity that affects only the noise, such as the wavelength, changes the standard
/// uncertainties of the terms: they change in proportion to the quantity, as their differences over
/// ± one standard uncertainty show. To first order this changes no height. A quantity that affects
/// the shift s of the line by light from below the surface, such as the transport length, changes
/// the correction of the height by Δs, in proportion to the quantity as well.
///
/// # Examples
///
/// ```
/// # let text = r#"
/// # [laser]
/// # wavelength = "650 nm"
/// # power = "5 mW"
/// # line_thickness = "0.2 mm"
/// # line_length = "50 mm"
/// # [camera]
/// # focal_length = "25 mm"
/// # f_number = 8
/// # pixel_pitch = "3.45 um"
/// # resolution = [640, 480]
/// # distance = "300 mm"
/// # angle = "30 deg"
/// # [sensor]
/// # quantum_efficiency = 0.6
/// # exposure = "0.1 ms"
/// # [surface]
/// # reflectance = 0.5
/// # "#;
/// use tem00_triangulation::{Measurement, SetupQuantity, SetupUncertainty, parse_setup};
/// use tem00_uncertainty::{Distribution, Input};
///
/// let setup = parse_setup(text)?;
/// let pitch = Input::new(3.45e-6, 3.45e-9, Distribution::Normal)?;
/// let uncertainty = SetupUncertainty {
///     height: Some(5e-3),
///     quantities: vec![(SetupQuantity::PixelPitch, pitch)],
///     ..SetupUncertainty::default()
/// };
/// let found = Measurement::new(&setup, &uncertainty)?.first_order()?;
/// // A pitch that is a thousandth larger makes heights a thousandth larger, and some perspective
/// // more.
/// let by_pitch = found.contributions()[0].uncertainty;
/// assert!((by_pitch / 5e-6 - 1.0).abs() < 0.03);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # References
///
/// - JCGM 100:2008, *Guide to the expression of uncertainty in measurement*, § 4.1.
#[derive(Clone, Debug)]
pub struct Measurement {
    setup: Setup,
    height: f64,
    row: f64,
    speckles: f64,
    /// The shift of the line by light from below the surface, in pixels, and its change by each
    /// quantity.
    shift: (f64, Vec<f64>),
    sources: Vec<MeasurementInput>,
    inputs: Inputs,
    /// For each term with a position, the relative change of its standard uncertainty by each
    /// quantity.
    slopes: Vec<Vec<f64>>,
}

impl Measurement {
    /// Creates a measurement.
    ///
    /// # Errors
    ///
    /// Returns an error if the height is outside of the measuring range, if nothing can be measured
    /// there, if a quantity is not possible one standard uncertainty above or below its estimate,
    /// or if the correlations are not possible.
    pub fn new(setup: &Setup, uncertainty: &SetupUncertainty) -> Result<Self, TriangulationError> {
        let range = setup.measuring_range();
        let height = uncertainty.height.unwrap_or(range.high);
        let allowed = "within the measuring range of the set-up (in metres)";
        within("height", height, (range.low, range.high), allowed)?;
        let budget = Budget::at_height(setup, height)?;
        let terms = budget.terms().iter().filter(|term| term.uncertainty > 0.0);
        let terms: Vec<BudgetTerm> = terms.copied().collect();
        let quantities = &uncertainty.quantities;
        let of_set_up = quantities
            .iter()
            .map(|(quantity, input)| Ok((MeasurementInput::Quantity(*quantity), *input)));
        let of_terms = terms
            .iter()
            .map(|term| Ok((MeasurementInput::Term(term.source), error_of(term)?)));
        let all: Result<Vec<_>, TriangulationError> = of_set_up.chain(of_terms).collect();
        let (sources, inputs) = all?.into_iter().unzip();
        let (slopes, shifts) = slopes(setup, height, quantities, &terms)?;
        Ok(Self {
            row: setup.line_at(height).map_or(f64::NAN, |line| line.position),
            speckles: budget.speckles(),
            sources,
            inputs: Inputs::correlated(inputs, &uncertainty.correlations)?,
            slopes,
            shift: (shift(&budget), shifts),
            height,
            setup: setup.clone(),
        })
    }

    /// Returns the measured height, in metres.
    pub const fn height(&self) -> f64 {
        self.height
    }

    /// Returns the full width of the line at the height, in speckles; see
    /// [`Budget::LEAST_SPECKLES`].
    pub const fn speckles(&self) -> f64 {
        self.speckles
    }

    /// Returns the sources of the inputs, in their order: first the quantities of the set-up, then
    /// the terms of the budget that are not zero.
    pub fn sources(&self) -> &[MeasurementInput] {
        &self.sources
    }

    /// Returns the inputs: quantities in SI units; errors of the position of the line in pixels,
    /// the error of the calibration in metres.
    pub const fn inputs(&self) -> &Inputs {
        &self.inputs
    }

    /// Returns the height, in metres, that follows from values of the inputs, or NaN where the line
    /// of sight meets no laser plane or there is no such camera.
    pub fn height_of(&self, values: &[f64]) -> f64 {
        let (mut row, mut calibration) = (self.row, 0.0);
        let (quantities, errors) = values.split_at(values.len() - self.slopes.len());
        let terms = self.sources[quantities.len()..].iter().zip(errors);
        for ((source, error), slopes) in terms.zip(&self.slopes) {
            match source {
                MeasurementInput::Term(UncertaintySource::Calibration) => calibration = *error,
                _ => row += error * (1.0 + self.change(quantities, slopes)),
            }
        }
        // The set-up as it is described sees the line where its own shift has it.
        row -= self.change(quantities, &self.shift.1);
        let setup = self.with(quantities);
        height_at(&setup, row).map_or(f64::NAN, |height| height + calibration)
    }

    /// Returns the result by the law of propagation of uncertainty.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`FirstOrder::new`].
    pub fn first_order(&self) -> Result<FirstOrder, TriangulationError> {
        Ok(FirstOrder::new(&self.inputs, |x| self.height_of(x))?)
    }

    /// Returns the result by the propagation of distributions.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Propagation::new`].
    pub fn propagation(
        &self,
        options: PropagationOptions,
    ) -> Result<Propagation, TriangulationError> {
        let found = Propagation::new(&self.inputs, |x| self.height_of(x), options);
        found.map_err(|error| self.named(error))
    }

    /// Returns the fractions of the variance that the inputs contribute.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`Decomposition::new`].
    pub fn decomposition(
        &self,
        options: DecompositionOptions,
    ) -> Result<Decomposition, TriangulationError> {
        let found = Decomposition::new(&self.inputs, |x| self.height_of(x), options);
        found.map_err(|error| self.named(error))
    }

    /// Returns an error about an input by its name.
    fn named(&self, error: UncertaintyError) -> TriangulationError {
        match error {
            UncertaintyError::ImpossibleDraw {
                input,
                distribution,
                value,
            } => TriangulationError::ImpossibleDraw {
                input: match self.sources[input] {
                    MeasurementInput::Quantity(quantity) => quantity.to_string(),
                    MeasurementInput::Term(source) => source.to_string(),
                },
                distribution,
                value,
            },
            error => error.into(),
        }
    }

    /// Returns the description of the set-up with other values of its uncertain quantities.
    fn with(&self, values: &[f64]) -> SetupDescription {
        let mut description = self.setup.exposed_description();
        for (source, &value) in self.sources.iter().zip(values) {
            if let MeasurementInput::Quantity(quantity) = source {
                quantity.set(&mut description, value);
            }
        }
        description
    }

    /// Returns the change of a value that is linear in the quantities.
    fn change(&self, quantities: &[f64], slopes: &[f64]) -> f64 {
        let inputs = self.inputs.as_slice().iter().zip(quantities);
        let changes = inputs
            .zip(slopes)
            .map(|((input, x), slope)| slope * (x - input.estimate()));
        changes.sum()
    }
}

/// Returns the height of a line at a row of the middle column, in metres, as camera and laser plane
/// of a description give it.
fn height_at(description: &SetupDescription, row: f64) -> Option<f64> {
    let triangulator =
        Triangulator::new(camera(description).ok()?, description.laser_plane().ok()?);
    let [width, _] = description.camera.resolution;
    let point = triangulator.point(DVec2::new(0.5 * width as f64, row))?;
    Some(point.z)
}

/// Returns the error by a term: the error of a detector is even over a period, all others are sums
/// of many errors.
fn error_of(term: &BudgetTerm) -> Result<Input, TriangulationError> {
    let distribution = match term.distribution {
        ErrorDistribution::Periodic => Distribution::Arcsine,
        ErrorDistribution::Normal | ErrorDistribution::Rectangular => Distribution::Normal,
    };
    let input = Input::new(0.0, term.uncertainty, distribution)?;
    Ok(input.with_degrees_of_freedom(term.degrees_of_freedom)?)
}

/// Changes per unit of each quantity: of the standard uncertainty of each term, relative to it, and
/// of the shift by light from below the surface, in pixels.
type Slopes = (Vec<Vec<f64>>, Vec<f64>);

/// Returns the changes by each quantity, from differences over one standard uncertainty on both
/// sides.
fn slopes(
    setup: &Setup,
    height: f64,
    quantities: &[(SetupQuantity, Input)],
    terms: &[BudgetTerm],
) -> Result<Slopes, TriangulationError> {
    let mut slopes = vec![Vec::new(); terms.len()];
    let mut shifts = Vec::new();
    for (quantity, input) in quantities {
        let budget = |sign: f64| {
            let mut description = setup.exposed_description();
            quantity.set(
                &mut description,
                input.estimate() + sign * input.uncertainty(),
            );
            Budget::at_height(&Setup::new(description)?, height)
        };
        let (below, above) = (budget(-1.0)?, budget(1.0)?);
        shifts.push((shift(&above) - shift(&below)) / (2.0 * input.uncertainty()));
        for (slopes, term) in slopes.iter_mut().zip(terms) {
            let uncertainty = |budget: &Budget| {
                let term = budget.term(term.source);
                term.map_or(0.0, |term| term.uncertainty)
            };
            let [below, above] = [&below, &above].map(uncertainty);
            slopes.push((above - below) / (2.0 * input.uncertainty() * term.uncertainty));
        }
    }
    Ok((slopes, shifts))
}

/// Returns the shift of a line by light from below the surface, in pixels.
fn shift(budget: &Budget) -> f64 {
    budget.subsurface().map_or(0.0, |shift| shift.position)
}

#[cfg(test)]
mod tests;
