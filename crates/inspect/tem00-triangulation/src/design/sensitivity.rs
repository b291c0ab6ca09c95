use super::DesignFigures;
use crate::{SetupDescription, SetupQuantity};

/// Figures of a set-up when one of its parameters is off.
#[derive(Clone, Debug, PartialEq)]
pub struct Neighbours {
    /// The parameter.
    pub parameter: SetupQuantity,
    /// The figures with less of it, or `None` if that is not possible.
    pub less: Option<DesignFigures>,
    /// The figures with more of it, or `None` if that is not possible.
    pub more: Option<DesignFigures>,
}

/// Returns the figures of a set-up when each of its parameters, one at a time, is smaller and
/// greater by the fraction `part` of itself: 0.1 for ±10 %. Parameters that are 0, such as a
/// linewidth, are left out.
pub fn neighbours(description: &SetupDescription, part: f64) -> Vec<Neighbours> {
    let changed = |parameter: SetupQuantity, factor: f64| {
        let mut changed = description.clone();
        parameter.set(&mut changed, factor * parameter.value_in(description));
        DesignFigures::evaluate(&changed).ok()
    };
    SetupQuantity::varied()
        .into_iter()
        .filter(|parameter| parameter.value_in(description) > 0.0)
        .map(|parameter| Neighbours {
            parameter,
            less: changed(parameter, 1.0 - part),
            more: changed(parameter, 1.0 + part),
        })
        .collect()
}
