use std::fmt::{Debug, Display};

/// Table of the arguments that a constructor refuses.
///
/// The defaults make a valid object. Each row names an argument, or a field of one, with bad
/// values: each alone must be an error whose message names the argument, with `_` or spaces, or
/// the text behind `as`.
///
/// ```
/// use tem00_testkit::refuses;
///
/// struct Lens { focal_length: f64, f_number: f64 }
/// fn area(lens: Lens, scale: f64) -> Result<f64, String> {
///     let positive = |name, x: f64| {
///         if x > 0.0 { Ok(x) } else { Err(format!("{name} must be positive")) }
///     };
///     let focal_length = positive("focal_length", lens.focal_length)?;
///     let diameter = focal_length / positive("f-number", lens.f_number)?;
///     Ok(positive("scale", scale)? * diameter * diameter)
/// }
///
/// refuses!(lens = Lens { focal_length: 0.1, f_number: 8.0 }, scale = 1.0 => area(lens, scale);
///     scale: [0.0, -1.0, f64::NAN],
///     lens.focal_length: [0.0],
///     lens.f_number as "f-number": [0.0, f64::NAN],
/// );
/// ```
#[macro_export]
macro_rules! refuses {
    ($($name:ident = $default:expr),+ => $make:expr;
        $($bad:ident $(. $field:ident)* $(as $shown:literal)? : [$($value:expr),+ $(,)?]),+
        $(,)?) => {{
        let defaults = { $(let $name = $default;)+ $make };
        $crate::assert_accepted(stringify!($make), defaults);
        $crate::refuses!(@rows { $(let mut $name = $default; let _ = &mut $name;)+ } ($make)
            $({ $bad $(. $field)* } [$($shown)?] [$($value),+])+);
    }};
    (@rows $defaults:tt $make:tt $($place:tt $shown:tt [$($value:expr),+])+) => {
        $($($crate::refuses!(@one $defaults $make $place $shown $value);)+)+
    };
    (@one { $($defaults:tt)* } ($make:expr) { $($place:tt)+ } [$($shown:literal)?]
        $value:expr) => {{
        $($defaults)*
        $($place)+ = $value;
        let place = [stringify!($($place)+), stringify!($value)];
        $crate::assert_refused(place, concat!($($shown)?), stringify!($make), $make);
    }};
}

/// Asserts that the defaults of a table make an object.
#[track_caller]
pub fn assert_accepted<T, E: Debug>(make: &str, result: Result<T, E>) {
    if let Err(error) = result {
        panic!("{make} refuses the defaults: {error:?}");
    }
}

/// Asserts that a result is an error that names the argument at a place, as shown.
#[track_caller]
pub fn assert_refused<T, E: Display>(
    [place, value]: [&str; 2],
    shown: &str,
    make: &str,
    result: Result<T, E>,
) {
    let field = place.rsplit('.').next().unwrap_or(place).trim();
    let name = if shown.is_empty() { field } else { shown };
    let Err(error) = result else {
        panic!("{make} accepts {place} = {value}");
    };
    let text = error.to_string();
    let named = text.contains(name) || text.contains(&name.replace('_', " "));
    assert!(
        named,
        "{make} with {place} = {value} blames another: {text}"
    );
}

#[cfg(test)]
mod tests {
    fn root(value: f64, scale: f64) -> Result<f64, String> {
        let product = value * scale;
        let wrong = || format!("value must not be negative, got {value}");
        if product >= 0.0 {
            Ok(product.sqrt())
        } else {
            Err(wrong())
        }
    }

    #[test]
    #[should_panic(expected = "root(value, 2.0) accepts value = 0.5")]
    fn good_values_fail_the_table() {
        refuses!(value = 1.0 => root(value, 2.0); value: [-1.0, 0.5]);
    }

    #[test]
    #[should_panic(expected = "scale = -1.0 blames another")]
    fn errors_that_name_another_argument_fail_the_table() {
        refuses!(scale = 1.0 => root(1.0, scale); scale: [-1.0]);
    }

    #[test]
    #[should_panic(expected = "refuses the defaults")]
    fn defaults_must_be_valid() {
        refuses!(value = -1.0 => root(value, 1.0); value: [-2.0]);
    }
}
