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
        let at = |offset: f64| Estimate {
            position: offset,
            width: None,
        };
        let offset = match method {
            LineMethod::CentreOfGravity => gravity::plain(self).map(at),
            LineMethod::ThresholdedCentreOfGravity { threshold } => {
                gravity::thresholded(self, *threshold).map(at)
            }
            LineMethod::IteratedCentreOfGravity => gravity::iterated(self).map(at),
            LineMethod::Parabola => three_point::parabola(self).map(at),
            LineMethod::LogGaussian => three_point::log_gaussian(self).map(at),
            LineMethod::LinearInterpolation => three_point::linear(self).map(at),
            LineMethod::BlaisRioux { order } => blais_rioux::zero(self, *order).map(at),
            LineMethod::GaussianFit => gaussian_fit::fit(self),
            LineMethod::Steger { sigma } => steger::in_column(self, *sigma).map(at),
        };
        self.placed(offset?)
    }
}
