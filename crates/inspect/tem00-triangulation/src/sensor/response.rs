use super::Sensor;

/// The variance of the error of rounding to whole grey values, in DN².
const QUANTISATION: f64 = 1.0 / 12.0;

/// Predictions of the linear model, for the mean number `electrons` that light frees in a pixel.
impl Sensor {
    /// Returns the mean grey value `y₀ + K (μ_e + μ_I t)`, in DN, below saturation.
    pub fn mean_grey_value(&self, electrons: f64) -> f64 {
        let d = self.description();
        d.black_level + d.gain * (electrons + self.dark_electrons())
    }

    /// Returns the temporal variance of the grey value, in DN², below saturation.
    ///
    /// ```text
    /// σ_y² = K² (σ_d² + μ_e + μ_I t) + 1/12
    /// ```
    pub fn temporal_variance(&self, electrons: f64) -> f64 {
        let d = self.description();
        let counted = d.dark_noise * d.dark_noise + electrons + self.dark_electrons();
        d.gain * d.gain * counted + QUANTISATION
    }

    /// Returns the variance of the mean grey value from pixel to pixel, in DN².
    ///
    /// ```text
    /// s_y² = K² (DSNU² + PRNU² μ_e²)
    /// ```
    pub fn spatial_variance(&self, electrons: f64) -> f64 {
        let d = self.description();
        let response = d.prnu * electrons;
        d.gain * d.gain * (d.dsnu * d.dsnu + response * response)
    }

    /// Returns the signal-to-noise ratio `K μ_e / σ_y` of one pixel over time.
    pub fn signal_to_noise_ratio(&self, electrons: f64) -> f64 {
        self.description().gain * electrons / self.temporal_variance(electrons).sqrt()
    }

    /// Returns the mean number of electrons that light frees when a pixel is saturated: when its
    /// well is full or its grey value the largest, whichever comes first. It is 0 if darkness
    /// saturates it.
    pub fn saturation_electrons(&self) -> f64 {
        let d = self.description();
        let digital = (d.largest_value() - d.black_level) / d.gain;
        (d.full_well.min(digital) - self.dark_electrons()).max(0.0)
    }

    /// Returns the irradiance on the sensor at saturation, in W/m², at a vacuum wavelength in
    /// metres.
    pub fn saturation_irradiance(&self, wavelength: f64) -> f64 {
        self.saturation_electrons() / self.electrons(1.0, wavelength)
    }

    /// Returns the absolute sensitivity threshold: the mean number of electrons at which the
    /// signal-to-noise ratio is 1.
    ///
    /// ```text
    /// μ_e² = μ_e + σ²    ⇒    μ_e = ½ + √(¼ + σ²)      with σ² = σ_d² + μ_I t + 1/(12 K²)
    /// ```
    pub fn threshold_electrons(&self) -> f64 {
        let gain = self.description().gain;
        0.5 + (0.25 + self.temporal_variance(0.0) / (gain * gain)).sqrt()
    }

    /// Returns the dynamic range: saturation over the absolute sensitivity threshold.
    pub fn dynamic_range(&self) -> f64 {
        self.saturation_electrons() / self.threshold_electrons()
    }

    /// Returns the grey value from which on a pixel may be saturated, in DN: the grey value of a
    /// full well minus three standard deviations of dark noise and DSNU, or the largest grey value
    /// if that is less.
    ///
    /// The level is for code that has only grey values;
    /// [`RawFrame::saturated`](crate::RawFrame::saturated) marks the saturated pixels.
    pub fn saturation_level(&self) -> f64 {
        let d = self.description();
        let spread = 3.0 * d.dark_noise.hypot(d.dsnu);
        let level = d.black_level + d.gain * (d.full_well - spread).max(0.0);
        level.min(d.largest_value())
    }
}
