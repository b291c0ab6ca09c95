use super::{
    LineMethod, blais_rioux, gaussian_fit, gravity,
    profile::{Estimate, Profile},
    steger, three_point,
};

impl Profile<'_> {
    /// Estimates the position of the line, or returns `None` if the method fails.
    ///
    /// All methods count from the middle of the greatest pixel: an image that is moved by a pixel
    /// moves the position by just that.
    pub(super) fn estimate(&self, method: &LineMethod) -> Option<Estimate> {
        let position = match method {
            LineMethod::GaussianFit => return self.placed(gaussian_fit::fit(self)?),
            LineMethod::CentreOfGravity => gravity::plain(self),
            LineMethod::ThresholdedCentreOfGravity { threshold } => {
                gravity::thresholded(self, *threshold)
            }
            LineMethod::IteratedCentreOfGravity => gravity::iterated(self),
            LineMethod::Parabola => three_point::parabola(self),
            LineMethod::LogGaussian => three_point::log_gaussian(self),
            LineMethod::LinearInterpolation => three_point::linear(self),
            LineMethod::BlaisRioux { order } => blais_rioux::zero(self, *order),
            LineMethod::Steger { sigma } => steger::in_column(self, *sigma),
        };
        self.placed(Estimate {
            position: position?,
            width: None,
        })
    }
}
