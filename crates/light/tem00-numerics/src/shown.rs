use core::fmt;

/// A number formatted for messages: the shortest form that parses back, with an exponent below 1e-4
/// and from 1e7.
///
/// # Examples
///
/// ```
/// use tem00_numerics::Shown;
///
/// assert_eq!(Shown(0.25).to_string(), "0.25");
/// assert_eq!(Shown(6.5e-7).to_string(), "6.5e-7");
/// assert_eq!(Shown(-1e30).to_string(), "-1e30");
/// assert_eq!(Shown(f64::NAN).to_string(), "NaN");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Shown(pub f64);

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value) = self;
        if *value == 0.0 || (1e-4..1e7).contains(&value.abs()) {
            write!(f, "{value}")
        } else {
            write!(f, "{value:e}")
        }
    }
}
