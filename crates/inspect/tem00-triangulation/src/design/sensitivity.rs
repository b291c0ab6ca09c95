use super::{DesignFigures, DesignParameter};
use crate::SetupDescription;

/// Figures of a set-up when one of its parameters is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbours {
    /// The parameter.
    pub parameter: DesignParameter,
    /// The figures with less of it, or `None` if that is not possible.
    pub less: Option<DesignFigures>,
    /// The figures with more of it, or `None` if that is not possible.
    pub more: Option<DesignFigures>,
}

/// Returns the figures of a set-up when each of its parameters, one at a time, is smaller and greater
/// by a part of itself: 0.1 for ±10 %. Those that are 0 are left out: a linewidth.
pub fn neighbours(description: &SetupDescription, part: f64) -> Vec<Neighbours> {
    let changed = |parameter: DesignParameter, factor: f64| {
        let value = factor * parameter.value_in(description);
        DesignFigures::evaluate(&parameter.set(description, value)).ok()
    };
    DesignParameter::ALL
        .into_iter()
        .filter(|parameter| parameter.value_in(description) > 0.0)
        .map(|parameter| Neighbours {
            parameter,
            less: changed(parameter, 1.0 - part),
            more: changed(parameter, 1.0 + part),
        })
        .collect()
}
