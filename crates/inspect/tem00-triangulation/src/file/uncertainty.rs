use tem00_config::{Document, LENGTH, NUMBER, Problem, Section, Value, nearest};
use tem00_numerics::Refusal;
use tem00_uncertainty::{Correlation, Distribution, Input, Inputs, UncertaintyError};

use crate::{HeightRange, Setup, SetupQuantity, SetupUncertainty, TriangulationError};

const BUDGET: &[&str] = &["height"];
const CORRELATION: &[&str] = &["between", "coefficient"];

/// Reads the uncertain quantities of a set-up from its file.
///
/// ```toml
/// [camera]
/// angle = { value = "30 deg", uncertainty = "0.05 deg" }
/// distance = { value = "300 mm", uncertainty = "0.2 mm", degrees_of_freedom = 8 }
///
/// [[correlation]]                    # of normal quantities
/// between = ["camera.angle", "camera.distance"]
/// coefficient = 0.5
///
/// [budget]
/// height = "5 mm"                    # the greatest of the measuring range without it
/// ```
///
/// An uncertainty of 0 is as good as none. A normal value with degrees of freedom has a t
/// distribution.
///
/// # Errors
///
/// Returns a problem, placed in the file, if a table has a key that is not allowed, or a value that
/// is not possible.
pub fn read_uncertainty(
    document: &Document<'_>,
    setup: &Setup,
) -> Result<SetupUncertainty, Problem> {
    let mut quantities = Vec::new();
    for &quantity in SetupQuantity::ALL {
        quantities.extend(read_quantity(document, setup, quantity)?);
    }
    let budget = document.table("budget", BUDGET)?;
    Ok(SetupUncertainty {
        height: budget.map_or(Ok(None), |section| read_height(&section, setup))?,
        correlations: read_correlations(document, &quantities)?,
        quantities,
    })
}

fn read_height(section: &Section<'_>, setup: &Setup) -> Result<Option<f64>, Problem> {
    let Some(value) = section.optional("height") else {
        return Ok(None);
    };
    let HeightRange { low, high } = setup.measuring_range();
    let [from, to] = [low, high].map(|end| format!("{:.4} mm", 1e3 * end));
    let allowed = format!("within the measuring range, from {from} to {to}");
    value.within(&LENGTH, low..=high, &allowed).map(Some)
}

fn read_quantity(
    document: &Document<'_>,
    setup: &Setup,
    quantity: SetupQuantity,
) -> Result<Option<(SetupQuantity, Input)>, Problem> {
    let [section, key] = quantity.path();
    let Some(section) = document.table(section, SetupQuantity::keys_of_section(section))? else {
        return Ok(None);
    };
    let Some(table) = section.uncertain(key)? else {
        return Ok(None);
    };
    table.required("value", "the best estimate")?;
    let uncertainty = table.required("uncertainty", "a standard uncertainty")?;
    let uncertainty = uncertainty.within(quantity.unit().dimension, 0.0.., "at least 0")?;
    let shapes = Distribution::ALL.map(|shape| (shape.name(), shape));
    let shape = table.or("distribution", Distribution::Normal, |value| {
        value.one_of(&shapes)
    })?;
    let freedom = match shape {
        Distribution::StudentT => Some(table.required("degrees_of_freedom", "8")?),
        _ => table.optional("degrees_of_freedom"),
    };
    let freedom = freedom.map_or(Ok(f64::INFINITY), |value| value.quantity(&NUMBER))?;
    if uncertainty == 0.0 {
        return Ok(None);
    }
    let rejected = |error: UncertaintyError| table.problem_with(error.parameter(), error);
    let estimate = quantity.value_in(setup.description());
    let input = Input::new(estimate, uncertainty, shape).map_err(rejected)?;
    let input = input.with_degrees_of_freedom(freedom).map_err(rejected)?;
    if input.standard_deviation().is_infinite() {
        let message = format!(
            "`degrees_of_freedom` must be above 2, got {freedom}: a t distribution of fewer has no \
             variance; pool more readings, or state another `distribution`"
        );
        return Err(table.problem_with("degrees_of_freedom", message));
    }
    for (side, value) in [
        ("below", estimate - uncertainty),
        ("above", estimate + uncertainty),
    ] {
        let mut description = setup.exposed_description();
        quantity.set(&mut description, value);
        Setup::new(description).map_err(|error| impossible(&table, side, &error))?;
    }
    Ok(Some((quantity, input)))
}

/// The problem that there is no set-up one standard uncertainty on a side of the value.
fn impossible(table: &Section<'_>, side: &str, error: &TriangulationError) -> Problem {
    let wanted = match error {
        TriangulationError::Refused(Refusal {
            parameter, allowed, ..
        }) => format!("{parameter} must be {allowed}"),
        error => error.to_string(),
    };
    let message = format!("one `uncertainty` {side} its value, {wanted}");
    table.problem_with("uncertainty", message)
}

fn read_correlations(
    document: &Document<'_>,
    quantities: &[(SetupQuantity, Input)],
) -> Result<Vec<Correlation>, Problem> {
    let mut correlations = Vec::new();
    let sections = document.tables("correlation", CORRELATION)?;
    for section in &sections {
        let example = "[\"camera.angle\", \"camera.distance\"]";
        let between = section.required("between", example)?;
        let [first, second] = between.elements(&format!(
            "two names of uncertain quantities, such as {example}"
        ))?;
        let positions = [
            position(&first, quantities)?,
            position(&second, quantities)?,
        ];
        let coefficient = section.required("coefficient", "0.5")?;
        correlations.push(Correlation {
            between: positions,
            coefficient: coefficient.within(&NUMBER, -1.0..=1.0, "from -1 to 1")?,
        });
        let is_all = correlations.len() == sections.len();
        check(section, quantities, (&correlations, is_all))?;
    }
    Ok(correlations)
}

/// Returns the position of a name among the uncertain quantities.
fn position(name: &Value<'_>, quantities: &[(SetupQuantity, Input)]) -> Result<usize, Problem> {
    let text = name.string()?;
    let names: Vec<String> = quantities
        .iter()
        .map(|(quantity, _)| quantity.to_string())
        .collect();
    if let Some(position) = names.iter().position(|known| known == text) {
        return Ok(position);
    }
    let names: Vec<&str> = names.iter().map(String::as_str).collect();
    let allowed = match nearest(text, &names) {
        Some(meant) => format!("an uncertain quantity of this set-up; did you mean \"{meant}\"?"),
        None => "an uncertain quantity of this set-up".to_owned(),
    };
    Err(name
        .must_be(allowed)
        .with_help(format!("uncertain are: {}", names.join(", "))))
}

/// Checks the last of the correlations so far; only all of them are held to be possible together.
fn check(
    section: &Section<'_>,
    quantities: &[(SetupQuantity, Input)],
    (correlations, is_all): (&[Correlation], bool),
) -> Result<(), Problem> {
    let inputs = quantities.iter().map(|(_, input)| *input).collect();
    let Err(error) = Inputs::correlated(inputs, correlations) else {
        return Ok(());
    };
    let message = match &error {
        UncertaintyError::NotNormal { input } => {
            let (quantity, _) = quantities[*input];
            format!(
                "`between` must name normal quantities without degrees of freedom, {quantity} is \
                 none"
            )
        }
        UncertaintyError::Contradiction { .. } if !is_all => return Ok(()),
        UncertaintyError::Contradiction { .. } => {
            "`coefficient` contradicts other correlations: their matrix is not positive \
             semi-definite"
                .into()
        }
        UncertaintyError::Between { .. } => "`between` must name two different quantities".into(),
        UncertaintyError::Repeated { .. } => "`between` names two quantities a second time".into(),
        error => error.to_string(),
    };
    let key = match error {
        UncertaintyError::Contradiction { .. } => "coefficient",
        _ => "between",
    };
    Err(section.problem_with(key, message))
}

#[cfg(test)]
mod tests;
