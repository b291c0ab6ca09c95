//! A height that is measured with a set-up whose quantities are uncertain.

use tem00_report::{failure::Failure, interrupt, progress::Progress};
use tem00_triangulation::{
    Budget, Measurement, MeasurementInput, Setup, SetupUncertainty, SimulationOptions,
    TriangulationError, VirtualExperiment,
};
use tem00_uncertainty::{
    CoverageInterval, CoverageProbability, Decomposition, DecompositionOptions, FirstOrder, Input,
    Propagation, PropagationOptions, Validation,
};

use crate::args::BudgetArgs;

/// The number of samples of the decomposition of the variance.
const SAMPLES: u32 = 1 << 15;
/// The maximum number of trials of the propagation of distributions: for a smooth distribution,
/// enough to make two digits stable.
const MAX_TRIALS: u64 = 2_000_000;

/// Returns whether the uncertainties of two methods differ: whether their ratio, with its standard
/// error, is farther from 1 than a twentieth and chance.
pub(super) fn differs([ratio, error]: [f64; 2]) -> bool {
    (ratio - 1.0).abs() > 0.05 + 3.3 * error
}

/// A height and its uncertainty by three methods.
pub(super) struct ThreeMethods {
    pub(super) measurement: Measurement,
    pub(super) first_order: FirstOrder,
    pub(super) propagation: Propagation,
    /// The decomposition of the variance; `None` with correlated inputs.
    pub(super) decomposition: Option<Decomposition>,
    /// The virtual experiment, unless trials were left out.
    pub(super) experiment: Option<VirtualExperiment>,
}

/// Result of a method.
pub(super) struct MethodAnswer {
    /// The height, in metres.
    pub(super) estimate: f64,
    /// Its standard uncertainty, in metres.
    pub(super) uncertainty: f64,
    /// The standard error of the uncertainty, in metres, where trials estimate it.
    pub(super) standard_error: Option<f64>,
    /// The interval of 95 %.
    pub(super) interval: CoverageInterval,
}

/// Method whose uncertainty is to be quoted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Quoted {
    FirstOrder,
    Propagation,
    VirtualExperiment,
}

impl Quoted {
    pub(super) const ALL: [Self; 3] =
        [Self::FirstOrder, Self::Propagation, Self::VirtualExperiment];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::FirstOrder => "law of propagation",
            Self::Propagation => "propagation of distributions",
            Self::VirtualExperiment => "virtual experiment",
        }
    }

    /// Returns the name in JSON.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::FirstOrder => "first_order",
            Self::Propagation => "propagation",
            Self::VirtualExperiment => "virtual_experiment",
        }
    }
}

impl ThreeMethods {
    /// Returns `None` for a set-up that is known exactly.
    pub(super) fn new(
        args: &BudgetArgs,
        setup: &Setup,
        uncertainty: &SetupUncertainty,
    ) -> Result<Option<Self>, Failure> {
        if !uncertainty.states_height() {
            return Ok(None);
        }
        let measured = Measurement::new(setup, uncertainty).and_then(|found| Self::of(args, found));
        measured.map(Some).map_err(|error| {
            let help = "smaller uncertainties, or limits by another `distribution`; --trials 0 \
                        leaves the virtual experiment out";
            crate::measuring(&args.common.setup, &error, help)
        })
    }

    fn of(args: &BudgetArgs, measurement: Measurement) -> Result<Self, TriangulationError> {
        let propagation = PropagationOptions {
            digits: 2,
            // What a validation of the first order asks for.
            tolerance_divisor: 5.0,
            max_trials: MAX_TRIALS,
            seed: args.seed,
            ..PropagationOptions::default()
        };
        let samples = DecompositionOptions {
            samples: SAMPLES,
            seed: args.seed,
        };
        let decomposed = || measurement.decomposition(samples);
        let is_independent = measurement.inputs().are_independent();
        Ok(Self {
            first_order: measurement.first_order()?,
            propagation: measurement.propagation(propagation)?,
            decomposition: is_independent.then(decomposed).transpose()?,
            experiment: (args.trials > 0)
                .then(|| tried(args, &measurement))
                .transpose()?,
            measurement,
        })
    }

    /// Returns the inputs with their estimates and uncertainties.
    pub(super) fn inputs(&self) -> impl Iterator<Item = (MeasurementInput, &Input)> {
        let sources = self.measurement.sources().iter().copied();
        sources.zip(self.measurement.inputs().as_slice())
    }

    /// Returns the standard uncertainty of the height by the values of the light from below the
    /// surface, in metres: of its correction.
    pub(super) fn subsurface(&self) -> f64 {
        let is_below = |input: MeasurementInput| match input {
            MeasurementInput::Quantity(quantity) => quantity.is_subsurface(),
            MeasurementInput::Term(_) => false,
        };
        let contributions = self.first_order.contributions().iter();
        let sources = self.measurement.sources().iter();
        let squares = contributions
            .zip(sources)
            .filter(|(_, source)| is_below(**source))
            .map(|(contribution, _)| contribution.uncertainty.powi(2));
        squares.sum::<f64>().sqrt()
    }

    /// Returns the answer of a method; `None` for a virtual experiment that was left out, or whose
    /// lines cannot be trusted.
    pub(super) fn answer(&self, method: Quoted) -> Option<MethodAnswer> {
        Some(match method {
            Quoted::FirstOrder => MethodAnswer {
                estimate: self.first_order.estimate(),
                uncertainty: self.first_order.combined(),
                standard_error: None,
                interval: self.first_order.interval(CoverageProbability::P95),
            },
            Quoted::Propagation => self.answer_by_distributions(),
            Quoted::VirtualExperiment => {
                let found = self.experiment?;
                let error = found.error?;
                MethodAnswer {
                    estimate: found.mean,
                    uncertainty: error.uncertainty,
                    standard_error: Some(error.standard_error),
                    interval: found.interval?,
                }
            }
        })
    }

    /// Returns the answer of the method to quote.
    pub(super) fn quoted_answer(&self) -> MethodAnswer {
        let answer = self.answer(self.quoted());
        answer.unwrap_or_else(|| self.answer_by_distributions())
    }

    fn answer_by_distributions(&self) -> MethodAnswer {
        MethodAnswer {
            estimate: self.propagation.estimate(),
            uncertainty: self.propagation.uncertainty(),
            standard_error: None,
            interval: self.propagation.interval(),
        }
    }

    /// Returns the pairs of inputs that are correlated, with their coefficients.
    pub(super) fn correlations(&self) -> impl Iterator<Item = ([MeasurementInput; 2], f64)> {
        let (inputs, sources) = (self.measurement.inputs(), self.measurement.sources());
        let pairs =
            (0..sources.len()).flat_map(|first| (0..first).map(move |second| [second, first]));
        pairs
            .map(|pair| {
                (
                    pair.map(|index| sources[index]),
                    inputs.correlation(pair[0], pair[1]),
                )
            })
            .filter(|(_, coefficient)| *coefficient != 0.0)
    }

    /// Returns whether the trials of distributions were enough for two digits.
    pub(super) fn is_stable(&self) -> bool {
        self.propagation.largest_error() <= self.validation().tolerance
    }

    /// Compares the law of propagation with the propagation of distributions.
    pub(super) fn validation(&self) -> Validation {
        self.propagation.validate(&self.first_order)
    }

    /// Returns the ratio of the uncertainty in the virtual experiment to the uncertainty by
    /// distributions, and its standard error.
    pub(super) fn ratio(&self) -> Option<[f64; 2]> {
        let error = self.experiment?.error?;
        let by_distributions = self.propagation.uncertainty();
        Some([error.uncertainty, error.standard_error].map(|found| found / by_distributions))
    }

    /// Returns the fractions of the variance of the height that its inputs contribute: in the
    /// trials of distributions, or by the law of propagation where that is quoted or inputs are
    /// correlated.
    pub(super) fn parts(&self) -> Vec<(MeasurementInput, f64)> {
        let by_trials = self
            .decomposition
            .as_ref()
            .filter(|_| self.quoted() != Quoted::FirstOrder);
        let parts: Vec<f64> = match by_trials {
            Some(found) => found.inputs().iter().map(|part| part.total.value).collect(),
            None => {
                let contributions = self.first_order.contributions().iter();
                contributions.map(|part| part.variance_fraction).collect()
            }
        };
        let sources = self.measurement.sources().iter().copied();
        sources.zip(parts).collect()
    }

    /// Returns whether the line is so thin that formulas of its noise do not hold, and that noise
    /// counts: for a twentieth of the variance.
    pub(super) fn is_thin(&self) -> bool {
        let sources = self.measurement.sources().iter();
        let noise = sources
            .zip(self.first_order.contributions())
            .filter(|(source, _)| matches!(source, MeasurementInput::Term(_)));
        let part: f64 = noise.map(|(_, part)| part.variance_fraction).sum();
        part > 0.05 && self.measurement.speckles() < Budget::LEAST_SPECKLES
    }

    /// Returns the method to quote: the first that neither the line nor the next one contradicts.
    pub(super) fn quoted(&self) -> Quoted {
        if self
            .ratio()
            .is_some_and(|ratio| self.is_thin() || differs(ratio))
        {
            Quoted::VirtualExperiment
        } else if self.validation().is_valid() {
            Quoted::FirstOrder
        } else {
            Quoted::Propagation
        }
    }
}

fn tried(
    args: &BudgetArgs,
    measurement: &Measurement,
) -> Result<VirtualExperiment, TriangulationError> {
    let bar = Progress::of(args.trials.into(), "trials");
    bar.name("measuring".into());
    let options = SimulationOptions {
        trials: args.trials,
        seed: args.seed,
    };
    measurement.virtual_experiment(options, &|_| bar.advance(1), interrupt::flag())
}
