use tem00_config::{Choice, NUMBER, Problem, Section, rejected};
use tem00_tracer::{Filter, FilterSampler};

const KEYS: &[&str] = &["box", "gaussian"];
const FILTERS: &[Choice] = &[
    ("box", &["radius"]),
    ("gaussian", &["radius", "standard_deviation"]),
];

/// The filters by name, with the parameters that they usually have.
const USUAL: &[(&str, Filter)] = &[
    ("box", Filter::Box { radius: 0.5 }),
    (
        "gaussian",
        Filter::Gaussian {
            radius: 1.5,
            standard_deviation: 0.5,
        },
    ),
];

/// Reads a reconstruction filter: its name, or a table with its parameters.
pub(crate) fn read(render: &Section<'_>) -> Result<Filter, Problem> {
    let Some(value) = render.optional("filter") else {
        return Ok(Filter::default());
    };
    if !value.is_table() {
        return value.one_of(USUAL);
    }
    let Some(table) = render.table("filter", KEYS)? else {
        return Ok(Filter::default());
    };
    let (name, section) = table.one_of("kernel", FILTERS)?;
    let usual = USUAL.iter().find(|(usual, _)| *usual == name);
    let filter = with_parameters(
        usual.map(|(_, filter)| *filter).unwrap_or_default(),
        &section,
    )?;
    match FilterSampler::new(filter) {
        Ok(sampler) => Ok(sampler.filter()),
        Err(error) => Err(rejected(&error, error.parameter(), &[&section])),
    }
}

fn with_parameters(filter: Filter, section: &Section<'_>) -> Result<Filter, Problem> {
    let number = |key, default| section.or(key, default, |value| value.quantity(&NUMBER));
    let radius = number("radius", filter.radius())?;
    Ok(match filter {
        Filter::Box { .. } => Filter::Box { radius },
        Filter::Gaussian {
            standard_deviation, ..
        } => Filter::Gaussian {
            radius,
            standard_deviation: number("standard_deviation", standard_deviation)?,
        },
    })
}
