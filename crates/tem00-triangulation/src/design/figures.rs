use tem00_beam::GaussianBeam;

use crate::{
    BandwidthEffect, Budget, HeightRange, Setup, SetupDescription, TriangulationError,
    UncertaintySource,
};

/// Figures of a set-up that searches compare.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignFigures {
    /// The combined standard uncertainty of a height on the reference plane, in metres.
    pub uncertainty: f64,
    /// The expanded uncertainty of a height on the reference plane, in metres.
    pub expanded_uncertainty: f64,
    /// The contribution of each source to the standard uncertainty, in metres.
    pub contributions: Vec<(UncertaintySource, f64)>,
    /// The source that contributes most.
    pub dominant: UncertaintySource,
    /// The length of the range of heights that can be measured, in metres: they are seen, and within
    /// the depth of field.
    pub range: f64,
    /// The depth of field of camera and laser line together, in metres of height: there the image is
    /// at most √2 times as wide as in focus, and the line on the part at most √2 times as wide as at
    /// its waist on the reference plane.
    pub depth_of_field: f64,
    /// The width of the field, in metres.
    pub field_width: f64,
    /// The power in the line, in watts.
    pub power: f64,
    /// The exposure time, in seconds.
    pub exposure: f64,
    /// The mean of the brightest pixel as a part of what the sensor can hold.
    pub saturation: f64,
    /// The bright grains of speckle as a part of what the sensor can hold; see
    /// [`Setup::grain_saturation`].
    pub grain_saturation: f64,
    /// The mean of the brightest pixel by its noise in the dark; see [`Setup::signal`].
    pub signal: f64,
    /// The full width of the line in the image between the points of 1/e², in pixels.
    pub imaged_width: f64,
    /// The speckle size along rows and columns, in pixels.
    pub speckle_size: [f64; 2],
    /// What the linewidth of the laser makes of speckle.
    pub bandwidth: BandwidthEffect,
}

impl DesignFigures {
    /// Returns the figures of a set-up.
    ///
    /// The laser line is a Gaussian beam across, its waist on the reference plane and as wide as the
    /// line is thick: diffraction makes a fine line spread within its Rayleigh range, which ends the depth of
    /// field where the lens does not.
    ///
    /// ```text
    /// |z| ≤ z_R = π w₀² / λ      w₀ = line_thickness / 2
    /// ```
    ///
    /// # Errors
    ///
    /// Returns an error if the set-up is not possible, if its line is too fine to be a beam at all, or
    /// the errors of [`Budget::new`].
    pub fn evaluate(description: &SetupDescription) -> Result<Self, TriangulationError> {
        let setup = Setup::new(description.clone())?;
        let waist = waist_range(description)?;
        let in_focus = setup.depth_of_field();
        let budget = Budget::new(&setup)?;
        Ok(Self {
            uncertainty: budget.combined(),
            expanded_uncertainty: budget.expanded(),
            contributions: budget
                .terms()
                .iter()
                .map(|term| (term.source, term.contribution()))
                .collect(),
            dominant: budget.dominant().source,
            range: shared(&[setup.seen_range(), in_focus, waist]),
            depth_of_field: shared(&[in_focus, waist]),
            field_width: setup.field_width(),
            power: description.laser.power,
            exposure: setup.description().sensor.exposure_time,
            saturation: setup.saturation(),
            grain_saturation: setup.grain_saturation(),
            signal: setup.signal(),
            imaged_width: setup.line().width,
            speckle_size: setup.line().speckle_size,
            bandwidth: setup.line().bandwidth,
        })
    }
}

/// Returns the heights at which the laser line is at most √2 times as wide as on the reference plane.
fn waist_range(description: &SetupDescription) -> Result<HeightRange, TriangulationError> {
    let laser = &description.laser;
    let beam = GaussianBeam::from_waist(laser.light.wavelength, 0.5 * laser.line_thickness);
    let beam = beam.map_err(|_| TriangulationError::OutOfRange {
        parameter: "line_thickness",
        value: laser.line_thickness,
        allowed: "at least 4 λ / π: a finer line is no beam",
    })?;
    let rayleigh_range = beam.rayleigh_range();
    Ok(HeightRange {
        low: -rayleigh_range,
        high: rayleigh_range,
    })
}

/// Returns the length of what ranges share, 0 if that is nothing.
fn shared(ranges: &[HeightRange]) -> f64 {
    let low = ranges
        .iter()
        .map(|range| range.low)
        .fold(f64::MIN, f64::max);
    let high = ranges
        .iter()
        .map(|range| range.high)
        .fold(f64::MAX, f64::min);
    (high - low).max(0.0)
}
