use tem00_numerics::Grid;

/// Values as integers of 16 bits, as range cameras give them.
///
/// ```text
/// value = offset + scale · integer        for integers from 1 to 65535
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct QuantisedGrid {
    /// The integers; 0 where nothing was measured.
    pub integers: Grid<u16>,
    /// The value of the integer 0, in the unit of the values, if it were one.
    pub offset: f64,
    /// The step from one integer to the next, in the unit of the values, positive.
    pub scale: f64,
}

impl QuantisedGrid {
    /// Spreads the range of values over all integers; `None` where all are NaN.
    ///
    /// The error of a value is half a step, a 131068th of the range, and the rounding of `f32`.
    pub fn new(values: &Grid<f32>) -> Option<Self> {
        let [low, high] = range(values)?;
        // Equal values have any scale.
        let scale = if high > low {
            (high - low) / f64::from(u16::MAX - 1)
        } else {
            1.0
        };
        let offset = low - scale;
        let integers = values.map(|&value| {
            if value.is_nan() {
                return 0;
            }
            let steps = ((f64::from(value) - offset) / scale).round();
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between 1 and 65535"
            )]
            let integer = steps.clamp(1.0, f64::from(u16::MAX)) as u16;
            integer
        });
        Some(Self {
            integers,
            offset,
            scale,
        })
    }
}

/// The minimum and the maximum of values; `None` where all are NaN.
pub(crate) fn range(values: &Grid<f32>) -> Option<[f64; 2]> {
    let values = values.values().iter().filter(|value| !value.is_nan());
    values.fold(None, |range, &value| {
        let value = f64::from(value);
        let [low, high] = range.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}
