use crate::{
    BandwidthEffect, Budget, Setup, SetupDescription, SubsurfaceShift, TriangulationError,
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
    /// The length of the [measuring range](Setup::measuring_range), in metres.
    pub range: f64,
    /// The length of the [depth of field](Setup::depth_of_field) of camera and laser line together,
    /// in metres of height.
    pub depth_of_field: f64,
    /// The width of the field, in metres.
    pub field_width: f64,
    /// The power in the line, in watts.
    pub power: f64,
    /// The exposure time, in seconds.
    pub exposure: f64,
    /// The mean of the brightest pixel as a fraction of what the sensor can hold.
    pub saturation: f64,
    /// The bright grains of speckle as a fraction of what the sensor can hold; see
    /// [`Setup::grain_saturation`].
    pub grain_saturation: f64,
    /// The mean of the brightest pixel divided by its noise in the dark; see [`Setup::signal`].
    pub signal: f64,
    /// The full width of the line in the image between the points of 1/e², in pixels.
    pub imaged_width: f64,
    /// The full width of the line in speckles; see [`Budget::LEAST_SPECKLES`].
    pub speckles: f64,
    /// The speckle size along rows and columns, in pixels.
    pub speckle_size: [f64; 2],
    /// Effect of the laser's linewidth on speckle.
    pub bandwidth: BandwidthEffect,
    /// The shift of the line by light from below the surface, which is corrected; `None` on a part
    /// that lets no light in.
    pub subsurface: Option<SubsurfaceShift>,
}

impl DesignFigures {
    /// Returns the figures of a set-up.
    ///
    /// # Errors
    ///
    /// Returns an error if the set-up is not possible, or the errors of [`Budget::new`].
    pub fn evaluate(description: &SetupDescription) -> Result<Self, TriangulationError> {
        let setup = Setup::new(description.clone())?;
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
            range: setup.measuring_range().length(),
            depth_of_field: setup.depth_of_field().length(),
            field_width: setup.field_width(),
            power: description.laser.power,
            exposure: setup.description().sensor.exposure_time,
            saturation: setup.saturation(),
            grain_saturation: setup.grain_saturation(),
            signal: setup.signal(),
            imaged_width: setup.line().width,
            speckles: budget.speckles(),
            speckle_size: setup.line().speckle_size,
            bandwidth: setup.line().bandwidth,
            subsurface: budget.subsurface(),
        })
    }
}
