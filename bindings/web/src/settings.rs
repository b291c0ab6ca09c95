//! Settings of the page, in units for people.

use crate::AnyError;

/// A number that can be set.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Its name.
    pub name: &'static str,
    /// Label of the control, including its unit.
    pub label: &'static str,
    /// Allowed values.
    pub allowed: Allowed,
    /// The value at the start.
    pub start: f64,
    /// Parts to rebuild after a change of this setting.
    pub changes: Changes,
}

/// The values of a setting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// From the first to the second.
    Between(f64, f64),
    /// The number of one of these, from 0.
    OneOf(&'static [&'static str]),
}

impl Allowed {
    /// The least and the greatest value.
    pub fn range(self) -> [f64; 2] {
        match self {
            Self::Between(least, most) => [least, most],
            Self::OneOf(choices) => [0.0, (choices.len() - 1) as f64],
        }
    }
}

/// Off or on.
const SWITCH: Allowed = Allowed::OneOf(&["off", "on"]);

/// Parts to rebuild after a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Changes {
    /// The picture from the same light.
    View,
    /// The light on the sensor.
    Frame,
    /// The speckle, since its size or its path is another.
    Stack,
}

macro_rules! settings {
    ($($field:ident $label:literal $allowed:expr, $start:literal $changes:ident;)*) => {
        /// Everything that can be set.
        pub const SETTINGS: &[Setting] = &[$(Setting {
            name: stringify!($field),
            label: $label,
            allowed: $allowed,
            start: $start,
            changes: Changes::$changes,
        }),*];

        /// The values of all settings.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[expect(missing_docs, reason = "the labels say it")]
        pub struct Values {
            $(pub $field: f64),*
        }

        impl Default for Values {
            fn default() -> Self {
                Self { $($field: $start),* }
            }
        }

        impl Values {
            fn slot(&mut self, name: &str) -> Option<&mut f64> {
                match name {
                    $(stringify!($field) => Some(&mut self.$field),)*
                    _ => None,
                }
            }
        }
    };
}

settings! {
    part "Part" Allowed::OneOf(&["plate", "step gauge", "sphere", "corner"]), 1.0 Frame;
    light "Light" Allowed::OneOf(&["line", "spot"]), 0.0 Frame;
    wavelength "Wavelength, nm" Allowed::Between(405.0, 850.0), 650.0 Stack;
    f_number "f-number" Allowed::Between(4.0, 32.0), 16.0 Stack;
    distance "Distance of the camera, mm" Allowed::Between(150.0, 600.0), 300.0 Stack;
    line_width "Width of the light, mm" Allowed::Between(0.05, 20.0), 1.0 Frame;
    power "Power, mW" Allowed::Between(0.1, 50.0), 5.0 Frame;
    exposure "Exposure, ms" Allowed::Between(0.1, 100.0), 5.0 View;
    lamp "Lamp, W/m²" Allowed::Between(0.0, 50.0), 5.0 Frame;
    slide "The part slides, µm" Allowed::Between(-300.0, 300.0), 0.0 Frame;
    lift "The part lifts, µm" Allowed::Between(-2000.0, 2000.0), 0.0 Frame;
    tilt "The part tilts, mrad" Allowed::Between(-3.0, 3.0), 0.0 Frame;
    azimuth "Camera around the part, °" Allowed::Between(-180.0, 180.0), -70.0 Frame;
    elevation "Camera above the plate, °" Allowed::Between(10.0, 89.0), 50.0 Frame;
    speckle "Speckle" SWITCH, 1.0 Frame;
    printed "As printed in 2016" SWITCH, 0.0 Frame;
    false_colour "False colour" SWITCH, 0.0 View;
    zoom "Zoom on the pixels" Allowed::Between(1.0, 32.0), 1.0 View;
    zoom_x "Centre of the zoom, part of the width" Allowed::Between(0.0, 1.0), 0.5 View;
    zoom_y "Centre of the zoom, part of the height" Allowed::Between(0.0, 1.0), 0.5 View;
    seed "Seed" Allowed::Between(0.0, 4_294_967_295.0), 1.0 Stack;
}

impl Values {
    /// Sets the value of that name, and says what has to be made again.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such setting, or the value is not in its range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<Changes, AnyError> {
        let unknown = || format!("there is no setting `{name}`");
        let setting = SETTINGS.iter().find(|setting| setting.name == name);
        let setting = setting.ok_or_else(unknown)?;
        let [min, max] = setting.allowed.range();
        if !(min..=max).contains(&value) {
            return Err(format!("`{name}` is {value}: it must be from {min} to {max}").into());
        }
        *self.slot(name).ok_or_else(unknown)? = value;
        Ok(setting.changes)
    }
}

/// Returns all settings as JSON: name, label, min, max, start and choices of each.
pub fn as_json() -> String {
    let setting = |setting: &Setting| {
        let [min, max] = setting.allowed.range();
        let choices = match setting.allowed {
            Allowed::OneOf(choices) => choices,
            Allowed::Between(..) => &[],
        };
        let Setting {
            name, label, start, ..
        } = setting;
        // Debug quotes as JSON does: no name needs more.
        format!(
            "{{\"name\":{name:?},\"label\":{label:?},\"min\":{min},\"max\":{max},\
             \"start\":{start},\"choices\":{choices:?}}}"
        )
    };
    let all: Vec<String> = SETTINGS.iter().map(setting).collect();
    format!("[{}]", all.join(","))
}
