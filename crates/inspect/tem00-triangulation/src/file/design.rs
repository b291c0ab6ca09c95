use std::sync::LazyLock;

use tem00_config::{Dimension, Document, Problem, Section, Value};

use crate::{
    Constraint, DesignFigure, DesignQuestion, DesignSearch, Objective, SetupDescription,
    SetupQuantity, Spacing, Sweep, TriangulationError,
};

const KEYS: &[&str] = &["objective", "max_setups", "vary", "require"];
static VARY: LazyLock<Vec<&str>> = LazyLock::new(|| {
    SetupQuantity::varied()
        .into_iter()
        .map(SetupQuantity::key)
        .collect()
});
const RANGE: &[&str] = &["from", "to", "steps", "scale"];
const REQUIRE: &[&str] = &DesignFigure::NAMES;

/// The maximum number of set-ups that are tried if the file gives no number.
const MAX_SETUPS: u64 = 20_000;

/// Reads the section `[design]` of a set-up file: a search that begins with the set-up.
///
/// ```toml
/// [design]
/// objective = "uncertainty"      # or "expanded_uncertainty"
///
/// [design.vary]                  # lists, or ranges with both ends
/// f_number = { from = 4, to = 16, steps = 5, scale = "log" }
/// angle = ["20 deg", "30 deg", "45 deg"]
///
/// [design.require]               # at least range, depth_of_field, field_width; at most the others
/// range = "20 mm"
/// saturation = 0.9
/// ```
///
/// Where the file does not bound the light, [`Constraint::LIGHT`] does.
///
/// # Errors
///
/// Returns a problem, placed in the file, if the section is missing, has a key that is not allowed,
/// or a value that is not possible; or if there are more combinations than allowed.
pub fn read_design(
    document: &Document<'_>,
    base: &SetupDescription,
) -> Result<DesignSearch, Problem> {
    let section = document.table("design", KEYS)?.ok_or_else(|| {
        let help = "for example `f_number = [4, 8, 16]` below the line `[design.vary]`";
        Problem::new("the set-up has no section [design] to search by").with_help(help)
    })?;
    let objectives = [
        ("uncertainty", Objective::Uncertainty),
        ("expanded_uncertainty", Objective::ExpandedUncertainty),
    ];
    let max = DesignSearch::MAX_SETUPS as u64;
    let max_setups = section.or("max_setups", MAX_SETUPS, |value| value.integer(1..=max))?;
    let question = DesignQuestion {
        base: base.clone(),
        sweeps: sweeps(&section)?,
        constraints: constraints(&section)?,
        objective: section.or("objective", Objective::default(), |value| {
            value.one_of(&objectives)
        })?,
        max_setups: usize::try_from(max_setups).unwrap_or(DesignSearch::MAX_SETUPS),
    };
    DesignSearch::new(question).map_err(|error| section.problem_with("vary", error))
}

fn sweeps(section: &Section<'_>) -> Result<Vec<Sweep>, Problem> {
    let Some(vary) = section.table("vary", &VARY)? else {
        let message = "[design] needs the section [design.vary], with what is varied";
        return Err(section.problem(message));
    };
    let given = SetupQuantity::varied().into_iter();
    given
        .filter_map(|parameter| Some((parameter, vary.optional(parameter.key())?)))
        .map(|(parameter, value)| sweep(&vary, parameter, &value))
        .collect()
}

fn sweep(
    vary: &Section<'_>,
    parameter: SetupQuantity,
    value: &Value<'_>,
) -> Result<Sweep, Problem> {
    let dimension = parameter.unit().dimension;
    let name = parameter.key();
    if let Some(range) = value
        .is_table()
        .then(|| vary.table(name, RANGE))
        .transpose()?
    {
        return match range {
            Some(range) => between(&range, parameter),
            None => Err(value.must_be(ALLOWED)),
        };
    }
    let values = value.list(ALLOWED)?;
    let values: Result<Vec<_>, _> = values
        .iter()
        .map(|value| value.positive(dimension))
        .collect();
    Sweep::list(parameter, values?).map_err(|_| value.must_be(ALLOWED))
}

const ALLOWED: &str = "a list of values, or a range such as { from = 4, to = 16, steps = 5 }";

fn between(range: &Section<'_>, parameter: SetupQuantity) -> Result<Sweep, Problem> {
    let end = |key, dimension: &Dimension| {
        let example = if key == "from" { "4" } else { "16" };
        range.required(key, example)?.positive(dimension)
    };
    let ends = (
        end("from", parameter.unit().dimension)?,
        end("to", parameter.unit().dimension)?,
    );
    let steps = range.required("steps", "5")?.integer(2..=10_000)?;
    let scales = [("linear", Spacing::Linear), ("log", Spacing::Logarithmic)];
    let spacing = range.or("scale", Spacing::Linear, |value| value.one_of(&scales))?;
    // From 2 to 10000.
    let steps = u32::try_from(steps).unwrap_or(0);
    Sweep::between(parameter, ends, steps, spacing)
        .map_err(|error: TriangulationError| range.problem_with("steps", error))
}

fn constraints(section: &Section<'_>) -> Result<Vec<Constraint>, Problem> {
    let require = section.table("require", REQUIRE)?;
    let given = |figure: DesignFigure| require.as_ref()?.optional(figure.name());
    let usual = |figure| {
        Constraint::LIGHT
            .into_iter()
            .find(|light| light.figure == figure)
    };
    let mut constraints = Vec::new();
    for figure in DesignFigure::ALL {
        match given(figure) {
            Some(value) => constraints.push(Constraint {
                figure,
                bound: value.positive(figure.unit().dimension)?,
            }),
            None => constraints.extend(usual(figure)),
        }
    }
    Ok(constraints)
}

#[cfg(test)]
mod tests;
