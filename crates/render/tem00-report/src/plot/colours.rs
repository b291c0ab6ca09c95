//! The meanings of colours: one colour has one meaning in all diagrams of a report.

/// A colour on white paper, and the colour with the same meaning on a dark screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour {
    pub light: &'static str,
    pub dark: &'static str,
}

macro_rules! colours {
    ($($(#[$doc:meta])* $name:ident = $light:literal, $dark:literal;)*) => {
        $($(#[$doc])* pub const $name: Colour = Colour { light: $light, dark: $dark };)*

        /// List of all colours.
        pub const ALL: &[Colour] = &[$($name),*];
    };
}

colours! {
    /// Colour of the combined uncertainty.
    COMBINED = "#202020", "#e8e8e8";
    SPECKLE = "#1f5fa8", "#6fabe8";
    SHOT_NOISE = "#d2701a", "#f0a050";
    DARK_NOISE = "#2a8a5a", "#55c48a";
    QUANTISATION = "#a03040", "#e87a8a";
    PRNU = "#7a4fa0", "#b890e0";
    DSNU = "#18a0b0", "#4fd0e0";
    DETECTOR_BIAS = "#8a6030", "#c8a070";
    CALIBRATION = "#8a8a20", "#c8c850";
    /// A source without its own colour.
    OTHER = "#808080", "#a0a0a0";
    /// Uncertainties by formulas.
    FORMULAS = "#55606e", "#a8b4c2";
    /// Uncertainties by trials.
    TRIALS = "#c9960c", "#f0c850";
    /// Set-ups that keep every constraint.
    KEPT = "#3f4a8a", "#98a4ee";
    /// Set-ups that break a constraint.
    BROKEN = "#b8bec6", "#565c66";
    /// Set-ups than which no other is better.
    FRONT = "#d6249f", "#ff70cc";
    /// Less of a parameter.
    LESS = "#e0a030", "#f5c060";
    /// More of a parameter.
    MORE = "#b05a8a", "#e090bc";
    /// Heights.
    HEIGHT = "#b4532a", "#e8895c";
    /// Uncertainties of heights.
    UNCERTAINTY = "#2f6fb8", "#79b4f0";
    /// Values measured in an image, in all directions.
    MEASURED = "#1d6f9f", "#60b4e4";
    ALONG_X = "#2e7d32", "#7cc480";
    ALONG_Y = "#c2571a", "#f09a60";
    THEORY = "#101010", "#f0f0f0";
    FITTED = "#9c2c4c", "#e4809c";
}

/// The colour of cells without a value.
pub(super) const HOLE: &str = "#ffffff";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_colour_is_unlike_all_others() {
        for (index, a) in ALL.iter().enumerate() {
            for b in &ALL[..index] {
                assert!(a.light != b.light && a.dark != b.dark, "{a:?}, {b:?}");
            }
        }
    }
}
